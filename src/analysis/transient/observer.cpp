#include <analysis/transient/observer.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

Recorder::Recorder(std::vector<Measurement> channels, RowSink sink, double t_begin, double every,
                   double t0, double t1, Gate gate)
    : channels_(std::move(channels)),
      sink_(std::move(sink)),
      gate_(std::move(gate)),
      ticker_(t_begin, every),
      every_(every),
      t0_(t0),
      t1_(t1) {
  WHIRL_EXPECTS(every >= 0.0 && sink_ != nullptr);
  std::size_t n = 1;
  for (const Measurement& m : channels_)
    n += m.width();
  row_.resize(n);
}

void Recorder::write(const Snapshot& s) {
  if (gate_ && !gate_(s)) return;
  row_[0] = s.t();
  double* out = row_.data() + 1;
  for (const Measurement& m : channels_) {
    m.evaluate(s, out);
    out += m.width();
  }
  sink_(row_);
  ++rows_;
}

void Recorder::begin(const Snapshot& s) {
  if (s.t() >= t0_ && s.t() <= t1_) write(s);
  ticker_.advance();
}

void Recorder::step(StepAccess& s) {
  if (every_ <= 0.0) {
    if (s.t1() >= t0_ && s.t1() <= t1_) write(s.end());
    return;
  }
  // a tick within round-off of the step's end belongs to this step
  const double slack = 1e-12 * std::max(std::abs(s.t1()), every_);
  if (s.t1() < t0_ || s.t0() > t1_) {  // outside the window nothing is evaluated
    ticker_.pass(s.t1() + slack);
    return;
  }
  if (s.t0() < t0_) ticker_.pass(t0_ - slack);
  for (; ticker_.next() <= s.t1() + slack; ticker_.advance())
    if (const double t = std::min(ticker_.next(), s.t1()); t >= t0_ && t <= t1_) write(s.at(t));
}

void Recorder::save(OutArchive& out) const {
  out.put_count(static_cast<std::uint64_t>(ticker_.count()));
  out.put_count(static_cast<std::uint64_t>(rows_));
}

void Recorder::restore(InArchive& in) {
  ticker_.set_count(static_cast<long>(in.count()));
  rows_ = static_cast<long>(in.count());
}

PeakTracker::PeakTracker(const std::vector<std::pair<std::string, Point>>& points, Index reference,
                         double t_from, std::vector<Index> turns_of)
    : turns_of_(std::move(turns_of)),
      motions_(turns_of_.size()),
      last_(turns_of_.size(), Vec2::Zero()),
      reference_(reference),
      t_from_(t_from) {
  WHIRL_EXPECTS(turns_of_.empty() || turns_of_.size() == points.size());
  points_.reserve(points.size());
  peaks_.reserve(points.size());
  for (const auto& [name, point] : points) {
    points_.push_back(point);
    peaks_.push_back({name, 0.0, 0.0, 0.0});
  }
}

void PeakTracker::begin(const Snapshot& s) {
  for (Peak& p : peaks_) {
    p.time = s.t();
    p.speed = s.node(reference_).spin();
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec2 u = displacement(s, points_[i]).tail<2>();
    peaks_[i].amplitude = u.norm();
    if (motions_.empty()) continue;
    last_[i] = u;
    motions_[i].begin(u, s.t(), s.total_phi(turns_of_[i]));
  }
}

namespace {

/// Weights of the polynomial through n + 1 equally spaced values at x in [0, n] (barycentric form:
/// J.-P. Berrut and L. N. Trefethen, SIAM Review 46, 2004).
template <std::size_t N>
std::array<double, N> lagrange(double x) {
  static const auto signed_binomials = [] {
    std::array<double, N> w{};
    double c = 1;
    for (std::size_t k = 0; k < N; ++k) {
      w[k] = k % 2 == 0 ? c : -c;
      c = c * static_cast<double>(N - 1 - k) / static_cast<double>(k + 1);
    }
    return w;
  }();
  std::array<double, N> w{};
  double sum = 0;
  for (std::size_t k = 0; k < N; ++k) {
    const double d = x - static_cast<double>(k);
    if (d == 0.0) {
      w = {};
      w[k] = 1;
      return w;
    }
    w[k] = signed_binomials[k] / d;
    sum += w[k];
  }
  for (double& x_k : w)
    x_k /= sum;
  return w;
}

}  // namespace

namespace {

/// What the amplitude of a point does not pass in a step: its largest look, and twice what the parabola
/// through that one and its neighbours rises above it.
template <std::size_t N>
double reach_of(const std::array<std::vector<Vec2>, N>& seen, std::size_t point) {
  std::array<double, N> square;
  for (std::size_t k = 0; k < N; ++k)
    square[k] = seen[k][point].squaredNorm();
  const std::size_t top =
      static_cast<std::size_t>(std::max_element(square.begin(), square.end()) - square.begin());
  const std::size_t middle = std::clamp<std::size_t>(top, 1, N - 2);
  const double before = std::sqrt(square[middle - 1]), here = std::sqrt(square[middle]),
               after = std::sqrt(square[middle + 1]), highest = std::sqrt(square[top]);
  const double slope = 0.5 * (after - before);
  const double curvature = 2.0 * here - after - before;
  if (!(std::abs(slope) <= curvature)) return highest;  // the vertex lies beyond the neighbours
  const double vertex = curvature > 0.0 ? here + 0.5 * slope * slope / curvature : here;
  return highest + 2.0 * std::max(0.0, vertex - highest);
}

}  // namespace

void PeakTracker::look(StepAccess& s, int k) {
  s.displacements(time_of(s, k), points_, seen_[static_cast<std::size_t>(k)]);
}

void PeakTracker::widen(StepAccess& s) {
  const Snapshot& end = s.end();
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const std::array<Vec2, OrbitWidth::looks> path{last_[i], seen_[2][i], seen_[4][i], seen_[6][i],
                                                   seen_[8][i]};
    motions_[i].step(path, s.t0(), s.t1());
    motions_[i].turned_to(end.total_phi(turns_of_[i]), path.back(), s.t1());
    last_[i] = path.back();
  }
}

void PeakTracker::step(StepAccess& s) {
  if (s.t1() < t_from_) return;
  spin_known_ = false;
  // Four looks a step bracket a maximum; golden section finishes a new one.
  for (int k = 2; k < looks; k += 2)
    look(s, k);
  if (!motions_.empty()) widen(s);
  bool complete = false;
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    double square = 0.0, where = looks - 1;
    for (int k = 2; k < looks; k += 2)
      if (const double r = seen_[static_cast<std::size_t>(k)][i].squaredNorm(); r > square) {
        square = r;
        where = k;
      }
    const double best = std::sqrt(square);
    if (best < 0.9 * peaks_[i].amplitude) continue;
    for (int k : {0, 1, 3, 5, 7})
      if (!complete) look(s, k);
    complete = true;
    refine(s, i, best, where);
  }
}

void PeakTracker::refine(StepAccess& s, std::size_t point, double best, double where) {
  const auto radius = [&](double x) {
    const std::array<double, looks> w = lagrange<looks>(x);
    Vec2 u = Vec2::Zero();
    for (std::size_t k = 0; k < looks; ++k)
      u += w[k] * seen_[k][point];
    return u.norm();
  };
  Peak& peak = peaks_[point];
  if (reach_of(seen_, point) <= peak.amplitude) return;
  const auto take = [&](double x, double r) {
    if (!(r > best)) return;
    best = r;
    where = x;
  };
  const auto keep = [&] {
    if (!(best > peak.amplitude)) return;
    peak.amplitude = best;
    peak.time = time_of(s, where);
    peak.speed = spin_at(s, where);
  };
  double a = std::max(0.0, where - 2), b = std::min<double>(looks - 1, where + 2);
  if (const double x = vertex_in(a, b, where, point); x >= a) {
    take(x, radius(x));
    return keep();
  }
  constexpr double golden = 0.6180339887498949;
  double x1 = b - golden * (b - a), x2 = a + golden * (b - a), r1 = radius(x1), r2 = radius(x2);
  for (int k = 0; k < 24 && best > 0.99 * peak.amplitude; ++k) {
    if (r1 > r2) {
      b = x2;
      x2 = x1;
      r2 = r1;
      x1 = b - golden * (b - a);
      r1 = radius(x1);
    } else {
      a = x1;
      x1 = x2;
      r1 = r2;
      x2 = a + golden * (b - a);
      r2 = radius(x2);
    }
  }
  take(x1, r1);
  take(x2, r2);
  keep();
}

double PeakTracker::vertex_in(double a, double b, double x, std::size_t point) const {
  // the polynomial through the looks, in Newton's form: u and its derivatives with x
  std::array<Vec2, looks> c;
  for (std::size_t k = 0; k < looks; ++k)
    c[k] = seen_[k][point];
  for (std::size_t order = 1; order < looks; ++order)
    for (std::size_t k = looks - 1; k >= order; --k)
      c[k] = (c[k] - c[k - 1]) / static_cast<double>(order);
  for (int again = 0; again < 8; ++again) {
    Vec2 u = c[looks - 1], u1 = Vec2::Zero(), u2 = Vec2::Zero();
    for (std::size_t k = looks - 1; k-- > 0;) {
      const double d = x - static_cast<double>(k);
      u2 = u2 * d + 2.0 * u1;
      u1 = u1 * d + u;
      u = u * d + c[k];
    }
    const double slope = u.dot(u1), bend = u1.squaredNorm() + u.dot(u2);  // of half the square
    if (!(bend < 0.0)) return -1.0;
    const double next = std::clamp(x - slope / bend, a, b);  // or where it still rises at an end
    if (std::abs(next - x) < 1e-7) return next;
    x = next;
  }
  return -1.0;
}

double PeakTracker::spin_at(StepAccess& s, double k) {
  if (points_.size() <= static_cast<std::size_t>(spins))  // a state a peak costs no more
    return s.spin(time_of(s, k), reference_);
  const auto look_at = [&](std::size_t i) {
    spin_[i] = s.spin(time_of(s, 2.0 * static_cast<double>(i)), reference_);
  };
  if (!spin_known_) {
    for (const std::size_t i : {0u, 2u, 4u})
      look_at(i);
    // what nearly keeps its speed asks for no more
    constexpr double straight = 1e-7;
    if (std::abs(spin_[0] - 2.0 * spin_[2] + spin_[4]) <= straight * std::abs(spin_[2])) {
      spin_[1] = 0.125 * (3.0 * spin_[0] + 6.0 * spin_[2] - spin_[4]);
      spin_[3] = 0.125 * (3.0 * spin_[4] + 6.0 * spin_[2] - spin_[0]);
    } else {
      look_at(1);
      look_at(3);
    }
  }
  spin_known_ = true;
  const std::array<double, spins> w = lagrange<spins>(0.5 * k);
  double spin = 0;
  for (std::size_t i = 0; i < w.size(); ++i)
    spin += w[i] * spin_[i];
  return spin;
}

void PeakTracker::save(OutArchive& out) const {
  for (const Peak& p : peaks_) {
    out.put(p.amplitude);
    out.put(p.time);
    out.put(p.speed);
  }
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    motions_[i].save(out);
    for (const double x : last_[i])
      out.put(x);
  }
}

void PeakTracker::restore(InArchive& in) {
  for (Peak& p : peaks_) {
    p.amplitude = in.number();
    p.time = in.number();
    p.speed = in.number();
  }
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    motions_[i].restore(in);
    for (double& x : last_[i])
      x = in.number();
  }
}

void EnergyBalance::begin(const Snapshot& s) {
  const auto p = s.power();
  e0_ = e1_ = p.stored;
  kinetic0_ = p.kinetic;
  exchanged_ = s.vibration_energy();  // a steady whirl exchanges nothing
  largest_kinetic_ = p.kinetic;
  largest_potential_ = std::abs(p.stored - p.kinetic);
}

namespace {

/// Radau points of a step: the collocation polynomial is most accurate there, and the quadrature has
/// order 5.
struct RadauPoints {
  double c[3], b[3];
};
const RadauPoints& radau_points() {
  static const double r6 = std::sqrt(6.0);
  static const RadauPoints points{{(4.0 - r6) / 10.0, (4.0 + r6) / 10.0, 1.0},
                                  {(16.0 - r6) / 36.0, (16.0 + r6) / 36.0, 1.0 / 9.0}};
  return points;
}

}  // namespace

bool EnergyBalance::jumps_at(double t) const {
  return std::binary_search(jumps_.begin(), jumps_.end(), t);
}

void EnergyBalance::step_by_residual(StepAccess& s, double work) {
  const auto& [c, b] = radau_points();
  const double h = s.t1() - s.t0();
  double lost = 0.0;
  for (int k = 0; k < 2; ++k)
    lost += h * b[k] * s.dissipation(s.t0() + c[k] * h);
  if (jumps_at(s.t1())) {
    lost += h * b[2] * s.dissipation(std::nextafter(s.t1(), -infinity));
  } else {
    lost += h * b[2] * s.end().energy().dissipated;
  }
  const system::Energy& e = s.end().energy();
  const double stored = e.kinetic + e.elastic + e.gravity;
  dissipated_ += lost;
  supplied_ += (stored - e1_) + lost - work;
  e1_ = stored;
  add_rounding(s, stored, e.kinetic);
  look({stored, e.kinetic});
}

void EnergyBalance::add_rounding(StepAccess& s, double stored, double kinetic) {
  constexpr double last_digit = 2.2e-16;
  rounding_ += 20 * last_digit * std::max(std::abs(stored), kinetic);
  for (const Driven& d : driven_) {
    const auto& node = s.end().node(d.node);
    const double turned = std::abs(node.spin()) * (s.t1() - s.t0());
    const double angle = std::abs(node.phi) + turned;  // without the whole turns before the step
    rounding_ += 2 * last_digit * angle * d.stiffness * turned;
  }
}

void EnergyBalance::step(StepAccess& s) {
  if (jumps_at(s.t0())) {  // a speed that jumps gives or takes energy by an impulse
    const double after = s.at(s.t0()).power().stored;
    supplied_ += after - e1_;
    e1_ = after;
  }
  if (const std::optional<double> work = s.residual_work()) return step_by_residual(s, *work);
  const auto& [c, b] = radau_points();
  const double h = s.t1() - s.t0();
  for (int k = 0; k < 2; ++k) {
    const auto p = s.exchange(s.t0() + c[k] * h);
    supplied_ += h * b[k] * p.supplied;
    dissipated_ += h * b[k] * p.dissipated;
  }
  // Where laws jump, the end of the step sees them from the left.
  const bool jump = jumps_at(s.t1());
  const auto p = jump ? s.at(std::nextafter(s.t1(), -infinity)).power() : s.end().power();
  supplied_ += h * b[2] * p.supplied;
  dissipated_ += h * b[2] * p.dissipated;
  e1_ = p.stored;
  add_rounding(s, p.stored, p.kinetic);
  look(p);
  if (!jump) return;
  const double after = s.end().power().stored;
  supplied_ += after - e1_;
  e1_ = after;
}

void EnergyBalance::look(const time::Problem::Power& p) {
  known_ = known_ && std::isfinite(defect());
  largest_kinetic_ = std::max(largest_kinetic_, p.kinetic);
  largest_potential_ = std::max(largest_potential_, std::abs(p.stored - p.kinetic));
  const double kinetic = p.kinetic - kinetic0_;
  const double stored = p.stored - e0_;
  for (const double x : {kinetic, stored - kinetic, stored, supplied_, dissipated_})
    exchanged_ = std::max(exchanged_, std::abs(x));
  worst_ = std::max(worst_, std::abs(defect()));
}

void EnergyBalance::save(OutArchive& out) const {
  for (double x : {e0_, kinetic0_, e1_, supplied_, dissipated_, worst_, largest_kinetic_,
                   largest_potential_, exchanged_, rounding_})
    out.put(x);
  out.put_count(known_ ? 1 : 0);
}

void EnergyBalance::restore(InArchive& in) {
  for (double* x : {&e0_, &kinetic0_, &e1_, &supplied_, &dissipated_, &worst_, &largest_kinetic_,
                    &largest_potential_, &exchanged_, &rounding_})
    *x = in.number();
  known_ = in.count() != 0;
}

void TiltWatch::save(OutArchive& out) const {
  out.put(tilt_);
  out.put(time_);
  out.put_count(static_cast<std::uint64_t>(node_));
}
void TiltWatch::restore(InArchive& in) {
  tilt_ = in.number();
  time_ = in.number();
  node_ = static_cast<Index>(in.count());
}

void TiltWatch::look(const Snapshot& s) {
  for (Index i = 0; i < s.system().nodes(); ++i)
    if (const double g = s.q().segment<2>(6 * i + system::gamma2).norm(); g > tilt_) {
      tilt_ = g;
      time_ = s.t();
      node_ = i;
    }
}

}  // namespace whirl::analysis
