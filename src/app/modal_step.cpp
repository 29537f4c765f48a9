// A modal step: whirl modes at one speed.
#include <app/frequency.hpp>

#include <fmt/format.h>

#include <cmath>

namespace whirl::app {

void run_modal_step(Job& job, const model::Step& step, const model::ModalStep& law) {
  FrequencyStep s(job, step, "modal", "whirl modes", std::abs(law.speed));
  analysis::ModesOptions o;
  o.count = law.modes;
  o.max_frequency = law.max_frequency;
  o.motion = motion_of(law.motion);
  o.damped = law.damped;
  o.real_roots = false;
  const std::vector<analysis::WhirlMode> modes = [&] {
    const PhaseTimer timer(job, "modes");
    return analysis::whirl_modes(s.linear, law.speed, o);
  }();

  io::Table table;
  table.title = "Modes";
  table.columns = {{"mode", "-", ""},
                   {"kind", "-", "by the largest share of energy"},
                   {"direction", "-", "of the orbits, seen along the spin"},
                   {"frequency", "Hz", "damped natural frequency"},
                   {"frequency", "rpm", ""},
                   {"log decrement", "-", "per cycle; negative: unstable"},
                   {"damping ratio", "-", ""},
                   {"lateral", "%", "share of the energy"},
                   {"torsional", "%", ""},
                   {"axial", "%", ""},
                   {"forwardness", "-", "1: forward circles, -1: backward circles"}};
  io::Value& v = s.summary();
  v["speed [rpm]"] = to_rpm(law.speed);
  io::Value list = io::Value::array();
  int unstable = 0;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const analysis::WhirlMode& m = modes[k];
    table.add({static_cast<int>(k + 1), std::string(to_string(m.kind)), direction_text(m), to_hz(m.frequency), to_rpm(m.frequency),
               tidy(m.log_decrement), tidy(m.damping_ratio), 100 * tidy(m.lateral), 100 * tidy(m.torsional), 100 * tidy(m.axial), tidy(m.forwardness)});
    io::Value e = io::Value::object();
    e["frequency [Hz]"] = to_hz(m.frequency);
    e["log decrement"] = tidy(m.log_decrement);
    e["kind"] = std::string(to_string(m.kind)), e["direction"] = direction_text(m);
    list.push(std::move(e));
    unstable += m.damping_ratio < -1e-12;   // below the rounding of the eigenvalue
  }
  v["modes"] = list;
  v["unstable modes"] = unstable;
  s.add_table("modes", std::move(table));

  const std::size_t drawn = std::min(modes.size(), static_cast<std::size_t>(law.shapes));
  for (std::size_t k = 0; k < drawn; ++k) {
    const analysis::WhirlMode& m = modes[k];
    const std::string name = fmt::format("mode_{}", k + 1);
    ShapeDrawing d{name, fmt::format("Mode {}: {:.5g} Hz, {}", k + 1, to_hz(m.frequency), description(m)), {}, &m.x, m.kind};
    if (std::abs(m.log_decrement) > 1e-9) d.caption = fmt::format("Log decrement {:.4g}.", m.log_decrement);
    add_shape_figures(s, d);
    write_shape_frames(s, name, m.x);
  }
  s.section.text = fmt::format("{} whirl modes at {:.6g} rpm, {}, about the spinning, loaded equilibrium.", modes.size(), to_rpm(law.speed),
                               law.damped ? "damped" : "undamped");
  if (unstable > 0) s.section.text += fmt::format(" {} of them unstable.", unstable);
  std::string line = fmt::format("{} modes at {:.0f} rpm", modes.size(), to_rpm(law.speed));
  for (std::size_t k = 0; k < std::min<std::size_t>(modes.size(), 4); ++k) line += fmt::format("{}{:.4g}", k ? ", " : ": ", to_hz(modes[k].frequency));
  s.finish(line + (modes.empty() ? "" : modes.size() > 4 ? " ... Hz" : " Hz") + (unstable ? fmt::format(", {} unstable", unstable) : ""));
}

}  // namespace whirl::app
