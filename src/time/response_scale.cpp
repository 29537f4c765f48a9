#include <time/response_scale.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace whirl::time {
namespace {
constexpr std::size_t of(Kind k) { return static_cast<std::size_t>(k); }
/// Motion below this share of a coordinate's size (a sag, a pre-deflection) is at rest: round-off
/// of the size is near.
constexpr double least_share = 1e-6;
/// Torque on a sagging shaft shakes it by less than the sag times the twist, at all of its frequencies. Motion
/// below ten times that, and below a hundredth of the sag, is not to be followed.
constexpr double shaken_by_twist = 10.0, most_shaken = 1e-2;
/// Rounding of the coordinates a correction carries, in units of the last place: sums over a row of
/// matrices.
constexpr double rounding_units = 4.0 * std::numeric_limits<double>::epsilon();
}  // namespace

void ResponseScale::resize(std::span<const Kind> kinds, const Scales& options) {
  WHIRL_EXPECTS(options.length > 0.0 && options.spin_angle > 0.0);
  kinds_.assign(kinds.begin(), kinds.end());
  options_ = options;
  const auto n = static_cast<Index>(kinds_.size());
  low_ = high_ = weight_ = single_weight_ = inertia_ = VecX::Zero(n);
  for (std::vector<Index>& list : of_kind_)
    list.clear();
  for (Index i = 0; i < n; ++i)
    of_kind_[of(kinds_[at(i)])].push_back(i);
  twist_.resize(kinds, options.twists);
  set_spin_inertia(VecX::Zero(n));
}

void ResponseScale::resolve(double smallest) {
  WHIRL_EXPECTS(smallest > 0.0);
  offset_share_ = std::max(least_share, rounding_units / smallest);
  twist_floor_ = offset_share_;  // angles of nodes are of the order of one
}

void ResponseScale::reset(CRef q) {
  WHIRL_EXPECTS(q.size() == weight_.size());
  low_ = high_ = q;
  swept_.fill(0.0);
  size_.fill(0.0);
  twist_.reset();
  largest_twist_error_ = 0.0;
  if (largest_error_.size() > 0) keep_errors();
  observe(q);
}

void ResponseScale::set_spin_inertia(CRef inertia) {
  WHIRL_EXPECTS(inertia.size() == inertia_.size());
  twist_.set_inertia(inertia);
  double sum = 0.0;
  for (const Index i : spin())
    sum += std::abs(inertia[i]);
  for (const Index i : spin())
    inertia_[i] = sum > 0.0 && std::isfinite(sum) ? std::abs(inertia[i]) / sum
                                                  : 1.0 / static_cast<double>(spin().size());
}

void ResponseScale::observe(CRef q) {
  WHIRL_EXPECTS(q.size() == low_.size());
  low_ = low_.cwiseMin(q);
  high_ = high_.cwiseMax(q);
  for (std::size_t k = 0; k < kinds_count; ++k) {
    double range = 0.0, size = size_[k];
    for (const Index i : of_kind_[k]) {
      range = std::max(range, high_[i] - low_[i]);
      size = std::max(size, std::abs(q[i]));
    }
    swept_[k] = std::max(swept_[k], 0.5 * range);
    size_[k] = size;
  }
}

void ResponseScale::rebase(Index i, double q) { low_[i] = high_[i] = q; }

void ResponseScale::begin_step(CRef dq) {
  WHIRL_EXPECTS(dq.size() == weight_.size());
  std::array<double, kinds_count> s = swept_;
  for (std::size_t k = 0; k < kinds_count; ++k) {
    double largest = 0.0;
    for (const Index i : of_kind_[k])
      largest = std::max(largest, std::abs(dq[i]));
    s[k] = std::max(s[k], 0.5 * largest);
  }
  const Scales& o = options_;
  double& u = s[of(Kind::displacement)];
  double& g = s[of(Kind::tilt)];
  double share = offset_share_;
  if (!twist_.empty()) {
    const double twist = std::max(twist_.swept(), 0.5 * twist_.size(dq));
    twist_scale_ = std::max(twist, twist_floor_);
    share = std::max(share, std::min(shaken_by_twist * twist, most_shaken));
  }
  const double sag = size_[of(Kind::displacement)];
  u = std::max({u, o.displacement, o.floor_displacement, share * sag});
  g = std::max({g, o.tilt, o.floor_tilt, share * size_[of(Kind::tilt)]});
  // a sag tilts a line; what symmetry keeps level is so to the rounding of forces
  g = std::max(g, offset_share_ * sag / o.length);
  const double u0 = u;
  u = std::max(u, o.cross_floor * o.length * g);
  g = std::max(g, o.cross_floor * u0 / o.length);
  const bool fine = spin_by_twist_ && o.follow_twist && !twist_.empty();
  s[of(Kind::spin_angle)] = fine ? std::min(twist_scale_, o.spin_angle) : o.spin_angle;
  s[of(Kind::held)] = infinity;
  if (s != used_) {
    used_ = s;
    for (Index i = 0; i < weight_.size(); ++i)
      weight_[i] = 1.0 / s[of(kinds_[at(i)])];
    for (const Scales::Limit& l : o.limits)
      if (kinds_[at(l.unknown)] != Kind::held)
        weight_[l.unknown] =
            std::max(weight_[l.unknown],
                     1.0 / std::max(l.scale, offset_share_ * size_[of(Kind::displacement)]));
    weigh_singly();
  }
  const double floor = std::max(o.internal, o.floor_internal);
  for (const Index i : internal())
    weight_[i] = 1.0 / std::max({0.5 * (high_[i] - low_[i]), 0.5 * std::abs(dq[i]), floor});
  if (!internal().empty())
    for (const Scales::Limit& l : o.limits)
      if (kinds_[at(l.unknown)] == Kind::internal)
        weight_[l.unknown] = std::max(weight_[l.unknown], 1.0 / l.scale);
  if (!internal().empty()) weigh_singly();
}

void ResponseScale::weigh_singly() {
  single_weight_ = weight_;
  for (const Index i : spin())
    single_weight_[i] = 0.0;
}

double ResponseScale::norm(CRef x) const {
  const double largest = x.cwiseProduct(weight_).lpNorm<Eigen::Infinity>();
  return options_.follow_twist ? std::max(largest, twist_.size(x) / twist_scale_) : largest;
}

double ResponseScale::rounding() const {
  double largest = 0.0;
  for (const Kind k : {Kind::displacement, Kind::tilt})
    if (used_[of(k)] > 0.0) largest = std::max(largest, size_[of(k)] / used_[of(k)]);
  for (const Scales::Limit& l : options_.limits)
    largest = std::max(largest, size_[of(Kind::displacement)] / l.scale);
  if (options_.follow_twist) largest = std::max(largest, 1.0 / twist_scale_);
  return rounding_units * largest;
}

double ResponseScale::error_norm(CRef x) const {
  WHIRL_EXPECTS(x.size() == weight_.size());
  const double largest = x.cwiseAbs().cwiseProduct(single_weight_).maxCoeff();
  // NaN must not be lost in a comparison
  const double sum = x.sum();
  if (!std::isfinite(sum)) return infinity;
  const double twist = options_.follow_twist ? twist_.size(x) / twist_scale_ : 0.0;
  return std::max({largest, turned(x), twist});
}

double ResponseScale::turned(CRef x) const {
  double sum = 0.0;
  for (const Index i : spin())
    sum += inertia_[i] * x[i] * x[i] * weight_[i] * weight_[i];
  return std::sqrt(sum);
}

void ResponseScale::keep_errors() {
  largest_error_ = sum_of_errors_ = VecX::Zero(weight_.size());
  largest_turned_ = sum_turned_ = errors_ = 0.0;
}

void ResponseScale::observe_error(CRef x) {
  largest_twist_error_ = std::max(largest_twist_error_, twist_.size(x));
  if (largest_error_.size() == 0) return;
  const double turn = turned(x);
  largest_error_ = largest_error_.cwiseMax(x.cwiseAbs());
  largest_turned_ = std::max(largest_turned_, turn);
  sum_of_errors_ += x.cwiseAbs();
  sum_turned_ += turn;
  errors_ += 1.0;
}

double ResponseScale::mean_error() const {
  return errors_ > 0.0 ? kept_norm(sum_of_errors_, sum_turned_) / errors_ : 0.0;
}

double ResponseScale::kept_norm(const VecX& x, double turned) const {
  return std::max(x.cwiseProduct(single_weight_).maxCoeff(), turned);
}

void ResponseScale::save(std::vector<double>& out) const {
  out.insert(out.end(), swept_.begin(), swept_.end());
  out.insert(out.end(), size_.begin(), size_.end());
  twist_.save(out);
  out.insert(out.end(), {largest_turned_, sum_turned_, errors_, largest_twist_error_});
  for (const VecX* x : {&low_, &high_, &inertia_, &largest_error_, &sum_of_errors_})
    out.insert(out.end(), x->data(), x->data() + x->size());
}

const double* ResponseScale::restore(const double* in) {
  std::copy_n(in, kinds_count, swept_.begin());
  std::copy_n(in + kinds_count, kinds_count, size_.begin());
  in += 2 * kinds_count;
  in = twist_.restore(in);
  for (double* c : {&largest_turned_, &sum_turned_, &errors_, &largest_twist_error_})
    *c = *in++;
  for (VecX* x : {&low_, &high_, &inertia_, &largest_error_, &sum_of_errors_}) {
    std::copy_n(in, x->size(), x->data());
    in += x->size();
  }
  return in;
}

}  // namespace whirl::time
