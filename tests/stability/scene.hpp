// Small scenes whose motion is known exactly, run the way the program runs a deck.
#pragma once
#include <analysis/statics/equilibrium.hpp>
#include <analysis/transient/transient.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/supports/spring_block.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>

#include <gtest/gtest.h>
#include <string>

namespace whirl::test {

inline constexpr double tolerance = 1e-4;  ///< the program's default accuracy
/// The accuracy asked for is an aim for the error over the largest value of its kind. Over a few
/// periods the error stays below the aim itself; scenes that amplify errors say so.
inline constexpr double aimed = tolerance;
inline constexpr const char* methods[] = {"radau5", "gauss4", "gauss6", "generalized_alpha"};

struct Setting {
  double t_end = 1, length = 1;
  const char* method = "radau5";
  double tol = tolerance, dt = 0;
};

inline analysis::TransientResult run(const system::System& s, const system::State& start,
                                     const Setting& c,
                                     const std::vector<analysis::Observer*>& observers = {},
                                     bool chart_change = true) {
  system::SystemProblem problem(s, {la::SolverKind::automatic, chart_change, 2.0});
  analysis::TransientOptions o;
  o.method = c.method;
  o.integrator.tolerance = c.tol;
  o.integrator.t_end = c.t_end;
  o.integrator.scales.length = c.length;
  o.integrator.dt_fixed = c.dt;
  o.integrator.breakpoints = s.breakpoints();
  return analysis::run_transient(problem, start, o, observers);
}

/// A run that must end well, without a number that is none.
inline system::State run_ok(const system::System& s, const system::State& start, const Setting& c,
                            const std::string& what) {
  const analysis::TransientResult r = run(s, start, c);
  EXPECT_EQ(r.reason, analysis::StopReason::end_time) << what << ": " << r.detail;
  EXPECT_TRUE(r.end.q.allFinite() && r.end.v.allFinite()) << what;
  return r.end;
}

inline Mat3 isotropic(double k) { return Vec3(k, k, k).asDiagonal(); }

/// Spring and damper to ground at a node.
inline void add_spring(system::Builder& b, Index node, const Mat3& K,
                       const Mat3& C = Mat3::Zero()) {
  elements::TranslationalBearing s;
  s.K = K;
  s.C = C;
  b.add(s, {node, b.add_ground(b.node(node).position, "ground")}, "springs");
}

/// A point mass m on an isotropic spring k and damper c: z'' + c/m z' + k/m z = -g.
inline system::System mass_on_spring(double m, double k, double c, double g) {
  system::Builder b;
  b.add_line("shaft");
  const Index n = b.add_node({Vec3::Zero(), 0, "mass", false});
  b.add(elements::PointMass{m}, {n}, "point masses");
  add_spring(b, n, isotropic(k), isotropic(c));
  b.set_gravity(Vec3(0, 0, -g));
  return b.finalize();
}

/// A straight shaft along x of elements with the given lengths; first node 0.
inline void add_shaft(system::Builder& b, const elements::ElementSection& section,
                      const std::vector<double>& lengths) {
  double x = 0.0;
  b.add_node({Vec3::Zero(), 0, "node 0", false});
  for (double l : lengths) {
    x += l;
    const Index n = b.add_node({Vec3(x, 0, 0), 0, "node at " + std::to_string(x), false});
    b.add(elements::ShaftBeam<false>(elements::make_shaft_constants(section, l), Vec3::UnitX()),
          {n - 1, n}, "shaft elements");
  }
}

inline elements::ElementSection round_bar(double diameter) {
  elements::ElementSection s;
  s.od1 = s.od2 = s.mass_od1 = s.mass_od2 = diameter;
  s.E = 2.1e11;
  s.G = 2.1e11 / 2.6;
  s.rho = 7850;
  return s;
}

inline void clamp(system::Builder& b, Index node) {
  for (int c = 0; c < 6; ++c)
    b.hold(node, c);
}

inline analysis::Equilibrium equilibrium(const system::System& s,
                                         const system::State* start = nullptr) {
  analysis::SteadySystem running(s);
  return analysis::EquilibriumSolver(running).solve(0.0, start);
}

}  // namespace whirl::test
