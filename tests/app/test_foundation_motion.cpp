// Motion in time of a rotor on a foundation whose matrices, from a file, are not symmetric and have
// rotations, against the exponential of the small linear system.
#include "deck_run.hpp"

#include <la/dense.hpp>
#include <core/types.hpp>

#include <fmt/format.h>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

using Mat4 = Eigen::Matrix4d;
using Mat8 = Eigen::Matrix<double, 8, 8>;

/// In the order y, z, ry, rz: bearing and foundation. The foundation has circulatory stiffness
/// between its displacements and between its rotations, other coupling of force with rotation than
/// of moment with displacement, gyroscopic damping, and a centre of mass beside its support point.
struct Parts {
  Mat4 K, C, Kf, Cf, Mf;
  Parts() {
    K << 5e6, 6e5, 0, 2e5, -6e5, 4e6, -1e5, 0, 0, -1.5e5, 3e4, 2e3, 1e5, 0, -2e3, 4e4;
    C << 400, 0, 0, 0, 0, 300, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4;
    Kf << 8e6, 1.5e6, 0, 3e5, -1e6, 9e6, -2e5, 0, 0, -4e5, 2e5, 3e4, 1e5, 0, -2e4, 2.5e5;
    Cf << 900, 700, 0, 0, -700, 800, 0, 0, 0, 0, 9, 30, 0, 0, -30, 8;
    Mf << 25, 0, 0, 0.5, 0, 25, -0.5, 0, 0, -0.5, 0.6, 0, 0.5, 0, 0, 0.7;
  }
};
constexpr double mass = 12, Ip = 0.2, Id = 0.11, Omega = 100 * pi, duration = 0.2;

std::string matrix(const Mat4& m, const char* force, const char* angle, const char* moment) {
  constexpr int place[] = {1, 2, 4, 5};  // of y, z, ry, rz in the 6x6
  std::string rows;
  for (int i = 0; i < 6; ++i) {
    std::string row;
    for (int j = 0; j < 6; ++j) {
      double x = 0;
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          if (place[a] == i && place[b] == j) x = m(a, b);
      row += fmt::format("{}{}", j ? ", " : "",
                         x == 0 ? "0"
                                : fmt::format("\"{:.17g} {}\"", x,
                                              i < 3 && j < 3   ? force
                                              : i < 3 || j < 3 ? angle
                                                               : moment));
    }
    rows += fmt::format("{}[{}]", i ? ", " : "", row);
  }
  return "[" + rows + "]";
}

std::string csv(const Parts& p) {
  std::string out = "row,column,K,C,M\n";
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const int turns = (i > 1) + (j > 1);
      const char* units[3][3] = {
          {"N/m", "N.s/m", "kg"}, {"N/rad", "N.s/rad", "kg.m"}, {"N.m/rad", "N.m.s/rad", "kg.m^2"}};
      out += fmt::format("{},{},{:.17g} {},{:.17g} {},{:.17g} {}\n", i + 1, j + 1, p.Kf(i, j),
                         units[turns][0], p.Cf(i, j), units[turns][1], p.Mf(i, j), units[turns][2]);
    }
  return out;
}

}  // namespace

// From a displacement, tilt and velocity of the rotor, everything else at rest. Micrometres and
// microradians: what is not linear is 1e-6 of them.
TEST(FoundationMotion, UnsymmetricMatricesWithRotations) {
  const Parts p;
  const Eigen::Vector4d q0(1e-6, -2e-6, 3e-6, 1e-6), v0(4e-4, -3e-4, 0, 0);
  const auto folder = std::filesystem::temp_directory_path() /
                      fmt::format("whirl_foundation_motion_{}", ::getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "table.csv") << csv(p);
  std::ofstream(folder / "d.toml")
      << fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 100, true], ["right", 100, true]]
[[disk]]
name = "disk"
at = "left:end"
mass = "{} kg"
Ip = "{} kg.m^2"
Id = "{} kg.m^2"
[[bearing]]
name = "guide"
at = "disk"
type = "rigid"
directions = ["x"]
[[bearing]]
name = "main"
at = "disk"
type = "linear"
K = {}
C = {}
[[foundation]]
name = "table"
symmetric = false
coordinates = ["main.y", "main.z", "main.ry", "main.rz"]
file = "table.csv"
[[drive]]
at = "disk"
type = "speed"
speed = "3000 rpm"
[[initial]]
displacement = ["0 mm", "{} mm", "{} mm"]
tilt = ["{} rad", "{} rad"]
velocity = ["0 m/s", "{} m/s", "{} m/s"]
about = ["100 mm", "0 mm", "0 mm"]
[[probe]]
name = "disk"
at = "disk"
[[probe]]
name = "support"
at = "main:support"
[[step]]
name = "run"
type = "transient"
start = "rest"
initial_speed = "3000 rpm"
duration = "{} s"
integrator = {{ tolerance = 1e-8 }}
[output]
every = "1 ms"
quantities = ["probes", "rotation"]
report = false
)",
                     mass, Ip, Id, matrix(p.K, "N/m", "N/rad", "N.m/rad"),
                     matrix(p.C, "N.s/m", "N.s/rad", "N.m.s/rad"), 1e3 * q0[0], 1e3 * q0[1], q0[2],
                     q0[3], v0[0], v0[1], duration);
  const DeckRun d(folder / "d.toml");
  std::filesystem::remove_all(folder);
  ASSERT_EQ(d.exit, 0) << d.log;

  // M q'' + (C + G) q' + K q = 0, q = (rotor, foundation); G: I_p Omega couples the tilts
  Mat8 M = Mat8::Zero(), C = M, K = M;
  M.diagonal().head<4>() << mass, mass, Id, Id;
  M.bottomRightCorner<4, 4>() = p.Mf;
  for (const auto& [part, own, whole] :
       {std::tuple{&p.K, &p.Kf, &K}, std::tuple{&p.C, &p.Cf, &C}}) {
    whole->topLeftCorner<4, 4>() = *part;
    whole->topRightCorner<4, 4>() = -*part;
    whole->bottomLeftCorner<4, 4>() = -*part;
    whole->bottomRightCorner<4, 4>() = *part + *own;
  }
  C(2, 3) += Ip * Omega;
  C(3, 2) -= Ip * Omega;
  MatX A = MatX::Zero(16, 16);
  A.topRightCorner<8, 8>().setIdentity();
  A.bottomLeftCorner<8, 8>() = -M.inverse() * K;
  A.bottomRightCorner<8, 8>() = -M.inverse() * C;
  const la::DenseEigenpairs eigen = la::eigenpairs(A);
  VecXc start = VecXc::Zero(16);
  start.head<4>() = q0.cast<Complex>();
  start.segment<4>(8) = v0.cast<Complex>();
  const VecXc part = la::DenseLu<Complex>(eigen.vectors).solve(start);
  const auto exact = [&](double t) {
    return VecX(
        (eigen.vectors * (eigen.values * t).array().exp().matrix().asDiagonal() * part).real());
  };

  const Columns run = d.csv("run.csv");
  ASSERT_EQ(run.rows.size(), 201u);
  const char* names[] = {"disk.y [m]",         "disk.z [m]",    "disk gamma.2 [rad]",
                         "disk gamma.3 [rad]", "support.y [m]", "support.z [m]"};
  double worst[6] = {}, largest[6] = {};
  for (const auto& row : run.rows) {
    const VecX x = exact(row[0]);
    for (std::size_t k = 0; k < 6; ++k) {
      largest[k] = std::max(largest[k], std::abs(x[static_cast<Index>(k)]));
      worst[k] = std::max(worst[k], std::abs(row[run.column(names[k])] - x[static_cast<Index>(k)]));
    }
  }
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_LT(worst[k], 2e-6 * largest[k]) << names[k];
  EXPECT_GT(eigen.values.real().maxCoeff(), 1.0)
      << "the circulation feeds a mode: symmetric matrices would not";
}
