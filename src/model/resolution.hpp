// The mesh the program chooses where a deck gives none: elements short enough for the motions that
// the deck's steps ask about, to the accuracy asked for.
//
// Bound. An element with the consistent mass matrix makes omega^2 of any motion of frequency omega
// too large by at most the share omega^2 c of its kinetic energy, c (s^2) the compliance of the
// element between clamped ends under its own inertia (elements/shaft/timoshenko_matrices.hpp):
//   c_w = rhoA h^4 (1 + 5 Phi)/(720 EI),  c_th = rhoI h^2/(12 EI) Phi/(1 + Phi),
//   Phi = 12 EI/(kGA h^2),  c = (1 - s) c_w + s c_th,  s = rhoI/(rhoI + rhoA h^2/15).
// So omega^2 c <= 2 accuracy in every element keeps all frequencies up to omega to the accuracy,
// whatever the supports and bodies are; the corrected mass of the elements then does better. For
// the twist, whose mass is the mean of the consistent and the lumped one, the error of omega is
// x^4/240, x = omega h sqrt(rhoIp/GJ), of a bare shaft, but x^2/24 of the share of the kinetic
// energy that bodies hold, at which the twist has a kink (the two parts of the element's error, omega^2
// rhoIp h/12 times the square of its twist and one of fourth order, cancel where strain and kinetic
// energy are alike).
// Frequencies. Steps that name one (speeds, frequency ranges) ask for that; steps that ask for a
// number of modes for a bound from above: a mode has a half-wave in one of two planes more than the
// one before, and n of them on shafts of wave number k(omega) = (rhoA/EI)^(1/4) sqrt(omega) reach
// to int k ds = n pi; bodies and soft supports only lower it. Torsional modes are counted by the phase of
// the bare stepped shafts. Large static deflections converge
// with order 4: 8 elements a line leave 1e-3.
#pragma once
#include <model/model.hpp>

namespace whirl::model {

/// What the steps of a deck ask of its mesh.
struct Resolution {
  double lateral = 0;    ///< rad/s: lateral motions are to be right up to this frequency
  double torsional = 0;  ///< rad/s
  int half_waves = 0;    ///< of static deflections too large to be linear, or of buckling; 0: none
};

/// The excitation orders of a step: those asked for, or once a turn of every shaft that rotates: the
/// sizes of their speed ratios, rising.
std::vector<double> orders_of(const Model& model, const std::vector<double>& asked);

/// Of all steps together.
Resolution resolution_of(const Model& m);

/// The mesh of a section is left to the program: neither it nor its shaft or model limits elements.
bool mesh_is_chosen(const Model& m, const Section& s);

/// Longest element of a flexible section, m: as the deck says, or where it leaves the mesh to the
/// program, short enough to resolve what is asked to Model::mesh_accuracy, but never below a
/// hundredth of the section. infinite: one element will do.
double longest_element(const Model& m, const Shaft& shaft, const Section& s, const Resolution& r);

}  // namespace whirl::model
