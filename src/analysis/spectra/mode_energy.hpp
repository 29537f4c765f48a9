// Where the energy of a mode is: strain energy by shaft element and by support, kinetic energy by
// node.
//
// Strain energy of a shaft element between nodes i and j: with G the rigid motion that carries node
// i's unknowns to node j, the part of x_j that deforms the element is e = x_j - G x_i, and its
// energy 1/2 e^H D e with D = -K_ij^T G^-1, for K of an element does not see rigid motions. So the
// assembled matrix of all elements is enough. Supports between two nodes (a rotor and its pedestal,
// two shafts) are taken likewise; what their forces then leave at a node is a spring to the ground.
// Inner states of supports keep their energy at their nodes. Taken about the equilibrium at rest (v = 0): circulatory parts store nothing.
#pragma once
#include <analysis/spectra/whirl_modes.hpp>

#include <string>
#include <vector>

namespace whirl::analysis {

struct EnergyPart {
  system::Family family = system::Family::body;
  std::string kind;            ///< of the batch, for display: "shaft elements", "rigid disks"
  Index node = 0, other = -1;  ///< other >= 0: what is between the two
  double share = 0;            ///< of the whole strain or kinetic energy
};

struct ModeEnergy {
  std::vector<EnergyPart> strain,
      kinetic;  ///< shares above 1e-6, in the order of the batches and nodes; each sums to 1
};

/// @pre x of length system().size().
ModeEnergy energy_distribution(Linearizer& linear, const VecXc& x);

}  // namespace whirl::analysis
