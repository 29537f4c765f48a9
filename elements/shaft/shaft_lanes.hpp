// The forces of the shaft element and of its damping, several elements at a time: one compiler
// vector holds the same quantity of four elements (two on a baseline machine). Compiled once per
// instruction set and chosen at run time, as the block LU is (la/lu_kernel.hpp). The formulas are
// in shaft_lanes.inl and shaft_damping.inl; their exact derivatives are the kernels' add_tangent.
//
// Only plain data crosses this interface, so that no inline function shared with other code is ever
// compiled for an instruction set the machine may lack.
#pragma once
#include <cstddef>

namespace whirl::elements::lanes {

/// Elements, nodes and forces as arrays of doubles; all distances are counted in doubles.
struct Elements {
  const double* element = nullptr;  ///< the first element
  std::ptrdiff_t stride = 0;        ///< from one element to the next
  std::size_t count = 0;
  const std::ptrdiff_t* nodes = nullptr;  ///< two a element
  const double* state =
      nullptr;  ///< the first node: u, du, ddu, t, dd, ddd, phi, dphi, ddphi one after another
  std::ptrdiff_t state_stride = 0,
                 chart = 0;  ///< from one node to the next; from a node to its chart pointer
  double* force = nullptr;   ///< 7 a node, added to
};

/// Where in a shaft element: the twelve scalars of ShaftElementConstants from `length` to `tau_c`;
/// M4 and G4c (4x4, column-major); polar (2x2); e0; psi0; preload; soft (q, r, 1/kGA, -kGA/2).
struct ShaftElements : Elements {
  std::ptrdiff_t scalars = 0, M4 = 0, G4c = 0, polar = 0, e0 = 0, psi0 = 0, preload = 0, soft = 0;
};

/// `element` points to eleven doubles: length, o1, o2, e0, d11, d12, d22, d_twist, d_axial.
struct DampingElements : Elements {};

struct Kernels {
  const char* isa;
  void (*add_force)(const ShaftElements&);         ///< nodes at the element's ends
  void (*add_force_offset)(const ShaftElements&);  ///< with offsets o1, o2
  void (*add_internal_damping)(const DampingElements&);
  void (*add_external_damping)(const DampingElements&);
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::elements::lanes
