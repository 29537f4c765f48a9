// The whole chain, model to mesh to system, against closed forms: linearised about the spinning
// state and in statics.
#include <la/dense.hpp>
#include "models.hpp"

#include <assembly/build_system.hpp>
#include <gtest/gtest.h>
#include <system/problem.hpp>

#include <algorithm>

using namespace whirl;
using namespace whirl::test;

namespace {

struct Matrices {
  MatX M, C, K;
};

/// M, C, K of the unknowns about the straight state spinning at Omega (spin and axial motion left
/// out).
Matrices lateral(const assembly::Built& b, double Omega) {
  const Index n = b.system.size();
  system::SystemProblem p(b.system);
  const VecX q = VecX::Zero(n);
  VecX v = q;
  std::vector<Index> keep;
  for (Index k = 0; k < n; ++k) {
    if (k % 6 == system::spin_phi)
      v[k] = Omega;
    else if (k % 6 != system::ux && b.system.active()[S(k)])
      keep.push_back(k);
  }
  p.linearize(0.0, q, v, q);
  Matrices full{MatX::Zero(n, n), MatX::Zero(n, n), MatX::Zero(n, n)};
  for (Index k = 0; k < n; ++k) {
    const VecX e = VecX::Unit(n, k);
    p.add_M(1.0, e, full.M.col(k));
    p.add_C(1.0, e, full.C.col(k));
    p.add_K(1.0, e, full.K.col(k));
  }
  return {full.M(keep, keep), full.C(keep, keep), full.K(keep, keep)};
}

/// Positive imaginary parts of the eigenvalues, ascending, rad/s.
std::vector<double> frequencies(const Matrices& m) {
  const Index n = m.M.rows();
  // Scaled by sqrt of M's diagonal, so that metres and radians do not meet.
  const VecX s = m.M.diagonal().array().rsqrt();
  const MatX M = s.asDiagonal() * m.M * s.asDiagonal(), C = s.asDiagonal() * m.C * s.asDiagonal(),
             K = s.asDiagonal() * m.K * s.asDiagonal();
  MatX A = MatX::Zero(2 * n, 2 * n);
  const la::DenseLu<double> lu(M);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -lu.solve(K);
  A.bottomRightCorner(n, n) = -lu.solve(C);
  const VecXc l = la::eigenvalues(A);
  std::vector<double> w;
  for (Index i = 0; i < l.size(); ++i)
    if (l[i].imag() > 0) w.push_back(l[i].imag());
  std::sort(w.begin(), w.end());
  return w;
}

model::Model pinned_shaft(int elements, bool rotary) {
  model::Model m = one_shaft({cylinder("shaft", 0.9, 0.05, 0, elements)});
  m.materials[0].E = 2e11;
  m.materials[0].G = 2e11 / 2.6;
  m.materials[0].rho = 7800;
  m.shafts[0].sections[0].shear = model::ShearFactor::none;
  m.shafts[0].sections[0].rotary_inertia = rotary;
  m.bearings = {held("l", 0, {true, true, true, false, false, false}),
                held("r", 0.9, {false, true, true, false, false, false})};
  return m;
}

// Simply supported spinning shaft: (rho A + s rho I b) w^2 -+ 2 rho I b Omega w - E I b^2 = 0, b =
// (n pi/L)^2; s = 0 without rotary inertia (code_aster SDLL141), s = 1 Rayleigh.
TEST(Chain, SpinningPinnedShaftExactWhirl) {
  const double Omega = 1e4, A = pi / 4 * 0.05 * 0.05, I = pi / 64 * std::pow(0.05, 4), rho = 7800,
               E = 2e11;
  for (bool rotary : {false, true}) {
    std::vector<double> exact;
    for (int n = 1; n <= 4; ++n) {
      const double b = std::pow(n * pi / 0.9, 2), a = rho * A + (rotary ? rho * I * b : 0),
                   g = rho * I * b * Omega;
      const double root = std::sqrt(g * g + a * E * I * b * b);
      exact.push_back((root - g) / a);
      exact.push_back((root + g) / a);
    }
    std::vector<double> coarse, fine;
    for (int elements : {12, 24}) {
      const model::Model m = pinned_shaft(elements, rotary);
      const auto w = frequencies(lateral(assembly::build_system(m, meshes::make_mesh(m)), Omega));
      std::printf("  pinned shaft, rotary %d, %2d elements:", rotary, elements);
      for (int k = 0; k < 8; ++k) {
        const double e = w[S(k)] / exact[S(k)] - 1;
        (elements == 12 ? coarse : fine).push_back(e);
        std::printf(" %8.1e", e);
      }
      std::printf("\n");
    }
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_LT(std::abs(coarse[k]), 1e-4);
      EXPECT_LT(std::abs(fine[k]),
                1e-5);  // the case's tolerance; the dense eigensolver's own noise is 5e-7
    }
    // Printed by the case: first pair.
    const double first = rotary ? 119.6437546 : 119.7547836,
                 second = rotary ? 125.6924098 : 125.8149546;
    EXPECT_NEAR(exact[0] / two_pi, first, 1e-7 * first);
    EXPECT_NEAR(exact[1] / two_pi, second, 1e-7 * second);
  }
}

// Multibody benchmark (Bauchau et al. 2016, doi 10.1007/s11044-016-9514-y): clamped-clamped tube of
// given constants, disk at mid-span. Exact sag 3.30985e-3 m; exact first frequency 56.853178 rad/s
// (Timoshenko half shaft by shooting, the disk as its end condition).
TEST(Chain, RotatingShaftBenchmarkSagAndFrequency) {
  model::Model m = one_shaft({cylinder("tube", 6.0, 0.1, 0.09, 8)});
  m.shafts[0].sections[0].constants =
      model::Section::Constants{313.4e6, 60.5e6, 272.7e3, 354.5e3, 11.640, 13.17e-3, 26.33e-3};
  m.disks = {disk("disk", 3.0, 70.573, 2.0325, 1.0309)};
  m.bearings = {held("l", 0, {true, true, true, false, true, true}),
                held("r", 6, {false, true, true, false, true, true})};
  m.gravity = Vec3(0, 0, -9.81);
  const assembly::Built b = assembly::build_system(m, meshes::make_mesh(m));
  const Matrices x = lateral(b, 0.0);
  EXPECT_NEAR(frequencies(x)[0], 56.853178, 4e-5 * 56.85);  // 8 elements; 12 give 8e-6
  // Linear sag from the residual of the straight shaft.
  const Index n = b.system.size();
  system::SystemProblem p(b.system);
  const VecX zero = VecX::Zero(n);
  VecX r(n);
  ASSERT_TRUE(p.residual(0.0, zero, zero, zero, r));
  std::vector<Index> keep;
  Index disk_z = -1;
  for (Index k = 0; k < n; ++k) {
    if (k % 6 == system::spin_phi || k % 6 == system::ux || !b.system.active()[S(k)]) continue;
    if (k == 6 * 4 + system::uz) disk_z = static_cast<Index>(keep.size());
    keep.push_back(k);
  }
  const VecX sag = la::DenseLu<double>(x.K).solve(VecX(r(keep)));
  // wL^4/384EI + PL^3/192EI + shear (wL^2/8 + PL/4)/kGA
  const double w = 11.640 * 9.81, P = 70.573 * 9.81, L = 6, EI = 354.5e3, kGA = 60.5e6;
  const double exact = w * std::pow(L, 4) / 384 / EI + P * std::pow(L, 3) / 192 / EI +
                       (w * L * L / 8 + P * L / 4) / kGA;
  EXPECT_NEAR(exact, 3.30985e-3, 5e-9);
  EXPECT_NEAR(sag[disk_z], exact, 1e-12 * exact);  // nodally exact
}

}  // namespace
