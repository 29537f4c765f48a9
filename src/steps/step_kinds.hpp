// One function a kind of step. Each runs the step, adds its section to the report and its entry to
// the summary, and writes its files.
#pragma once
#include <analysis/response/unbalance.hpp>
#include <run/job.hpp>

namespace whirl::steps {

void run_static_step(run::Job&, const model::Step&, const model::StaticStep&);
void run_static_speeds(run::Job&, const model::Step&, const std::vector<double>& speeds,
                       int load_steps);
void run_transient_step(run::Job&, const model::Step&, const model::TransientStep&);
/// In the frequency domain: any kind that is neither static nor transient.
void run_frequency_step(run::Job&, const model::Step&);

/// Modes, Campbell diagrams, critical speeds, stability, responses: each builds on
/// results/frequency.hpp.
/// Returns the modes that oscillate.
std::vector<analysis::WhirlMode> run_modal_step(run::Job&, const model::Step&,
                                                const model::ModalStep&);
void run_campbell_step(run::Job&, const model::Step&, const model::CampbellStep&);
void run_critical_step(run::Job&, const model::Step&, const model::CriticalStep&);
void run_critical_map_step(run::Job&, const model::Step&, const model::CriticalMapStep&);
void run_stability_step(run::Job&, const model::Step&, const model::StabilityStep&);
/// A stability step of a rotor whose shaft has unequal principal stiffnesses, in axes that turn
/// with it.
void run_instability_bands(run::Job&, const model::Step&, const model::StabilityStep&);
/// What an unbalance response found, for reports that judge it.
struct UnbalanceOutcome {
  std::vector<analysis::ResponseProbe> probes;
  analysis::UnbalanceResponse response;
  std::vector<analysis::ResponsePeak> peaks;  ///< of the probes that are shown
};
/// beside: number of the deck's last probes that are computed, not shown. operating: speeds, rad/s,
/// lowest and highest first, at which growth is looked for; empty: those of the step.
UnbalanceOutcome run_unbalance_step(run::Job&, const model::Step&, const model::UnbalanceStep&,
                                    std::size_t beside = 0, std::vector<double> operating = {});
void run_harmonic_step(run::Job&, const model::Step&, const model::HarmonicStep&);
void run_sensitivity_step(run::Job&, const model::Step&, const model::SensitivityStep&);
void run_torsional_step(run::Job&, const model::Step&, const model::TorsionalStep&);
/// Reports after standards: they run the kinds above on models of their own.
void run_api_lateral_step(run::Job&, const model::Step&, const model::ApiLateralStep&);
void run_api_torsional_step(run::Job&, const model::Step&, const model::ApiTorsionalStep&);
/// @throws Error (E63) when vectors, runs, probes and planes do not fit together; as make_mesh().
void check_balancing(const model::Model&, const model::Step&, const model::BalancingStep&);
void run_balancing_step(run::Job&, const model::Step&, const model::BalancingStep&);
void run_buckling_step(run::Job&, const model::Step&, const model::BucklingStep&);

}  // namespace whirl::steps
