#include <analysis/spectra/rotating_axes.hpp>
#include <core/contract.hpp>

#include <analysis/statics/definiteness.hpp>
#include <core/error.hpp>
#include <la/block_lu.hpp>
#include <la/direct.hpp>
#include <la/eigen.hpp>
#include <la/multiply.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace whirl::analysis {

namespace {

constexpr std::size_t idx(Index i) { return static_cast<std::size_t>(i); }

/// The turn of one node's unknowns about its axis by an angle; derivative: d/d theta.
Matrix<6> turn(const system::System& s, const Mat3& chart, Index node, double theta,
               bool derivative) {
  Matrix<6> T = Matrix<6>::Zero();
  if (s.node(node).scalar) return derivative ? T : Matrix<6>(Matrix<6>::Identity());
  const double c = std::cos(theta), k = std::sin(theta);
  Mat3 R = Mat3::Zero();
  Eigen::Matrix2d r;
  if (derivative)
    r << -k, -c, c, -k;
  else
    r << c, -k, k, c;
  R.block<2, 2>(1, 1) = r;
  if (!derivative) {
    R(0, 0) = 1.0;
    T(3, 3) = 1.0;
  }
  T.block<3, 3>(0, 0) = chart * R * chart.transpose();
  T.block<2, 2>(4, 4) = r;
  return T;
}

double largest(const la::BlockMatrix<6>& a) {
  double m = 0;
  for (std::size_t i = 0; i < a.value_count(); ++i)
    m = std::max(m, std::abs(a.data()[i]));
  return m;
}

double difference(const la::BlockMatrix<6>& a, const la::BlockMatrix<6>& b) {
  double m = 0;
  for (std::size_t i = 0; i < a.value_count(); ++i)
    m = std::max(m, std::abs(a.data()[i] - b.data()[i]));
  return m / std::max(largest(a), 1e-300);
}

bool larger_than_rounding(const Matrix<6>& change, const Matrix<6>& of) {
  constexpr double rounding = 1e-13;
  return change.cwiseAbs().maxCoeff() > rounding * of.cwiseAbs().maxCoeff();
}

/// Differences below this are no periodicity: sagging rotors and their unbalance leave parts per
/// million.
constexpr double steady = 1e-6;

/// Growth, relative to the speed, in a band that harmonics left out would have made. (They move
/// eigenvalues by its square.)
constexpr double negligible = 1e-6;

/// Unbalanced force, relative to the largest reaction, up to which an equilibrium serves another
/// speed: what varies with the speed in a sagging shaft is far smaller than the sag.
constexpr double unbalanced_share = 1e-8;

/// How strongly what changes over the revolution joins the motions of least frequency of the
/// constant matrices.
class Coupling {
 public:
  Coupling(const la::MCK& constant, std::span<const unsigned char> active) {
    la::ModeOptions options;
    options.count = 8;
    for (la::Mode& m : la::quadratic_modes(constant, active, options)) {
      VecXc Mx, Cx, Kx;
      la::multiply(constant, m.x, Mx, Cx, Kx);
      const double size = std::abs(m.x.dot(2.0 * m.lambda * Mx + Cx));
      if (m.lambda.imag() == 0.0 || !(size > 0.0)) continue;
      m.x /= std::sqrt(size);
      modes_.push_back(std::move(m));
    }
  }
  /// Largest rate, 1/s, that the difference of two sets of matrices gives one of the motions from
  /// another: |x_i^H (Q - R)(lambda_j) x_j| of motions with |x^H Q0' x| = 1.
  double rate(const la::MCK& m, const la::MCK& other) const {
    double most = 0.0;
    VecXc M1, C1, K1, M0, C0, K0;
    for (const la::Mode& j : modes_) {
      la::multiply(m, j.x, M1, C1, K1);
      la::multiply(other, j.x, M0, C0, K0);
      const VecXc y = j.lambda * (j.lambda * (M1 - M0) + (C1 - C0)) + (K1 - K0);
      for (const la::Mode& i : modes_)
        most = std::max({most, std::abs(i.x.dot(y)), std::abs(i.x.conjugate().dot(y))});
    }
    return most;
  }

  /// rad/s, ascending: of the motions looked at.
  std::vector<double> frequencies() const {
    std::vector<double> out;
    for (const la::Mode& m : modes_)
      out.push_back(std::abs(m.lambda.imag()));
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  std::vector<la::Mode> modes_;
};

/// Of every part of a node what is active of the node.
std::vector<unsigned char> active_of(std::span<const unsigned char> nodes, Index parts) {
  std::vector<unsigned char> out;
  for (std::size_t i = 0; i + 6 <= nodes.size(); i += 6)
    for (Index a = 0; a < parts; ++a)
      out.insert(out.end(), nodes.begin() + static_cast<std::ptrdiff_t>(i),
                 nodes.begin() + static_cast<std::ptrdiff_t>(i + 6));
  return out;
}

}  // namespace

void RotatingAxes::require(const SteadySystem& running) {
  if (running.orders().size() > 1)
    throw run_error(
        "E88",
        "an asymmetric or cracked shaft among shafts of different speeds: no axes exist in which "
        "the matrices are constant or have one period",
        "give the shafts one speed_ratio, or use a transient step");
}

RotatingAxes::RotatingAxes(Linearizer& linear, double Omega, Harmonics harmonics, Motion motion)
    : linear_(linear),
      motion_(linear.system(), motion, linear.running().spinning(), MotionReduction::Twist::held),
      arm_(0.1 * model_length(linear.system())),
      turned_(linear.system().make_matrices()),
      raw_(linear.system().make_matrices()) {
  WHIRL_EXPECTS(harmonics.least >= 1 && harmonics.most >= harmonics.least);
  require(linear.running());
  find_ratio(Omega);
  // What varies: in fixed axes (then there is something to do), and in rotating ones, over one and
  // half a revolution.
  sample(Omega, 0.0, {});
  const la::MCK first = turned_;
  const la::MCK fixed = raw_;
  const Coupling coupling(first, motion_.active());
  frequencies_ = coupling.frequencies();
  double varies = 0, half = 0, joined = 0, joined_by_half = 0;
  for (const double theta : {0.7, 1.9, 2.6}) {
    sample(Omega, theta, {});
    joined = std::max(joined, coupling.rate(turned_, first));
    varies = std::max({varies, difference(first.M, turned_.M), difference(first.K, turned_.K)});
    turning_ =
        turning_ || difference(fixed.K, raw_.K) > steady || difference(fixed.M, raw_.M) > steady;
    const la::MCK here = turned_;
    sample(Omega, theta + pi, {});
    half = std::max({half, difference(here.M, turned_.M), difference(here.K, turned_.K)});
    joined_by_half = std::max(joined_by_half, coupling.rate(turned_, here));
  }
  harmonics_ = varies > steady ? harmonics.least : 0;
  // the sag of a shaft has the period of a revolution, but joins next to nothing
  constexpr double sag = 1e-3;
  const bool joins_little =
      !frequencies_.empty() && half < sag && joined_by_half <= negligible * std::abs(speed(Omega));
  step_ = half > steady && !joins_little ? 1 : 2;
  // A harmonic left out is joined to the constant part by those before it.
  const double slowest = std::isnan(harmonics.slowest) ? Omega : harmonics.slowest;
  const double share = joined / std::max(std::abs(speed(slowest)), 1e-300);
  while (harmonics_ > 0 && harmonics_ < harmonics.most &&
         !(std::pow(share, static_cast<double>(harmonics_ + 1)) < negligible))
    ++harmonics_;
  if (harmonics_ == 0) {
    pattern_ = &linear.system().pattern();
    active_.assign(motion_.active().begin(), motion_.active().end());
    return;
  }
  const Index parts = 2 * harmonics_ + 1;
  own_pattern_ = make_pattern(parts);
  pattern_ = own_pattern_.get();
  hill_ = la::MCK(*own_pattern_);
  active_ = active_of(motion_.active(), parts);
}

std::unique_ptr<la::BlockPattern> RotatingAxes::make_pattern(Index parts) const {
  const la::BlockPattern& p = linear_.system().pattern();
  std::vector<std::pair<Index, Index>> couplings;
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[idx(i)]; s < p.row_start()[idx(i) + 1]; ++s)
      for (Index a = 0; a < parts; ++a)
        for (Index b = 0; b < parts; ++b)
          couplings.emplace_back(parts * i + a, parts * p.cols()[idx(s)] + b);
  return std::make_unique<la::BlockPattern>(parts * p.size(), couplings);
}

void RotatingAxes::find_ratio(double Omega) {
  const system::System& s = linear_.system();
  const la::BlockPattern& p = s.pattern();
  double turns = 0;
  for (Index i = 0; i < s.nodes() && turns == 0; ++i)
    if (!s.node(i).scalar && s.node(i).line >= 0) turns = linear_.running().ratio(s.node(i).line);
  if (turns != 0) ratio_ = turns;
  sample(Omega, 0.0, {});
  const la::MCK first = raw_;
  const double K = steady * largest(first.K), M = steady * largest(first.M);
  sample(Omega, 0.7, {});
  double found = 0;
  for (Index i = 0; i < s.nodes(); ++i) {
    const double ratio =
        s.node(i).scalar || s.node(i).line < 0 ? 0.0 : linear_.running().ratio(s.node(i).line);
    if (ratio == 0) continue;
    const Index own = p.slot(i, i);
    const bool varies = (first.K.block(own) - raw_.K.block(own)).cwiseAbs().maxCoeff() > K ||
                        (first.M.block(own) - raw_.M.block(own)).cwiseAbs().maxCoeff() > M;
    if (!varies) continue;
    if (found * ratio < 0)
      throw run_error(
          "E88",
          "asymmetric or cracked shafts that turn against one another: no axes exist in "
          "which the matrices are constant or have one period",
          "use a transient step");
    found = ratio;
  }
  if (found != 0) ratio_ = found;
}

bool RotatingAxes::still_balanced(double Omega) {
  if (!moved_) return false;
  const Equilibrium& e = linear_.equilibrium();
  if (e.Omega == Omega && Omega != 0.0) return true;
  double force = 0.0;
  for (Index k = 0; k < e.reactions.size(); ++k)
    if (k % 6 < 3) force = std::max(force, std::abs(e.reactions[k]));
  VecX r(e.state.q.size());
  if (!linear_.running().residual(e.state.frames, Omega, e.state.q, r)) return false;
  const std::vector<unsigned char> free = free_unknowns(linear_.system(), e.holds());
  for (Index k = 0; k < r.size(); ++k)
    if (free[idx(k)] && std::abs(r[k]) > unbalanced_share * force * (k % 6 < 3 ? 1.0 : arm_))
      return false;
  return true;
}

void RotatingAxes::sample(double Omega, double theta, Complex lambda, bool without_series) {
  WHIRL_EXPECTS(std::isfinite(theta));
  if (!still_balanced(Omega)) linear_.move_to(Omega);
  moved_ = true;
  const Equilibrium& e = linear_.equilibrium();
  SteadySystem& running = linear_.running();
  running.set_whirl(lambda, true);
  const bool inside =
      without_series ? running.tangent_without_series_at(e.state.frames, Omega, e.state.q,
                                                         theta / ratio_, raw_)
                     : running.tangent_at(e.state.frames, Omega, e.state.q, theta / ratio_, raw_);
  running.set_whirl(0.0);
  if (!inside)
    throw run_error("E76", "no linearisation: the state lies outside the range of an element");
  const system::System& s = linear_.system();
  const la::BlockPattern& p = s.pattern();
  const la::MCK& fixed = motion_.reduce(raw_);
  const double W = speed(Omega);
  std::vector<Matrix<6>> T(idx(s.nodes())), D(idx(s.nodes()));
  for (Index i = 0; i < s.nodes(); ++i) {
    const Mat3& chart = e.state.frames.axes(i);
    T[idx(i)] = turn(s, chart, i, theta, false);
    D[idx(i)] = turn(s, chart, i, 0.0, true);
  }
  for (Index i = 0; i < p.size(); ++i)
    for (Index k = p.row_start()[idx(i)]; k < p.row_start()[idx(i) + 1]; ++k) {
      const Index j = p.cols()[idx(k)];
      const Matrix<6> M = T[idx(i)].transpose() * fixed.M.block(k) * T[idx(j)],
                      C = T[idx(i)].transpose() * fixed.C.block(k) * T[idx(j)];
      const Matrix<6> MJ = M * D[idx(j)];
      turned_.M.block(k) = M;
      turned_.C.block(k) = C + 2.0 * W * MJ;
      turned_.K.block(k) = T[idx(i)].transpose() * fixed.K.block(k) * T[idx(j)] +
                           W * C * D[idx(j)] + W * W * MJ * D[idx(j)];
    }
}

const la::MCK& RotatingAxes::at(double Omega, Complex lambda) {
  if (harmonics_ == 0) {
    sample(Omega, 0.0, lambda);
    return turned_;
  }
  balance(Omega, lambda, orders(), balance_, hill_);
  hill_speed_ = speed(Omega);
  return hill_;
}

la::Mode RotatingAxes::copy(const la::Mode& mean, Index h, double w) const {
  const Index parts = 2 * harmonics_ + 1, cosine = 2 * std::abs(h) - 1;
  la::Mode out;
  out.lambda = mean.lambda + Complex(0.0, static_cast<double>(h * step_) * w);
  out.x = VecXc::Zero(6 * pattern_->size());
  for (Index i = 0; i < linear_.system().nodes(); ++i) {
    const auto own = mean.x.segment<6>(6 * i);
    if (h == 0) {
      out.x.segment<6>(6 * parts * i) = own;
      continue;
    }
    // exp(-i h theta), so that the motion is that of the mean
    out.x.segment<6>(6 * (parts * i + cosine)) = own;
    out.x.segment<6>(6 * (parts * i + cosine + 1)) = Complex(0.0, h > 0 ? -1.0 : 1.0) * own;
  }
  if (out.lambda.imag() < 0.0) {
    out.lambda = std::conj(out.lambda);
    out.x = out.x.conjugate().eval();
  }
  return out;
}

std::vector<la::Mode> RotatingAxes::motions_and_copies(const la::ModeOptions& options) const {
  WHIRL_EXPECTS(!constant());
  const la::BlockPattern& p = linear_.system().pattern();
  const Index parts = 2 * harmonics_ + 1;
  la::MCK mean = linear_.system().make_matrices();
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[idx(i)]; s < p.row_start()[idx(i) + 1]; ++s) {
      const Index from = pattern_->slot(parts * i, parts * p.cols()[idx(s)]);
      mean.M.block(s) = hill_.M.block(from);
      mean.C.block(s) = hill_.C.block(from);
      mean.K.block(s) = hill_.K.block(from);
    }
  std::vector<la::Mode> out;
  for (const la::Mode& m : la::quadratic_modes(mean, motion_.active(), options))
    for (Index h = m.lambda.imag() == 0.0 ? 0 : -harmonics_; h <= harmonics_; ++h)
      out.push_back(copy(m, h, hill_speed_));
  return out;
}

std::vector<Index> RotatingAxes::orders() const {
  std::vector<Index> out;
  for (Index h = 0; h <= harmonics_; ++h)
    out.push_back(step_ * h);
  return out;
}

void RotatingAxes::balance(double Omega, Complex lambda, const std::vector<Index>& orders,
                           std::unique_ptr<HarmonicBalance>& kept, la::MCK& out) {
  if (!kept) kept = std::make_unique<HarmonicBalance>(orders, step_);
  const HarmonicBalance& of = *kept;
  // the trapezoidal rule: exact up to the harmonic of its points less those of the product
  const Index points = constant() ? 1 : 2 * of.parts() + 2;
  const bool in_series = !constant() && !linear_.running().series().empty();
  const double W = speed(Omega);
  const la::BlockPattern& p = linear_.system().pattern();
  for (la::BlockMatrix<6>* m : {&out.M, &out.C, &out.K})
    m->set_zero();
  changing_.assign(idx(p.blocks()), -1);
  changes_.clear();
  for (Index n = 0; n < points; ++n) {
    const double theta = two_pi / static_cast<double>(step_ * points) * static_cast<double>(n);
    sample(Omega, theta, lambda, in_series);
    if (n == 0)
      first_ = turned_;
    else
      note_changes(of, theta, points);
  }
  for (Index i = 0; i < p.size(); ++i)
    for (Index k = p.row_start()[idx(i)]; k < p.row_start()[idx(i) + 1]; ++k) {
      const Index j = p.cols()[idx(k)];
      of.add(0, i, j, W, first_.M.block(k), first_.C.block(k), first_.K.block(k), out);
      if (changing_[idx(k)] < 0) continue;
      const Changes& c = changes_[idx(changing_[idx(k)])];
      for (Index h = 0; h < of.waves(); ++h) {
        const Eigen::Map<const Matrix<6>> M(c.col(h).data()), C(c.col(h).data() + 36),
            K(c.col(h).data() + 72);
        if (larger_than_rounding(M, first_.M.block(k)) ||
            larger_than_rounding(C, first_.C.block(k)) ||
            larger_than_rounding(K, first_.K.block(k)))
          of.add(h, i, j, W, M, C, K, out);
      }
    }
  if (in_series) add_series(Omega, orders, out);
}

void RotatingAxes::note_changes(const HarmonicBalance& of, double theta, Index points) {
  const la::BlockPattern& p = linear_.system().pattern();
  Eigen::Matrix<double, 108, 1> by;
  const auto differ = [&](const la::BlockMatrix<6>& first, const la::BlockMatrix<6>& now, Index k,
                          Index at) {
    Eigen::Map<Matrix<6>> change(by.data() + at);
    change = now.block(k) - first.block(k);
    return larger_than_rounding(change, first.block(k));
  };
  VecX weights;
  of.weigh(theta, points, weights);
  for (Index k = 0; k < p.blocks(); ++k) {
    const bool of_M = differ(first_.M, turned_.M, k, 0);
    const bool of_C = differ(first_.C, turned_.C, k, 36);
    const bool of_K = differ(first_.K, turned_.K, k, 72);
    if (!of_M && !of_C && !of_K) continue;
    if (changing_[idx(k)] < 0) {
      changing_[idx(k)] = static_cast<Index>(changes_.size());
      changes_.push_back(Changes::Zero(108, of.waves()));
    }
    changes_[idx(changing_[idx(k)])].noalias() += by * weights.transpose();
  }
}

namespace {

/// A compliance in series, in axes that turn with the shaft: its moments are M = B x of its two nodes.
struct InSeries {
  const system::SeriesCompliance& of;
  Eigen::Matrix<double, 2, 12> B;
  MatX mean;  ///< of d2W/dm2 over the parts, balanced by Galerkin's method
};

}  // namespace

void RotatingAxes::add_series(double Omega, const std::vector<Index>& orders, la::MCK& out) {
  SteadySystem& running = linear_.running();
  const Equilibrium& e = linear_.equilibrium();
  const Index parts = count_parts(orders);
  std::size_t count = 0;
  for (const system::SeriesCompliance& c : running.series())
    count = std::max(count, c.number + 1);
  std::vector<InSeries> all;
  std::vector<Vec2> kinks(count, Vec2::Zero());
  VecX r;
  for (const system::SeriesCompliance& c : running.series()) {
    all.push_back({c, {}, MatX::Zero(2 * parts, 2 * parts)});
    for (Index k = 0; k < 2; ++k) {
      kinks[c.number][k] = 1.0;
      if (!running.series_force_at(e.state.frames, Omega, e.state.q, 0.0, kinks, r)) return;
      kinks[c.number][k] = 0.0;
      for (Index i = 0; i < 2; ++i)
        all.back().B.block<1, 6>(k, 6 * i) = -r.segment<6>(6 * c.nodes[idx(i)]).transpose();
    }
  }
  // beside the quarters, where what breathes switches
  const Index points = 16 * (orders.back() / step_ + 4);
  for (Index n = 0; n < points; ++n) {
    const double theta =
        two_pi / static_cast<double>(step_ * points) * (static_cast<double>(n) + 0.5);
    const VecX f = waves_at(orders, theta);
    // d2W/dm2 knows the direction of m alone, which is that of M: the mean kink goes with the moment
    const auto add = [&](const system::Workspace& w) {
      for (InSeries& c : all) {
        const Mat2 compliance = c.of.law(w)(c.of.moment(w)).slope;
        for (Index a = 0; a < parts; ++a)
          for (Index b = 0; b < parts; ++b) {
            const double share = a == 0 && orders.front() == 0 ? 1.0 : 2.0;
            c.mean.block<2, 2>(2 * a, 2 * b) +=
                share / static_cast<double>(points) * f[a] * f[b] * compliance;
          }
      }
    };
    if (!running.visit_series_at(e.state.frames, Omega, e.state.q, theta / ratio_, add)) return;
  }
  for (const InSeries& c : all) {
    const MatX give = MatX::Identity(2 * parts, 2 * parts) + c.of.stiffness * c.mean;
    const MatX lost = give.transpose().partialPivLu().solve(c.mean.transpose()).transpose();
    for (Index i = 0; i < 2; ++i)
      for (Index j = 0; j < 2; ++j)
        for (Index a = 0; a < parts; ++a)
          for (Index b = 0; b < parts; ++b) {
            const Index t = out.K.pattern().slot(parts * c.of.nodes[idx(i)] + a,
                                                 parts * c.of.nodes[idx(j)] + b);
            out.K.block(t) -= c.B.block<2, 6>(0, 6 * i).transpose() *
                              lost.block<2, 2>(2 * a, 2 * b) * c.B.block<2, 6>(0, 6 * j);
          }
  }
}

double RotatingAxes::reach(double Omega) const {
  constexpr std::size_t always = 3;  // motions of least frequency
  constexpr double margin = 1.2, far = 4.0;
  const double joined = static_cast<double>(joined_multiples()) * std::abs(speed(Omega));
  const double own = frequencies_.size() < always ? 0.0 : frequencies_[always - 1];
  const double most = margin * std::max(joined, own);
  return constant() || frequencies_.empty() || frequencies_.back() <= far * most ? infinity : most;
}

VecXc RotatingAxes::constant_part(const VecXc& x) const {
  if (harmonics_ == 0) return x;
  const Index parts = 2 * harmonics_ + 1, n = linear_.system().nodes();
  VecXc out(6 * n);
  for (Index i = 0; i < n; ++i)
    out.segment<6>(6 * i) = x.segment<6>(6 * parts * i);
  return out;
}

double RotatingAxes::constant_share(const VecXc& x) const {
  if (harmonics_ == 0) return 1.0;
  const VecXc c = constant_part(x);
  double own = 0, all = 0;
  const Index parts = 2 * harmonics_ + 1;
  for (Index i = 0; i < linear_.system().nodes(); ++i) {
    own += squared_size(c, i);
    for (Index a = 0; a < parts; ++a)
      all += (a == 0 ? 1.0 : 0.5) * squared_size(x, parts * i + a);
  }
  return all > 0 ? own / all : 0.0;
}

double RotatingAxes::last_share(const VecXc& x) const {
  if (harmonics_ == 0) return 0.0;
  double last = 0, all = 0;
  const Index parts = 2 * harmonics_ + 1;
  for (Index i = 0; i < linear_.system().nodes(); ++i)
    for (Index a = 0; a < parts; ++a) {
      const double size = (a == 0 ? 1.0 : 0.5) * squared_size(x, parts * i + a);
      all += size;
      if (a + 2 >= parts) last += size;
    }
  return all > 0 ? std::sqrt(last / all) : 0.0;
}

RotatingAxes::SteadySize RotatingAxes::size_of(const VecX& x, Index parts) const {
  // of those a single one apart every other may be nothing
  const Index some = step_ == 1 ? 4 : 2;
  const Index last = constant() ? 0 : std::min<Index>(some, (parts - 2) / 2 * 2);
  SteadySize out;
  for (Index i = 0; i < linear_.system().nodes(); ++i) {
    if (linear_.system().node(i).scalar) continue;
    for (Index a = 0; a < parts; ++a) {
      const double size = std::sqrt(squared_size(x, parts * i + a));
      out.all = std::max(out.all, size);
      if (a + last >= parts) out.last = std::max(out.last, size);
    }
  }
  return out;
}

std::vector<VecXc> RotatingAxes::in_fixed_axes(const VecX& x, const std::vector<Index>& orders,
                                               Index count) const {
  const system::System& s = linear_.system();
  const Index parts = count_parts(orders);
  const Complex i(0, 1);
  std::vector<VecXc> out(idx(count + 1), VecXc::Zero(s.size()));
  for (Index n = 0; n < s.nodes(); ++n) {
    const Matrix<6> J = turn(s, linear_.equilibrium().state.frames.axes(n), n, 0.0, true);
    const Matrix<6> lateral = -J * J;
    const Matrix<6> along = Matrix<6>::Identity() - lateral;
    const auto add = [&](Index h, const Eigen::Matrix<Complex, 6, 1>& a) {
      if (h <= count) out[idx(h)].segment<6>(6 * n) += a;
    };
    Index part = 0;
    for (const Index m : orders) {
      // Re(c exp(i m theta)) in axes that turn with theta
      Eigen::Matrix<Complex, 6, 1> c = x.segment<6>(6 * (parts * n + part++)).cast<Complex>();
      if (m > 0) c -= i * x.segment<6>(6 * (parts * n + part++)).cast<Complex>();
      const Eigen::Matrix<Complex, 6, 1> forth = (lateral - i * J) * c,
                                         back = (lateral + i * J) * c;
      add(m + 1, (m == 0 ? 1.0 : 0.5) * forth);
      if (m > 1) add(m - 1, 0.5 * back);
      if (m == 1) add(0, 0.5 * back.real().cast<Complex>());
      add(m, along * c);
    }
  }
  return out;
}

VecX RotatingAxes::solve_response(double Omega, const VecXc& forces) {
  WHIRL_EXPECTS(forces.size() == linear_.system().size());
  const la::MCK& m = at(Omega);
  // of exp(i theta) with the angle of the axes, which may run backwards
  const VecXc f = ratio_ < 0 ? VecXc(forces.conjugate()) : forces;
  const system::System& s = linear_.system();
  const Index parts = 2 * harmonics_ + 1;
  VecX x = VecX::Zero(6 * pattern_->size());
  double size = 0.0, other = 0.0;
  for (Index n = 0; n < s.nodes(); ++n) {
    const Matrix<6> J = turn(s, linear_.equilibrium().state.frames.axes(n), n, 0.0, true);
    // what turns with the rotor is a quarter turn further on a quarter of a revolution later
    const Vector<6> now = -J * J * f.segment<6>(6 * n).real();
    const Vector<6> later = -f.segment<6>(6 * n).imag();
    const Vector<6> turned_on = J * now;
    const Vector<6> apart = -J * J * later - turned_on;
    size = std::max({size, now.head<3>().norm(), now.tail<3>().norm() / arm_});
    other = std::max({other, apart.head<3>().norm(), apart.tail<3>().norm() / arm_});
    x.segment<6>(6 * parts * n) = now;
  }
  for (Index k = 0; k < x.size(); ++k)
    if (!active_[idx(k)]) x[k] = 0.0;
  constexpr double nothing = 1e-12;  // N: what is left of unbalances that cancel
  if (other > std::max(1e-6 * size, nothing))
    throw run_error("E88", "forces once a revolution that do not turn with the asymmetric rotor",
                    "a transient step has no such limit");
  if (!direct_) direct_ = la::make_direct_solver<double>(*pattern_, active_);
  if (direct_->factor(m, 0.0, 0.0, 1.0) != la::Status::ok) return {};
  direct_->solve(x);
  return x;
}

VecXc RotatingAxes::response(double Omega, const VecXc& forces) {
  const VecX x = solve_response(Omega, forces);
  if (x.size() == 0) return VecXc::Constant(forces.size(), Complex(nan, nan));
  share_ = size_of(x, 2 * harmonics_ + 1).share(0.0);
  const VecXc a = in_fixed_axes(x, orders(), 1).back();
  return ratio_ < 0 ? VecXc(a.conjugate()) : a;
}

VecX RotatingAxes::unbalanced(double Omega, const std::vector<Index>& orders) {
  const system::System& s = linear_.system();
  const Equilibrium& e = linear_.equilibrium();
  const Index parts = count_parts(orders), points = 4 * (orders.back() + 2);
  VecX out = VecX::Zero(6 * parts * s.nodes()), r(s.size());
  for (Index n = 0; n < points; ++n) {
    const double theta = two_pi / static_cast<double>(points) * static_cast<double>(n);
    if (!linear_.running().residual_at(e.state.frames, Omega, e.state.q, theta / ratio_, r))
      throw run_error("E76", "no linearisation: the state lies outside the range of an element");
    const VecX f = waves_at(orders, theta);
    for (Index i = 0; i < s.nodes(); ++i) {
      const Mat3& chart = e.state.frames.axes(i);
      const Matrix<6> J = turn(s, chart, i, 0.0, true);
      const Vector<6> lateral = J * J * r.segment<6>(6 * i);  // of -r
      const Vector<6> turned = turn(s, chart, i, theta, false).transpose() * lateral;
      for (Index a = 0; a < parts; ++a) {
        const double share = (a == 0 && orders.front() == 0 ? 1.0 : 2.0);
        out.segment<6>(6 * (parts * i + a)) += share / static_cast<double>(points) * f[a] * turned;
      }
    }
  }
  return out;
}

const la::MCK& RotatingAxes::at_odd(double Omega) {
  if (odd_.empty()) {
    // a force of fixed direction turns backwards once a revolution here, and what has the period of
    // half a revolution joins every other multiple to that
    for (Index m = step_ == 1 ? 0 : 1; m <= 2 * harmonics_ + 1; m += step_)
      odd_.push_back(m);
    odd_pattern_ = make_pattern(count_parts(odd_));
    odd_active_ = active_of(motion_.active(), count_parts(odd_));
    odd_hill_ = la::MCK(*odd_pattern_);
  }
  balance(Omega, hysteretic() ? Complex(0, std::abs(speed(Omega))) : Complex(), odd_, odd_balance_,
          odd_hill_);
  return odd_hill_;
}

VecX RotatingAxes::solve_standing(double Omega) {
  const la::MCK& matrices = at_odd(Omega);
  VecX x = unbalanced(Omega, odd_);
  for (Index k = 0; k < x.size(); ++k)
    if (!odd_active_[idx(k)]) x[k] = 0.0;
  if (!odd_direct_) odd_direct_ = la::make_direct_solver<double>(*odd_pattern_, odd_active_);
  if (odd_direct_->factor(matrices, 0.0, 0.0, 1.0) != la::Status::ok) return {};
  odd_direct_->solve(x);
  return x;
}

std::vector<VecXc> RotatingAxes::multiples(double Omega, const VecXc& forces, int count) {
  WHIRL_EXPECTS(count >= 2);
  const VecXc none = VecXc::Constant(linear_.system().size(), Complex(nan, nan));
  SteadySize turned;
  std::vector<VecXc> of_response;
  if (forces.size() > 0) {
    const VecX x = solve_response(Omega, forces);
    if (x.size() > 0) {
      turned = size_of(x, 2 * harmonics_ + 1);
      of_response = in_fixed_axes(x, orders(), count);
    } else
      of_response.assign(idx(count + 1), none);
  }
  const VecX x = solve_standing(Omega);
  if (x.size() == 0) return std::vector<VecXc>(idx(count + 1), none);
  constexpr double nothing = 1e-6;  // beside the response: rounding, of a rotor without weight
  share_ = std::max(turned.share(0.0), size_of(x, count_parts(odd_)).share(nothing * turned.all));
  std::vector<VecXc> out = in_fixed_axes(x, odd_, count);
  for (std::size_t h = 0; h < of_response.size(); ++h) {
    if (h == 1)
      out[h] = of_response[h];
    else if (step_ == 2)  // else among what is unbalanced there
      out[h] += of_response[h];
  }
  if (speed(Omega) < 0)
    for (VecXc& a : out)
      a = a.conjugate().eval();
  return out;
}

Index RotatingAxes::negative_stiffnesses(double Omega) {
  sample(Omega, 0.0, Complex(0, infinity));
  la::MCK symmetric = linear_.system().make_matrices();
  if (harmonics_ > 0) {  // mean of the two principal positions of the supports
    const la::MCK one = turned_;
    sample(Omega, 0.5 * pi, Complex(0, infinity));
    for (std::size_t i = 0; i < turned_.K.value_count(); ++i)
      turned_.K.data()[i] = 0.5 * (turned_.K.data()[i] + one.K.data()[i]);
  }
  take_conservative_part(turned_, symmetric);
  // What no stiffness holds at all (states of a controller) counts as held, by a little.
  const la::BlockPattern& pattern = linear_.system().pattern();
  const double little = std::numeric_limits<double>::epsilon() * largest(symmetric.K);
  symmetric.M.set_zero();
  for (Index i = 0; i < pattern.size(); ++i)
    symmetric.M.block(pattern.diagonal(i)).setIdentity();
  la::BlockLu<double> lu(pattern, motion_.active());
  for (const double held : {0.0, 1.0, 3.7, 13.0})
    if (lu.factor(symmetric, held * little, 0.0, 1.0) == la::Status::ok)
      return lu.negative_eigenvalues();
  throw run_error("E88", "the stiffness in axes that turn with the rotor cannot be factored",
                  "use a transient step");
}

}  // namespace whirl::analysis
