// The one-element validation case: the single-disk rotor of Sorokin & Zhang 2018 (doi
// 10.18698/2308-6033-2018-10-1815), eq. (12). Thin disk (D = 0.5 m, m = 5 kg) on a massless rigid
// rod (l = 0.75 m) held at its left end by C1 = 2000 N/m, C2 = 500 N m/rad, spinning at 50 rad/s,
// released horizontal under gravity 9.81 m/s2 along -z.
//
// Reference: two independent formulations integrated at order 8 with rtol 1e-12, which agree to
// 5e-13 m over 10 s (nine printed digits).
#include "record.hpp"

#include <analysis/transient/transient.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/supports/spring_block.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;

namespace {

constexpr double l = 0.75, m = 5.0, D = 0.5, Omega0 = 50.0;

system::System make_rotor() {
  system::Builder b;
  b.add_line("rotor");
  const Index n = b.add_node({Vec3(l, 0, 0), 0, "disk centre", false});
  elements::RigidDisk disk;
  disk.mass = m;
  disk.Jt = m * D * D / 16;
  disk.Jp = m * D * D / 8;
  b.add(disk, {n}, "rigid disks");
  elements::SpringBlock spring;
  spring.C1 = 2000;
  spring.C2 = 500;
  spring.offset = -l;
  b.add(spring, {n}, "spring blocks");
  b.set_gravity(Vec3(0, 0, -9.81));
  return b.finalize();
}

system::State start_of(const system::System& s, double spin) {
  system::State x = s.make_state();
  x.v[system::spin_phi] = spin;
  return x;
}

struct Row {
  double t, x, y, z, phi, gamma_y, gamma_z;
};
constexpr Row reference[] = {
    {1, 0.739505515, -0.00613730358, -0.0785390156, 49.9972956, 0.0749684786, -0.00826746605},
    {2, 0.753673251, 0.0742199631, -0.0987913595, 99.9977928, 0.0910020105, 0.0677597893},
    {5, 0.737350448, 0.00925074668, -0.104446011, 249.988669, 0.0968815038, 0.0116157341},
    {10, 0.745250642, 0.0181325644, -0.136435971, 499.977124, 0.126412517, 0.0145155382},
};

struct Watch final : Observer {
  std::vector<Row> rows;
  double deviation = 0, tilt = 0, invariant = 0;
  void look(const Snapshot& s) {
    deviation = std::max(deviation, std::abs(s.node(0).dphi - Omega0) / Omega0);
    tilt = std::max(tilt, s.gamma(0).norm());
    invariant = std::max(invariant, std::abs(s.node(0).spin() - Omega0));
  }
  void step(StepAccess& s) override {
    for (const Row& r : reference)
      if (r.t > s.t0() && r.t <= s.t1()) {
        const Snapshot& x = s.at(r.t);
        const Vec3 p = x.system().node(0).position + x.node(0).u;
        rows.push_back({r.t, p.x(), p.y(), p.z(), x.total_phi(0), x.gamma(0)[0], x.gamma(0)[1]});
      }
    look(s.end());  // first: invariants are those of the steps themselves, not of the interpolant
    for (int k = 1; k < 8; ++k) {
      const Snapshot& x = s.at(s.t0() + (s.t1() - s.t0()) * k / 8.0);
      deviation = std::max(deviation, std::abs(x.node(0).dphi - Omega0) / Omega0);
      tilt = std::max(tilt, x.gamma(0).norm());
    }
  }
};

struct Outcome {
  Watch watch;
  EnergyBalance energy;
  TransientResult result;
};

void run(const std::string& method, double tolerance, double dt, Outcome& out) {
  const system::System s = make_rotor();
  system::SystemProblem problem(s);
  TransientOptions o;
  o.method = method;
  o.integrator.tolerance = tolerance > 0 ? tolerance : 1e-10;  // fixed steps: Newton's accuracy
  o.integrator.dt_fixed = dt;
  o.integrator.t_end = 10.0;
  o.integrator.breakpoints = {
      1, 2,
      5};  // the table's times are step ends: what is compared is the scheme, not its interpolant
  out.result = run_transient(problem, start_of(s, Omega0), o, {&out.watch, &out.energy});
}

void compare(const Watch& w, double tolerance) {
  ASSERT_EQ(w.rows.size(), std::size(reference));
  for (std::size_t i = 0; i < w.rows.size(); ++i) {
    const Row &a = w.rows[i], &b = reference[i];
    // relative to the size of each kind: position 0.75 m, displacement 0.1 m and tilt 0.1 rad carry
    // nine printed digits
    EXPECT_NEAR(a.x, b.x, tolerance * 0.75) << b.t;
    EXPECT_NEAR(a.y, b.y, tolerance * 0.1) << b.t;
    EXPECT_NEAR(a.z, b.z, tolerance * 0.1) << b.t;
    EXPECT_NEAR(a.phi, b.phi, tolerance * b.phi) << b.t;
    EXPECT_NEAR(a.gamma_y, b.gamma_y, tolerance * 0.1) << b.t;
    EXPECT_NEAR(a.gamma_z, b.gamma_z, tolerance * 0.1) << b.t;
  }
}

}  // namespace

TEST(PaperRotor, ReferenceTableByRadau) {
  test::Record record("The disk on a rod of Sorokin and Zhang",
                      "F. D. Sorokin, H. Zhang, Engineering Journal: Science and Innovation 2018 "
                      "no. 10, doi 10.18698/2308-6033-2018-10-1815, eq. 12; values of two "
                      "independent formulations, eighth order, rtol 1e-12");
  Outcome o;
  run("radau5", 1e-9, 0, o);
  ASSERT_EQ(o.result.reason, StopReason::end_time) << o.result.detail;
  compare(o.watch, 1e-7);
  for (std::size_t i = 0; i < o.watch.rows.size() && i < std::size(reference); ++i) {
    const Row &a = o.watch.rows[i], &b = reference[i];
    const std::string at = "t = " + std::to_string(static_cast<int>(b.t)) + " s, ";
    record.check(at + "x", "m", a.x, b.x, 1e-7 * 0.75);
    record.check(at + "y", "m", a.y, b.y, 1e-8);
    record.check(at + "z", "m", a.z, b.z, 1e-8);
    record.check(at + "phi", "rad", a.phi, b.phi, 1e-7 * b.phi);
  }
  record.check("largest |omega_phi - omega0|/omega0", "-", o.watch.deviation, 7.0176e-4,
               5e-8);  // five printed digits
  record.check("largest |gamma|", "rad", o.watch.tilt, 0.146326, 1e-6);
  EXPECT_LT(o.watch.invariant, 1e-7 * Omega0);
  EXPECT_LT(o.energy.worst_defect(), 2e-6);  // J, published
}

TEST(PaperRotor, ReferenceTableByGauss6) {
  Outcome o;
  run("gauss6", 0, 2e-3, o);
  ASSERT_EQ(o.result.reason, StopReason::end_time) << o.result.detail;
  compare(o.watch, 1e-7);
}

TEST(PaperRotor, DefaultAccuracyKeepsItsPromise) {
  Outcome o;
  run("radau5", 1e-4, 0, o);
  ASSERT_EQ(o.result.reason, StopReason::end_time) << o.result.detail;
  compare(
      o.watch,
      1.46e-4);  // 1e-4 of the peak response, 0.157 m and 0.146 rad; compare() multiplies by 0.1
}

TEST(PaperRotor, MomentumFormByExplicitRungeKutta) {
  // The paper's own route, its system (12): another set of unknowns, another integrator, the same
  // table.
  Outcome o;
  run("momentum_rk", 1e-10, 0, o);
  ASSERT_EQ(o.result.reason, StopReason::end_time) << o.result.detail;
  compare(o.watch, 1e-7);
  EXPECT_LT(o.energy.worst_defect(), 2e-6);
  // omega . d is a momentum over Jp there, which nothing changes: round-off, a hundred last digits
  // of the way back through phi'
  EXPECT_LT(o.watch.invariant, 2.2e-14 * Omega0);
}

TEST(PaperRotor, EnergyToOneNanojoule) {
  // Equal steps of 1 ms by Gauss 6, Newton to 1e-13: total energy 195 J, 1e-9 J is 5e-12 of it.
  Outcome o;
  run("gauss6", 1e-13, 1e-3, o);
  ASSERT_EQ(o.result.reason, StopReason::end_time) << o.result.detail;
  EXPECT_LT(o.energy.worst_defect(), 1e-9);
  EXPECT_LT(o.watch.invariant, 1e-12 * Omega0);  // ten times what Newton is asked for
}

TEST(PaperRotor, HundredThousandRevolutionsAtHighSpeed) {
  // 5,000 rad/s for 1e5 turns (125.7 s): the steps follow the whirl, not the spin, and the axial
  // angle keeps its digits. Checked: spin about the normal and phi against the exact geometric
  // phase, omega_phi - Omega0 = (1 - cos g)/g^2 e.(gamma x gamma').
  const system::System s = make_rotor();
  system::SystemProblem problem(s);
  const double Omega = 5000.0, t_end = 1e5 * two_pi / Omega;
  struct Phase final : Observer {
    double integral = 0, spin_error = 0, omega = 0;
    void step(StepAccess& st) override {
      // Gauss-Legendre of order 8 on the dense output
      const double x[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                           0.9305681557970263};
      const double w[4] = {0.17392742256872692, 0.3260725774312731, 0.3260725774312731,
                           0.17392742256872692};
      const double h = st.t1() - st.t0();
      for (int k = 0; k < 4; ++k) {
        const Snapshot& n = st.at(st.t0() + x[k] * h);
        const Vec2 g = n.gamma(0), dg = n.v().segment<2>(4);
        const double q = g.squaredNorm(),
                     f = q > 1e-8 ? (1 - std::cos(std::sqrt(q))) / q : 0.5 - q / 24;
        integral += h * w[k] * f * (g[0] * dg[1] - g[1] * dg[0]);
      }
      spin_error = std::max(spin_error, std::abs(st.end().node(0).spin() - omega));
    }
  } phase;
  phase.omega = Omega;
  TransientOptions o;
  o.integrator.tolerance = 1e-6;
  o.integrator.t_end = t_end;
  const TransientResult r = run_transient(problem, start_of(s, Omega), o, {&phase});
  ASSERT_EQ(r.reason, StopReason::end_time) << r.detail;
  const double phi = r.end.total_phi(0, 0);
  EXPECT_NEAR(phi - Omega * t_end, phase.integral, 1e-5);  // rad, of 628,319 rad
  EXPECT_LT(phase.spin_error, 1e-9 * Omega);
  // one turn in 1.26 ms; the whirl needs steps of several turns
  EXPECT_GT(r.statistics.step_mean(), 2.0 * two_pi / Omega);
}
