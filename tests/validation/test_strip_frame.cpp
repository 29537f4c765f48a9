// A right-angle frame of a slender strip on edge (Iz/Iy = 2500), pulled in its plane at the tip: it
// buckles sideways and goes far beyond. J. H. Argyris et al., Comput. Methods Appl. Mech. Engng 20
// (1979) 105, doi 10.1016/0045-7825(79)90061-2, started this family of tests. Reference: the exact
// rod by shooting.
#include "deck_model.hpp"
#include "exact_rod.hpp"
#include "record.hpp"

#include <analysis/statics/buckling.hpp>
#include <core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::test;

namespace {

constexpr double leg = 0.24, E = 71.24e9, G = E / 2.62, A = 18e-6, Iy = 0.54e-12, Iz = 1350e-12,
                 J = 2.16e-12, kappa = 5.0 / 6.0;

/// n elements a leg, tip force (1 N, 0, out_of_plane).
std::string deck(int n, double out_of_plane) {
  std::string legs;
  for (const char* name : {"leg1", "leg2"})
    legs += fmt::format(R"([[shaft.section]]
name = "{}"
length = "240 mm"
min_elements = {}
general = {{ A = "18 mm^2", Iy = "0.54 mm^4", Iz = "1350 mm^4", J = "2.16 mm^4", kappa_y = 0.8333333333333333, kappa_z = 0.8333333333333333 }}
)",
                        name, n);
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "71.24 GPa"
G = "71.24 GPa / 2.62"
density = "2700 kg/m^3"
[[shaft]]
name = "frame"
material = "m"
rotating = false
path = [{{ to = ["240 mm", "0 mm", "0 mm"] }}, {{ to = ["240 mm", "-240 mm", "0 mm"] }}]
{}[[bearing]]
name = "clamp"
at = "leg1:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "leg2:end"
force = ["1 N", "0 N", "{} N"]
)",
                     legs, out_of_plane);
}

struct Frame {
  DeckModel model;
  SteadySystem running;
  Frame(int n, double out_of_plane)
      : model(deck(n, out_of_plane)),
        running(model.built.system, model.running()) {}
  Index tip() const { return model.mesh.lines[0].first_node + model.mesh.lines[0].nodes - 1; }
  LoadPathResult follow(LoadPathOptions o,
                        const std::function<bool(const LoadPathPoint&)>& accept = {}) {
    o.max_points = 4000;
    const auto all = [](const LoadPathPoint&) { return true; };
    return follow_load_path(running, 0.0, running.system().make_state(), o, accept ? accept : all);
  }
};

/// Place of the tip under the force, from the exact rod; near: a place close to it.
Vec3 exact_tip(const Vec3& force, const Vec3& near, int steps) {
  ExactRod one;
  one.section = {E * A, kappa * G * A, kappa * G * A, G * J, E * Iy, E * Iz};
  one.length = leg;
  one.steps = steps;
  Mat3 corner;
  corner << 0, 1, 0, -1, 0, 0, 0, 0, 1;  // columns: the tangent turns from x to -y
  const auto march = [&](const Vec3& m) {
    const ExactRod::End bend = one.march(force, m);
    ExactRod two = one;
    two.r0 = bend.r;
    two.R0 = bend.R * corner;
    return two.march(force, bend.m);
  };
  Vec3 m = near.cross(force);
  const double size = force.norm() * leg;
  ExactRod::End end{};
  for (int k = 0; k < 30; ++k) {
    end = march(m);
    if (end.m.norm() < 1e-12 * size) break;
    Mat3 D;
    for (int c = 0; c < 3; ++c) {
      const Vec3 e = 1e-7 * size * Vec3::Unit(c);
      D.col(c) = (march(m + e).m - march(m - e).m) / (2e-7 * size);
    }
    m -= D.inverse() * end.m;
  }
  EXPECT_LT(end.m.norm(), 1e-9 * size);
  return end.r;
}

}  // namespace

// Far beyond buckling: no limit points, and order 4 in the length of the elements.
TEST(StripFrame, PostBucklingOfOrderFour) {
  Record record("Strip frame far beyond buckling",
                "exact shear-deformable rod by shooting; tip force 1 N in the plane and 1 mN "
                "across, times the load factor");
  for (const double load : {2.0, 6.0}) {
    const Vec3 force = load * Vec3(1.0, 0.0, 1e-3);
    double error[3];
    Vec3 exact = Vec3::Zero();
    for (int k = 2; k >= 0; --k) {
      const int n = 16 << k;
      Frame f(n, 1e-3);
      LoadPathOptions o;
      o.last_load = load;
      o.steps = 20;
      const LoadPathResult r = f.follow(o);
      ASSERT_EQ(r.end, LoadPathEnd::reached) << describe(r);
      EXPECT_TRUE(r.critical.empty()) << n << " elements a leg: " << describe(r);
      EXPECT_TRUE(r.tangent.stable());
      const Vec3 tip = Vec3(leg, -leg, 0) + r.last.state.q.segment<3>(6 * f.tip());
      if (k == 2) {
        exact = exact_tip(force, tip, 4000);
        EXPECT_LT((exact - exact_tip(force, tip, 2000)).norm(), 1e-10);  // Runge-Kutta of order 4
      }
      error[k] = (tip - exact).norm();
      record.below(
          fmt::format("load factor {}, {} elements a leg: distance of the tip from the exact place",
                      load, n),
          "of a leg", error[k] / leg, 4e-4 / std::pow(14.0, k));
    }
    std::printf("load %g: errors %.3e %.3e %.3e, orders %.2f %.2f\n", load, error[0], error[1],
                error[2], std::log2(error[0] / error[1]), std::log2(error[1] / error[2]));
    EXPECT_GT(std::log2(error[1] / error[2]), 3.5) << load;
  }
}

// The factor loses nothing under refinement: of order 2 (the classical linearisation drops squares
// of the load inside elements), without rounding; and the path, of order 4, has its bifurcation
// where the exact rod has it.
TEST(StripFrame, BucklingUnderRefinement) {
  Record record("Strip frame: buckling",
                "bifurcation of the exact rod's path at 1.08752; the linearised factor leaves out "
                "the bending before buckling");
  std::vector<double> factor;
  for (const int n : {8, 16, 32, 64, 128, 256}) {
    Frame f(n, 0.0);
    for (const BucklingMode& m : buckling(f.running, 0.0, 2).modes)
      if (m.factor.real() > 0) factor.push_back(m.factor.real());
    std::printf("%d elements a leg: %.8f\n", n, factor.back());
  }
  ASSERT_EQ(factor.size(), 6u);
  for (std::size_t k = 0; k + 2 < factor.size(); ++k)
    EXPECT_NEAR(std::log2((factor[k] - factor[k + 1]) / (factor[k + 1] - factor[k + 2])), 2.0, 0.1)
        << k;
  // what order 2 leaves, taken off, is one value: the classical factor
  const double classical = factor[5] + (factor[5] - factor[4]) / 3.0;
  EXPECT_NEAR(factor[2] + (factor[2] - factor[1]) / 3.0, classical, 2e-6);
  record.check("linearised factor, extrapolated", "-", classical, 1.086755, 2e-6);
  record.check("linearised factor, 256 elements a leg", "-", factor.back(), 1.08752, 1e-3);
  Frame f(16, 0.0);
  const PathCheck p = check_on_path(f.running, 0.0, factor[1]);
  EXPECT_TRUE(p.found);
  EXPECT_FALSE(p.limit);
  record.check("bifurcation on the path, 16 elements a leg", "-", p.load, 1.08752, 1e-5);
}

// A force of 1 mN across the plane is no reason for another buckling load; and the path, which
// bends away, says that there is none.
TEST(StripFrame, SmallForceAcrossThePlane) {
  Frame plain(16, 0.0), pushed(16, 1e-3);
  const auto smallest_positive = [](SteadySystem& r) {
    double out = infinity;
    for (const BucklingMode& m : buckling(r, 0.0, 3).modes)
      if (m.factor.real() > 0 && m.factor.imag() == 0) out = std::min(out, m.factor.real());
    return out;
  };
  const double factor = smallest_positive(plain.running);
  EXPECT_NEAR(smallest_positive(pushed.running), factor, 1e-3 * factor);
  const PathCheck p = check_on_path(pushed.running, 0.0, factor);
  EXPECT_FALSE(p.found);
  EXPECT_DOUBLE_EQ(p.load, 1.25 * factor);
}

// The perfect frame: the bifurcation is found on the primary path, and the branch leads to where
// the imperfect frame goes.
TEST(StripFrame, BranchAtTheBifurcation) {
  LoadPathOptions o;
  o.last_load = 3.0;
  o.steps = 30;
  Frame primary(16, 0.0);
  const LoadPathResult flat = primary.follow(o);
  ASSERT_EQ(flat.end, LoadPathEnd::reached) << describe(flat);
  ASSERT_GE(flat.critical.size(), 1u);
  EXPECT_FALSE(flat.critical[0].limit);
  EXPECT_NEAR(flat.critical[0].load, 1.08752, 1e-5);  // 16 elements
  EXPECT_EQ(flat.critical[0].before, 0);
  EXPECT_EQ(flat.critical[0].after, 1);
  EXPECT_LT(std::abs(flat.last.state.q[6 * primary.tip() + 2]), 1e-9);  // stays in its plane
  EXPECT_GE(flat.tangent.negative, 1);
  // out of the plane alone
  const VecX& d = flat.critical[0].direction;
  EXPECT_LT(std::abs(d[6 * primary.tip()]) + std::abs(d[6 * primary.tip() + 1]), 1e-6);
  double across[2];
  for (int k = 0; k < 2; ++k) {
    Frame f(16, 0.0);
    o.branch = k == 0 ? 1 : -1;
    const LoadPathResult r = f.follow(o);
    ASSERT_EQ(r.end, LoadPathEnd::reached) << describe(r);
    EXPECT_EQ(r.branched_at, 0);
    EXPECT_TRUE(r.tangent.stable());
    const Vec3 tip = Vec3(leg, -leg, 0) + r.last.state.q.segment<3>(6 * f.tip());
    across[k] = tip.z();
    const Vec3 exact = exact_tip(Vec3(3.0, 0.0, 0.0), tip, 1000);
    EXPECT_LT((tip - exact).norm(), 5e-5);  // 16 elements, see above
    EXPECT_GT(std::abs(exact.z()), 0.03);
  }
  EXPECT_NEAR(across[0], -across[1], 1e-9);  // mirror images
  Frame none(16, 1e-3);
  o.branch = 1;
  EXPECT_EQ(none.follow(o).end, LoadPathEnd::no_branch);
}

// The perfect frame through its bifurcation to five times the critical load, to either side.
TEST(StripFrame, BranchToFiveTimesTheCriticalLoad) {
  Record record(
      "Strip frame on its branch to five times the critical load",
      "exact shear-deformable rod by shooting; the perfect frame, force in its plane alone");
  const double load = 5 * 1.08752;
  const Vec3 force(load, 0, 0);
  std::vector<double> error, energy;
  Vec3 exact = Vec3::Zero();
  for (const int n : {64, 32, 16}) {
    Frame f(n, 0.0);
    LoadPathOptions o;
    o.last_load = load;
    o.steps = 30;
    o.branch = n == 32 ? -1 : 1;
    const LoadPathResult r = f.follow(o);
    ASSERT_EQ(r.end, LoadPathEnd::reached) << describe(r);
    EXPECT_EQ(r.branched_at, 0);
    EXPECT_TRUE(r.tangent.stable());
    Vec3 tip = Vec3(leg, -leg, 0) + r.last.state.q.segment<3>(6 * f.tip());
    EXPECT_GT(std::abs(tip.z()), 0.015);  // the far leg has turned over: beyond its largest
    tip.z() = std::abs(tip.z());          // the sides are mirror images
    if (error.empty()) {
      exact = exact_tip(force, tip, 4000);
      EXPECT_LT((exact - exact_tip(force, tip, 2000)).norm(), 1e-10);
    }
    error.push_back((tip - exact).norm());
    const system::System& s = f.model.built.system;
    system::Workspace w = s.make_workspace();
    const system::State& x = r.last.state;
    ASSERT_TRUE(
        s.evaluate_nodes(w, x.frames, 0.0, x.q, VecX::Zero(s.size()), VecX::Zero(s.size())));
    energy.push_back(s.energy(w).elastic);
    record.below(fmt::format("{} elements a leg: distance of the tip from the exact place", n),
                 "of a leg", error.back() / leg, 4e-4 * std::pow(16.0 / n, 3.8));
  }
  const double of_place[] = {std::log2(error[2] / error[1]), std::log2(error[1] / error[0])},
               of_energy = std::log2((energy[2] - energy[1]) / (energy[1] - energy[0]));
  std::printf(
      "five times the critical load: errors %.3e %.3e %.3e m, orders %.2f %.2f; energy %.9e "
      "J, order %.2f; tip %.6f %.6f %.6f\n",
      error[2], error[1], error[0], of_place[0], of_place[1], energy[0], of_energy, exact.x(),
      exact.y(), exact.z());
  EXPECT_GT(of_place[1], 3.5);
  EXPECT_GT(of_energy, 3.5);
}
