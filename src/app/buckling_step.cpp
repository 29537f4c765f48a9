// A buckling step: load factors at which the rotor buckles, linearised about the unloaded state.
#include <analysis/buckling.hpp>
#include <app/frequency.hpp>

#include <fmt/format.h>

#include <cmath>

namespace whirl::app {

void run_buckling_step(Job& job, const model::Step& step, const model::BucklingStep& law) {
  FrequencyStep s(job, step, "buckling", "buckling", std::abs(law.speed));
  const PhaseTimer timer(job, "buckling");
  const auto modes = analysis::buckling(s.linear.running(), law.speed, law.modes);
  io::Table table;
  table.title = "Buckling";
  table.columns = {{"mode", "-", ""}, {"load factor", "-", "negative: with all loads reversed"}, {"imaginary part", "-", "not zero: flutter"}};
  io::Value& v = s.summary();
  v["speed [rpm]"] = to_rpm(law.speed);
  double first = nan;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const analysis::BucklingMode& m = modes[k];
    table.add({static_cast<int>(k + 1), m.factor.real(), m.factor.imag()});
    v["load factors"].push(m.factor.real());
    if (std::isnan(first) && m.factor.real() > 0) first = m.factor.real();
    const std::string name = fmt::format("buckling_{}", k + 1);
    add_shape_figures(s, {name, fmt::format("Buckling shape {}: load factor {:.6g}", k + 1, m.factor.real()), {}, &m.x, analysis::ModeKind::lateral});
    write_shape_frames(s, name, m.x);
  }
  s.add_table("buckling", std::move(table));
  s.section.text = "Factors on gravity and all loads at which the stiffness of the rotor vanishes, from its derivative with the loads.";
  s.finish(modes.empty() ? "no buckling load" : fmt::format("smallest load factor {:.6g}", std::isnan(first) ? modes.front().factor.real() : first));
}

}  // namespace whirl::app
