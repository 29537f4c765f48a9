// A stability step: log decrement against speed and the onset speeds of instability, solved for directly.
#include <analysis/stability.hpp>
#include <app/frequency.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::app {

void run_stability_step(Job& job, const model::Step& step, const model::StabilityStep& law) {
  analysis::StabilityOptions o;
  const std::vector<double> speeds = speeds_of(law.speed);
  if (turns_with_stiffness(job.model)) return run_instability_bands(job, step, law);
  FrequencyStep s(job, step, "stability", "stability", std::max(std::abs(speeds.front()), std::abs(speeds.back())));
  o.speeds = speeds, o.modes = law.modes, o.all = true;
  const PhaseTimer timer(job, "stability");
  const analysis::StabilityResult r = analysis::find_instability(s.linear, o);

  io::Value& v = s.summary();
  v["stable at the first speed"] = r.stable_at_start;
  v["onsets"] = io::Value::array();
  io::Table table;
  table.title = "Onset of instability";
  table.columns = {{"speed", "rpm", ""}, {"whirl frequency", "Hz", ""}, {"frequency / speed", "-", ""}, {"kind", "-", ""}, {"direction", "-", ""},
                   {"above this speed", "-", ""}};
  std::vector<double> thresholds;
  for (const analysis::Onset& x : r.onsets) {
    table.add({to_rpm(x.speed), to_hz(x.frequency), x.ratio(), std::string(to_string(x.mode.kind)), direction_text(x.mode),
               x.gains ? "unstable" : "stable again"});
    io::Value e = io::Value::object();
    e["speed [rpm]"] = to_rpm(x.speed), e["whirl frequency [Hz]"] = to_hz(x.frequency), e["becomes unstable"] = x.gains;
    v["onsets"].push(std::move(e));
    thresholds.push_back(x.speed);
  }
  const std::vector<io::CampbellLine> lines = drawn_lines(r.diagram);
  std::vector<io::CampbellLine> shown;
  io::Table rates;
  rates.title = "Log decrement against speed";
  rates.columns.push_back({"speed", "rpm", ""});
  for (std::size_t l = 0; l < lines.size(); ++l) {
    rates.columns.push_back({lines[l].label + " log decrement", "-", ""});
    rates.columns.push_back({lines[l].label + " damping ratio", "-", ""});
    rates.columns.push_back({lines[l].label + " frequency", "Hz", ""});
  }
  for (std::size_t k = 0; k < r.diagram.speeds.size(); ++k) {
    std::vector<io::Table::Cell> row{to_rpm(r.diagram.speeds[k])};
    for (const analysis::CampbellLine& l : r.diagram.lines) {
      row.emplace_back(l.log_decrement[k]);
      row.emplace_back(l.damping_ratio[k]);
      row.emplace_back(to_hz(l.frequency[k]));
    }
    rates.add(std::move(row));
  }
  s.add_table("onset", std::move(table));
  s.add_table("log_decrement", std::move(rates), false);
  s.add_figure(io::plot_stability(s.file("log_decrement"), "Log decrement of the modes", lines, thresholds));
  s.add_figure(io::plot_campbell(s.file("frequencies"), "Frequencies of these modes", lines, std::vector<double>{1.0}, {}));
  for (std::size_t k = 0; k < r.onsets.size() && k < 3; ++k) {
    const analysis::Onset& x = r.onsets[k];
    s.linear.at(x.speed);
    add_shape_figures(s, {fmt::format("onset_{}", k + 1), fmt::format("Mode at the onset, {:.6g} rpm, {:.5g} Hz, {}", to_rpm(x.speed), to_hz(x.frequency), description(x.mode)), {},
                          &x.mode.x, x.mode.kind});
    write_shape_frames(s, fmt::format("onset_{}", k + 1), x.mode.x);
  }
  std::string line;
  if (!r.stable_at_start) line = fmt::format("unstable at {:.6g} rpm already", to_rpm(speeds.front()));
  else if (r.onsets.empty()) line = fmt::format("stable from {:.6g} to {:.6g} rpm", to_rpm(speeds.front()), to_rpm(speeds.back()));
  for (const analysis::Onset& x : r.onsets)
    if (x.gains) {
      line += fmt::format("{}instability above {:.8g} rpm, whirling at {:.5g} Hz", line.empty() ? "" : "; ", to_rpm(x.speed), to_hz(x.frequency));
      break;
    }
  if (law.map) line += add_stability_map(s, *law.map, o);
  s.section.text = line + ".";
  s.section.text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(s.section.text[0])));
  s.finish(line);
}

}  // namespace whirl::app
