#include <Eigen/Geometry>
#include <io/frame_sets.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace whirl::io {
namespace {

using meshes::Place;
using meshes::pose_at;
using meshes::section_axes;
using meshes::Skin;

void put(std::vector<float>& v, std::size_t i, const Vec3& x) {
  for (std::size_t c = 0; c < 3; ++c)
    v[3 * i + c] = static_cast<float>(x[static_cast<Index>(c)]);
}

PolyData::Array array(std::string name, int components, std::size_t n) {
  return {std::move(name), components,
          std::vector<float>(n * static_cast<std::size_t>(components))};
}

/// The array behind the first `before`, of n values, is there or not.
void keep_last(std::vector<PolyData::Array>& arrays, bool wanted, std::size_t before,
               const char* name, int components, std::size_t n) {
  if (wanted && arrays.size() == before) arrays.push_back(array(name, components, n));
  if (!wanted) arrays.erase(arrays.begin() + static_cast<std::ptrdiff_t>(before), arrays.end());
}

Index line_of(const Scene& s, const Place& p) { return s.node_line[at(p.node)]; }

bool knows_elements(const Scene& scene) {
  return std::any_of(scene.lines.begin(), scene.lines.end(),
                     [](const Scene::Line& l) { return !l.elements.empty(); });
}

class LineSet final : public FrameSet {
 public:
  explicit LineSet(const Scene& scene) : scene_(scene) {
    for (std::size_t l = 0; l < scene_.lines.size(); ++l)
      add_line(l);
    const std::size_t n = places_.size();
    data_.points.resize(3 * n);
    for (const char* name : {"displacement [m]", "rotation [rad]", "director", "axis2", "axis3"})
      data_.point_data.push_back(array(name, 3, n));
    data_.point_data.push_back(array("spin_angle [rad]", 1, n));
    data_.point_data.push_back({"radius [m]", 1, radius_});
  }

  const char* name() const override { return "line"; }

  void update(const FramePoses& f) override {
    const std::size_t n = places_.size();
    auto& arrays = data_.point_data;
    taken_ = 7;
    for (std::size_t i = 0; i < n; ++i) {
      const auto& p = places_[i];
      const Mat3& triad =
          f.state->charts.empty() ? scene_.lines[at(p.line)].triad : f.state->charts[at(p.line)];
      const meshes::Frame x = meshes::frame_of(f.true_poses, triad, p);
      put(data_.points, i, meshes::frame_of(f.drawn, triad, p).r);
      // tilt: of the node's axis from e; on a line along a path that of the nearer node to its left
      const Vec3 e = triad.col(0), near = f.true_poses[at(p.xi < 1 ? p.a.node : p.b.node)].d,
                 d = p.bent ? near : Vec3(x.axes.col(0)), axis = e.cross(d);
      const double s = std::sqrt(axis.squaredNorm()), g = std::atan2(s, e.dot(d));
      put(arrays[0].floats(), i, x.r - p.reference);
      put(arrays[1].floats(), i, s > 0 ? Vec3(g / s * axis) : Vec3(Vec3::Zero()));
      put(arrays[2].floats(), i, x.axes.col(0));
      put(arrays[3].floats(), i, x.axes.col(1));
      put(arrays[4].floats(), i, x.axes.col(2));
      arrays[5].floats()[i] = static_cast<float>(x.phi);
    }
    add("velocity [m/s]", f.state->velocity);
    add("angular_velocity [rad/s]", f.state->angular_velocity);
    add_sections("force [N]", f.state->force);
    add_sections("moment [N m]", f.state->moment);
    add_sections("von_mises [Pa]", f.state->stress);
    arrays.resize(taken_);
  }

 private:
  /// Of a place: the elements whose end values its own lies between, at their left (0) or right (1)
  /// ends; -1: none.
  struct Ends {
    Index a = -1, b = -1;
  };

  /// Number of the value at the nearest end of an element to the left or right of stretch k.
  static Index end_beside(const Scene::Line& line, std::size_t k, bool left) {
    if (line.elements.empty()) return -1;
    for (std::size_t i = k; left ? i > 0 : i + 1 < line.elements.size();) {
      i = left ? i - 1 : i + 1;
      if (line.elements[i] >= 0) return 2 * line.elements[i] + (left ? 1 : 0);
    }
    return -1;
  }
  static Ends ends_of(const Scene::Line& line, std::size_t k) {
    if (k >= line.elements.size()) return {};
    if (const Index e = line.elements[k]; e >= 0) return {2 * e, 2 * e + 1};
    // rigid: what the elements beside it leave at its ends
    Ends out{end_beside(line, k, true), end_beside(line, k, false)};
    if (out.a < 0) out.a = out.b;
    if (out.b < 0) out.b = out.a;
    return out;
  }

  void add_line(std::size_t l) {
    const Scene::Line& line = scene_.lines[l];
    std::vector<std::int64_t> ids;
    const auto finish = [&] {
      if (ids.size() > 1)
        data_.lines.add(ids.data(), ids.size());
      else if (ids.size() == 1)
        data_.vertices.add(ids.data(), 1);
      ids.clear();
    };
    const std::size_t points = line.points.size();
    for (std::size_t k = 0; k + 1 < points || (points == 1 && k == 0); ++k) {
      const std::size_t next = std::min(k + 1, points - 1);
      const bool elastic = line.points[k].node != line.points[next].node;
      const bool ends = next + 1 == points || (next < line.breaks.size() && line.breaks[next]);
      const int n = points == 1 ? 1 : elastic ? 4 : 1;
      for (int j = 0; j < n + (ends && points > 1 ? 1 : 0); ++j) {
        ids.push_back(static_cast<std::int64_t>(places_.size()));
        add_place(l, k, static_cast<double>(j) / n);
      }
      if (ends) finish();
    }
  }

  /// Outer radii at both ends of the stretch between two points, m: of its piece of the shaft, so that a
  /// step is a step.
  static std::pair<double, double> radii_of(const Scene::Line& line, std::size_t k,
                                            std::size_t next) {
    const auto same = [](const Place& a, const Place& b) {
      return a.node == b.node && a.offset == b.offset;
    };
    const auto piece = std::find_if(line.pieces.begin(), line.pieces.end(), [&](const auto& p) {
      return same(p.left, line.points[k]) && same(p.right, line.points[next]);
    });
    if (piece != line.pieces.end()) return {piece->outer_left, piece->outer_right};
    const double ra = k < line.radius.size() ? line.radius[k] : 0.0;
    return {ra, next < line.radius.size() ? line.radius[next] : ra};
  }

  /// A place in the stretch from point k to the next.
  void add_place(std::size_t l, std::size_t k, double xi) {
    const Scene::Line& line = scene_.lines[l];
    const std::size_t next = std::min(k + 1, line.points.size() - 1);
    const auto [ra, rb] = radii_of(line, k, next);
    const bool bent = scene_.bent(static_cast<Index>(l));
    places_.push_back(meshes::make_spot(scene_, static_cast<Index>(l), line.points[k],
                                        line.points[next], xi, bent ? line.bend_after[k] : -1,
                                        bent ? line.bend_before[next] : -1));
    ends_.push_back(ends_of(line, k));
    radius_.push_back(static_cast<float>(ra + xi * (rb - ra)));
  }

  /// Values at the ends of elements, where there are as many, else at nodes.
  template <class T>
  void add_sections(const char* name, std::span<const T> values) {
    if (!knows_elements(scene_))
      add(name, values);
    else
      put_array(name, values, [&](std::size_t i) -> T {
        const Ends& e = ends_[i];
        if (e.a < 0) return T(0.0 * values[0]);
        return T((1 - places_[i].xi) * values[at(e.a)] + places_[i].xi * values[at(e.b)]);
      });
  }
  /// Values at nodes, linear between them.
  template <class T>
  void add(const char* name, std::span<const T> values) {
    put_array(name, values, [&](std::size_t i) -> T {
      const meshes::Spot& p = places_[i];
      return T((1 - p.xi) * values[at(p.a.node)] + p.xi * values[at(p.b.node)]);
    });
  }
  template <class T, class ValueAt>
  void put_array(const char* name, std::span<const T> values, ValueAt value_at) {
    if (values.empty()) return;
    constexpr bool vector = std::is_same_v<T, Vec3>;
    std::vector<float>& to = next_array(name, vector ? 3 : 1).floats();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const T v = value_at(i);
      if constexpr (vector)
        put(to, i, v);
      else
        to[i] = static_cast<float>(v);
    }
  }
  /// That of the last frame, where it had one of this name in this place.
  PolyData::Array& next_array(const char* name, int components) {
    auto& arrays = data_.point_data;
    const std::size_t k = taken_++;
    if (k < arrays.size() && arrays[k].name == name) return arrays[k];
    arrays.resize(k);
    arrays.push_back(array(name, components, places_.size()));
    return arrays.back();
  }

  Scene scene_;
  std::vector<meshes::Spot> places_;
  std::vector<Ends> ends_;  ///< of each place
  std::vector<float> radius_;
  std::size_t taken_ = 0;  ///< arrays of this frame so far
};

class SurfaceSet final : public FrameSet {
 public:
  SurfaceSet(const Scene& scene, int points_around)
      : skin_(scene, points_around),
        sections_known_(knows_elements(scene)) {
    const auto& q = skin_.quads();
    std::vector<std::int64_t> id(4);
    for (std::size_t k = 0; k < q.size(); k += 4) {
      std::copy_n(q.begin() + static_cast<std::ptrdiff_t>(k), 4, id.begin());
      data_.polygons.add(id.data(), 4);
    }
    data_.normals = "Normals";
    data_.point_data.push_back({"Normals", 3, std::vector<float>{}});
    data_.point_data.push_back({"displacement [m]", 3, std::vector<float>{}});
    data_.cell_data.push_back(
        {"stripe", 1, std::vector<std::int32_t>(skin_.stripe().begin(), skin_.stripe().end())});
    data_.cell_data.push_back(
        {"part", 1, std::vector<std::int32_t>(skin_.part().begin(), skin_.part().end())});
    data_.names.push_back({"part names", skin_.part_names()});
  }
  const char* name() const override { return "surface"; }
  void update(const FramePoses& f) override {
    for (std::size_t l = 0; l < f.state->charts.size(); ++l)
      skin_.set_chart(static_cast<Index>(l), f.state->charts[l]);
    skin_.update(f.drawn, data_.points, data_.point_data[0].floats());
    skin_.centre_displacement(f.true_poses, data_.point_data[1].floats());
    const bool stressed = sections_known_ && !f.state->stress.empty();
    keep_last(data_.point_data, stressed, 2, "von_mises [Pa]", 1, 0);
    if (stressed) skin_.section_values(f.state->stress, data_.point_data[2].floats());
  }

 private:
  Skin skin_;
  bool sections_known_;  ///< stresses of a state are those at the ends of elements
};

class SupportSet final : public FrameSet {
 public:
  explicit SupportSet(const Scene& scene) : scene_(scene) {
    make_tables();
    for (std::size_t k = 0; k < scene_.supports.size(); ++k) {
      const auto& s = scene_.supports[k];
      const std::int64_t vertex = grow(1);
      data_.vertices.add(&vertex, 1);
      if (s.picture == model::Picture::bearing)
        for (int ring = 0; ring < 2; ++ring)
          polyline(ring_points + 1);
      polylines_of_springs(s);
    }
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) {
      const std::int64_t vertex = grow(1);
      data_.vertices.add(&vertex, 1);
    }
    data_.points.resize(3 * count_);
    data_.point_data.push_back(array("force [N]", 3, count_));
    // Cell data follow the order of cells: all vertices, then all lines.
    std::vector<std::int32_t> number;
    for (std::size_t k = 0; k < scene_.supports.size(); ++k)
      number.push_back(static_cast<std::int32_t>(k));
    const std::size_t joints = scene_.joints.size(), first_joint = number.size();
    number.insert(number.end(), joints, -1);
    for (std::size_t k = 0; k < scene_.supports.size(); ++k) {
      const auto& s = scene_.supports[k];
      number.insert(number.end(), s.picture == model::Picture::bearing ? 6 : 2,
                    static_cast<std::int32_t>(k));
    }
    std::vector<std::int32_t> joint(number.size(), -1);
    std::iota(joint.begin() + static_cast<std::ptrdiff_t>(first_joint),
              joint.begin() + static_cast<std::ptrdiff_t>(first_joint + joints), 0);
    data_.cell_data.push_back({"support", 1, std::move(number)});
    if (joints > 0) data_.cell_data.push_back({"joint", 1, std::move(joint)});
    name_cells();
  }
  const char* name() const override { return "bearings"; }

  void update(const FramePoses& f) override {
    std::size_t i = 0;
    const bool moments = !f.state->support_moment.empty();
    keep_last(data_.point_data, moments, 1, "moment [N m]", 3, count_);
    auto& force = data_.point_data[0].floats();
    for (std::size_t k = 0; k < scene_.supports.size(); ++k) {
      const auto& s = scene_.supports[k];
      const Mat3& triad = scene_.lines[at(line_of(scene_, s.at))].triad;
      const Pose journal = pose_at(f.drawn, s.at);
      const Mat3 bend = s.bend >= 0 ? scene_.bends[at(s.bend)] : Mat3(Mat3::Identity());
      Vec3 far = scene_.nodes[at(s.at.node)] + s.at.offset * triad.col(0);
      Mat3 far_axes = triad * bend;
      if (s.to_node) {
        const Pose other = pose_at(f.drawn, s.to);
        far = other.r;
        far_axes = section_axes(scene_.lines[at(line_of(scene_, s.to))].triad, other.d, 0.0);
      }
      const double r = s.radius > 0 ? s.radius : default_radius();
      if (!f.state->support_force.empty()) put(force, i, f.state->support_force[k]);
      if (moments) put(data_.point_data[1].floats(), i, f.state->support_moment[k]);
      put(data_.points, i++, journal.r);
      // Springs do not turn with the shaft: axes at phi = 0.
      const Mat3 axes = section_axes(triad, journal.d, 0.0) * bend;
      if (s.picture == model::Picture::bearing) {
        circle(journal.r, axes, 1.12 * r, i);
        circle(far, far_axes, 1.9 * r, i);
        for (int q = 0; q < 4; ++q) {
          const double a = pi / 4 + q * pi / 2;
          helix(far + 1.9 * r * (std::cos(a) * far_axes.col(1) + std::sin(a) * far_axes.col(2)),
                journal.r + 1.12 * r * (std::cos(a) * axes.col(1) + std::sin(a) * axes.col(2)),
                triad * bend.col(0), 0.12 * r, i);
        }
      } else {
        for (int q = 1; q < 3; ++q)
          helix(far - 5.0 * r * far_axes.col(q), journal.r, triad * bend.col(0), 0.5 * r, i);
      }
    }
    for (std::size_t k = 0; k < scene_.joints.size(); ++k) {
      if (!f.state->joint_force.empty()) put(force, i, f.state->joint_force[k]);
      if (!f.state->joint_moment.empty())
        put(data_.point_data[1].floats(), i, f.state->joint_moment[k]);
      put(data_.points, i++, place_of(f.drawn, scene_.joints[k]));
    }
  }

 private:
  static constexpr std::size_t ring_points = 48, spring_points = 97, turns = 6;
  struct Ring {
    double cos, sin;
  };
  /// Of a point of a spring: the share of its length before it, of its radius, and where around it.
  struct Coil {
    double x, swell, cos, sin;
  };

  void make_tables() {
    for (std::size_t k = 0; k <= ring_points; ++k) {
      const double a = two_pi * static_cast<double>(k) / ring_points;
      ring_.push_back({std::cos(a), std::sin(a)});
    }
    for (std::size_t k = 0; k < spring_points; ++k) {
      const double x = static_cast<double>(k) / (spring_points - 1);
      const double coil = std::clamp((x - 0.12) / 0.76, 0.0, 1.0), angle = two_pi * turns * coil;
      const double swell = std::min({1.0, 12 * coil, 12 * (1 - coil)});
      coil_.push_back({x, swell, std::cos(angle), std::sin(angle)});
    }
  }

  void name_cells() {
    PolyData::Names supports{"support names", {}}, joints{"joint names", {}};
    for (const meshes::SupportShape& s : scene_.supports)
      supports.values.push_back(s.name);
    for (const Scene::Joint& j : scene_.joints)
      joints.values.push_back(j.name);
    for (PolyData::Names* n : {&supports, &joints})
      if (!n->values.empty()) data_.names.push_back(std::move(*n));
  }

  Vec3 place_of(std::span<const Pose> poses, const Scene::Joint& j) const {
    if (j.bend < 0) return pose_at(poses, j.at).r;
    const Pose& p = poses[at(j.at.node)];
    const Mat3& triad = scene_.lines[at(line_of(scene_, j.at))].triad;
    return p.r + j.at.offset * (section_axes(triad, p.d, p.phi) * scene_.bends[at(j.bend)].col(0));
  }
  std::int64_t grow(std::size_t n) {
    const auto first = static_cast<std::int64_t>(count_);
    count_ += n;
    return first;
  }
  void polyline(std::size_t n) {
    std::vector<std::int64_t> id(n);
    std::int64_t first = grow(n);
    for (auto& x : id)
      x = first++;
    data_.lines.add(id.data(), n);
  }
  void polylines_of_springs(const meshes::SupportShape& s) {
    const int n = s.picture == model::Picture::bearing ? 4 : 2;
    for (int q = 0; q < n; ++q)
      polyline(spring_points);
  }
  // A support on a line without a radius (rigid massless rod): a fiftieth of the rotor's length.
  double default_radius() const {
    Vec3 lo = scene_.nodes.front(), hi = lo;
    for (const auto& x : scene_.nodes) {
      lo = lo.cwiseMin(x);
      hi = hi.cwiseMax(x);
    }
    double longest = (hi - lo).maxCoeff();
    for (const auto& l : scene_.lines)
      for (const auto& d : l.disks)
        longest = std::max(longest, d.outer);
    return longest > 0 ? longest / 50 : 1.0;
  }
  void circle(const Vec3& centre, const Mat3& axes, double r, std::size_t& i) {
    for (const Ring& at : ring_)
      put(data_.points, i++, centre + r * (at.cos * axes.col(1) + at.sin * axes.col(2)));
  }
  // A spring from a to b: straight ends, `turns` coils between.
  void helix(const Vec3& a, const Vec3& b, const Vec3& side, double r, std::size_t& i) {
    const Vec3 axis = b - a;
    Vec3 n1 = axis.cross(side);
    const double l = std::sqrt(n1.squaredNorm());
    n1 = l > 0 ? Vec3(n1 / l) : Vec3(Vec3::Zero());
    for (const Coil& at : coil_) {
      const double swell = r * at.swell;
      put(data_.points, i++, a + at.x * axis + swell * (at.cos * n1 + at.sin * side));
    }
  }

  Scene scene_;
  std::size_t count_ = 0;
  std::vector<Ring> ring_;
  std::vector<Coil> coil_;
};

class TrailSet final : public FrameSet {
 public:
  TrailSet(const Scene& scene, std::size_t longest)
      : scene_(scene),
        longest_(std::max<std::size_t>(longest, 2)),
        points_(scene.trails.size()) {
    data_.point_data.push_back(array("age [s]", 1, 0));
  }
  const char* name() const override { return "orbits"; }
  void update(const FramePoses& f) override {
    if (times_.size() == longest_) times_.pop_front();
    times_.push_back(f.state->time);
    data_.points.clear();
    data_.lines.clear();
    auto& age = data_.point_data[0].floats();
    age.clear();
    ++data_.topology;
    std::vector<std::int64_t> id;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (points_[k].size() == longest_) points_[k].pop_front();
      points_[k].push_back(pose_at(f.drawn, scene_.trails[k].at).r);
      id.clear();
      for (std::size_t j = 0; j < points_[k].size(); ++j) {
        id.push_back(static_cast<std::int64_t>(data_.points.size() / 3));
        for (int c = 0; c < 3; ++c)
          data_.points.push_back(static_cast<float>(points_[k][j][c]));
        age.push_back(static_cast<float>(f.state->time - times_[j]));
      }
      if (id.size() == 1) id.push_back(id.front());  // a path that has just begun is one as well
      data_.lines.add(id.data(), id.size());
    }
  }

  void save(OutArchive& out) const override {
    out.put_count(times_.size());
    for (const double t : times_)
      out.put(t);
    for (const auto& trail : points_)
      for (const Vec3& r : trail)
        for (int c = 0; c < 3; ++c)
          out.put(r[c]);
  }
  void restore(InArchive& in) override {
    times_.resize(in.count());
    for (double& t : times_)
      t = in.number();
    for (auto& trail : points_) {
      trail.resize(times_.size());
      for (Vec3& r : trail)
        for (int c = 0; c < 3; ++c)
          r[c] = in.number();
    }
  }

 private:
  Scene scene_;
  std::size_t longest_;
  std::deque<double> times_;
  std::vector<std::deque<Vec3>> points_;
};

}  // namespace

std::unique_ptr<FrameSet> make_line_set(const Scene& scene) {
  return std::make_unique<LineSet>(scene);
}
std::unique_ptr<FrameSet> make_surface_set(const Scene& scene, int points_around) {
  return std::make_unique<SurfaceSet>(scene, points_around);
}
std::unique_ptr<FrameSet> make_support_set(const Scene& scene) {
  return std::make_unique<SupportSet>(scene);
}
std::unique_ptr<FrameSet> make_trail_set(const Scene& scene, std::size_t longest) {
  return std::make_unique<TrailSet>(scene, longest);
}

}  // namespace whirl::io
