// Decks of lines on joints, motions of theirs, and what they are compared with.
#pragma once
#include "deck_model.hpp"

#include <analysis/transient/transient.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace whirl::test {

using namespace whirl::analysis;

inline const std::string head = R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
G = "80 GPa"
density = "8000 kg/m^3"
)";

inline std::string section(const std::string& name, double length, int elements) {
  return fmt::format(
      "[[shaft.section]]\nname = \"{}\"\nlength = \"{:.17g} m\"\nod = \"20 mm\"\n"
      "min_elements = {}\n",
      name, length, elements);
}
inline std::string rigid_line(const std::string& name, double x, double length, double od_mm = 20) {
  return fmt::format(
      "[[shaft]]\nname = \"{0}\"\nmaterial = \"m\"\nrotating = false\n"
      "origin = [\"{1:.17g} m\", \"0 m\", \"0 m\"]\n[[shaft.section]]\n"
      "name = \"{0}1\"\nlength = \"{2:.17g} m\"\nod = \"{3} mm\"\nrigid = true\n",
      name, x, length, od_mm);
}

inline Index last_node(const DeckModel& m, std::size_t line) {
  return m.mesh.lines[line].first_node + m.mesh.lines[line].nodes - 1;
}
inline Vec3 place_of(const DeckModel& m, const system::State& x, Index node) {
  return m.mesh.nodes[static_cast<std::size_t>(node)].position + x.q.segment<3>(6 * node);
}

/// Motion of a deck from `start` to t.
inline system::State move_to(const DeckModel& m, const system::State& start, double t,
                             double tolerance, const std::string& method = "radau5",
                             double dt = 0.0, const std::vector<double>& breakpoints = {},
                             std::vector<Observer*> observers = {}) {
  system::SystemProblem problem(m.built.system);
  TransientOptions o;
  o.method = method;
  o.integrator.tolerance = tolerance;
  o.integrator.t_end = t;
  o.integrator.dt_fixed = dt;
  o.integrator.breakpoints = breakpoints;
  const TransientResult r = run_transient(problem, start, o, observers);
  EXPECT_EQ(r.reason, StopReason::end_time) << r.detail;
  return r.end;
}

inline double energy_of(const system::System& s, const system::State& x) {
  system::Workspace w = s.make_workspace();
  EXPECT_TRUE(s.evaluate_nodes(w, x.frames, x.t, x.q, x.v, x.a));
  const system::Energy e = s.energy(w);
  return e.kinetic + e.elastic + e.gravity;
}

/// y' = f(y) by Runge-Kutta of order four.
inline VecX integrate(const std::function<VecX(const VecX&)>& f, VecX y, double t, int steps) {
  const double h = t / steps;
  for (int i = 0; i < steps; ++i) {
    const VecX a = f(y), b = f(y + 0.5 * h * a), c = f(y + 0.5 * h * b), d = f(y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

/// A rigid bar of the decks here: mass, moment of inertia across about its middle.
struct Bar {
  double m, I, polar;
  explicit Bar(double length, double d = 0.02)
      : m(8000 * pi / 4 * d * d * length),
        I(m * (length * length / 12 + d * d / 16)),
        polar(m * d * d / 8) {}
};

inline const char* const clamp = R"([[bearing]]
name = "clamp"
at = "one:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
)";

}  // namespace whirl::test
