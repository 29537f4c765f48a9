// The sets of a frame: centre lines, surface, supports, orbit trails. Each turns a scene and poses
// into PolyData.
#pragma once
#include <io/frames.hpp>
#include <io/polydata.hpp>
#include <deque>

namespace whirl::io {

/// What all sets share at one frame: the poses as they are and as they are drawn.
struct FramePoses {
  std::span<const Pose> true_poses, drawn;
  const FrameState* state = nullptr;
};

class FrameSet {
 public:
  virtual ~FrameSet() = default;
  virtual const char* name() const = 0;
  virtual void update(const FramePoses& poses) = 0;
  const PolyData& data() const { return data_; }
  /// Something to stand with every frame.
  void note(PolyData::Names what) { data_.names.push_back(std::move(what)); }
  /// What a later frame still needs of the earlier ones.
  virtual void save(OutArchive& out) const { (void)out; }
  virtual void restore(InArchive& in) { (void)in; }

 protected:
  PolyData data_;
};

/// Names of arrays end in their unit: "displacement [m]". What the numbers of a cell array stand for
/// is field data: "part names", "support names", "joint names".
///
/// Centre lines: displacement, rotation (Euler vector of the tilt), spin_angle, radius, director,
/// axis2, axis3; velocity, angular_velocity, force, moment, von_mises where the state has them.
/// Four segments between two nodes. Where section forces may jump a line ends and the next begins, each
/// with a point of its own there.
std::unique_ptr<FrameSet> make_line_set(const Scene& scene);
/// True surface: normals, displacement of the centre line, von_mises of the shaft's sections where the
/// state has stresses at the ends of elements; cells: stripe (1 = painted), part (each line and its disks).
std::unique_ptr<FrameSet> make_surface_set(const Scene& scene, int points_around);
/// Supports: housing ring, journal ring and springs between them; a vertex at each journal carries
/// `force` and, where any gives one, `moment`; cell array `support` counts them. A joint is a vertex with both, counted by the cell array
/// `joint` (both -1 where a cell is not of that kind; `joint` is there where there are any).
std::unique_ptr<FrameSet> make_support_set(const Scene& scene);
/// Paths of the trail points so far: `age` s.
std::unique_ptr<FrameSet> make_trail_set(const Scene& scene, std::size_t longest);

}  // namespace whirl::io
