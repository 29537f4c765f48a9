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

void StaticFrames::write(const run::Job& job, const system::Workspace& nodes, double time,
                         const MeanLoads& loads,
                         const std::vector<assembly::SectionPoint>& points) {
  FrameArrays arrays(job);
  arrays.take_nodes([&](Index k) -> const system::NodeState& { return nodes.in_own_axes(k); });
  arrays.take_sections(points);
  arrays.take_loads(loads.supports, loads.joints);
  const io::FrameState frame = arrays.state(time, false);
  for (auto& w : writers_)
    w->frame(frame);
}

void StaticFrames::end() {
  for (auto& w : writers_)
    w->end();
}

}  // namespace whirl::results
