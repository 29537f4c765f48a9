// Examples that run bearings, foundations and couplings, against independent models of theirs.
#include "deck_run.hpp"
#include "reference_rotor.hpp"

#include <la/dense.hpp>
#include <core/types.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

using namespace whirl;
using test::Columns;
using test::DeckRun;
using test::ReferenceRotor;

namespace {

std::filesystem::path example(const char* name) {
  return std::filesystem::path(WHIRL_SOURCE) / "examples" / name / "deck.toml";
}

/// Frequency (Hz) and logarithmic decrement of the mode of a table nearest to f, the latter also
/// continued where the table has it.
std::array<double, 3> mode_near(const Columns& modes, double f) {
  std::array<double, 3> best{infinity, 0, whirl::nan};
  for (const auto& row : modes.rows) {
    const auto m = modes.named(row);
    if (std::abs(m.at("frequency [Hz]") - f) < std::abs(best[0] - f))
      best = {m.at("frequency [Hz]"), m.at("log decrement [-]"),
              m.contains("continued log decrement [-]") ? m.at("continued log decrement [-]")
                                                        : whirl::nan};
  }
  return best;
}

}  // namespace

// Limits of the motion once the start has died out, from an independent integration of the eight
// contact forces (DOP853, 1e-10).
TEST(ExampleNumbers, VaryingCompliance) {
  const DeckRun d(example("22_varying_compliance"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns run = d.csv("run.csv");
  const std::size_t t = run.column("t [s]"), y = run.column("inner ring.y [m]"),
                    z = run.column("inner ring.z [m]");
  double least[2] = {infinity, infinity}, most[2] = {-infinity, -infinity};
  for (const auto& row : run.rows)
    if (row[t] > 0.6)
      for (int k = 0; k < 2; ++k) {
        least[k] = std::min(least[k], row[k == 0 ? y : z]);
        most[k] = std::max(most[k], row[k == 0 ? y : z]);
      }
  // rows every 0.1 ms see a peak of a pass of 32 ms to 1e-4 of the swing of 1.4 um
  EXPECT_NEAR(-most[1], 9.71753874e-06, 1e-3 * 1.6e-7);
  EXPECT_NEAR(-least[1], 9.87555871e-06, 1e-3 * 1.6e-7);
  EXPECT_NEAR(least[0], -7.17400478e-07, 1e-3 * 1.4e-6);
  EXPECT_NEAR(most[0], 6.63437104e-07, 1e-3 * 1.4e-6);
}

// Rotor in a casing beam on a foundation: modes at 3,000 rpm with both planes, the foundation's
// coordinates and the gyroscopic coupling. The example's elements are good to some 1e-5, the
// bearings' 3e-5 of the weight's tilt to less.
TEST(ExampleNumbers, CasingOnFoundation) {
  const double Omega = 3000 * pi / 30;
  ReferenceRotor rotor, casing;
  const int de = rotor.tube(0.075, 0.08, 0, 6, true);
  rotor.tube(0.075, 0.08, 0, 6, true);
  const int impeller = rotor.tube(0.35, 0.11, 0, 16, true);
  rotor.tube(0.35, 0.11, 0, 16, true);
  const int nde = rotor.tube(0.075, 0.08, 0, 6, true);
  rotor.tube(0.075, 0.08, 0, 6, true);
  rotor.disk(impeller, 120, 4.5, 2.6);
  const int front = casing.tube(0.075, 0.42, 0.38, 4, false);
  const int front_foot = casing.tube(0.075, 0.42, 0.38, 4, false);
  const int rear_foot = casing.tube(0.7, 0.42, 0.39, 20, false);
  const int rear = casing.tube(0.075, 0.42, 0.38, 4, false);
  casing.tube(0.075, 0.42, 0.38, 4, false);
  // unknowns: rotor y, rotor z, casing y, casing z, foundation (front y, z, rear y, z, internal)
  const Index r = rotor.M.rows(), c = casing.M.rows(), n = 2 * r + 2 * c + 5;
  MatX M = MatX::Zero(n, n), C = M, K = M;
  for (Index p = 0; p < 2; ++p) {
    const Index a = p * r, b = 2 * r + p * c;
    M.block(a, a, r, r) = rotor.M;
    K.block(a, a, r, r) = rotor.K;
    M.block(b, b, c, c) = casing.M;
    K.block(b, b, c, c) = casing.K;
  }
  C.block(0, r, r, r) = Omega * rotor.G;
  C.block(r, 0, r, r) = -Omega * rotor.G;
  const auto spring = [&](Index i, Index j, double k, double damping) {
    for (const auto& [m, value] : {std::pair(&K, k), std::pair(&C, damping)}) {
      (*m)(i, i) += value;
      (*m)(j, j) += value;
      (*m)(i, j) -= value;
      (*m)(j, i) -= value;
    }
  };
  const Index table = 2 * r + 2 * c;
  for (Index p = 0; p < 2; ++p) {
    const auto at_rotor = [&](int node) { return p * r + 2 * node; };
    const auto at_casing = [&](int node) { return 2 * r + p * c + 2 * node; };
    spring(at_rotor(de), at_casing(front), 1.5e8, 6e4);
    spring(at_rotor(nde), at_casing(rear), 1.5e8, 6e4);
    spring(at_casing(front_foot), table + p, p == 0 ? 3e8 : 5e8, 2e4);
    spring(at_casing(rear_foot), table + 2 + p, p == 0 ? 3e8 : 5e8, 2e4);
    for (int foot : {front_foot, rear_foot})
      K(at_casing(foot) + 1, at_casing(foot) + 1) += 2e7;
    for (Index i : {table + p, table + 2 + p}) {
      K(i, i) += p == 0 ? 4e8 : 6e8;
      C(i, i) += p == 0 ? 8e4 : 9e4;
      M(i, i) += p == 0 ? 800 : 850;
    }
    K(table + p, table + 2 + p) = K(table + 2 + p, table + p) = p == 0 ? -1e8 : -1.5e8;
    M(table + p, table + 2 + p) = M(table + 2 + p, table + p) = p == 0 ? 120 : 140;
  }
  const Index mode = table + 4;
  K(mode, mode) = 2.2e7;
  C(mode, mode) = 4e3;
  M(mode, mode) = 400;
  M(mode, table + 1) = M(table + 1, mode) = 260;
  M(mode, table + 3) = M(table + 3, mode) = -260;
  const Eigen::VectorXcd exact =
      test::eigenvalues(M.cast<Complex>(), C.cast<Complex>(), K.cast<Complex>());

  const DeckRun d(example("25_casing_on_foundation"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns modes = d.csv("modes_modes.csv");
  for (const double f : {36.9, 78.4, 90.5, 118.8, 125.4}) {  // 105.1 Hz is axial
    const Complex l = test::nearest(exact, Complex(0, two_pi * f));
    const auto found = mode_near(modes, l.imag() / two_pi);
    EXPECT_NEAR(found[0], l.imag() / two_pi, 1e-4 * f);
    EXPECT_NEAR(found[1], -two_pi * l.real() / l.imag(), 1e-3 * found[1]) << f;
  }
}

// Films on pads in closed form, K(w) + i w C(w), at each mode's own frequency; the table between
// its rows of 10 Hz is good to 1e-4.
TEST(ExampleNumbers, PadDynamics) {
  const double Omega = 9000 * pi / 30, rpm = 9000, k1 = 6e7 + 6e3 * rpm, c1 = 8e4 - 2 * rpm,
               m2 = 60, k2 = 4e8, c2 = 1e4;
  ReferenceRotor rotor;
  const int de = rotor.tube(0.1, 0.11, 0, 4, true);
  rotor.tube(0.1, 0.11, 0, 4, true);
  const int middle = rotor.tube(0.45, 0.14, 0, 14, true);
  rotor.tube(0.45, 0.14, 0, 14, true);
  const int nde = rotor.tube(0.1, 0.11, 0, 4, true);
  rotor.tube(0.1, 0.11, 0, 4, true);
  rotor.disk(middle, 160, 4.8, 3.1);
  const DeckRun d(example("26_pad_dynamics"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns modes = d.csv("modes_modes.csv");
  // The pads as masses of their own.
  const Index n = rotor.M.rows();
  MatXc M = MatXc::Zero(n + 2, n + 2), C = M, K = M;
  M.topLeftCorner(n, n) = rotor.M.cast<Complex>();
  C.topLeftCorner(n, n) = -Complex(0, Omega) * rotor.G;
  K.topLeftCorner(n, n) = rotor.K.cast<Complex>();
  K(2 * middle, 2 * middle) -= Complex(0, 4e6);
  for (int k = 0; k < 2; ++k) {
    const Index at = 2 * (k == 0 ? de : nde), p = n + k;
    M(p, p) = m2;
    for (auto [matrix, inner, outer] : {std::tuple{&K, k1, k2}, std::tuple{&C, c1, c2}}) {
      (*matrix)(at, at) += inner;
      (*matrix)(p, p) += inner + outer;
      (*matrix)(at, p) -= inner;
      (*matrix)(p, at) -= inner;
    }
  }
  const VecXc truth = test::eigenvalues(M, C, K);
  for (const auto& [sign, guess] :
       {std::pair{-1.0, 89.2}, std::pair{1.0, 89.5}, std::pair{-1.0, 381.0},
        std::pair{1.0, 382.0}}) {  // backward, forward: y + i z turns with e^(i w t)
    const bool of_pads = guess > 300;
    Complex l(0, sign * two_pi * guess);
    for (int it = 0; it < 20; ++it) {
      const double w = std::abs(l.imag());
      const Complex film(k1, w * c1), pad(k2 - w * w * m2, w * c2),
          both = 1.0 / (1.0 / film + 1.0 / pad);
      MatXc Kw = rotor.K.cast<Complex>(), Cw = -Complex(0, Omega) * rotor.G;
      for (int at : {de, nde}) {
        Kw(2 * at, 2 * at) += both.real();
        Cw(2 * at, 2 * at) += both.imag() / w;
      }
      Kw(2 * middle, 2 * middle) -= Complex(0, 4e6);
      const Complex next = test::nearest(test::eigenvalues(rotor.M.cast<Complex>(), Cw, Kw), l);
      l += (of_pads ? 0.4 : 1.0) *
           (next - l);  // there 0.4 makes it converge: Im l falls faster than w rises
    }
    const double f = std::abs(l.imag()) / two_pi;
    const auto found = mode_near(modes, f);
    EXPECT_NEAR(found[0], f, 2e-4 * f) << sign;
    EXPECT_NEAR(found[1], -l.real() / f, 2e-3 * found[1]) << sign;
    // What the table at a real frequency makes of the decay: little for the rotor, half of it too
    // much for the pads; continued to first order a tenth remains.
    const Complex whole = test::nearest(truth, l);
    const double decrement = -two_pi * whole.real() / std::abs(whole.imag());
    EXPECT_NEAR(found[0], std::abs(whole.imag()) / two_pi, (of_pads ? 1e-2 : 5e-4) * f) << sign;
    EXPECT_NEAR(found[2], decrement, (of_pads ? 0.1 : 1e-3) * decrement) << sign;
  }
}

// What turns with the coupling is half the difference of its stiffnesses, D: the force D e^(2 i
// phi) conj(r) on a relative displacement r makes of a standing r0 (offset and sag) a motion at
// twice the spin, and of that a standing force again. Two harmonics are the whole solution of the
// linear rotor.
TEST(ExampleNumbers, MisalignedCoupling) {
  const double Omega = 1480 * pi / 30, g = 9.80665, mean = 5e6, D = 1e6;
  ReferenceRotor motor, pump(0.4);
  const int armature = motor.tube(0.125, 0.05, 0, 6, true, 1e-5);
  const int motor_de = motor.tube(0.125, 0.05, 0, 6, true, 1e-5);
  const int end = motor.tube(0.15, 0.05, 0, 6, true, 1e-5);
  const int pump_de = pump.tube(0.15, 0.045, 0, 6, true, 1e-5);
  const int impeller = pump.tube(0.15, 0.045, 0, 6, true, 1e-5);
  const int pump_end = pump.tube(0.15, 0.045, 0, 6, true, 1e-5);
  motor.disk(armature, 18, 0.09, 0.1);
  pump.disk(impeller, 9, 0.05, 0.03);
  const Index m = motor.M.rows(), p = pump.M.rows(), n = m + p;
  MatX M = MatX::Zero(n, n), C = M, K = M, G = M;
  M.topLeftCorner(m, m) = motor.M;
  C.topLeftCorner(m, m) = motor.C;
  K.topLeftCorner(m, m) = motor.K;
  G.topLeftCorner(m, m) = motor.G;
  M.bottomRightCorner(p, p) = pump.M;
  C.bottomRightCorner(p, p) = pump.C;
  K.bottomRightCorner(p, p) = pump.K;
  G.bottomRightCorner(p, p) = pump.G;
  VecX weight = VecX::Zero(n);
  for (Index i = 0; i < n; i += 2)
    weight[i] = 1;
  weight = M * weight * g;
  for (int at : {0, motor_de}) {
    K(2 * at, 2 * at) += 6e7;
    C(2 * at, 2 * at) += 3e3;
  }
  for (Index at : {m + 2 * pump_de, m + 2 * pump_end}) {
    K(at, at) += 5e7;
    C(at, at) += 3e3;
  }
  VecX b = VecX::Zero(n), tilt = b;
  b[2 * end] = 1;
  b[m] = -1;
  tilt[2 * end + 1] = 1;
  tilt[m + 1] = -1;
  K += mean * b * b.transpose() + 4e3 * tilt * tilt.transpose();
  const double w = 2 * Omega;
  const la::DenseLu<Complex> still(MatXc(K.cast<Complex>())),
      turning(MatXc((K - w * w * M).cast<Complex>() + Complex(0, w) * C + w * Omega * G));
  Complex r0 = -2e-4, r2 = 0;
  VecXc x2;
  for (int it = 0; it < 60; ++it) {
    const VecXc x0 =
        still.solve(VecXc(-Complex(0, 1) * weight + b * (mean * 2e-4 - D * std::conj(r2))));
    r0 = b.cast<Complex>().dot(x0) - 2e-4;
    x2 = turning.solve(VecXc(-b * (D * std::conj(r0))));
    r2 = b.cast<Complex>().dot(x2);
  }
  const DeckRun d(example("27_misaligned_coupling"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns run = d.csv("run.csv");
  const std::size_t t = run.column("t [s]");
  const auto line = [&](const char* probe,
                        double frequency) {  // over 18 turns, by a Hann window: the rows of 0.5 ms
                                             // do not end with a turn
    const double from = 1.5 - 18 * two_pi / Omega;
    const std::size_t y = run.column(std::string(probe) + ".y [m]"),
                      z = run.column(std::string(probe) + ".z [m]");
    Complex sum = 0;
    double weights = 0;
    for (const auto& row : run.rows)
      if (row[t] >= from && row[t] <= 1.5) {
        const double weight = 1 - std::cos(two_pi * (row[t] - from) / (1.5 - from));
        sum += weight * Complex(row[y], row[z]) * std::exp(Complex(0, -frequency * row[t]));
        weights += weight;
      }
    return std::abs(sum) / weights;
  };
  // the twist of the shafts follows the torque of the misaligned forces: 1e-4 rad of the phase
  EXPECT_NEAR(line("motor DE", w), std::abs(x2[2 * motor_de]), 1e-4 * std::abs(x2[2 * motor_de]));
  EXPECT_NEAR(line("pump DE", w), std::abs(x2[m + 2 * pump_de]),
              1e-4 * std::abs(x2[m + 2 * pump_de]));
  EXPECT_LT(line("motor DE", Omega), 1e-4 * line("motor DE", w));  // nothing is out of balance
}

// The speed of this example is held at its end, where one row is the fastest by rounding alone.
TEST(ExampleNumbers, AListOfPeaksDoesNotHangOnRounding) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("whirl_peaks_" + std::to_string(::getpid()));
  std::vector<std::vector<std::string>> lists;
  for (const char* isa : {"baseline", "avx2", "avx512"}) {
    const fs::path results = folder / isa;
    fs::create_directories(results);
    const std::string command = "cd '" + folder.string() + "' && WHIRL_ISA=" + isa +
                                " '" WHIRL_EXE "' run '" WHIRL_SOURCE
                                "/examples/03_rotating_shaft_benchmark/deck.toml' -q -o '" +
                                results.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    lists.emplace_back();
    for (const auto& f : fs::directory_iterator(results)) {
      if (!f.path().filename().string().ends_with("_response_peaks.csv")) continue;
      std::ifstream in(f.path());
      for (std::string line; std::getline(in, line);) {  // probe, direction, rising or falling
        std::size_t end = 0;
        for (int k = 0; k < 3; ++k)
          end = line.find(',', end + 1);
        lists.back().push_back(line.substr(0, end));
      }
    }
  }
  std::error_code ec;
  fs::remove_all(folder, ec);
  ASSERT_GT(lists[0].size(), 3u);
  EXPECT_EQ(lists[0], lists[1]);
  EXPECT_EQ(lists[0], lists[2]);
}

// The table of this example ends at the first and the last speed of its steps: forces there are
// those of a table that may be extrapolated, not NaN for the last bit of a speed.
TEST(ExampleNumbers, ATableReachesToItsEnds) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("whirl_table_ends_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  fs::copy(example("26_pad_dynamics").parent_path(), folder,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  std::ostringstream text;
  text << std::ifstream(folder / "deck.toml").rdbuf();
  std::string deck = text.str();
  const std::string held = "extrapolate = \"hold\"\n";
  ASSERT_NE(deck.find(held), std::string::npos);
  // rows at the peaks stand at speeds that agree to 1e-9, where phases do not to 1e-6
  const std::string refined = ", refine = \"peaks\"";
  deck.replace(deck.find(refined), refined.size(), ", refine = \"no\"");
  std::ofstream(folder / "deck.toml") << deck;
  deck.erase(deck.find(held), held.size());
  std::ofstream(folder / "one.toml") << deck;
  const auto response = [](const fs::path& deck_file) {
    const DeckRun r(deck_file);
    EXPECT_EQ(r.exit, 0) << r.log;
    EXPECT_FALSE(r.says("not finite")) << r.log;
    return r.csv("unbalance_response.csv");
  };
  const Columns a = response(folder / "deck.toml"), b = response(folder / "one.toml");
  std::error_code ec;
  fs::remove_all(folder, ec);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t r = 0; r < a.rows.size(); ++r)
    for (std::size_t c = 0; c < a.names.size(); ++c)
      EXPECT_NEAR(b.rows[r][c], a.rows[r][c], 1e-6 * std::abs(a.rows[r][c]) + 1e-12)
          << a.names[c] << " in row " << r;
}
