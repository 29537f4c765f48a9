// Growth by parts whose stiffness changes as they pass (teeth of gears, rolling elements), to first order.
//
// Linear analyses take such a support's mean. What is left, K_h = Kc_h + i Ks_h of
//   K(theta) - mean = sum_h Re(conj(K_h) exp(i h theta)),   theta = rate Omega t,
// joins two motions x_i, x_j (lambda = sigma + i w) where h rate Omega is about w_i + w_j: with slowly
// changing amplitudes a_i and b_j = conj(a_j) exp(i D t), D = h rate Omega - w_i - w_j,
//   a_i' = sigma_i a_i + c_ij b_j,      b_j' = (sigma_j + i D) b_j + conj(c_ji) a_i,
//   c_ij = -(1/2) x_i^H conj(K_h) conj(x_j) / x_i^H (2 lambda_i M + C) x_i,
// the shape standing for the left vector (exact for conservative rotors, gyroscopic or not). Of one
// oscillator with the stiffness k (1 + a cos 2 w t) that is a growth of a w/4 less its damping (Mathieu).
// First order in the change of stiffness; resonances of higher order, and those of differences, which need
// a motion of negative energy, are left out.
// Source: A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, 1979, doi 10.1002/9783527617586, ch. 5.
#pragma once
#include <analysis/spectra/campbell.hpp>
#include <array>
#include <string>
#include <vector>

namespace whirl::analysis {

/// Supports whose parts pass at one rate.
struct PassingParts {
  std::vector<std::string> names;
  std::vector<std::size_t> terms;           ///< of the system, with others of their kind
  std::vector<std::array<Index, 2>> nodes;  ///< between which each stands
  double rate = 0;                          ///< passes a turn of the reference
  bool meshes = false;                      ///< teeth among them
};

/// Two motions that what passes makes grow, where they grow most.
struct PassingGrowth {
  std::size_t parts = 0;         ///< of the list
  double speed = 0, growth = 0;  ///< of the reference, rad/s; 1/s
  double first = 0, second = 0;  ///< natural frequencies there, rad/s
  int multiple = 1;              ///< of the frequency at which parts pass: their sum
};

struct PassingOptions {
  Index modes = 12;   ///< slowest motions; solved for where the diagram has less
  int multiples = 4;  ///< of the rate
};

/// All that grows at the speeds of a diagram or, where frequencies between them go by straight lines,
/// between them; of every two motions and multiple the largest, fastest first.
/// @pre the diagram has the shapes of its motions, and speeds of the reference that ascend or descend.
/// @throws Error as Linearizer::at.
std::vector<PassingGrowth> find_passing_growth(Linearizer& linear,
                                               const std::vector<PassingParts>& parts,
                                               const Campbell& diagram,
                                               const PassingOptions& options = {});

}  // namespace whirl::analysis
