// Mode shapes and operating shapes as figures and as frames for ParaView.
#include <results/frame_arrays.hpp>
#include <results/frequency.hpp>

#include <core/rotation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

/// Change of the director of a node, global axes.
Eigen::Vector3cd tilt_of(const analysis::Linearizer& linear, const VecXc& a, Index node) {
  const system::State& s = linear.equilibrium().state;
  rotation::Director d;
  rotation::director(s.q.segment<2>(6 * node + 4), d);
  return s.frames.axes(node) * (d.D * a.segment<2>(6 * node + 4));
}

struct Station {
  double s;
  Eigen::Vector3cd u, t;
};

/// Displacement and tilt at the stations of a line, axes of the line.
std::vector<Station> stations_of(const FrequencyStep& step, const VecXc& a, std::size_t l) {
  const meshes::Mesh& mesh = step.job.mesh;
  const meshes::Line& line = mesh.lines[l];
  const Mat3 axes = step.linear.equilibrium().state.frames.chart[l].transpose();
  std::vector<Station> out;
  for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
    const meshes::Station& st = mesh.stations[at(k)];
    const Eigen::Vector3cd t = tilt_of(step.linear, a, st.at.node);
    out.push_back({st.s, axes * (a.segment<3>(6 * st.at.node) + st.at.offset * t), axes * t});
  }
  return out;
}

/// Names of disks and bearings on a line.
std::vector<std::pair<std::string, double>> names_on(const run::Job& job, std::size_t l) {
  std::vector<std::pair<std::string, double>> out;
  for (const model::Disk& d : job.model.disks)
    if (d.at.shaft == l) out.emplace_back(d.name, d.at.s);
  for (const model::Bearing& b : job.model.bearings) {
    if (b.at.shaft == l) out.emplace_back(b.name, b.at.s);
    if (b.to && b.to->shaft == l) out.emplace_back(b.name, b.to->s);
  }
  return out;
}

plot::Figure along_figure(const FrequencyStep& s, const ShapeDrawing& d) {
  const int c = d.kind == analysis::ModeKind::torsional ? 3 : 0;
  plot::Axes axes;
  axes.x = plot::Axis("axial position", "m");
  axes.y = plot::Axis(c == 3 ? "twist, largest = 1" : "axial motion, largest = 1", "-");
  axes.y.include_zero = true;
  constexpr double first_of_equals = 1.0 + 1e-9;
  double largest = 0;
  Complex top = 1;
  for (Index n = 0; n < s.linear.system().nodes(); ++n)
    if (const Complex x = (*d.a)[6 * n + c];
        !s.linear.system().node(n).scalar && std::abs(x) > first_of_equals * largest) {
      largest = std::abs(x);
      top = x;
    }
  for (std::size_t l = 0; l < s.job.mesh.lines.size(); ++l) {
    const meshes::Line& line = s.job.mesh.lines[l];
    plot::Series y;
    y.label = s.job.mesh.lines.size() > 1 ? line.name : "";
    y.style.marker = plot::Marker::circle;
    y.style.marker_size = 4;
    y.keep_all = true;
    for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
      const meshes::Station& st = s.job.mesh.stations[at(k)];
      y.x.push_back(st.position.x());
      y.y.push_back(((*d.a)[6 * st.at.node + c] / top).real());
    }
    axes.series.push_back(std::move(y));
  }
  plot::Figure f;
  f.name = s.file(d.name);
  f.title = d.title;
  f.caption = d.caption;
  f.height = 300;
  f.axes.push_back(std::move(axes));
  return f;
}

/// Places along a line between stations and the deflection there, axes of the line: the cubic with
/// the tilts as end slopes, so that a few elements bend like many.
struct FinePlace {
  double s;
  std::size_t station;  ///< to the left
  double fraction;      ///< of the way to the next
  Eigen::Vector3cd u;
};
std::vector<FinePlace> fine_places(const std::vector<Station>& st) {
  constexpr int parts = 6;
  std::vector<FinePlace> out;
  for (std::size_t k = 0; k < st.size(); ++k) {
    const double h = k + 1 < st.size() ? st[k + 1].s - st[k].s : 0.0;
    for (int i = 0; i < (h > 0 ? parts : 1); ++i) {
      const double x = static_cast<double>(i) / parts, x2 = x * x, x3 = x2 * x;
      Eigen::Vector3cd u = st[k].u;
      if (i > 0)
        u = (1 - 3 * x2 + 2 * x3) * st[k].u + (x - 2 * x2 + x3) * h * st[k].t +
            (3 * x2 - 2 * x3) * st[k + 1].u + (x3 - x2) * h * st[k + 1].t;
      out.push_back({st[k].s + x * h, k, x, u});
    }
  }
  return out;
}

/// Of the one line of a machine, in its own axes.
plot::Figure line_figure(FrequencyStep& s, const ShapeDrawing& d) {
  plot::ModeShape m;
  m.stations = names_on(s.job, 0);
  m.in_metres = d.in_metres;
  for (const FinePlace& p : fine_places(stations_of(s, *d.a, 0))) {
    m.s.push_back(p.s);
    m.y.push_back(p.u[1]);
    m.z.push_back(p.u[2]);
  }
  return plot::plot_mode_shape(s.file(d.name), d.title, m);
}

/// Displacement of a place, axes of the machine.
Eigen::Vector3cd deflection_of(const FrequencyStep& s, const VecXc& a, const meshes::Place& p) {
  return a.segment<3>(6 * p.node) + p.offset * tilt_of(s.linear, a, p.node);
}

/// All lines where they stand, in one scale, with what joins them.
plot::Figure machine_figure(FrequencyStep& s, const ShapeDrawing& d) {
  const meshes::Mesh& mesh = s.job.mesh;
  plot::MachineShape shape;
  shape.in_metres = d.in_metres;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    plot::ShapeLine line;
    line.label = mesh.lines[l].name;
    const std::vector<Station> st = stations_of(s, *d.a, l);
    const Mat3 axes = s.linear.equilibrium().state.frames.chart[l];
    const std::size_t orbits_apart = 1 + st.size() / 14;
    for (const FinePlace& p : fine_places(st)) {
      const auto station = at(mesh.lines[l].first_station) + p.station;
      const Vec3& left = mesh.stations[station].position;
      const bool last = p.station + 1 == st.size();
      const Vec3& right = last ? left : mesh.stations[station + 1].position;
      if (p.fraction == 0.0 && (p.station % orbits_apart == 0 || last))
        line.stations.push_back(line.rest.size());
      line.rest.push_back(left + p.fraction * (right - left));
      line.u.push_back(axes * p.u);
    }
    shape.lines.push_back(std::move(line));
  }
  const auto rest = [&](const meshes::Place& p) {
    const meshes::Node& n = mesh.nodes[at(p.node)];
    const Vec3 along = n.line < 0
                           ? Vec3(Vec3::UnitX())
                           : Vec3(s.linear.equilibrium().state.frames.chart[at(n.line)].col(0));
    return Vec3(n.position + p.offset * along);
  };
  for (const meshes::SupportShape& b : s.job.scene.supports) {
    plot::ShapeLink link;
    link.name = b.name;
    link.at = rest(b.at);
    link.u_at = deflection_of(s, *d.a, b.at);
    link.to_ground = !b.to_node || mesh.nodes[at(b.to.node)].line < 0;
    if (!link.to_ground) {
      link.to = rest(b.to);
      link.u_to = deflection_of(s, *d.a, b.to);
    }
    shape.links.push_back(std::move(link));
  }
  plot::Figure f = plot::plot_machine_shape(s.file(d.name), d.title, shape);
  f.caption = "All lines where they stand, their deflections enlarged alike.";
  return f;
}

}  // namespace

void add_shape_figures(FrequencyStep& s, const ShapeDrawing& d) {
  if (!s.job.model.output.report) return;
  const bool lateral = d.kind == analysis::ModeKind::lateral;
  plot::Figure f = !lateral                      ? along_figure(s, d)
                   : s.job.mesh.lines.size() > 1 ? machine_figure(s, d)
                                                 : line_figure(s, d);
  if (lateral)
    f.caption = d.caption + (d.caption.empty() || f.caption.empty() ? "" : " ") + f.caption;
  s.add_figure(std::move(f));
}

void write_shape_frames(FrequencyStep& s, const std::string& name, const VecXc& a,
                        double amplitude) {
  const model::Output& out = s.job.model.output;
  for (const model::VtkOutput& v : out.vtk) {
    if (!v.step.empty() && v.step != s.step.name) continue;
    io::VtkFrameOptions options = frame_options(s.job, v, s.file(name));
    options.deformation_scale = 1.0;  // in the amplitude
    options.max_frames = model::VtkOutput::frames_of_a_shape;
    const Index nodes = static_cast<Index>(s.job.mesh.nodes.size());
    io::HarmonicShape shape;
    double largest = 0, length = 0;
    for (Index n = 0; n < nodes; ++n) {
      shape.u.push_back(a.segment<3>(6 * n));
      shape.tilt.push_back(tilt_of(s.linear, a, n));
      shape.phi.push_back(a[6 * n + 3]);
      largest = std::max(largest, shape.u.back().cwiseAbs().maxCoeff());
    }
    double twist = 0;
    for (const Complex& p : shape.phi)
      twist = std::max(twist, std::abs(p));
    for (const meshes::Line& l : s.job.mesh.lines)
      length = std::max(length, l.length);
    double factor = amplitude;
    if (factor == 0)
      factor = largest * 0.5 > twist * 0.05 * length ? 0.05 * length / largest
               : twist > 0                           ? 0.5 / twist
                                                     : 0.0;  // a torsional mode: half a radian
    const auto writer = io::make_vtk_frames(options);
    io::write_harmonic(*writer, s.job.scene, shape, factor * v.deformation_scale,
                       model::VtkOutput::frames_of_a_shape);
  }
}

}  // namespace whirl::results
