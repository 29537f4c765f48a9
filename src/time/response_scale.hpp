// The unit of error: running response of each kind of unknown, and the norms built on it.
#pragma once
#include <time/integrator.hpp>
#include <array>
#include <vector>

namespace whirl::time {

/// Scale of a kind: half the range its largest unknown has swept since reset(), see Scales. Norms
/// are maxima over the unknowns of a kind, then over kinds; spin_angle in the error test is a mean
/// square weighted by polar inertia instead: what turns the unbalance is the heavy disk's angle,
/// and a light shaft end ringing in torsion must not set the step.
class ResponseScale {
 public:
  void resize(std::span<const Kind> kinds, const Scales& options);
  /// The smallest part of a scale that anything is asked to be right to: scales are then so large
  /// that this is above rounding.
  void resolve(double smallest);
  /// Forgets everything; ranges start at q.
  void reset(CRef q);
  /// Row sums of the spin columns of M (any non-negative numbers): weights of the spin_angle mean
  /// square.
  void set_spin_inertia(CRef inertia);
  /// Range of an accepted state.
  void observe(CRef q);
  /// Entries of q were re-expressed (chart change): their ranges start again, the scales stay.
  void rebase(Index i, double q);
  /// Weights for a step whose increments are dq: while nothing has moved yet the step itself is the
  /// response.
  void begin_step(CRef dq);
  /// max_i |x_i| / scale_i of the weights set last.
  double norm(CRef x) const;
  /// Rounding of the coordinates in the same measure: below this no correction means anything.
  double rounding() const;
  /// The same with the inertia-weighted mean of spin_angle.
  double error_norm(CRef x) const;
  /// 1 / scale_i, 0 for held entries.
  const VecX& weights() const { return weight_; }
  double scale(Kind k) const { return used_[static_cast<std::size_t>(k)]; }

  void save(std::vector<double>& out) const;
  const double* restore(const double* in);

 private:
  static constexpr std::size_t kinds_count = 5;
  std::vector<Kind> kinds_;
  Scales options_;
  double offset_share_ = 1e-6;
  std::array<double, kinds_count> swept_{}, size_{},
      used_{};  ///< range and size of the run so far; of the weights
  VecX low_, high_, weight_, inertia_;
  void weigh_singly();
  VecX single_weight_;  ///< weight_, 0 for spin angles
  std::array<std::vector<Index>, kinds_count> of_kind_;
  const std::vector<Index>& internal() const {
    return of_kind_[static_cast<std::size_t>(Kind::internal)];
  }
  const std::vector<Index>& spin() const {
    return of_kind_[static_cast<std::size_t>(Kind::spin_angle)];
  }
};

}  // namespace whirl::time
