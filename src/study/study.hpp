// Error against run time of a deck, and the stability of the integrators on its rotor.
#pragma once
#include <run/options.hpp>

namespace whirl::study {

struct StudyOptions {
  std::filesystem::path deck;
  deck::ReadOptions read;
  run::RunOptions run;
  std::filesystem::path exact;  ///< CSV of the exact displacements of probes; empty: none
};
/// Error against run time of a deck over a ladder of tolerances, steps, integrators and meshes.
/// @throws Error (E95, E96) when the deck has nothing to study.
int study_deck(const StudyOptions& options);
/// Spectral radius, numerical damping and energy over very many steps of every integrator on the
/// deck's rotor.
/// @throws Error (E95) when the deck has nothing to study.
int study_stability(const StudyOptions& options);

}  // namespace whirl::study
