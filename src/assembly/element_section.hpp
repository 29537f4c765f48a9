// From a section of the model to the numbers of its elements.
#pragma once
#include <elements/shaft/section.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <meshes/mesh.hpp>
#include <model/model.hpp>

namespace whirl::assembly {

/// The part of a (circular or given) section that a mesh element covers.
elements::ElementSection element_section(const model::Model& m, const meshes::Element& e);
/// How the masses of shaft elements are made.
elements::MassKind mass_kind(const model::Model& m);
/// Constants of a mesh element, with its offsets; share as in make_shaft_constants(). Not for
/// general sections.
elements::ShaftElementConstants element_constants(const model::Model& m, const meshes::Element& e,
                                                  const elements::MassShare& share = {});

}  // namespace whirl::assembly
