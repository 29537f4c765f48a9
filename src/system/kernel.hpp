// What an element is: a stateless kernel whose data members are its parameters.
//
//   struct RigidDisk {
//     static constexpr int n_nodes = 1;       // nodes it touches
//     static constexpr int width = 7;         // coordinates a node: 3 = (u), 7 = (u, d, phi)
//     static constexpr bool has_M = true, has_C = true, has_K = true;   // tangents that exist
//     static constexpr Family family = Family::body;      // what it stands for in results
//     static constexpr Dependence depends{.spin = true, .weight = true};
//     // f += left side of M a + f = 0
//     void add_force(const Nodes<1>&, const Context&, ForceX<7>& f) const;
//     // t += exact derivatives of f
//     void add_tangent(const Nodes<1>&, const Context&, TangentX<7>& t) const;
//     void add_energy(const Nodes<1>&, const Context&, Energy& e) const;
//   };
//
// depends says what the force depends on beside position and lateral motion (dependence.hpp). Where
// that depends on the parameters it is a member function, Dependence depends(const Context&) const,
// for the time and the means (Context::averaged) of a context. A kernel that says nothing is none.
// The conformance suite of the tests holds every kernel to its word.
//
// Optional: static void add_forces(std::span<const K>, const std::array<Index, n_nodes>* nodes,
// const NodeState*, const Context&, Vector<7>* force), the same for all elements of a batch at
// once, where a kernel is fast that way; likewise add_energies(.., const Context&, Energy&).
//
// Optional: static constexpr Axes axes says what it takes the axes of its nodes for (below).
//
// Optional: powerless = true says that add_energy never adds to supplied or dissipated, so that a
// power balance skips it.
//
// Optional: quadratic_in_rates = true says that f is a polynomial of degree <= 2 in u', d', phi' at
// fixed u, d, phi, with constant M: frequency-domain analyses then combine its matrices for any
// speed from three evaluations.
//
// Optional: linear_in_displacements = true says that at given d(t), phi(t) f is affine in u, u',
// u'' with constant coefficients: a scene of such kernels in which nothing tilts or turns freely is
// integrated with one linearisation.
//
// Optional: int region(const Nodes<>&) const numbers the smooth pieces of a force that has corners
// (a gap closes), and bool cornered() const says whether this element has any: a transient puts the
// ends of its steps on the corners.
//
// Optional: own = n and void relax(const Nodes<>&, const Context&, std::array<double, n>&) const: the values
// of its last n nodes, which are scalars that no other element touches, at which they are in balance
// at rest, everything else being where it is. With own_each = k these have k unknowns each
// (NodeDef::scalars), and the array those of one node after the other. Statics begins there, and goes
// back there when Newton's method finds no way. What it cannot balance it leaves.
//
// Sign: f is what stands on the LEFT: inertia + internal force - external force. Absent tangents
// (has_* false) are never touched. Kernels do not allocate, throw, or branch on physics that the
// deck could have left out: that is another kernel.
#pragma once
#include <system/dependence.hpp>
#include <system/node.hpp>
#include <concepts>
#include <type_traits>

namespace whirl::system {

/// What the elements of a kernel stand for in results.
enum class Family {
  shaft,    ///< stress and mass of a shaft
  damping,  ///< what a shaft loses
  body,     ///< masses that are not the shaft's
  support,  ///< joints to ground, housings and other shafts, and what they stand on
  load      ///< forces, torques, unbalance, weight
};

/// What an element of width 7 takes the axes of its nodes for (frames.hpp), once they have moved.
enum class Axes {
  any,     ///< its force is the same vector whatever the axes
  common,  ///< compares its two nodes' angles: both must be in the same axes
  own      ///< phi, or t = d - e, means something about the axes of the line as they began
};

/// A kernel that says nothing means its line's own axes.
template <class K>
constexpr Axes axes_of() {
  if constexpr (K::width < 7)
    return Axes::any;
  else if constexpr (requires { K::axes; })
    return K::axes;
  else
    return Axes::own;
}

/// A constant declaration.
template <class K>
concept DependsAlike = std::same_as<decltype(K::depends), const Dependence> && requires {
  typename std::bool_constant<K::depends.spin>;
};

/// One that follows the parameters of the element.
template <class K>
concept DependsByParameters = requires(const K& k, const Context& c) {
  { k.depends(c) } -> std::same_as<Dependence>;
};

/// What the force of an element, or of the law in one, depends on in a context.
template <class K>
requires DependsAlike<K> || DependsByParameters<K> Dependence dependence_of(const K& k,
                                                                            const Context& c) {
  if constexpr (DependsByParameters<K>)
    return k.depends(c);
  else
    return K::depends;
}

template <class K>
concept Kernel = (DependsAlike<K> ||
                  DependsByParameters<K>)&&requires(const K& k, const Nodes<K::n_nodes>& x,
                                                    const Context& c,
                                                    ForceX<K::n_nodes * K::width>& f,
                                                    TangentX<K::n_nodes * K::width>& t, Energy& e) {
  requires K::width == 3 || K::width == 7;
  { K::has_M } -> std::convertible_to<bool>;
  { K::has_C } -> std::convertible_to<bool>;
  { K::has_K } -> std::convertible_to<bool>;
  { K::family } -> std::convertible_to<Family>;
  k.add_force(x, c, f);
  k.add_tangent(x, c, t);
  k.add_energy(x, c, e);
};

}  // namespace whirl::system
