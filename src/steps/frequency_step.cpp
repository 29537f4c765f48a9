// Which function runs a step in the frequency domain.
#include <results/frequency.hpp>
#include <steps/step_kinds.hpp>

#include <type_traits>

namespace whirl::steps {

void run_frequency_step(run::Job& job, const model::Step& step) {
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

}  // namespace whirl::steps
