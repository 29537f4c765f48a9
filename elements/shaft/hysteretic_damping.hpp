// Hysteretic damping of the shaft material in its rotating axes: a loss per cycle that does not
// depend on the rate.
//
// A strain that goes as exp(i nu t) in the rotating axes of an element meets the stiffness k (1 + i
// eta sign(nu)), eta the loss factor. Seen in fixed axes a forward whirl exp(i w t) has nu = w - s,
// a backward one nu = -(w + s), s the spin of the element; twist and axial strain have nu = w. With
// the viscous law of unit coefficient, f = C X' and its derivative K = s S at steady spin (S:
// circulatory), this is, for w > 0,
//   f = eta (a/w C X' + b S X),   a = (sign(w - s) + sign(w + s))/2,
//       b = (sign(w + s) - sign(w - s))/2,
// so above the spin (w > |s|) an ordinary complex stiffness i eta k, below it a circulatory
// stiffness of constant size, which drives forward whirl: a shaft is destabilised above its
// critical speed and not below. At the synchronous rate (w = |s|, circular) the strain stands still
// and loses nothing. (Zorzi and Nelson 1977, doi 10.1115/1.3446254, take b = 1 at every rate, so
// that forward whirl is driven below the critical speed too; the sign used here: G. Genta, Dynamics
// of Rotating Systems, 2005, doi 10.1007/0-387-28687-X.) A decaying or growing motion, rate g + i
// w: i k eta X is written as eta/w C X' less g eta/w C X with C = k, exact at that rate. Steady
// states: w = 0 leaves f = eta sign(s) S X, the same side force of a sagging shaft at every speed.
//
// No such law exists in time (it would not be causal). Motions in time feel the viscous law with
// the coefficient eta/nu0 instead: equal loss per cycle at the rate nu0 alone.
#pragma once
#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/section_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>

namespace whirl::elements {

/// The part of a general beam that its betas make.
struct GeneralBeamDamping {
  GeneralBeam with, without;
  GeneralBeamDamping() = default;
  /// Damping with the coefficients given (s), of the beam without any.
  /// along: of twist and length.
  GeneralBeamDamping(const GeneralBeam& beam, double beta, double along);
  system::Dependence depends(const system::Context&) const {
    return {.angle = with.axisymmetric() ? system::no_angle : system::each_angle, .spin = true};
  }
  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
};

/// Part of the viscous law of a full section whose damping is beta times its stiffness K on the rates of
/// its strains, axial strain and twist (1) and the lateral ones (2): K11 alone, or the rest. K12 goes with
/// K22: where the two kinds of strain have one rate (a line that stands, rates in rotating axes) both parts
/// are taken alike and K is whole; above the spin the factor of K22 is that of K11 as well; below it, where
/// their rates have opposite signs, coupling turns with the section, and its mean is zero.
struct SectionBeamDamping {
  enum class Part { along, bending };
  SectionBeam with, without;
  SectionBeamDamping() = default;
  SectionBeamDamping(const SectionBeam& beam, double beta, Part part);
  system::Dependence depends(const system::Context&) const {
    return {.angle = with.axisymmetric() ? system::twist_angle : system::each_angle, .spin = true};
  }
  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
};

/// Viscous: the law with loss factor x stiffness for its coefficients, rotating.
template <class Viscous>
struct HystereticDamping {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::common;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::damping;
  /// The rate of a small motion counts where hysteretic damping has its own form.
  system::Dependence depends(const system::Context& ctx) const;

  Viscous bending;      ///< lateral strains
  Viscous along;        ///< twist and axial strain
  double stand_in = 0;  ///< 1/nu0, s; 0: nothing in motions

  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
};

extern template struct HystereticDamping<ShaftDamping<true>>;
extern template struct HystereticDamping<GeneralBeamDamping>;
extern template struct HystereticDamping<SectionBeamDamping>;

}  // namespace whirl::elements
