#include <results/frame_arrays.hpp>
#include <core/contract.hpp>
#include <core/parallel.hpp>
#include <io/queued_frames.hpp>

#include <algorithm>

namespace whirl::results {

io::VtkFrameOptions frame_options(const run::Job& job, const model::VtkOutput& asked,
                                  const std::string& name) {
  io::VtkFrameOptions options;
  options.directory = job.folder.subfolder("vtk");
  options.name = name;
  io::set_content(options, asked.content);
  options.deformation_scale = asked.deformation_scale;
  options.points_around = asked.points_around;
  options.one_file = asked.one_file;
  options.compression = asked.compression;
  options.max_frames = static_cast<std::uint64_t>(asked.max_frames);
  return options;
}

std::unique_ptr<io::FrameWriter> frame_writer(const run::Job& job,
                                              const io::VtkFrameOptions& options) {
  std::unique_ptr<io::FrameWriter> writer = io::make_vtk_frames(options);
  const int threads = job.options.jobs > 0 ? job.options.jobs : processors();
  return threads > 1 ? io::make_queued_frames(std::move(writer)) : std::move(writer);
}

FrameArrays::FrameArrays(const run::Job& job)
    : job_(job),
      poses_(job.mesh.nodes.size()),
      velocity_(poses_.size()),
      omega_(poses_.size()),
      force_(2 * job.mesh.elements.size(), Vec3::Zero()),
      moment_(force_),
      supports_(job.model.bearings.size(), Vec3::Zero()),
      joints_(job.model.joints.size(), Vec3::Zero()),
      stress_(force_.size(), 0.0) {
  const auto gives_moment = [](const auto& x) { return static_cast<bool>(x.moment); };
  if (std::ranges::any_of(job.built.support_forces, gives_moment) ||
      std::ranges::any_of(job.built.joints, gives_moment)) {
    support_moments_.resize(supports_.size());
    joint_moments_.resize(joints_.size());
  }
}

void FrameArrays::take_nodes(const assembly::NodeAt& node) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const system::NodeState& n = node(static_cast<Index>(i));
    poses_[i] = {job_.mesh.nodes[i].position + n.u, n.d(), n.phi};
    velocity_[i] = n.du;
    omega_[i] = n.omega();
  }
}

void FrameArrays::take_sections(const std::vector<assembly::SectionPoint>& points) {
  for (const assembly::SectionPoint& p : points) {
    if (p.xi != 0.0 && p.xi != 1.0) continue;
    const std::size_t i = 2 * at(p.element) + (p.xi == 0.0 ? 0 : 1);
    force_[i] = p.force;
    moment_[i] = p.moment;
    stress_[i] = p.von_mises;
  }
}

void FrameArrays::take_supports(const assembly::NodeAt& node, const system::Context& context,
                                const assembly::ReactionAt& reaction) {
  const auto load_of = [&](const auto& x) {
    return PlaceLoad{x.force(node, context, reaction),
                     x.moment ? x.moment(node, context, reaction) : Vec3(Vec3::Zero())};
  };
  loads_.clear();
  for (const assembly::SupportForce& f : job_.built.support_forces)
    loads_.push_back(load_of(f));
  joint_loads_.clear();
  for (const assembly::JointResult& j : job_.built.joints)
    joint_loads_.push_back(load_of(j));
  take_loads(loads_, joint_loads_);
}

void FrameArrays::take_loads(const std::vector<PlaceLoad>& supports,
                             const std::vector<PlaceLoad>& joints) {
  WHIRL_EXPECTS(supports.size() == job_.built.support_forces.size());
  WHIRL_EXPECTS(joints.size() == joints_.size());
  std::ranges::fill(support_moments_, Vec3::Zero());
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    supports_[i].setZero();
    for (std::size_t k = 0; k < supports.size(); ++k) {
      if (job_.built.support_forces[k].name != job_.model.bearings[i].name) continue;
      supports_[i] = supports[k].force;
      if (!support_moments_.empty()) support_moments_[i] = supports[k].moment;
    }
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i] = joints[i].force;
    if (!joint_moments_.empty()) joint_moments_[i] = joints[i].moment;
  }
}

io::FrameState FrameArrays::state(double time, bool in_motion) const {
  io::FrameState frame;
  frame.time = time;
  frame.nodes = poses_;
  if (in_motion) {
    frame.velocity = velocity_;
    frame.angular_velocity = omega_;
  }
  frame.force = force_;
  frame.moment = moment_;
  frame.stress = stress_;
  frame.support_force = supports_;
  frame.joint_force = joints_;
  frame.support_moment = support_moments_;
  frame.joint_moment = joint_moments_;
  return frame;
}

}  // namespace whirl::results
