#include <results/frame_arrays.hpp>
#include <results/static_results.hpp>

namespace whirl::results {

StaticFrames::StaticFrames(const run::Job& job, const std::string& step) {
  for (const model::VtkOutput& o : job.model.output.vtk) {
    if (!o.step.empty() && o.step != step) continue;
    writers_.push_back(frame_writer(job, frame_options(job, o, step)));
    writers_.back()->begin(job.scene);
  }
}

void StaticFrames::write(const run::Job& job, system::SystemProblem& problem,
                         const system::State& s, double time,
                         const std::vector<assembly::SectionPoint>& points) {
  const auto node = [&](Index k) -> const system::NodeState& {
    return problem.workspace().in_own_axes(k);
  };
  VecX r(job.system().size());
  job.system().residual(problem.workspace(), s.frames, s.t, s.q, s.v, s.a, r);
  FrameArrays arrays(job);
  arrays.take_nodes(node);
  arrays.take_sections(points);
  arrays.take_supports(node, problem.workspace().context, [&](Index k) { return r[k]; });
  const io::FrameState frame = arrays.state(time, false);
  for (auto& w : writers_)
    w->frame(frame);
}

void StaticFrames::end() {
  for (auto& w : writers_)
    w->end();
}

}  // namespace whirl::results
