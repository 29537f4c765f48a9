// Every example as the program prunes it against the general model of --keep-everything: all
// numbers it writes, to the accuracy asked for. Transients run for at most `longest` seconds of
// their time.
#include <run/options.hpp>
#include <steps/run_deck.hpp>
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <io/value.hpp>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

constexpr double longest = 2.5;  // s
/// Of rotors whose films whirl: nothing holds the phase of a self-excited motion, so that the
/// difference of two runs grows with it.
constexpr double still = 0.05;  // s

std::vector<std::string> examples() {
  std::vector<std::string> out;
  for (const auto& e : fs::directory_iterator(fs::path(WHIRL_SOURCE) / "examples"))
    if (fs::exists(e.path() / "deck.toml")) out.push_back(e.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

struct Csv {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  // whirl::NaN: not a number in the file
};

Csv read_csv(const fs::path& p) {
  std::ifstream in(p);
  Csv out;
  std::string line;
  const auto split = [](const std::string& text) {
    std::vector<std::string> cells;
    std::istringstream s(text);
    for (std::string c; std::getline(s, c, ',');)
      cells.push_back(c);
    return cells;
  };
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    const auto cells = split(line);
    if (out.columns.empty()) {
      out.columns = cells;
      continue;
    }
    std::vector<double> row;
    for (const std::string& c : cells) {
      double x = whirl::nan;
      if (const auto [end, ec] = std::from_chars(c.data(), c.data() + c.size(), x);
          ec != std::errc() || end != c.data() + c.size())
        x = whirl::nan;
      row.push_back(x);
    }
    row.resize(out.columns.size(), whirl::nan);
    out.rows.push_back(std::move(row));
  }
  return out;
}

/// Components of one thing share a scale: "disk.y [m]" and "disk.z [m]" -> "disk"; so do the lines
/// of a spectrum: "-139.5 Hz [m]" -> "Hz".
std::string group(const std::string& column) {
  if (column.ends_with(" Hz [m]")) return "Hz";
  return column.substr(0, column.find_last_of('.', column.find('[')));
}

class KeepEverything : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("whirl_keep_" + std::to_string(::getpid()) + "_" + GetParam());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_P(KeepEverything, GivesTheSame) {
  const fs::path deck = fs::path(WHIRL_SOURCE) / "examples" / GetParam() / "deck.toml";
  const bool whirls = GetParam() == "37_turbocharger_floating_rings";
  double tolerance = 0.0;
  std::size_t pruned_kernels = 0;
  for (const bool all : {false, true}) {
    model::Model m = deck::load_model(deck, {});
    m.keep_everything = all;
    m.output.report = false;
    m.output.binary = false;
    m.output.csv = true;
    m.output.vtk.clear();
    for (model::Step& s : m.steps) {
      // what is left out is the same at all speeds
      if (auto* t = std::get_if<model::StabilityStep>(&s.law); t && t->speed.values.empty()) {
        t->speed.stop = t->speed.start + (t->speed.stop - t->speed.start) / 4.0;
        t->speed.points = std::max(3, t->speed.points / 4);
      }
      if (auto* t = std::get_if<model::TransientStep>(&s.law)) {
        t->duration = std::min(t->duration, whirls ? still : longest);
        t->checkpoint = 0;
        m.output.every = std::max(m.output.every, t->duration / 500.0);  // equal rows in both runs
        tolerance = std::max(tolerance, t->integrator.tolerance);
      }
    }
    run::RunOptions o;
    o.quiet = true;
    o.variant = [&](const std::string& setting) {
      deck::ReadOptions read;
      read.set.push_back(setting);
      model::Model other = deck::load_model(deck, read);
      other.keep_everything = all;
      return other;
    };
    o.build = [&](const std::vector<std::string>& settings) {
      deck::ReadOptions read;
      read.set = settings;
      return deck::load_model(deck, read);
    };
    o.output = folder_ / (all ? "all" : "pruned");
    ASSERT_EQ(steps::run_deck(m, o), 0);
  }
  // Each run aims at `tolerance` of the largest value; aim and hit differ by a factor of up to 2.5,
  // and there are two of them. Without a transient the two solve the same equations by iterations
  // converged to 1e-9 or better.
  const double allowed = tolerance > 0.0 ? 5.0 * tolerance : 1e-7;
  int files = 0;
  for (const auto& e : fs::directory_iterator(folder_ / "pruned")) {
    if (e.path().extension() != ".csv") continue;
    ++files;
    Csv a = read_csv(e.path()), b = read_csv(folder_ / "all" / e.path().filename());
    ASSERT_EQ(a.columns, b.columns) << e.path().filename();
    ASSERT_EQ(a.rows.size(), b.rows.size()) << e.path().filename();
    if (e.path().stem().string().ends_with("_energy")) {  // shares of the parts of each mode: parts
                                                          // are listed by kind, and kinds differ
      const auto by_share = [](const auto& x, const auto& y) {
        return std::pair(x.front(), x.back()) < std::pair(y.front(), y.back());
      };
      std::sort(a.rows.begin(), a.rows.end(), by_share);
      std::sort(b.rows.begin(), b.rows.end(), by_share);
    }
    double largest = 0.0;  // m, of all amplitudes in the file
    for (std::size_t c = 0; c < a.columns.size(); ++c)
      if (a.columns[c].ends_with("[m]"))
        for (const auto& row : a.rows)
          if (std::isfinite(row[c])) largest = std::max(largest, std::abs(row[c]));
    std::map<std::string, double> scale;
    for (std::size_t c = 0; c < a.columns.size(); ++c)
      for (const auto& row : a.rows)
        if (std::isfinite(row[c]))
          scale[group(a.columns[c])] = std::max(scale[group(a.columns[c])], std::abs(row[c]));
    for (std::size_t c = 0; c < a.columns.size(); ++c) {
      // the instant of a peak is known to the square root of the peak's own accuracy
      const bool instant = e.path().stem().string().ends_with("_peaks") &&
                           a.columns[c].find("amplitude") == std::string::npos;
      // a phase has a meaning where its amplitude is above the rounding of the motion
      auto amplitude = a.columns.end();
      if (const std::size_t at = a.columns[c].find(" lag [deg]"); at != std::string::npos)
        for (std::string name :
             {a.columns[c].substr(0, at) + " [m]",
              a.columns[c].substr(0, at == 0 ? 0 : a.columns[c].rfind(' ', at - 1)) +
                  " amplitude [m]"})
          if (amplitude == a.columns.end())
            amplitude = std::find(a.columns.begin(), a.columns.end(), name);
      double worst = 0.0;
      for (std::size_t r = 0; r < a.rows.size(); ++r) {
        if (!std::isfinite(a.rows[r][c]) && !std::isfinite(b.rows[r][c])) continue;
        if (amplitude != a.columns.end() &&
            a.rows[r][static_cast<std::size_t>(amplitude - a.columns.begin())] < 1e-8 * largest)
          continue;
        ASSERT_EQ(std::isfinite(a.rows[r][c]), std::isfinite(b.rows[r][c]))
            << e.path().filename() << " " << a.columns[c];
        double off = std::abs(a.rows[r][c] - b.rows[r][c]);
        // a phase is known to the accuracy of the motion over its own amplitude: their product, a
        // displacement, is what is compared
        if (amplitude != a.columns.end())
          off = std::abs(std::remainder(off, 360.0)) * pi / 180.0 *
                a.rows[r][static_cast<std::size_t>(amplitude - a.columns.begin())];
        worst = std::max(worst, off);
      }
      // The torque of a prescribed speed is an acceleration: at the default accuracy it is known to
      // 2.3e-3 of its largest value in either run (against a tolerance of 1e-9), where displacements
      // are to 2e-6.
      const bool reaction = a.columns[c].ends_with("torque [N.m]");
      // where nothing but rounding moves, there is nothing to compare: a millionth of the motion
      const double own = std::max(scale[group(a.columns[c])],
                                  a.columns[c].ends_with("[m]") ? 1e-6 * largest : 0.0);
      const double size = amplitude != a.columns.end() ? largest : own;
      // a half cycle at the edge of a class is in this one or the next
      const double counted = a.columns[c].starts_with("cycles") ? 0.5 : 0.0;
      EXPECT_LE(worst, counted + (instant    ? std::sqrt(allowed)
                                  : reaction ? std::max(allowed, 5e-3)
                                             : allowed) *
                                     size)
          << e.path().filename() << " " << a.columns[c];
    }
  }
  EXPECT_GT(files, 0);
  // elements along a path are general ones, with nothing to leave out
  const auto shafts = deck::load_model(deck, {}).shafts;
  if (std::all_of(shafts.begin(), shafts.end(),
                  [](const model::Shaft& s) { return !s.path.empty(); }))
    return;
  // the summary names what was left out, and the general model leaves out none of it
  for (const bool all : {false, true}) {
    std::ifstream in(folder_ / (all ? "all" : "pruned") / "summary.json");
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const std::size_t from = text.find("\"left out\": ["), to = text.find(']', from);
    ASSERT_NE(from, std::string::npos);
    const std::size_t entries = static_cast<std::size_t>(std::count(
        text.begin() + static_cast<long>(from), text.begin() + static_cast<long>(to), '\n'));
    if (!all) pruned_kernels = entries;
    if (all) {
      EXPECT_LT(entries, pruned_kernels)
          << "nothing was pruned, or --keep-everything keeps nothing";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, KeepEverything, testing::ValuesIn(examples()),
                         [](const auto& x) { return x.param; });

}  // namespace
