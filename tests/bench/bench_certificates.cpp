// What the certificate of a spectrum costs: Campbell diagrams with and without the count of their
// roots, CPU seconds of one core, the least of several runs in turn. Prints a Markdown table:
//   build/bin/bench_certificates .
#include <analysis/spectra/campbell.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

using namespace whirl;

namespace {

double cpu_seconds() {
  std::timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A shaft of steel with a disk at its middle, in two bearings.
std::string rotor(int elements, const std::string& bearing) {
  std::string text = fmt::format(R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["left", 500, 20, {0}], ["right", 500, 20, {0}]]
[[disk]]
at = "left:end"
mass = "3 kg"
Ip = "0.015 kg.m^2"
Id = "0.0075 kg.m^2"
)",
                                 elements / 2);
  for (const char* at : {"left:start", "right:end"})
    text += fmt::format("[[bearing]]\nat = \"{}\"\n{}", at, bearing);
  return text + "[[bearing]]\nat = \"left:start\"\ntype = \"linear\"\nkxx = \"1e6 N/m\"\n";
}

const std::string linear_bearing = R"(type = "linear"
kyy = "1e6 N/m"
kzz = "8e5 N/m"
cyy = "50 N.s/m"
czz = "50 N.s/m"
)";

/// Tables against frequency, which stiffen.
const std::string frequency_table = R"(type = "table"
extrapolate = "hold"
columns = ["speed[rpm]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[0, 0, 1e6, 8e5, 80, 80], [0, 200, 1.1e6, 9e5, 60, 60], [0, 600, 1.3e6, 1.1e6, 50, 50],
  [9000, 0, 1e6, 8e5, 80, 80], [9000, 200, 1.1e6, 9e5, 60, 60], [9000, 600, 1.3e6, 1.1e6, 50, 50]]
)";

double run(const model::Model& m, Index modes, bool certify) {
  const meshes::Mesh mesh = meshes::make_mesh(m);
  const assembly::Built built = assembly::build_system(m, mesh);
  analysis::SteadyRotation running;
  for (const auto& s : m.shafts)
    running.ratio.push_back(s.rotating ? s.speed_ratio : 0.0);
  running.table_frequencies = built.table_frequencies;
  running.axially_free = built.axially_free;
  analysis::Linearizer linear(built.system, running);
  analysis::CampbellOptions o;
  for (int k = 0; k < 30; ++k)
    o.speeds.push_back(9000 * pi / 30 * k / 29);
  o.track.modes.count = modes;
  o.track.modes.motion = analysis::Motion::lateral;
  o.track.modes.certify = certify;
  const double start = cpu_seconds();
  const analysis::Campbell c = analysis::campbell(linear, o);
  const double seconds = cpu_seconds() - start;
  if (certify)
    for (const auto& known : c.certificates)
      if (!known.complete()) std::printf("<!-- %s -->\n", known.text().c_str());
  return seconds;
}

void row(const char* what, const std::string& text, Index modes) {
  const deck::Deck d = deck::read_deck_text(text, "deck.toml");
  if (!d.ok()) {
    std::printf("%s\n", d.report().c_str());
    return;
  }
  double with = infinity, without = infinity;
  for (int k = 0; k < 5; ++k) {
    without = std::min(without, run(d.model, modes, false));
    with = std::min(with, run(d.model, modes, true));
  }
  std::printf("| %s | %d | %.4f | %.4f | %.0f %% |\n", what, static_cast<int>(modes), without, with,
              100 * (with / without - 1));
}

}  // namespace

int main() {
  std::printf(
      "Campbell diagrams of 30 speeds.\n\n| rotor | modes | s without | s with certificate | more "
      "|\n|---|---|---|---|---|\n");
  row("100 elements, linear bearings", rotor(100, linear_bearing), 6);
  row("100 elements, linear bearings", rotor(100, linear_bearing), 12);
  row("400 elements, linear bearings", rotor(400, linear_bearing), 12);
  row("20 elements, tables against frequency", rotor(20, frequency_table), 6);
  return 0;
}
