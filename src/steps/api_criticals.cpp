#include <steps/api_criticals.hpp>

#include <steps/critical_margins.hpp>
#include <steps/undamped_forward.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::steps {

using results::Check;

Check check_critical_speeds(run::Job& sub, const model::Step& step,
                            const model::ApiLateralStep& law, const ApiMachine& machine,
                            const std::vector<double>& peaks) {
  results::FrequencyStep s(sub, step, "damped critical speeds", "damped critical speeds",
                           law.max_speed);
  CriticalMarginOptions o;
  o.order = sub.model.shafts[machine.shaft].speed_ratio;
  o.min_speed = law.min_speed;
  o.max_speed = law.max_speed;
  o.range = {law.operating[0], law.operating[1]};
  const model::ApiLimits& l = law.limits;
  o.rule = {l.damped, l.margin_factor, l.margin_offset, l.margin_above, l.margin};
  o.peaks = peaks;
  o.threads = sub.options.jobs;
  analysis::SpectrumCertificate certificate;
  std::vector<CriticalMargin> found = critical_margins(s.linear, o, &certificate);
  s.certify(certificate);
  // what another rotor of the deck does, and this one not with it, is none of its modes
  constexpr double with_it = 0.01;
  std::erase_if(found, [&](const CriticalMargin& m) {
    return !moves(sub.mesh, sub.system(), m.critical.mode.x, machine.shaft, with_it);
  });
  io::Table t;
  t.title = "Damped critical speeds";
  t.nan_means = "none";
  t.columns = {{"critical speed", "rpm", ""},
               {"direction", "-", ""},
               {"amplification factor", "-", "1/(2 zeta)"},
               {"required", "%", ""},
               {"actual", "%", "negative: inside the operating range"},
               {"peak", "rpm", "of a response that shows it"},
               {"result", "-", ""}};
  int light = 0;
  double least = infinity;
  std::optional<Check> worst;
  for (const CriticalMargin& m : found) {
    const analysis::Critical& c = m.critical;
    light += !m.damped;
    const std::string direction = results::direction_text(c.mode);
    t.add({to_rpm(c.speed), direction, std::isinf(c.amplification()) ? nan : c.amplification(),
           100 * m.required, 100 * m.actual, m.peak ? to_rpm(*m.peak) : nan,
           m.damped     ? "critically damped"
           : m.peak     ? "by its peak"
           : m.passed() ? "passed"
                        : "FAILED"});
    if (m.passed() || m.actual - m.required >= least) continue;
    least = m.actual - m.required;
    worst = results::compare("margin of a critical speed", 100 * m.actual, "%",
                             Check::Rule::at_least, 100 * m.required);
    worst->where =
        fmt::format("{:.5g} rpm, {}, AF {:.4g}", to_rpm(c.speed), direction, c.amplification());
    worst->remark = "no unbalance of this report drives it to a peak";
  }
  if (!worst) {
    worst = results::compare("critical speeds without a peak", nan, "-", Check::Rule::none, nan);
    worst->where =
        fmt::format("{:.5g} to {:.5g} rpm", to_rpm(law.min_speed), to_rpm(law.max_speed));
    worst->remark = fmt::format(
        "{} lightly damped critical speed{}, none within its margin but where a peak is judged{}",
        light, light == 1 ? "" : "s",
        certificate.complete() ? "" : "; the list may not be complete");
  }
  s.add_table("margins", std::move(t));
  s.section.text =
      "Damped critical speeds of the machine as given, seals and all: those that ask for a margin "
      "are "
      "judged by it where no response has a peak for them.";
  s.finish(fmt::format("{} critical speed{}, {} lightly damped", found.size(),
                       found.size() == 1 ? "" : "s", light));
  return *worst;
}

}  // namespace whirl::steps
