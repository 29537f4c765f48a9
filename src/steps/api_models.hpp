// The models that an API report looks at: the deck with one set of bearings, and what of it takes
// part in which analysis.
#pragma once
#include <analysis/response/api617.hpp>
#include <run/job.hpp>

namespace whirl::steps {

/// One set of bearings.
struct ApiMachine {
  std::string set, tag;                      ///< name, and what files are called after
  model::Model model;                        ///< as given, with the set's bearings
  std::vector<std::size_t> journals, seals;  ///< numbers of bearings; journals along the shaft
  std::size_t shaft = 0;                     ///< on which the journals are
  double ratio = 1;                          ///< of its speed to the reference, positive
};

/// The machine of every set of the step, at least one.
/// @throws Error (E70) when one cannot be made, or does not fit the step; as deck::load_model.
std::vector<ApiMachine> api_machines(const model::Model& model, const run::RunOptions& options,
                                     const model::Step& step, const model::ApiLateralStep& law);

/// Seals and the like without a force.
model::Model without_seals(const ApiMachine& m);
/// Nothing turns with the rotor but what is added: no unbalance, bow, skew, eccentric disk,
/// misaligned coupling or load that turns.
model::Model balanced(const model::Model& m);
/// Gravity alone, across the shafts.
model::Model weight_alone(const model::Model& m);
/// Journals whose coefficients follow from their load, as tables of these: at speeds, rad/s.
model::Model with_tables(const run::Job& parent, const ApiMachine& machine, const model::Model& m,
                         const model::Step& step, const std::vector<double>& speeds);
/// Journals with the mean of their direct stiffnesses in both directions, and no damping.
model::Model with_mean_stiffness(const ApiMachine& machine, const model::Model& m);
/// Journals that hold the shaft rigidly.
model::Model with_rigid_journals(const ApiMachine& machine, const model::Model& m);

}  // namespace whirl::steps
