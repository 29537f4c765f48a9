// Deflected centre lines of a static state.
#include <assembly/element_section.hpp>
#include <assembly/section_results.hpp>
#include <core/rotation.hpp>
#include <results/along_shaft.hpp>
#include <results/static_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::results {

namespace {

constexpr int stretches = 8;  ///< of an element, between the points at which it is drawn; even

/// The cubic over 0 .. 1 that begins at zero without slope and ends at `end` with the slope `turn`.
Vec3 cubic(double x, const Vec3& end, const Vec3& turn) {
  return x * x * ((3.0 - 2.0 * x) * end + (x - 1.0) * turn);
}

/// How far the centre line of each element lies beside the cubic through its ends with the directors as
/// slopes: what weight and shear add between nodes. With the exact section forces (section_results.hpp)
///   d' = M x d/EI,  r' = d + (F - F.d d)/kGA
/// integrated from the left end, less the cubic of what is left at the right one. Zero where the section
/// is none of a shaft with one stiffness, or the line follows a path.
class BetweenNodes {
 public:
  using Points = std::array<Vec3, stretches + 1>;
  BetweenNodes(const run::Job& job, const system::Workspace& state, const MeanLoads& loads)
      : job_(job),
        forces_(assembly::calc_section_results(job.model, job.mesh, job.built, state,
                                               loads.elements, inner)) {}

  struct Beside {
    Points line;
    std::optional<Vec3>
        turn;  ///< of the section normal from end to end, of the sound shaft; where known
  };
  Beside of(std::size_t element) const;

 private:
  static constexpr int inner = stretches - 1;  ///< points between the ends of an element
  const run::Job& job_;
  std::vector<assembly::SectionPoint> forces_;
};

BetweenNodes::Beside BetweenNodes::of(std::size_t element) const {
  Beside beside;
  Points& out = beside.line;
  out.fill(Vec3::Zero());
  const meshes::Element& e = job_.mesh.elements[element];
  const model::Shaft& shaft = job_.model.shafts[at(e.line)];
  if (!shaft.path.empty() || shaft.sections[e.section].general) return beside;
  const elements::ElementSection section = assembly::element_section(job_.model, e);
  const double h = (e.s2 - e.s1) / stretches;
  std::array<Vec3, inner + 2> bending, shear;
  for (std::size_t k = 0; k < bending.size(); ++k) {
    const assembly::SectionPoint& p = forces_[element * bending.size() + k];
    const elements::SectionProperties s = section.at(p.xi);
    bending[k] = p.moment.cross(p.normal) / s.EI;
    shear[k] = (p.force - p.force.dot(p.normal) * p.normal) / s.kGA;
  }
  Vec3 slope = Vec3::Zero();
  for (std::size_t k = 0; k < stretches; k += 2) {  // parabolas through three points
    const Vec3 &a = bending[k], &m = bending[k + 1], &b = bending[k + 2];
    const Vec3 &u = shear[k], &v = shear[k + 1], &w = shear[k + 2];
    out[k + 1] = out[k] + h * slope + h * h / 24.0 * (7.0 * a + 6.0 * m - b) +
                 h / 12.0 * (5.0 * u + 8.0 * v - w);
    slope += h / 12.0 * (5.0 * a + 8.0 * m - b);
    out[k + 2] = out[k + 1] + h * slope + h * h / 24.0 * (10.0 * m + 3.0 * b - a) +
                 h / 12.0 * (8.0 * v + 5.0 * w - u);
    slope += h / 12.0 * (8.0 * m + 5.0 * b - a);
  }
  const Vec3 end = out.back(), turn = (e.s2 - e.s1) * slope;
  for (std::size_t k = 0; k <= stretches; ++k) {
    const double x = static_cast<double>(k) / stretches;
    out[k] -= cubic(x, end, turn);
  }
  beside.turn = slope;
  return beside;
}

/// The deflected centre line of one line of the mesh.
class DeflectedLine {
 public:
  DeflectedLine(const run::Job& job, const system::Workspace& state, std::size_t line)
      : job_(job),
        state_(state),
        number_(line),
        line_(job.mesh.lines[line]),
        path_(job.model.shafts[line].path) {}
  void add_stations(io::Table& t);
  void add_elements(const BetweenNodes& between);
  /// No axes where nothing moves.
  plot::Figure figure(const std::string& step) const;
  /// The largest deflection, where there is one.
  void say_largest(std::vector<std::string>& lines, io::Value& summary) const;

 private:
  const system::NodeState& node(Index n) const { return state_.in_own_axes(n); }
  /// Of a straight line what lies across it, without the growth along it.
  double size_of(const Vec3& u) const {
    return path_.empty() ? std::hypot(u.y(), u.z()) : u.norm();
  }
  /// Direction of a line along a path, now.
  Vec3 tangent(const system::NodeState& n, const Path::Point& p) const {
    return Vec3(meshes::section_axes(*n.chart, n.d(), n.phi) * p.triad.col(0));
  }
  struct Turn {
    Vec2 slope;  ///< of the section normal, along the second and third axis of the line
    double phi;  ///< about the line, rad
  };
  /// Along a path the axes are those of the undeformed line at the place. A standing line turns by
  /// less than half a turn about itself; what spins counts its turns about the axis of the line.
  Turn turn_of(const system::NodeState& n, double s) const {
    if (path_.empty()) return {n.d().tail<2>(), n.phi};
    const Mat3 before = path_.after(s).triad;
    const Mat3 now = meshes::section_axes(*n.chart, n.d(), n.phi) * before;
    const Vec2 slope(now.col(0).dot(before.col(1)), now.col(0).dot(before.col(2)));
    const bool opposite = 1.0 + now.col(0).dot(before.col(0)) < 1e-12;
    if (line_.rotating || opposite) return {slope, n.phi};
    const Mat3 bent = rotation::minimal_rotation(before.col(0), now.col(0)) * before;
    return {slope, std::atan2(now.col(1).dot(bent.col(2)), now.col(1).dot(bent.col(1)))};
  }
  meshes::Pose pose(const meshes::Place& p) const {
    const system::NodeState& n = node(p.node);
    return {job_.mesh.nodes[at(p.node)].position + n.u + p.offset * n.d(), n.d(), n.phi};
  }
  /// What cracks make of the line in an element beside that cubic: a kink each. lost: the turning that the
  /// sound shaft between the nodes does not have.
  BetweenNodes::Points kinks(const meshes::Element& e, const Vec3& lost) const;
  void add_point(double s, const Vec3& u);
  void look_between_points();

  const run::Job& job_;
  const system::Workspace& state_;
  std::size_t number_;
  const meshes::Line& line_;
  const Path& path_;
  plot::Series x_ = curve_of("axial"), y_ = curve_of("y"), z_ = curve_of("z"),
               phi_ = curve_of("angle");
  double largest_ = 0, where_ = 0;                    ///< m
  double whole_ = 0;                                  ///< m, along the line too
  const meshes::Station* largest_station_ = nullptr;  ///< null: between stations
};

void DeflectedLine::add_stations(io::Table& t) {
  const double phi0 = turn_of(node(line_.first_node), 0.0).phi;
  for (Index k = line_.first_station; k < line_.first_station + line_.stations; ++k) {
    const meshes::Station& station = job_.mesh.stations[at(k)];
    const system::NodeState& n = node(station.at.node);
    const Vec3 u = n.u + station.at.offset * (n.d() - Vec3::UnitX());
    const Turn turn = turn_of(n, station.s);
    t.add({line_.name, station.s, station.label(), u.x(), u.y(), u.z(), turn.slope.x(),
           turn.slope.y(), turn.phi});
    phi_.x.push_back(station.s);
    phi_.y.push_back(turn.phi - phi0);
    whole_ = std::max(whole_, u.norm());
    if (const double size = size_of(u); size > largest_ * (1 + 1e-9)) {
      largest_ = size;
      where_ = station.s;
      largest_station_ = &station;
    }
  }
}

BetweenNodes::Points DeflectedLine::kinks(const meshes::Element& e, const Vec3& lost) const {
  BetweenNodes::Points out;
  out.fill(Vec3::Zero());
  std::vector<double> places;
  // the bend of a bow is none of the crack's, and stands in the cubic
  if (job_.model.shafts[number_].bow.any()) return out;
  for (const model::Crack& c : job_.model.cracks) {
    const double from = std::max(e.s1, c.at.s), to = std::min(e.s2, c.to ? c.to->s : c.at.s);
    if (c.at.shaft == number_ && from <= to) places.push_back(0.5 * (from + to));
  }
  for (const double s : places) {
    const Vec3 kink = lost / static_cast<double>(places.size());
    for (std::size_t k = 0; k <= stretches; ++k) {
      const double x = static_cast<double>(k) / stretches;
      out[k] += std::max(0.0, e.s1 + x * (e.s2 - e.s1) - s) * kink -
                cubic(x, (e.s2 - s) * kink, (e.s2 - e.s1) * kink);
    }
  }
  return out;
}

/// Between nodes: the cubic with the directors as end slopes, and what lies beside it.
void DeflectedLine::add_elements(const BetweenNodes& between) {
  for (Index k = line_.first_element; k < line_.first_element + line_.elements; ++k) {
    const meshes::Element& e = job_.mesh.elements[at(k)];
    meshes::Pose a = pose(e.left), b = pose(e.right);
    if (!path_.empty()) {
      a.d = tangent(node(e.left.node), path_.after(e.s1));
      b.d = tangent(node(e.right.node), path_.before(e.s2));
    }
    // end slopes for the stretched length (thermal growth): chord, and the arc over it
    const double arc = (b.r - a.r).norm() * (1.0 + (b.d - a.d).squaredNorm() / 24.0);
    const BetweenNodes::Beside beside = between.of(at(k));
    const Vec3 turned = b.d - a.d;
    const BetweenNodes::Points kinked =
        kinks(e, beside.turn ? Vec3(turned - *beside.turn) : Vec3(Vec3::Zero()));
    for (int i = k == line_.first_element ? 0 : 1; i <= stretches; ++i) {
      const double xi = static_cast<double>(i) / stretches, s = e.s1 + xi * (e.s2 - e.s1);
      add_point(s, meshes::interpolate(a, b, arc, xi).r + beside.line[at(i)] + kinked[at(i)] -
                       job_.model.shafts[number_].position(s));
    }
  }
  look_between_points();
}

void DeflectedLine::add_point(double s, const Vec3& u) {
  x_.x.push_back(s);
  x_.y.push_back(u.x());
  y_.x.push_back(s);
  y_.y.push_back(u.y());
  z_.x.push_back(s);
  z_.y.push_back(u.z());
}

void DeflectedLine::look_between_points() {
  const auto size = [&](std::size_t k) { return size_of(Vec3(x_.y[k], y_.y[k], z_.y[k])); };
  const auto take = [&](double s, double u) {
    if (!(u > largest_ * (1 + 1e-9))) return;
    largest_ = u;
    where_ = s;
    largest_station_ = nullptr;
  };
  for (std::size_t k = 0; k < x_.x.size(); ++k) {
    take(x_.x[k], size(k));
    if (k == 0 || k + 1 == x_.x.size()) continue;
    // the vertex of the parabola through three points
    const double a = x_.x[k - 1] - x_.x[k], b = x_.x[k + 1] - x_.x[k];
    const double before = (size(k - 1) - size(k)) / a, after = (size(k + 1) - size(k)) / b;
    const double bend = (after - before) / (b - a), slope = before - a * bend;
    const double at_vertex = -0.5 * slope / bend;
    if (bend < 0.0 && at_vertex > a && at_vertex < b)
      take(x_.x[k] + at_vertex, size(k) + 0.5 * slope * at_vertex);
  }
}

plot::Figure DeflectedLine::figure(const std::string& step) const {
  plot::Figure f = figure_of_line(job_, step, "deflection", number_);
  f.title = job_.mesh.lines.size() > 1 ? "Deflected centre line of " + line_.name
                                       : "Deflected centre line";
  const auto row = [&](const char* label, const std::vector<plot::Series>& curves, const char* unit,
                       double limit) {
    std::vector<plot::Series> shown;
    std::copy_if(curves.begin(), curves.end(), std::back_inserter(shown),
                 [&](const plot::Series& s) { return largest_of(s) > limit; });
    if (!shown.empty()) add_row(f, job_, number_, label, unit, std::move(shown), curves.size() > 1);
  };
  const double lateral = std::max(largest_of(y_), largest_of(z_));
  const double size = std::max(lateral, largest_of(x_));
  row("lateral displacement", {y_, z_}, "m", std::max(1e-9 * lateral, 1e-15));
  row("axial displacement", {x_}, "m", std::max(1e-6 * size, 1e-15));
  row("twist from the left end", {phi_}, "rad", 1e-9);
  f.height = 110.0 + 200.0 * static_cast<double>(std::max<std::size_t>(f.axes.size(), 1));
  return f;
}

void DeflectedLine::say_largest(std::vector<std::string>& lines, io::Value& summary) const {
  if (!(largest_ > 0)) return;
  const plot::DisplayUnit u = plot::length_unit(largest_);
  const bool named = largest_station_ && !largest_station_->labels.empty();
  std::string said =
      fmt::format("{} '{}': largest deflection {:.4g} {} at {:.4g} m{}",
                  line_.rotating ? "shaft" : "casing", line_.name, largest_ * u.factor, u.name,
                  where_, named ? " (" + largest_station_->label() + ")" : std::string());
  if (!line_.rotating && path_.empty() && whole_ > 1.01 * largest_) {
    const plot::DisplayUnit v = plot::length_unit(whole_);
    said += fmt::format(" across it, largest displacement {:.4g} {}", whole_ * v.factor, v.name);
    summary["deflection"][line_.name]["largest displacement [m]"] = whole_;
  }
  lines.push_back(std::move(said));
  summary["deflection"][line_.name]["largest [m]"] = largest_;
  summary["deflection"][line_.name]["at [m]"] = where_;
}

}  // namespace

void add_deflection(const run::Job& job, const std::string& step, const system::Workspace& state,
                    const MeanLoads& loads, StaticResults& out, io::Value& summary) {
  out.deflection.title = "Deflection";
  out.deflection.columns = {{"shaft", "-", ""},
                            {"s", "m", "from the left end"},
                            {"station", "-", ""},
                            {"u_x", "m", "displacement of the centre line"},
                            {"u_y", "m", ""},
                            {"u_z", "m", ""},
                            {"slope_y", "rad", "d_y of the section normal"},
                            {"slope_z", "rad", "d_z; along a path of the axes at the place"},
                            {"phi", "rad", "axial angle; of standing paths about the line"}};
  const BetweenNodes between(job, state, loads);
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    DeflectedLine line(job, state, l);
    line.add_stations(out.deflection);
    line.add_elements(between);
    if (plot::Figure f = line.figure(step); !f.axes.empty()) out.figures.push_back(std::move(f));
    line.say_largest(out.lines, summary);
  }
}

}  // namespace whirl::results
