// Levels of the reference speed: what ends a run or counts as an event where the speed passes them.
#pragma once
#include <core/law.hpp>
#include <run/job.hpp>

namespace whirl::results {

struct SpeedLevel {
  LawPtr angle;                ///< prescribed at the reference node; null: its spin is an unknown
  double spin = 0;             ///< of the reference node at the level, rad/s
  double reach = 0, hold = 0;  ///< rad/s: see analysis::LevelPassages
};

/// speed: the level, of the reference, rad/s. tolerance: of the integrator.
SpeedLevel speed_level(const run::Job& job, double speed, double tolerance);

}  // namespace whirl::results
