// The films of journal bearings as their kernels, from what the model says.
#pragma once
#include <elements/films/finite_journal.hpp>
#include <model/model.hpp>

namespace whirl::assembly {

/// nodes: points of the grid round the circumference, law.nodes or others to compare with.
/// @throws Error E84 as JournalSurface.
elements::FiniteJournal make_finite_journal(const model::FiniteJournal& law, int nodes);

}  // namespace whirl::assembly
