// Tables and figures of a static state: deflection, supports, section forces, stresses.
#pragma once
#include <analysis/statics/load_path.hpp>
#include <results/mean_loads.hpp>
#include <run/job.hpp>
#include <assembly/section_results.hpp>
#include <string>
#include <vector>

namespace whirl::results {

struct StaticResults {
  io::Table deflection, supports, sections, extremes;
  io::Table joints;   ///< loads and coordinates of joints; no rows without joints
  io::Table magnets;  ///< currents and forces of magnetic bearings; no rows without them
  io::Table rolling;  ///< load of every ball and roller; no rows without such bearings
  std::vector<plot::Figure> figures;
  std::vector<assembly::SectionPoint> points;
  std::vector<std::string> lines;  ///< for the terminal
};

/// `problem` has evaluated the state; reactions: residual at held unknowns, and at spin holds.
StaticResults make_static_results(run::Job& job, const std::string& step,
                                  system::SystemProblem& problem, const MeanLoads& loads,
                                  const VecX& reactions, std::span<const Index> spin_holds,
                                  io::Value& summary);

/// Load path: factor and displacements (of probes, else disks) point by point.
class PathRecord {
 public:
  PathRecord(const run::Job& job, const model::LoadPath& law);
  void add(system::SystemProblem& problem, const analysis::LoadPathPoint& p);
  const io::Table& table() const { return table_; }
  plot::Figure figure(const std::string& step) const;

 private:
  struct Watched {
    std::string name;
    meshes::Place at;
  };
  std::vector<Watched> watched_;
  io::Table table_;
  std::vector<double> load_;
  std::vector<std::vector<double>> u_;  ///< y, z, x of each watched, flat
};

/// One frame of the state in the files the deck asks for (none: null functions).
class StaticFrames {
 public:
  StaticFrames(const run::Job& job, const std::string& step);
  /// nodes: evaluated at the state.
  void write(const run::Job& job, const system::Workspace& nodes, double time,
             const MeanLoads& loads, const std::vector<assembly::SectionPoint>& points);
  bool any() const { return !writers_.empty(); }
  void end();

 private:
  std::vector<std::unique_ptr<io::FrameWriter>> writers_;
};

}  // namespace whirl::results
