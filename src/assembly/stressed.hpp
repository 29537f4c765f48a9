// Kernels that carry stress of a shaft element. Internal to src/assembly.
#pragma once
#include <assembly/parts.hpp>
#include <elements/shaft/end_axes.hpp>

namespace whirl::assembly {

/// Adds a kernel to those of a mesh element, and notes it for the element's section forces.
/// @pre the element has its place in Built::element_forces.
template <system::Kernel K>
void add_stressed(Assembly& a, const K& k, const std::array<Index, 2>& nodes, const char* kind,
                  std::size_t element) {
  const std::size_t place = a.builder.count<K>();
  a.builder.add(k, nodes, kind);
  ElementForce& f = a.built.element_forces.at(element);
  f = [place, before = std::move(f)](const system::System& s, const system::Nodes<2>& x,
                                     const system::Context& c, system::ForceX<14>& out) {
    if (before) before(s, x, c, out);
    s.batch<K>()->elements()[place].add_force(x, c, out);
  };
}

/// Ends of a mesh element, for what is fixed in it at an angle from e2 towards e3.
inline elements::EndAxes end_axes(const meshes::Element& e, double angle) {
  return {e.s2 - e.s1, e.left.offset, e.right.offset, elements::EndAxes::normal_at(angle)};
}

/// Slopes of half a sine of amount 1 at the ends of an element, against its chord, 1/m.
Vec2 bow_slopes(const model::Shaft& shaft, const meshes::Element& e);

/// How much of its bow a line has.
inline elements::Growth growth_of(const model::Bow& b) {
  return {b.constant() ? b.amount : b.initial, b.amount, b.time_constant};
}

}  // namespace whirl::assembly
