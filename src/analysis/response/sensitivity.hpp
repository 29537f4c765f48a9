// Sensitivity of control loops: with every loop closed, a displacement d added to the signal behind
// the sensor of one loop, and S = e/d of what then enters its controller, e = d + y. With the other
// loops closed L is the open loop of this one and S = 1/(1 + L). ISO 14839-3:2006 judges the largest
// |S| of every loop.
#pragma once
#include <analysis/response/harmonic.hpp>

namespace whirl::analysis {

/// A loop opened behind its sensor.
struct OpenedLoop {
  std::vector<std::pair<Index, double>> entry;  ///< unknowns and the force on them for d, N/m
  Index signal = -1;             ///< unknown of the sensor; -1: the displacement itself
  double unit = 1;               ///< m, of the signal
  Point shaft;                   ///< the displacement: of this place ..
  std::optional<Point> housing;  ///< .. against this one
  Vec2 axis = Vec2::UnitX();     ///< in (y, z)
};

class SensitivityMeter {
 public:
  SensitivityMeter(Linearizer& linear, std::vector<OpenedLoop> loops);
  /// One S a loop at speed Omega and frequency w, rad/s; nan: w is an undamped pole of the system.
  /// @pre w > 0.
  const std::vector<Complex>& at(double Omega, double w);
  /// That of one loop.
  /// @pre loop < loops().
  Complex of(std::size_t loop, double Omega, double w);
  std::size_t loops() const { return loops_.size(); }

 private:
  Complex seen(const OpenedLoop& loop, const VecXc& x);
  /// With the matrices prepared, of these loops.
  bool prepare(double Omega, double w);
  void solve(std::span<const OpenedLoop> loops, std::span<Complex> values);
  std::vector<OpenedLoop> loops_;
  HarmonicSolver solver_;
  MatXc x_;  ///< a column a loop
  VecXc column_;
  std::vector<Complex> values_;
};

}  // namespace whirl::analysis
