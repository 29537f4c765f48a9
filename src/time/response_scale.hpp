// The unit of error: running response of each kind of unknown, and the norms built on it.
#pragma once
#include <time/integrator.hpp>
#include <time/twist_scale.hpp>
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
  /// Twist of an accepted step from q0 to q; again: in place of the step before.
  void observe_twist(CRef q0, CRef q, bool again) {
    if (!twist_.empty()) twist_.observe(q0, q, again);
  }
  /// For schemes that know no norms but that of their weights: spin angles as finely as the twist.
  void weigh_spin_by_twist() { spin_by_twist_ = true; }
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
  /// Errors of accepted steps are kept from now on, to be measured by the response of the whole run:
  /// steps of a given length are not to blame for errors of a motion that had hardly begun.
  void keep_errors();
  /// Whether anything is made of the errors of steps.
  bool keeps_errors() const { return largest_error_.size() > 0 || !twist_.empty(); }
  /// One step's error in the unit of each unknown.
  void observe_error(CRef x);
  /// error_norm() of the largest errors kept, and of their means, by the scales set last.
  double largest_error() const {
    const double largest = kept_norm(largest_error_, largest_turned_);
    return options_.follow_twist ? std::max(largest, twist_error()) : largest;
  }
  double mean_error() const;
  /// Half the range of twist, rad, and the largest error of a step in it, a share of that range.
  /// Nothing has moved but in twist.
  bool twists_alone() const {
    const auto moves = [this](Kind k, double floor) {
      const auto i = static_cast<std::size_t>(k);
      return swept_[i] > std::max(floor, offset_share_ * size_[i]);
    };
    return twist_.swept() > 0.0 && !moves(Kind::displacement, options_.floor_displacement) &&
           !moves(Kind::tilt, options_.floor_tilt);
  }
  double twist() const { return twist_.swept(); }
  double twist_error() const {
    return twist() > 0.0 ? largest_twist_error_ / std::max(twist(), twist_floor_) : 0.0;
  }
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
  double turned(CRef x) const;
  double kept_norm(const VecX& x, double turned) const;
  VecX largest_error_, sum_of_errors_;  ///< empty: not kept
  TwistScale twist_;
  double twist_floor_ = 1e-6, twist_scale_ = 1.0;  ///< rad
  double largest_twist_error_ = 0.0;               ///< rad
  bool spin_by_twist_ = false;
  double largest_turned_ = 0.0, sum_turned_ = 0.0, errors_ = 0.0;
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
