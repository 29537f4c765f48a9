// Bearings whose 6x6 coefficients follow the speed, and bearings estimated from their load, through
// decks.
//
// A rigid body (mass m, Ip, Id) on one bearing at a distance a from its mass centre. In (x, y, z,
// ry, rz) of the mass centre, turning at Omega, with B from these to the bearing's motion:  M l^2 +
// (B^T C B + Omega G) l + B^T K B,  G from Ip. Solved here as it stands.
#include <analysis/statics/equilibrium.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <elements/rolling/hertz.hpp>
#include "deck_model.hpp"
#include "record.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using test::DeckModel;
using test::rpm;

namespace {

constexpr double mass = 40, Ip = 0.9, Id = 0.6, arm = 0.1;

/// Symmetric part and cross coupling, translations with tilts: what a seal or a pair of pads of
/// finite length has.
Matrix<6> stiffness(double speed) {
  Matrix<6> K = Matrix<6>::Zero();
  const double s = speed / (3000 * rpm);
  K(0, 0) = 4e6;
  K.block<2, 2>(1, 1) << 2e7 + 1e6 * s, 3e6 * s, -2e6 * s, 3e7;
  K.block<2, 2>(4, 4) << 3e5, 2e4 * s, -1e4 * s, 4e5 + 1e5 * s;
  K(1, 5) = 4e5 * s;
  K(5, 1) = 3e5;
  K(2, 4) = -2e5;
  K(4, 2) = -5e5 * s;
  K(0, 4) = 1e5;
  K(4, 0) = 1e5;
  K(3, 3) = 10;  // against twist
  return K;
}
Matrix<6> damping(double speed) {
  Matrix<6> C = 1e-4 * stiffness(0);
  C(1, 2) = 200 + 0.1 * speed;
  C(2, 1) = -C(1, 2);
  C(1, 5) = 30;
  return C;
}
Matrix<6> inertia() {
  Matrix<6> M = Matrix<6>::Zero();
  M(1, 1) = M(2, 2) = 2.0;
  M(4, 4) = M(5, 5) = 0.01;
  M(1, 5) = M(5, 1) = 0.05;
  return M;
}

const char* axes[6] = {"x", "y", "z", "rx", "ry", "rz"};
std::string name(char letter, int i, int j) {
  if (i >= 3 && j >= 3 && (i == j || (i > 3 && j > 3)))
    return std::string(1, letter) + axes[i] + axes[j - 3];
  return std::string(1, letter) + axes[i] + (i < 3 && j < 3 ? "" : "_") + axes[j];
}

/// Every one of the 108 columns, by name.
std::string table(const std::vector<double>& speeds) {
  static const char* units[3][3] = {
      {"N/m", "N/rad", "N.m/rad"}, {"N.s/m", "N.s/rad", "N.m.s/rad"}, {"kg", "kg.m", "kg.m^2"}};
  std::string columns = "\"speed[rad/s]\"", rows;
  for (int p = 0; p < 3; ++p)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        columns += fmt::format(", \"{}[{}]\"", name("kcm"[p], i, j), units[p][(i >= 3) + (j >= 3)]);
  for (const double s : speeds) {
    rows += fmt::format("[{:.17g}", s);
    for (const Matrix<6>& m : {stiffness(s), damping(s), inertia()})
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          rows += fmt::format(", {:.17g}", m(i, j));
    rows += "],\n";
  }
  return fmt::format("columns = [{}]\nrows = [\n{}]\n", columns, rows);
}

std::string body(const std::string& bearing, const char* gravity = "0 m/s^2") {
  return fmt::format(R"(format = 1
[model]
gravity = "{}"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true]]
[[disk]]
name = "body"
at = "left:end"
mass = "{} kg"
Ip = "{} kg.m^2"
Id = "{} kg.m^2"
[[bearing]]
name = "bearing"
at = "left:start"
{})",
                     gravity, mass, Ip, Id, bearing);
}

/// Motion of the bearing from that of the mass centre, which lies `arm` towards +x: u_b = u - arm
/// (rotation x e).
Matrix<6, 5> to_bearing() {
  Matrix<6, 5> B = Matrix<6, 5>::Zero();
  B(0, 0) = B(1, 1) = B(2, 2) = B(4, 3) = B(5, 4) = 1;
  B(1, 4) = -arm;
  B(2, 3) = arm;
  return B;
}

std::vector<Complex> exact(double Omega) {
  const Matrix<6, 5> B = to_bearing();
  const Matrix<5> K = B.transpose() * stiffness(Omega) * B;
  Matrix<5> C = B.transpose() * damping(Omega) * B, M = B.transpose() * inertia() * B;
  M.diagonal() += (Vector<5>() << mass, mass, mass, Id, Id).finished();
  C(3, 4) += Ip * Omega;
  C(4, 3) -=
      Ip * Omega;  // Id ry'' + Ip Omega rz' = My: the spin's momentum follows the axis (1, rz, -ry)
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(10, 10);
  const Matrix<5> Mi = M.inverse();
  A.topRightCorner(5, 5).setIdentity();
  A.bottomLeftCorner(5, 5) = -Mi * K;
  A.bottomRightCorner(5, 5) = -Mi * C;
  std::vector<Complex> out;
  for (const Complex& l : A.eigenvalues())
    if (l.imag() > 0) out.push_back(l);
  std::sort(out.begin(), out.end(), [](Complex a, Complex b) { return a.imag() < b.imag(); });
  return out;
}

}  // namespace

// The rows are linear in the speed, so both interpolations are exact. What remains is the
// eigensolver's rounding.
TEST(BearingTables, ModesOnFullMatrices) {
  test::Record record(
      "Rigid body on a bearing with 6x6 K, C, M tabulated against speed",
      "eigenvalues of the 5 x 5 matrices, tests/validation/test_bearing_tables.cpp");
  for (const char* interpolation : {"linear", "pchip"}) {
    const DeckModel m(body("type = \"table\"\ninterpolation = \"" + std::string(interpolation) +
                           "\"\n" + table({-100, 0, 150, 400, 700})));
    analysis::Linearizer linear(m.built.system, m.running());
    analysis::ModesOptions o;
    o.count = 12;
    for (const double Omega : {0.0, 70.0, 314.0, 650.0}) {
      const auto reference = exact(Omega);
      std::vector<Complex> found;
      for (const auto& mode : analysis::whirl_modes(linear, Omega, o))
        if (mode.kind != analysis::ModeKind::torsional && mode.lambda.imag() > 0)
          found.push_back(mode.lambda);
      ASSERT_EQ(found.size(), reference.size()) << Omega;
      std::sort(found.begin(), found.end(),
                [](Complex a, Complex b) { return a.imag() < b.imag(); });
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_LT(std::abs(found[i] - reference[i]), 1e-9 * std::abs(reference[i]))
            << interpolation << " " << Omega << " " << i << " " << found[i] << " " << reference[i];
      if (Omega != 650.0) continue;
      for (std::size_t i = 0; i < found.size(); ++i)
        record.check(fmt::format("frequency {} at 650 rad/s, {}", i + 1, interpolation), "rad/s",
                     found[i].imag(), reference[i].imag(), 1e-9 * std::abs(reference[i]));
    }
  }
}

// Set point, preload and weight at rest: K (q - q0) = preload + weight at the bearing, small
// motions (the deck's are of 1e-4).
TEST(BearingTables, SetPointAndPreload) {
  const DeckModel m(
      body("type = \"table\"\nsetpoint = [\"10 um\", \"20 um\", \"-30 um\"]\nsetpoint_tilt = [\"0 "
           "deg\", \"0.001 deg\", \"-0.002 deg\"]\n"
           "preload = [\"100 N\", \"-200 N\", \"300 N\"]\npreload_moment = [\"0 N.m\", \"5 N.m\", "
           "\"7 N.m\"]\n" +
               table({0, 700}),
           "9.81 m/s^2"));
  const Matrix<6, 5> B = to_bearing();
  Vector<6> setpoint, preload;
  setpoint << 10e-6, 20e-6, -30e-6, 0, 0.001 * pi / 180, -0.002 * pi / 180;
  preload << 100, -200, 300, 0, 5, 7;
  Vector<5> weight = Vector<5>::Zero();
  weight[2] = -mass * 9.81;
  const Matrix<6> K = stiffness(0);
  const Vector<5> q =
      (B.transpose() * K * B).fullPivLu().solve(weight + B.transpose() * (preload + K * setpoint));
  analysis::SteadySystem running(m.built.system, m.running());
  const Vec3 u = analysis::EquilibriumSolver(running).solve(0.0).state.q.segment<3>(6 * m.disk());
  const double o =
      m.mesh.place(m.deck.model.disks[0].at).offset;  // of the mass centre from its node
  Vec3 exact = Vec3(q.head<3>()) - o * Vec3(0, q[4], -q[3]);
  exact.x() -= 0.5 * arm * (q[3] * q[3] + q[4] * q[4]);  // the arm is rigid
  EXPECT_LT((u - exact).norm(),
            1e-6 * exact.norm());  // the next terms: tilts of 1e-4 in the arms of the forces
}

// The estimate is a linear bearing with the book's stiffnesses, turned to the load.
TEST(BearingTables, RollingEstimates) {
  for (const bool roller : {false, true}) {
    const DeckModel m(test::lateral_mass(
        50, "0 m/s^2",
        fmt::format(R"([[bearing]]
name = "estimated"
at = "mass"
type = "{}"
load = "500 N"
load_angle = "-60 deg"
contact_angle = "30 deg"
)",
                    roller ? "roller_estimate\"\nrollers = 8\nroller_length = \"30 mm"
                           : "ball_estimate\"\nballs = 8\nball_diameter = \"30 mm")));
    analysis::Linearizer linear(m.built.system, m.running());
    analysis::ModesOptions o;
    o.count = 4;
    o.motion = analysis::Motion::lateral;
    const auto modes = analysis::whirl_modes(linear, 0.0, o);
    ASSERT_EQ(modes.size(), 2u);
    // Friswell et al. 2010, pp. 182-185, for 8 elements of 30 mm at 500 N and 30 degrees: 46.4,
    // 100.9 (balls), 272.8, 556.8 (rollers) MN/m
    const double across = roller ? 272821927 : 46416883.8, along = roller ? 556779444 : 100906269;
    EXPECT_NEAR(modes[0].frequency, std::sqrt(across / 50), 1e-8 * modes[0].frequency);
    EXPECT_NEAR(modes[1].frequency, std::sqrt(along / 50), 1e-8 * modes[1].frequency);
    const Index y = 6 * m.disk() + 1;
    const double angle = std::atan2((modes[1].x[y + 1] / modes[1].x[y]).real(), 1.0);
    EXPECT_NEAR(angle, -pi / 3, 1e-8);
  }
}
