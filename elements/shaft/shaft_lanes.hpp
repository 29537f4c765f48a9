// The forces of the shaft element and of its damping, several elements at a time: one compiler
// vector holds the same quantity of four elements (two on a baseline machine). Compiled once per
// instruction set and chosen at run time, as the block LU is (la/lu_kernel.hpp). The formulas are
// those of one element, in shaft_strain.inl and shaft_damping.inl; the exact derivatives are the
// kernels' add_tangent.
//
// Only plain data crosses this interface, so that no inline function shared with other code is ever
// compiled for an instruction set the machine may lack: arrays of doubles, and the places of the
// numbers in them, which shaft_beam.cpp, shaft_damping.cpp and system/node.hpp assert one by one.
#pragma once
#include <cstddef>

namespace whirl::elements::lanes {

/// Where the numbers of a ShaftBeam stand, in doubles from its start; matrices column-major.
struct ShaftPlaces {
  static constexpr int length = 0, o1 = 1, o2 = 2, EA_l = 3;
  static constexpr int b11 = 4, b12 = 5, b22 = 6, k11 = 7, k12 = 8, k22 = 9, GJ_l = 10, tau_c = 11;
  static constexpr int scalars = 12;  ///< so many of them
  static constexpr int M4 = 12, polar = 44, bend = 52, inverse = 57;
  static constexpr int rest = 58;  ///< start of those from e0 to soft_limit
  static constexpr int e0 = 58, psi0 = 61, preload = 62;
  static constexpr int soft_torque = 63, soft_axial = 64, soft_shear = 65, soft_limit = 66;
  static constexpr int after_rest = 67;
  static constexpr int size = 68;  ///< from one element to the next
};

/// Where the numbers of a ShaftDamping stand.
struct DampingPlaces {
  static constexpr int length = 0, o1 = 1, o2 = 2, e0 = 3;
  static constexpr int d11 = 6, d12 = 7, d22 = 8, d_twist = 9, d_axial = 10;
  static constexpr int size = 11;
};

/// A batch of elements, its nodes and their forces (null where energies are asked for).
struct Elements {
  const double* element = nullptr;  ///< the first element
  std::size_t count = 0;
  const std::ptrdiff_t* nodes = nullptr;  ///< two an element
  const double* state = nullptr;          ///< the first node (system/node_places.hpp)
  double* force = nullptr;                ///< 7 a node, added to
};

/// Sums over a batch, J.
struct Energies {
  double elastic = 0, kinetic = 0, gravity = 0;
};

struct Kernels {
  const char* isa;
  void (*add_force)(const Elements&);         ///< ShaftBeam, nodes at the element's ends
  void (*add_force_offset)(const Elements&);  ///< ShaftBeam with offsets o1, o2
  void (*add_internal_damping)(const Elements&);
  void (*add_external_damping)(const Elements&);
  /// gravity: acceleration, three components. The elements are added one by one, in their order.
  void (*add_energy)(const Elements&, const double* gravity, Energies&);         ///< ShaftBeam
  void (*add_energy_offset)(const Elements&, const double* gravity, Energies&);  ///< with o1, o2
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::elements::lanes
