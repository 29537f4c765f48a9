// Foundations as matrices: closed forms, and the same bodies built otherwise.
#include <analysis/linearizer.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <core/error.hpp>
#include "deck_model.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

using namespace whirl;
using test::DeckModel;

namespace {

std::vector<Complex> eigenvalues(const DeckModel& m, double Omega, int count) {
  analysis::Linearizer linear(m.built.system, m.running());
  linear.at(Omega);
  analysis::ModesOptions options;
  options.count = count;
  std::vector<Complex> out;
  for (const auto& mode : analysis::whirl_modes(linear, Omega, options))
    out.push_back(mode.lambda);
  return out;
}

}  // namespace

// A mass m1 on k1, c1 on a foundation of mass m2 with circulatory stiffness s and gyroscopic
// damping g. With w = y + i z
//   m1 l^2 w1 + (c1 l + k1)(w1 - w2) = 0,
//       m2 l^2 w2 + (c2 - i g) l w2 + (k2 - i s) w2 = (c1 l + k1)(w1 - w2)
// s and g move the forward and the backward modes apart, and one of them grows.
TEST(Foundation, CirculatoryAndGyroscopicPartsOfAPoint) {
  const double m1 = 20, k1 = 3e6, c1 = 400, m2 = 60, k2 = 8e6, c2 = 300, s = 6e5, g = 9e3;
  const DeckModel m(test::lateral_mass(m1, "9.81 m/s^2", R"([[bearing]]
name = "tested"
at = "mass"
type = "linear"
kyy = "3e6 N/m"
kzz = "3e6 N/m"
cyy = "400 N.s/m"
czz = "400 N.s/m"
[[foundation]]
name = "table"
symmetric = false
coordinates = ["tested.y", "tested.z"]
columns = ["row", "column", "K[N/m]", "C[N.s/m]", "M[kg]"]
rows = [[1, 1, 8e6, 300, 60], [2, 2, 8e6, 300, 60], [1, 2, 6e5, 9e3, 0], [2, 1, -6e5, -9e3, 0]]
)"));
  // (M l^2 + C l + K) x = 0 as l (x, l x) = A (x, l x)
  Eigen::Matrix2cd C, K, M = Eigen::Vector2cd(m1, m2).asDiagonal();
  C << c1, -c1, -c1, Complex(c1 + c2, -g);
  K << k1, -k1, -k1, Complex(k1 + k2, -s);
  Eigen::Matrix4cd A = Eigen::Matrix4cd::Zero();
  A.topRightCorner<2, 2>().setIdentity();
  A.bottomLeftCorner<2, 2>() = -M.inverse() * K;
  A.bottomRightCorner<2, 2>() = -M.inverse() * C;
  const Eigen::Vector4cd exact =
      Eigen::ComplexEigenSolver<Eigen::Matrix4cd>(A, false).eigenvalues();
  EXPECT_GT(exact.real().maxCoeff(), 1.0);  // it does grow
  const auto found = eigenvalues(m, 100.0, 4);
  ASSERT_EQ(found.size(), 4u);
  for (Index i = 0; i < 4; ++i) {
    double nearest = infinity;
    for (const Complex& l : found)
      nearest = std::min({nearest, std::abs(l - exact[i]), std::abs(std::conj(l) - exact[i])});
    EXPECT_LT(nearest, 1e-10 * std::abs(exact[i])) << exact[i];
  }
}

// Six directions of a support point: a rigid casing of mass m, centre 50 mm beside the bearing, on
// an unsymmetric 6 x 6 spring and damper, once as a casing shaft and once as matrices. The casing
// turns with exact angles, the matrices with their sines: 1e-8 at tilts of 1e-4.
TEST(Foundation, SixDirectionsAreARigidCasing) {
  const std::string rotor = R"(format = 1
[model]
gravity = "9.81 m/s^2"
[[shaft]]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 250, 40, 2], ["b", 250, 40, 2]]
[[disk]]
name = "disk"
at = "rotor/b:end"
mass = "12 kg"
Ip = "0.2 kg.m^2"
Id = "0.11 kg.m^2"
)";
  const std::string bearing = R"([[bearing]]
name = "main"
at = "rotor/a:end"
type = "linear"
kxx = "2e7 N/m"
kyy = "5e7 N/m"
kzz = "4e7 N/m"
krr = "3e5 N.m/rad"
cyy = "1e3 N.s/m"
czz = "1e3 N.s/m"
crr = "20 N.m.s/rad"
)";
  const DeckModel casing(rotor + R"([[shaft]]
name = "casing"
material = "steel"
rotating = false
origin = ["150 mm", "0 mm", "0 mm"]
columns = ["name", "length[mm]", "rigid"]
rows = [["c", 100, true], ["d", 50, true]]
[[disk]]
name = "body"
at = "casing/d:end"
mass = "30 kg"
Ip = "0.8 kg.m^2"
Id = "0.5 kg.m^2"
)" + bearing + R"(to = "casing/c:end"
[[bearing]]
name = "ground"
at = "casing/c:end"
type = "linear"
K = [["3e7 N/m", 0, 0, 0, 0, 0], [0, "2e7 N/m", "4e6 N/m", 0, 0, "1e6 N/rad"], [0, "-4e6 N/m", "3e7 N/m", 0, "-5e5 N/rad", 0],
     [0, 0, 0, "4e5 N.m/rad", 0, 0], [0, 0, "-3e5 N/rad", 0, "6e5 N.m/rad", "5e4 N.m/rad"], [0, "2e6 N/rad", 0, 0, "-5e4 N.m/rad", "8e5 N.m/rad"]]
C = [["900 N.s/m", 0, 0, 0, 0, 0], [0, "800 N.s/m", "300 N.s/m", 0, 0, 0], [0, "-300 N.s/m", "700 N.s/m", 0, 0, 0],
     [0, 0, 0, "5 N.m.s/rad", 0, 0], [0, 0, 0, 0, "6 N.m.s/rad", "40 N.m.s/rad"], [0, 0, 0, 0, "-40 N.m.s/rad", "7 N.m.s/rad"]]
)");
  // mass centre at +50 mm: u_y + 0.05 rz, u_z - 0.05 ry
  const DeckModel matrices(rotor + bearing + R"([[foundation]]
name = "casing"
symmetric = false
coordinates = ["main.x", "main.y", "main.z", "main.rx", "main.ry", "main.rz"]
columns = ["row", "column", "K", "C", "M"]
rows = [[1, 1, "3e7 N/m", "900 N.s/m", "30 kg"], [2, 2, "2e7 N/m", "800 N.s/m", "30 kg"], [3, 3, "3e7 N/m", "700 N.s/m", "30 kg"],
        [2, 3, "4e6 N/m", "300 N.s/m", 0], [3, 2, "-4e6 N/m", "-300 N.s/m", 0], [2, 6, "1e6 N/rad", 0, "1.5 kg.m"], [6, 2, "2e6 N/rad", 0, "1.5 kg.m"],
        [3, 5, "-5e5 N/rad", 0, "-1.5 kg.m"], [5, 3, "-3e5 N/rad", 0, "-1.5 kg.m"],
        [4, 4, "4e5 N.m/rad", "5 N.m.s/rad", "0.8 kg.m^2"], [5, 5, "6e5 N.m/rad", "6 N.m.s/rad", "0.575 kg.m^2"], [6, 6, "8e5 N.m/rad", "7 N.m.s/rad", "0.575 kg.m^2"],
        [5, 6, "5e4 N.m/rad", "40 N.m.s/rad", 0], [6, 5, "-5e4 N.m/rad", "-40 N.m.s/rad", 0]]
)");
  const auto one = eigenvalues(casing, 400.0, 10), two = eigenvalues(matrices, 400.0, 10);
  ASSERT_EQ(one.size(), two.size());
  ASSERT_GE(one.size(), 8u);
  for (std::size_t i = 0; i < one.size(); ++i)
    EXPECT_LT(std::abs(one[i] - two[i]), 1e-8 * std::abs(one[i])) << one[i];
}

// On a base that turns, masses at the support points are pedestals to rounding; other mass matrices
// are refused.
TEST(Foundation, OnATurningBase) {
  const std::string rotor = R"(format = 1
[model]
gravity = "9.81 m/s^2"
[base.turn]
axis = [0.2, 0.5, 0.8]
rate = "40 deg/s"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 400, 50, 2], ["b", 400, 50, 2]]
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
)";
  const auto bearings = [](const char* support) {
    std::string out;
    for (const char* place : {"a:start", "b:end"})
      out += std::string("[[bearing]]\nname = \"") + place[0] + "\"\nat = \"" + place +
             "\"\ntype = \"linear\"\nkyy = \"5e7 N/m\"\nkzz = \"5e7 N/m\"\n" + support;
    return out;
  };
  const auto table = [](const char* more) {
    return std::string(R"([[foundation]]
name = "table"
coordinates = ["a.y", "a.z", "b.y", "b.z"]
columns = ["row", "column", "K[N/m]", "C[N.s/m]", "M[kg]"]
rows = [[1, 1, 4e7, 500, 12], [2, 2, 6e7, 500, 12], [3, 3, 4e7, 500, 12], [4, 4, 6e7, 500, 12])") +
           more + "]\n";
  };
  const DeckModel pedestals(rotor +
                            bearings("support = { mass = \"12 kg\", kyy = \"4e7 N/m\", kzz = \"6e7 "
                                     "N/m\", cyy = \"500 N.s/m\", czz = \"500 N.s/m\" }\n"));
  const DeckModel matrices(rotor + bearings("") + table(""));
  const system::System &p = pedestals.built.system, &f = matrices.built.system;
  // nodes in the order of the mesh; pedestals have a ground node each behind them
  std::vector<Index> same;
  for (Index i = 0, j = 0; i < f.nodes(); ++i) {
    while (j < p.nodes() && p.node(j).name != f.node(i).name)
      ++j;
    ASSERT_LT(j, p.nodes()) << f.node(i).name;
    same.push_back(j++);
  }
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  VecX q[2], v[2], a[2], r[2];
  for (int k = 0; k < 2; ++k)
    q[k] = v[k] = a[k] = r[k] = VecX::Zero((k == 0 ? p : f).size());
  for (Index i = 0; i < f.nodes(); ++i)
    for (Index c = 0; c < 6; ++c) {
      const Index from = 6 * i + c, to = 6 * same[static_cast<std::size_t>(i)] + c;
      q[0][to] = q[1][from] = 1e-4 * normal(rng);
      v[0][to] = v[1][from] = 0.1 * normal(rng);
      a[0][to] = a[1][from] = 10 * normal(rng);
    }
  const system::System* systems[2] = {&p, &f};
  for (int k = 0; k < 2; ++k) {
    system::Workspace w = systems[k]->make_workspace();
    const system::Frames frames = systems[k]->make_state().frames;
    systems[k]->impose(frames, 0.4, q[k], v[k], a[k]);
    ASSERT_TRUE(systems[k]->residual(w, frames, 0.4, q[k], v[k], a[k], r[k]));
  }
  const double size = r[1].cwiseAbs().maxCoeff();
  for (Index i = 0; i < f.nodes(); ++i)
    for (Index c = 0; c < 6; ++c) {
      if (!f.active()[static_cast<std::size_t>(6 * i + c)]) continue;
      EXPECT_NEAR(r[0][6 * same[static_cast<std::size_t>(i)] + c], r[1][6 * i + c], 1e-14 * size)
          << f.node(i).name << " " << c;
    }

  try {
    DeckModel refused(rotor + bearings("") + table(", [1, 3, 0, 0, 2]"));
    FAIL() << "masses that couple two places are not refused";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("does not say where the mass is"), std::string::npos)
        << e.what();
  }
}
