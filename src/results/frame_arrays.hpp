// What a frame of the rotor shows beside its place: velocities, section forces, stresses, support
// forces, at one state; and how frames are written.
#pragma once
#include <run/job.hpp>
#include <assembly/section_results.hpp>

namespace whirl::results {

/// How frames of a step are written that a table of the deck asks for: into the results folder, under
/// this name.
io::VtkFrameOptions frame_options(const run::Job& job, const model::VtkOutput& asked,
                                  const std::string& name);

/// Writes them; beside the solver where the run may use more than one thread, in either way the same
/// files.
std::unique_ptr<io::FrameWriter> frame_writer(const run::Job& job,
                                              const io::VtkFrameOptions& options);

/// On a shaft or the line of a joint, N, and about the place, N m; global axes.
struct PlaceLoad {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

class FrameArrays {
 public:
  explicit FrameArrays(const run::Job& job);

  /// Poses and velocities of the nodes (m, m/s, rad/s, global axes).
  void take_nodes(const assembly::NodeAt& node);
  /// Section forces (N, N m, global axes: of the right part on the left one) and equivalent
  /// stresses (Pa) at both ends of every element.
  void take_sections(const std::vector<assembly::SectionPoint>& points);
  /// Force of each bearing of the model on its shaft and of each joint on the line of its `at`, N, and
  /// moment about its place, N m; global axes.
  void take_supports(const assembly::NodeAt& node, const system::Context& context,
                     const assembly::ReactionAt& reaction);
  /// The same as given: in the order of Built::support_forces and of Built::joints.
  void take_loads(const std::vector<PlaceLoad>& supports, const std::vector<PlaceLoad>& joints);

  /// The frame; valid until something is taken again. Charts: of the state, or its pictures turn
  /// with the old ones. In motion: with velocities.
  io::FrameState state(double time, bool in_motion) const;

 private:
  const run::Job& job_;
  std::vector<io::Pose> poses_;
  std::vector<Vec3> velocity_, omega_, force_, moment_, supports_, joints_, support_moments_,
      joint_moments_;  ///< the moments: none where no law gives any
  std::vector<double> stress_;
  std::vector<PlaceLoad> loads_, joint_loads_;
};

}  // namespace whirl::results
