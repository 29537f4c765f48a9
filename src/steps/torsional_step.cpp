// A torsional step: natural frequencies in torsion, their shapes, and the speeds at which orders of
// the speed meet them.
#include <analysis/spectra/critical.hpp>
#include <model/resolution.hpp>
#include <results/frequency.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

std::vector<analysis::WhirlMode> solve(results::FrequencyStep& s, const model::TorsionalStep& law) {
  analysis::ModesOptions o;
  o.count = law.modes;
  o.motion = analysis::Motion::torsional;
  analysis::SpectrumCertificate certificate;
  std::vector<analysis::WhirlMode> modes =
      analysis::whirl_modes(s.linear, law.max_speed, o, &certificate);
  s.certify(certificate);
  return modes;
}

/// Tables and shapes of the modes; their lines in the interference diagram.
std::vector<plot::CampbellLine> add_modes(results::FrequencyStep& s,
                                          const std::vector<analysis::WhirlMode>& modes,
                                          double max_speed) {
  io::Table table;
  table.title = "Torsional natural frequencies";
  table.columns = {{"mode", "-", ""},
                   {"frequency", "Hz", ""},
                   {"frequency", "rpm", ""},
                   {"log decrement", "-", ""},
                   {"damping ratio", "-", ""}};
  std::vector<plot::CampbellLine> lines;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const analysis::WhirlMode& m = modes[k];
    const double decrement = results::tidy(m.log_decrement);
    table.add({static_cast<int>(k + 1), to_hz(m.frequency), to_rpm(m.frequency), decrement,
               results::tidy(m.damping_ratio)});
    s.summary()["frequencies [Hz]"].push(to_hz(m.frequency));
    plot::CampbellLine l;
    l.label = fmt::format("T{}", k + 1);
    l.speed = {0, max_speed};
    l.frequency = {m.frequency, m.frequency};
    l.log_decrement = {decrement, decrement};
    lines.push_back(std::move(l));
    const std::string name = fmt::format("mode_{}", k + 1);
    results::add_shape_figures(
        s, {name,
            fmt::format("Torsional mode {}: {:.5g} Hz", k + 1, to_hz(m.frequency)),
            {},
            &m.x,
            analysis::ModeKind::torsional});
    results::write_shape_frames(s, name, m.x);
  }
  results::MeshAccuracy mesh(s);
  mesh.look_at(modes, max_speed);
  mesh.report();
  s.add_table("torsional", std::move(table));
  return lines;
}

std::vector<plot::CriticalMark> add_criticals(results::FrequencyStep& s,
                                              const std::vector<analysis::WhirlMode>& modes,
                                              const model::TorsionalStep& law) {
  io::Table table;
  table.title = "Torsional critical speeds";
  table.columns = {
      {"order", "-", "excitations a revolution"}, {"speed", "rpm", ""}, {"frequency", "Hz", ""}};
  double highest = 0;  // of the undamped frequencies of the modes listed
  for (const analysis::WhirlMode& m : modes)
    highest = std::max(highest, analysis::undamped_reach(m.frequency, m.damping_ratio));
  std::vector<plot::CriticalMark> marks;
  for (const double order : law.orders) {
    if (modes.empty()) break;
    analysis::CriticalOptions q;
    q.order = order;
    q.max_speed = law.max_speed;
    q.motion = analysis::Motion::torsional;
    q.max_frequency = highest;
    for (const analysis::Critical& c : analysis::critical_speeds(s.linear, q)) {
      table.add({order, to_rpm(c.speed), to_hz(c.frequency)});
      s.summary()["critical speeds [rpm]"][fmt::format("{:g}x", order)].push(to_rpm(c.speed));
      marks.push_back({c.speed, c.frequency, order, {}});
    }
  }
  s.add_table("critical_speeds", std::move(table));
  return marks;
}

}  // namespace

void run_torsional_step(run::Job& job, const model::Step& step, const model::TorsionalStep& asked) {
  model::TorsionalStep law = asked;
  law.orders = model::orders_of(job.model, asked.orders);
  results::FrequencyStep s(job, step, "torsional", "torsional vibration", law.max_speed);
  const run::PhaseTimer timer(job, "modes");
  const std::vector<analysis::WhirlMode> modes = solve(s, law);
  const std::vector<plot::CampbellLine> lines = add_modes(s, modes, law.max_speed);
  const std::vector<plot::CriticalMark> marks = add_criticals(s, modes, law);
  if (!lines.empty())
    s.add_figure(plot::plot_campbell(s.file("interference"), "Torsional interference diagram",
                                     lines, law.orders, marks));
  s.section.text = modes.empty()
                       ? "The model has no torsional mode: no inertia twists against another."
                       : fmt::format("{} torsional modes.", modes.size());
  const auto unstable = std::count_if(modes.begin(), modes.end(),
                                      [](const analysis::WhirlMode& m) { return m.growth() > 0; });
  if (unstable > 0) {
    s.summary()["unstable modes"] = static_cast<int>(unstable);
    s.section.text += fmt::format(" {} of them unstable.", unstable);
  }
  s.finish(fmt::format("{} torsional modes{}, {} critical speeds", modes.size(),
                       unstable > 0 ? fmt::format(" ({} unstable)", unstable) : "", marks.size()));
}

}  // namespace whirl::steps
