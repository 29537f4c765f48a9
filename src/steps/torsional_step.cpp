// A torsional step: natural frequencies in torsion, their shapes, and the speeds at which orders of
// the speed meet them.
#include <analysis/spectra/critical.hpp>
#include <results/frequency.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

void run_torsional_step(run::Job& job, const model::Step& step, const model::TorsionalStep& law) {
  results::FrequencyStep s(job, step, "torsional", "torsional vibration", law.max_speed);
  const run::PhaseTimer timer(job, "modes");
  analysis::ModesOptions o;
  o.count = law.modes;
  o.motion = analysis::Motion::torsional;
  analysis::SpectrumCertificate certificate;
  const std::vector<analysis::WhirlMode> modes =
      analysis::whirl_modes(s.linear, law.max_speed, o, &certificate);
  s.certify(certificate);
  io::Table table;
  table.title = "Torsional natural frequencies";
  table.columns = {{"mode", "-", ""},
                   {"frequency", "Hz", ""},
                   {"frequency", "rpm", ""},
                   {"log decrement", "-", ""},
                   {"damping ratio", "-", ""}};
  io::Value& v = s.summary();
  std::vector<plot::CampbellLine> lines;
  double highest = 0;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const analysis::WhirlMode& m = modes[k];
    table.add({static_cast<int>(k + 1), results::to_hz(m.frequency), results::to_rpm(m.frequency),
               results::tidy(m.log_decrement), results::tidy(m.damping_ratio)});
    v["frequencies [Hz]"].push(results::to_hz(m.frequency));
    highest = std::max(highest, m.frequency);
    plot::CampbellLine l;
    l.label = fmt::format("T{}", k + 1);
    l.speed = {0, law.max_speed};
    l.frequency = {m.frequency, m.frequency};
    l.log_decrement = {results::tidy(m.log_decrement), results::tidy(m.log_decrement)};
    lines.push_back(std::move(l));
    results::add_shape_figures(
        s, {fmt::format("mode_{}", k + 1),
            fmt::format("Torsional mode {}: {:.5g} Hz", k + 1, results::to_hz(m.frequency)),
            {},
            &m.x,
            analysis::ModeKind::torsional});
    results::write_shape_frames(s, fmt::format("mode_{}", k + 1), m.x);
  }
  results::MeshAccuracy mesh(s);
  mesh.look_at(modes, law.max_speed);
  mesh.report();
  s.add_table("torsional", std::move(table));
  io::Table criticals;
  criticals.title = "Torsional critical speeds";
  criticals.columns = {
      {"order", "-", "excitations a revolution"}, {"speed", "rpm", ""}, {"frequency", "Hz", ""}};
  std::vector<plot::CriticalMark> marks;
  for (const double order : law.orders) {
    analysis::CriticalOptions q;
    q.order = order;
    q.max_speed = law.max_speed;
    q.motion = analysis::Motion::torsional;
    q.max_frequency = 1.0001 * highest;
    if (modes.empty()) break;
    for (const analysis::Critical& c : analysis::critical_speeds(s.linear, q)) {
      criticals.add({order, results::to_rpm(c.speed), results::to_hz(c.frequency)});
      v["critical speeds [rpm]"][fmt::format("{:g}x", order)].push(results::to_rpm(c.speed));
      marks.push_back({c.speed, c.frequency, order, {}});
    }
  }
  s.add_table("critical_speeds", std::move(criticals));
  if (!lines.empty())
    s.add_figure(plot::plot_campbell(s.file("interference"), "Torsional interference diagram",
                                     lines, law.orders, marks));
  s.section.text = modes.empty()
                       ? "The model has no torsional mode: no inertia twists against another."
                       : fmt::format("{} torsional modes.", modes.size());
  s.finish(fmt::format("{} torsional modes, {} critical speeds", modes.size(), marks.size()));
}

}  // namespace whirl::steps
