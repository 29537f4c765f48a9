// `whirl study`: integrators against an exact solution, meshes, and its errors.
#include <core/plugin.hpp>
#include <core/types.hpp>
#include <gtest/gtest.h>
#include <io/results.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

class Study : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("whirl_study_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// Exit code; what it printed in text_.
  int study(const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && '" WHIRL_EXE "' study " +
                                arguments + " >out.txt 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    std::ifstream in(folder_ / "out.txt");
    text_.assign(std::istreambuf_iterator<char>(in), {});
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  fs::path folder_;
  std::string text_;
};

/// Example 09: r'' + 2 zeta w r' + w^2 r = e (phi'^2 - i phi'') exp(i phi), phi = alpha t^2/2, at
/// rest at 0, r = y + i z. Over an interval exp(lambda h) times what was there and the integral of
/// the load, by 12-point Gauss quadrature (0.4 rad of phase: exact to rounding). F. M. Lewis, J.
/// Appl. Mech. 54 (1932) APM-54-24, has the same integrals as error functions; his peak, 23.5842911
/// e, is checked below.
struct ConstantAcceleration {
  static constexpr double w = 100, zeta = 0.01, alpha = 20, e = 1e-4;
  static constexpr std::array<double, 6> x{.1252334085114689, .3678314989981802, .5873179542866175,
                                           .7699026741943047, .9041172563704749, .9815606342467193};
  static constexpr std::array<double, 6> g{.2491470458134028, .2334925365383548, .2031674267230659,
                                           .1600783285433462, .1069393259953184, .0471753363865118};
  Complex z = 0, zbar = 0;  // of lambda and its conjugate
  double t = 0;
  void advance(double h) {
    const Complex lambda(-zeta * w, w * std::sqrt(1 - zeta * zeta));
    const auto load = [](double s) {
      return e * Complex(alpha * alpha * s * s, -alpha) * std::polar(1.0, 0.5 * alpha * s * s);
    };
    Complex a = 0, b = 0;
    for (std::size_t k = 0; k < 12; ++k) {
      const double s = 0.5 * h * (1 + (k < 6 ? -x[k] : x[k - 6])), weight = 0.5 * h * g[k % 6];
      a += weight * std::exp(lambda * (h - s)) * load(t + s);
      b += weight * std::exp(std::conj(lambda) * (h - s)) * load(t + s);
    }
    z = std::exp(lambda * h) * z + a;
    zbar = std::exp(std::conj(lambda) * h) * zbar + b;
    t += h;
  }
  Complex r() const { return (z - zbar) / Complex(0, 2 * w * std::sqrt(1 - zeta * zeta)); }
};

const std::string example_09 = WHIRL_SOURCE "/examples/09_jeffcott_run_up/";

}  // namespace

TEST_F(Study, ExactSolutionOfTheExampleIsExact) {
  ConstantAcceleration s;
  double peak = 0;
  std::ostringstream csv;
  csv.precision(16);
  csv << "t [s],disk.y [m],disk.z [m]\n";
  const bool update = std::getenv("WHIRL_UPDATE_GOLDEN") != nullptr;
  io::Columns file;
  if (!update) file = io::read_csv(example_09 + "exact.csv");
  for (int row = 1; row <= 60; ++row) {
    for (int k = 0; k < 100; ++k) {
      s.advance(1e-3);
      peak = std::max(peak, std::abs(s.r()));
    }
    csv << 0.1 * row << ',' << s.r().real() << ',' << s.r().imag() << '\n';
    if (update) continue;
    ASSERT_GE(file.rows(), static_cast<std::size_t>(row));
    EXPECT_NEAR(file["disk.y"][static_cast<std::size_t>(row - 1)], s.r().real(), 1e-15)
        << row;  // 1e-12 of the peak: rounding of 6000 intervals
    EXPECT_NEAR(file["disk.z"][static_cast<std::size_t>(row - 1)], s.r().imag(), 1e-15) << row;
  }
  EXPECT_NEAR(peak / ConstantAcceleration::e, 23.5842911,
              3e-4);  // every millisecond: (1 - cos(w 0.5 ms)) of the beat's share at most
  if (update) std::ofstream(example_09 + "exact.csv") << csv.str();
}

TEST_F(Study, MeasuresIntegratorsAgainstTheExactSolution) {
  // 2 s of its 6 s, up to 0.4 of the critical speed
  std::ifstream in(example_09 + "exact.csv");
  std::string text;
  int rows = -1;
  for (std::string line; rows < 20 && std::getline(in, line); ++rows)
    text += line + '\n';
  write("exact.csv", text);
  ASSERT_EQ(study(example_09 + "deck.toml --exact exact.csv --set step.run_up.duration='2 s' -o r"),
            0)
      << text_;
  EXPECT_NE(text_.find("and the exact solution given, checked by"), std::string::npos) << text_;
  const io::Columns c = io::read_csv(folder_ / "r/study.csv");
  double smallest = 1;
  int checked = 0;
  for (const char* axis : {"y", "z"}) {
    const auto& error = c[std::string("error of disk.") + axis + " against the exact solution"];
    for (std::size_t k = 0; k < c.rows(); ++k) {
      smallest = std::min(smallest, error[k]);
      if (!(c["tolerance"][k] > 1e-9)) continue;
      ++checked;
      // the accuracy asked for is one of the largest displacement up to then; it is met within the
      // factor 2.5
      EXPECT_LT(error[k], 2.5 * c["tolerance"][k]) << k;
    }
  }
  EXPECT_GT(checked, 20);
  // on the front: no other setting is both faster and more accurate
  const auto &cpu = c["CPU"], &worst = c["largest error"];
  for (std::size_t k = 0; k < c.rows(); ++k) {
    bool beaten = std::isnan(worst[k]);
    for (std::size_t j = 0; j < c.rows(); ++j)
      beaten = beaten || (cpu[j] <= cpu[k] && worst[j] <= worst[k] &&
                          (cpu[j] < cpu[k] || worst[j] < worst[k]));
    EXPECT_EQ(c["Pareto"][k], beaten ? 0.0 : 1.0) << k;
  }
  EXPECT_LT(smallest, 3e-9);  // Gauss 6 at 1e-8; the exact table has 16 digits
}

TEST_F(Study, ExactSolutionMayBeHdf5) {
  if (!Plugin::available("hdf5")) GTEST_SKIP() << "built without HDF5";
  const io::Columns table = io::read_csv(example_09 + "exact.csv");
  const auto file = io::make_hdf5_series(folder_ / "exact.h5");
  const std::vector<io::Channel> channels{{"t", "s"}, {"disk.y", "m"}, {"disk.z", "m"}};
  file->begin(channels);
  for (std::size_t k = 0; k < 20; ++k)
    file->append(std::vector<double>{table["t"][k], table["disk.y"][k], table["disk.z"][k]});
  file->close();
  ASSERT_EQ(study(example_09 + "deck.toml --exact exact.h5 --set step.run_up.duration='2 s' -o r"),
            0)
      << text_;
  const io::Columns c = io::read_csv(folder_ / "r/study.csv");
  const auto& error = c["error of disk.y against the exact solution"];
  EXPECT_LT(*std::min_element(error.begin(), error.end()), 3e-9);
}

TEST_F(Study, MeshesOfStepsWithoutTime) {
  ASSERT_EQ(study(WHIRL_SOURCE "/examples/06_unbalance_response/deck.toml -o r"), 0) << text_;
  const io::Columns c = io::read_csv(folder_ / "r/study_mesh.csv");
  ASSERT_GE(c.rows(), 4u);
  EXPECT_EQ(c["mesh factor"], (std::vector<double>{1, 2, 4, 8}));
  const auto& speed = c["error of unbalance_peaks: speed"];
  EXPECT_LT(speed[0], 1e-6);  // 12 elements; below 1e-7 the search for the peaks is seen
  const auto& amplitude = c["error of shaker_response: disk 2 major"];
  EXPECT_GT(std::log2(amplitude[0] / amplitude[1]),
            3.0);  // the frequencies' order: 6 when slender, 3 at elements as short as thick
  EXPECT_LT(c["largest error"][2], 1e-4);
  EXPECT_TRUE(fs::exists(folder_ / "r/study.html"));
  EXPECT_TRUE(fs::exists(folder_ / "r/plots/study_mesh.svg"));
  EXPECT_FALSE(fs::exists(folder_ / "r/mesh_study"));  // runs of the study itself leave nothing
}

TEST_F(Study, SaysWhatIsWrong) {
  const auto expect = [&](const std::string& csv, const std::string& message) {
    write("exact.csv", csv);
    EXPECT_EQ(study(example_09 + "deck.toml --exact exact.csv -o r"), 3) << csv;
    EXPECT_NE(text_.find("E96"), std::string::npos) << text_;
    EXPECT_NE(text_.find(message), std::string::npos) << text_;
  };
  expect("t [s],hub.y [m]\n1,0\n", "column 'hub.y [m]' is no displacement of a probe");
  expect("t [s],disk.y [mm]\n1,0\n", "column 'disk.y [mm]' is no displacement of a probe");
  expect("disk.y [m]\n1\n", "a column \"t [s]\" and one of a displacement are needed");
  expect("t [s],disk.y [m]\n1,0\n1,0\n", "must increase");
  expect("t [s],disk.y [m]\n7,0\n", "0 < t <= 6 s");
  EXPECT_EQ(study(example_09 + "deck.toml --exact missing.csv -o r"), 3);
  EXPECT_NE(text_.find("no file"), std::string::npos) << text_;
  EXPECT_NE(study(WHIRL_SOURCE "/examples/30_static_sag/deck.toml --exact missing.csv -o r"), 0);
  EXPECT_NE(text_.find("E96"), std::string::npos) << text_;
}
