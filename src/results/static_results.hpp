// Tables and figures of a static state: deflection, supports, section forces, stresses.
#pragma once
#include <analysis/statics/load_path.hpp>
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

/// Force and moment of each support on the shaft, in the order of Built::support_forces, N and N m.
struct SupportLoad {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

/// Of an equilibrium at speed the mean over the revolution, which is what is in balance. reactions:
/// mean residual at held unknowns.
/// @throws Error (R11) when the state cannot be evaluated.
std::vector<SupportLoad> calc_support_loads(const run::Job& job, analysis::SteadySystem& running,
                                            const system::State& state, double Omega,
                                            const VecX& reactions);

/// `problem` has evaluated the state (power()); reactions: residual at held unknowns, and at spin
/// holds.
StaticResults make_static_results(run::Job& job, const std::string& step,
                                  system::SystemProblem& problem,
                                  const std::vector<SupportLoad>& loads, const VecX& reactions,
                                  std::span<const Index> spin_holds, io::Value& summary);

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
  void write(const run::Job& job, system::SystemProblem& problem, const system::State& s,
             double time, const std::vector<assembly::SectionPoint>& points);
  bool any() const { return !writers_.empty(); }
  void end();

 private:
  std::vector<std::unique_ptr<io::FrameWriter>> writers_;
};

}  // namespace whirl::results
