// Sections that are not a matter of two principal planes, as matrices.
#pragma once
#include <core/section_matrices.hpp>
#include <model/model.hpp>

namespace whirl::model {

/// Stiffness and mass of a section that is_full, in its own axes, with its added mass.
FullSection full_section(const Model& m, const Section& s);
/// The round section nearest to full matrices.
Section::Constants round_constants(const Section::Full& f);
/// Whether the bending of a section depends on its direction by more than `share` of its stiffness.
bool is_unequal(const Section& s, double share);
/// Whether the rotary inertia of a section given by matrices does, with the options that act on it.
bool has_unequal_inertia(const Section& s, double share);

}  // namespace whirl::model
