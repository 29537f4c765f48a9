// The rotor as a picture: bodies of revolution about the deformed centre lines, rebuilt at every
// frame.
//
// A section stands on the centre line at r with its normal d; a vector w fixed to the section (w
// perpendicular to e) is carried by R = P(d<-e) L(phi e), P the minimal rotation, so a stripe
// painted on the shaft shows the true spin. Between two nodes the centre line is the cubic with the
// directors as end slopes; the sections stand normal to it.
#pragma once
#include <core/types.hpp>
#include <model/support_traits.hpp>
#include <span>
#include <string>
#include <vector>

namespace whirl::meshes {

/// Where a node is. phi may lack whole turns as long as all nodes of a line lack the same.
struct Pose {
  Vec3 r = Vec3::Zero();   ///< position, m, global axes
  Vec3 d = Vec3::UnitX();  ///< section normal (director), unit
  double phi = 0.0;        ///< axial angle, rad
};

/// A place on a line: `offset` m along the director of a node (0 = at the node).
struct Place {
  Index node = 0;
  double offset = 0.0;
};

/// A piece of shaft between two places, radii in m; conical when they differ. inner = 0: solid.
struct ShaftPiece {
  Place left, right;
  double outer_left = 0, outer_right = 0, inner_left = 0, inner_right = 0;
  Index bend_left = -1,
        bend_right =
            -1;  ///< axes of the line at its ends, into Scene::bends; -1: those of the line's triad
  Index element = -1;  ///< of the mesh; -1: rigid
};

/// A disk, centred on its place. inner: the bore, usually the shaft radius.
struct DiskShape {
  std::string name;
  Place at;
  double outer = 0, inner = 0, width = 0;  ///< m
  Index bend = -1;
};

/// A spring, bearing or support glyph.
struct SupportShape {
  std::string name;
  model::Picture picture = model::Picture::bearing;
  Place at;              ///< on the shaft
  bool to_node = false;  ///< the far end is a place too (intershaft bearing, coupling, pedestal);
                         ///< else the ground
  Place to;
  double radius = 0;  ///< shaft radius there, m
  Index bend = -1;    ///< of the line at `at`
};

/// What there is to draw, in the reference state. Plain data, independent of how it is written.
struct Scene {
  struct Joint {
    std::string name;
    Place at;         ///< on the line it carries a load to
    Index bend = -1;  ///< axes of that line there, if it is not straight along e
  };
  struct Line {
    std::string name;
    Mat3 triad = Mat3::Identity();  ///< columns e, e2, e3
    std::vector<Place> points;      ///< along the centre line, left to right
    std::vector<double> radius;     ///< outer radius at each point, m (may be empty)
    std::vector<Index> bend_after,
        bend_before;  ///< axes there looking right and looking left; empty: straight along e
    /// Of the mesh, between each point and the next; -1: rigid. May be empty, like breaks: nonzero at a
    /// point where section forces may jump.
    std::vector<Index> elements;
    std::vector<unsigned char> breaks;
    std::vector<ShaftPiece> pieces;  ///< left to right
    std::vector<DiskShape> disks;
  };
  struct Trail {
    std::string name;
    Place at;
  };  ///< points whose orbit is drawn

  std::vector<Vec3> nodes;       ///< reference positions, m
  std::vector<Index> node_line;  ///< index into lines of each node
  std::vector<Line> lines;
  std::vector<SupportShape> supports;
  std::vector<Joint> joints;
  std::vector<Trail> trails;
  std::vector<Mat3> bends;  ///< columns tangent, y, z of a line that is not straight along e, in
                            ///< its triad's components

  bool bent(Index line) const { return !lines[static_cast<std::size_t>(line)].bend_after.empty(); }
};

/// Displacement and tilt magnified, spin not: r0 + s (r - r0), and d from e + s (d - e). s = 1
/// returns the pose itself.
Pose magnified(const Pose& p, const Vec3& r0, const Vec3& e, double s);

/// Pose of a place given the poses of all nodes.
/// @pre p names one of the nodes.
Pose pose_at(std::span<const Pose> nodes, const Place& p);

/// Pose at fraction xi in [0,1] between two poses `length` apart in the reference state.
Pose interpolate(const Pose& a, const Pose& b, double length, double xi);

/// Rotation of the section, P(d<-e) L(phi e) applied to the triad: columns d, R e2, R e3. e + d = 0
/// is not reached: there the azimuth of P is undefined and any is returned.
Mat3 section_axes(const Mat3& triad, const Vec3& d, double phi);

/// A place between two nodes, where a section stands in a picture.
struct Spot {
  Index line = 0;
  Place a, b;
  double length = 0, xi = 0;      ///< of the centre line from a to b at rest, m; fraction
  Vec3 reference = Vec3::Zero();  ///< centre of the section at rest, m
  Mat3 bend_a = Mat3::Identity(), bend_b = Mat3::Identity();
  bool bent = false;
};
/// @pre line, a and b are of the scene.
Spot make_spot(const Scene& scene, Index line, const Place& a, const Place& b, double xi,
               Index bend_a = -1, Index bend_b = -1);

/// A section as it stands: centre, columns tangent, y, z of its axes, axial angle.
struct Frame {
  Vec3 r = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  double phi = 0.0;
};
/// triad: of the line, that the poses refer to.
Frame frame_of(std::span<const Pose> nodes, const Mat3& triad, const Spot& s);

/// Quadrilateral skin of all shafts and disks of a scene. Topology is fixed; positions and normals
/// follow the poses. Rings are duplicated where the surface has an edge (diameter steps, end
/// faces), shared where it is smooth.
class Skin {
 public:
  /// points_around >= 3 points on each circle.
  /// @throws std::invalid_argument for fewer.
  Skin(const Scene& scene, int points_around);

  Index point_count() const { return static_cast<Index>(rings_.size()) * around_; }
  Index quad_count() const { return static_cast<Index>(quads_.size() / 4); }
  int around() const { return static_cast<int>(around_); }
  /// Four point indices a quad, counter-clockwise seen from outside.
  const std::vector<Index>& quads() const { return quads_; }
  /// Per quad: 1 on the painted stripe.
  const std::vector<unsigned char>& stripe() const { return stripe_; }
  /// Per quad: the number of its part, a line or a disk.
  const std::vector<int>& part() const { return part_; }
  /// Each line and then its disks, line by line.
  const std::vector<std::string>& part_names() const { return part_names_; }

  /// After a change of chart: the triad that the poses of a line refer to from now on.
  void set_chart(Index line, const Mat3& triad) { triads_[static_cast<std::size_t>(line)] = triad; }
  /// Positions and outward unit normals at the given (already magnified) poses: 3 floats a point.
  /// No allocation when the vectors already have their size.
  void update(std::span<const Pose> nodes, std::vector<float>& points,
              std::vector<float>& normals) const;
  /// Displacement of the centre line at each point's section, m: 3 floats a point.
  void centre_displacement(std::span<const Pose> nodes, std::vector<float>& displacement) const;
  /// Values of the shaft's sections at each point: linear between the two ends of its element, of a
  /// rigid part what the elements beside it have there; 0 on disks. at_ends: left and right of each
  /// element of the mesh.
  void section_values(std::span<const double> at_ends, std::vector<float>& values) const;

 private:
  /// Numbers of the values at the ends of elements that a section's lies between; -1: it has none.
  struct Section {
    Index left = -1, right = -1;
    double xi = 0;
  };
  struct Ring {
    std::size_t station;
    Section section;
    double radius, n_axial, n_radial;
  };
  struct Vertex {
    std::size_t station;
    double s, radius;
    Section section{};
  };
  static Section section_of(const std::vector<ShaftPiece>& pieces, std::size_t k, double xi);
  std::size_t add_station(Spot s);
  int add_part(const std::string& name);
  void add_shaft(const Scene& scene, Index line, int part);
  void add_disk(const Scene& scene, Index line, const DiskShape& disk, int part);
  /// Revolves a closed polyline; the outside is on its left. Corners get two rings.
  void revolve(const std::vector<Vertex>& profile, int part);
  std::vector<Mat3> triads_;
  std::vector<double> cos_, sin_;
  Index around_ = 0;
  std::vector<Spot> stations_;  ///< where the rings stand
  std::vector<Ring> rings_;
  std::vector<Index> quads_;
  std::vector<unsigned char> stripe_;
  std::vector<int> part_;
  std::vector<std::string> part_names_;
};

}  // namespace whirl::meshes
