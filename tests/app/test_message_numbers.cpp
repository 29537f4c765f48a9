// Numbers that warnings say and the summary keeps, from closed forms: of 10 kg on a spring of 1e6 N/m
// with 600 N s/m.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>

#include <cmath>
#include <functional>
#include <regex>

namespace {

using namespace whirl;
using test::DeckRun;

constexpr double m = 10, k = 1e6, c = 600, weight = 9.81 * m;
const double w_n = std::sqrt(k / m), zeta = c / (2 * std::sqrt(k * m)),
             w_d = w_n * std::sqrt(1 - zeta * zeta);

const char* const spring = R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)";

std::string stop(const std::string& gap) {
  return "[[bearing]]\nname = \"stop\"\nat = \"mass\"\ntype = \"rub\"\ngap = \"" + gap +
         "\"\nstiffness = \"5e6 N/m\"\n";
}

DeckRun run_of(const std::string& rest, const std::string& gravity = "0 m/s^2") {
  return DeckRun(test::lateral_mass(m, gravity, spring + rest));
}

/// Of the warning with this code, in their order; names between quotes are left out.
std::vector<double> numbers_said(const DeckRun& run, const std::string& code) {
  std::string text;
  const io::Value all = run.summary();
  for (const io::Value& w : all.at("warnings").items())
    if (w.text().starts_with(code + ": ")) text = w.text().substr(code.size() + 2);
  text = std::regex_replace(text, std::regex("'[^']*'"), "");
  std::vector<double> out;
  const std::regex number("[-+]?[0-9]+\\.?[0-9]*(e[-+]?[0-9]+)?");
  for (std::sregex_iterator i(text.begin(), text.end(), number), end; i != end; ++i)
    out.push_back(std::stod(i->str()));
  return out;
}

/// To as many digits as are written.
void expect_said(const DeckRun& run, const std::string& code, const std::vector<double>& wanted,
                 double relative = 2e-3) {
  const std::vector<double> said = numbers_said(run, code);
  ASSERT_EQ(said.size(), wanted.size()) << run.log;
  for (std::size_t i = 0; i < said.size(); ++i)
    EXPECT_NEAR(said[i], wanted[i], relative * std::abs(wanted[i]))
        << code << ", number " << i << "\n"
        << run.log;
}

/// y of 1 kN that begins at 0.
double step_response(double t) {
  return 1000 / k *
         (1 -
          std::exp(-zeta * w_n * t) * (std::cos(w_d * t) + zeta * w_n / w_d * std::sin(w_d * t)));
}

double root_of(const std::function<double(double)>& f, double a, double b) {
  for (int i = 0; i < 200; ++i)
    (f((a + b) / 2) > 0 ? b : a) = (a + b) / 2;
  return (a + b) / 2;
}

}  // namespace

// m_u w^2/|k - m w^2 + i c w| of 1 kg mm at 3000 rpm, the faster of two speeds.
TEST(MessageNumbers, OfAResponseBeyondAGap) {
  const DeckRun run = run_of(stop("200 um") + R"([[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["2000 rpm", "3000 rpm"], refine = "no" }
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const double w = 100 * pi, a = 1e-3 * w * w / std::hypot(k - m * w * w, c * w);
  expect_said(run, "W11", {3000, 1e3 * a, 0.2, a / 0.2e-3});
}

TEST(MessageNumbers, OfALinearMotionBeyondAGap) {
  const DeckRun run = run_of(stop("1.2 mm") + R"([[load]]
at = "mass"
force = ["0 N", "1 kN", "0 N"]
[[step]]
name = "t"
type = "transient"
linear = true
start = "rest"
duration = "15 ms"
[step.integrator]
tolerance = 1e-7
dt_max = "0.02 ms"
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const double top = pi / w_d, largest = step_response(top),
               begin = root_of([](double t) { return step_response(t) - 1.2e-3; }, 0, top);
  expect_said(run, "W11", {top, 1e3 * largest, 1.2, largest / 1.2e-3, begin}, 5e-3);
  const io::Value gap = run.summary("t").at("gaps").at("stop");
  EXPECT_NEAR(gap.at("gap [m]").number(), 1.2e-3, 1e-15);
  EXPECT_NEAR(gap.at("largest displacement [m]").number(), largest, 1e-4 * largest);
  EXPECT_NEAR(gap.at("at [s]").number(), top, 2e-3 * top);
  const double from =
      gap.at("beyond from [s]").number();  // the end of a step of dt_max, or of the next
  EXPECT_GE(from, begin - 1e-6);
  EXPECT_LE(from, begin + 0.04e-3);
}

namespace {

const char* const table = R"([[bearing]]
name = "seal"
at = "mass"
type = "table"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]"]
rows = [[1000, 1e5, 1e5], [2000, 1e5, 1e5]]
extrapolate = "hold"
)";

}  // namespace

TEST(MessageNumbers, OfSpeedsBeyondATable) {
  const DeckRun run = run_of(std::string(table) + R"([[unbalance]]
at = "mass"
amount = "1 g.mm"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["500 rpm", "1500 rpm", "2600 rpm"], refine = "no" }
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  expect_said(run, "W12", {1000, 2000, 500, 2600});
}

// 1500 to 2500 rpm in 0.2 s: beyond the table from half of it on.
TEST(MessageNumbers, OfARunUpBeyondATable) {
  const DeckRun run = run_of(std::string(table) + R"([[drive]]
at = "rotor/0 mm"
type = "speed"
speed = { type = "ramp", time = ["0 s", "0.2 s"], value = ["1500 rpm", "2500 rpm"] }
[[step]]
name = "t"
type = "transient"
duration = "0.2 s"
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const io::Value held = run.summary("t").at("held tables").at("seal");
  EXPECT_NEAR(held.at("table from [rpm]").number(), 1000, 1e-9);
  EXPECT_NEAR(held.at("table to [rpm]").number(), 2000, 1e-9);
  EXPECT_NEAR(held.at("slowest [rpm]").number(), 1500, 1e-6);
  EXPECT_NEAR(held.at("fastest [rpm]").number(), 2500, 1e-6);
  const double from = held.at("from [s]").number();
  EXPECT_NEAR(from, 0.1, 1e-9);  // whatever the steps are
  expect_said(run, "W12", {from, 1000, 2000, 1500, 2500});
}

// The spring alone would sag by 98.1 um; past 50 um the stop helps with 5e6 N/m.
TEST(MessageNumbers, OfAClosedContact) {
  const DeckRun run =
      run_of(stop("50 um") + "[[step]]\nname = \"st\"\ntype = \"static\"\n", "9.81 m/s^2");
  ASSERT_EQ(run.exit, 0) << run.log;
  const double sag = (weight + 5e6 * 50e-6) / (k + 5e6);
  expect_said(run, "W04", {0, 1e3 * sag, 0.05, 5e6 * (sag - 50e-6)}, 2e-3);
}
