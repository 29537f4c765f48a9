#include <core/messages.hpp>
#include <results/held.hpp>

#include <fmt/format.h>

#include <type_traits>

namespace whirl::results {

namespace {

/// What a step of some motions only leaves out.
const char* left_out_motion(const model::StepLaw& law) {
  return std::visit(
      [](const auto& s) -> const char* {
        using T = std::decay_t<decltype(s)>;
        model::MotionKind motion = model::MotionKind::all;
        if constexpr (std::is_same_v<T, model::TorsionalStep> ||
                      std::is_same_v<T, model::ApiTorsionalStep>)
          motion = model::MotionKind::torsional;
        else if constexpr (requires { s.motion; })
          motion = s.motion;
        switch (motion) {
          case model::MotionKind::lateral:
            return "twist and axial motion without inertia: they follow lateral motion statically";
          case model::MotionKind::torsional:
            return "lateral and axial motion: the step takes torsional motion alone";
          case model::MotionKind::axial:
            return "lateral motion and twist: the step takes axial motion alone";
          case model::MotionKind::all: break;
        }
        return nullptr;
      },
      law);
}

/// Loads, unbalances and motions of the base with a law of time, in steps that have none.
void add_what_changes(const model::Model& m, std::vector<std::string>& out) {
  const auto say = [&out](const char* what, const std::string& name, const LawPtr& factor) {
    if (factor)
      out.push_back(fmt::format(
          "{} '{}' at its value at t = 0, {:.4g} times what is given: the step has no time", what,
          name, factor->at(0.0).f));
  };
  for (const model::PointLoad& x : m.loads)
    say("load", x.name, x.factor);
  for (const model::Unbalance& x : m.unbalances)
    say("unbalance", x.name, x.factor);
  const auto say_base = [&out](const std::string& what, const LawPtr& law, double unit,
                               const char* named) {
    if (varies(law))
      out.push_back(
          fmt::format("{} of the base at its value at t = 0, {:.4g} {}: the step has no time", what,
                      law->at(0.0).f / unit, named));
  };
  for (std::size_t k = 0; k < 3; ++k)
    say_base(fmt::format("acceleration along {}", "xyz"[k]), m.base.acceleration[k], 1.0, "m/s^2");
  if (m.base.turn) say_base("turning", m.base.turn->rate, pi / 180.0, "deg/s");
}

}  // namespace

std::vector<std::string> held_in_step(const run::Job& job, const model::Step& step,
                                      std::span<const Index> holds) {
  std::vector<std::string> out;
  const bool in_time = std::holds_alternative<model::TransientStep>(step.law);
  for (const model::Drive& d : job.model.drives) {
    if (in_time || !std::holds_alternative<model::PrescribedSpin>(d.law) ||
        (!d.step.empty() && d.step != step.name))
      continue;
    out.push_back(
        fmt::format("twist of shaft '{}' at {}: drive '{}' prescribes its angle (the speed is that "
                    "of the step)",
                    job.model.shafts[d.at.shaft].name, d.at.text, d.name));
  }
  for (const Index k : holds)
    out.push_back(fmt::format("{} of {}: nothing else holds {} shaft '{}'",
                              k % 6 == system::ux ? "axial place" : "angle",
                              job.system().node(k / 6).name,
                              k % 6 == system::ux ? "the axial motion of" : "the turning of",
                              job.system().line_name(job.system().node(k / 6).line)));
  if (!in_time) add_what_changes(job.model, out);
  if (const char* motion = left_out_motion(step.law)) out.emplace_back(motion);
  out.insert(out.end(), job.built.held.begin(), job.built.held.end());
  return out;
}

void say_held(run::Job& job, const model::Step& step, const std::vector<std::string>& held,
              io::ReportSection& section) {
  if (held.empty()) return;
  io::Value& list = job.summary["steps"][step.name]["held"];
  std::string all;
  for (const std::string& h : held) {
    list.push(h);
    all += (all.empty() ? "" : "; ") + h;
    if (!job.options.quiet) say(fmt::format("  {}: held: {}\n", step.name, h));
  }
  section.text += "\n\nHeld: " + all + ".";
}

}  // namespace whirl::results
