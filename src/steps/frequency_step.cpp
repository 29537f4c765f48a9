// Which function runs a step in the frequency domain.
#include <results/frequency.hpp>
#include <run/support_diagnosis.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <type_traits>

namespace whirl::steps {

namespace {

/// What films and magnets carry at the speed at which they do not carry all.
Error explained(const run::Job& job, const analysis::NoEquilibrium& e) {
  analysis::SteadySystem running(job.system(), results::steady_rotation_of(job, e.Omega));
  run::StepState start{job.system().make_state(), e.Omega, {}};
  running.set_rates(e.Omega, start.state.v);
  Error said = run::explain_no_equilibrium(job, running, start, e);
  std::vector<Diagnostic> all = said.diagnostics();
  if (all.front().message.find(" rpm") == std::string::npos)
    all.front().message = fmt::format("at {:.6g} rpm: {}", to_rpm(e.Omega), all.front().message);
  return Error(said.exit(), std::move(all));
}

void run_step_of_kind(run::Job& job, const model::Step& step) {
  std::visit(
      [&](const auto& law) {
        using T = std::decay_t<decltype(law)>;
        if constexpr (std::is_same_v<T, model::ModalStep>)
          run_modal_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::CampbellStep>)
          run_campbell_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::CriticalStep>)
          run_critical_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::UnbalanceStep>)
          run_unbalance_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::StabilityStep>)
          run_stability_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::CriticalMapStep>)
          run_critical_map_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::HarmonicStep>)
          run_harmonic_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::SensitivityStep>)
          run_sensitivity_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::TorsionalStep>)
          run_torsional_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::ApiLateralStep>)
          run_api_lateral_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::ApiTorsionalStep>)
          run_api_torsional_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::BalancingStep>)
          run_balancing_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::BucklingStep>)
          run_buckling_step(job, step, law);
      },
      step.law);
}

}  // namespace

void run_frequency_step(run::Job& job, const model::Step& step) {
  try {
    run_step_of_kind(job, step);
  } catch (const analysis::NoEquilibrium& e) {
    throw explained(job, e);
  }
}

}  // namespace whirl::steps
