#include <analysis/spectra/periodic.hpp>
#include <core/contract.hpp>

#include <analysis/search.hpp>
#include <core/error.hpp>
#include <la/block_lu.hpp>
#include <la/direct.hpp>
#include <la/eigen.hpp>

#include <algorithm>
#include <cmath>

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

/// Differences below this are no periodicity: sagging rotors and their unbalance leave parts per
/// million.
constexpr double steady = 1e-6;

}  // namespace

void RotatingAxes::require(const SteadySystem& running) {
  if (running.orders().size() > 1)
    throw run_error("E88",
                    "an asymmetric shaft among shafts of different speeds: no axes exist in which "
                    "the matrices are constant or have one period",
                    "give the shafts one speed_ratio, or use a transient step");
}

RotatingAxes::RotatingAxes(Linearizer& linear, double Omega, Index harmonics, Motion motion)
    : linear_(linear),
      motion_(linear.system(), motion, MotionReduction::Twist::held),
      turned_(linear.system().make_matrices()),
      raw_(linear.system().make_matrices()) {
  WHIRL_EXPECTS(harmonics >= 0);
  require(linear.running());
  // What varies: in fixed axes (then there is something to do), and in rotating ones, over one and
  // half a revolution.
  sample(Omega, 0.0, {});
  const la::MCK first = turned_;
  const la::MCK fixed = raw_;
  double varies = 0, half = 0;
  for (const double theta : {0.7, 1.9, 2.6}) {
    sample(Omega, theta, {});
    varies = std::max({varies, difference(first.M, turned_.M), difference(first.K, turned_.K)});
    turning_ =
        turning_ || difference(fixed.K, raw_.K) > steady || difference(fixed.M, raw_.M) > steady;
    const la::MCK here = turned_;
    sample(Omega, theta + pi, {});
    half = std::max({half, difference(here.M, turned_.M), difference(here.K, turned_.K)});
  }
  harmonics_ = varies > steady ? std::max<Index>(harmonics, 1) : 0;
  step_ = half > steady ? 1 : 2;
  const la::BlockPattern& p = linear.system().pattern();
  if (harmonics_ == 0) {
    pattern_ = &p;
    active_.assign(motion_.active().begin(), motion_.active().end());
    return;
  }
  // Node i, harmonic part j -> node (2H+1) i + j: neighbours stay neighbours.
  const Index parts = 2 * harmonics_ + 1;
  std::vector<std::pair<Index, Index>> couplings;
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[idx(i)]; s < p.row_start()[idx(i) + 1]; ++s)
      for (Index a = 0; a < parts; ++a)
        for (Index b = 0; b < parts; ++b)
          couplings.emplace_back(parts * i + a, parts * p.cols()[idx(s)] + b);
  own_pattern_ = std::make_unique<la::BlockPattern>(parts * p.size(), couplings);
  pattern_ = own_pattern_.get();
  hill_ = la::MCK(*own_pattern_);
  for (Index i = 0; i < p.size(); ++i)
    for (Index a = 0; a < parts; ++a)
      for (int c = 0; c < 6; ++c)
        active_.push_back(motion_.active()[idx(6 * i + c)]);
}

void RotatingAxes::sample(double Omega, double theta, Complex lambda) {
  WHIRL_EXPECTS(std::isfinite(theta));
  if (linear_.Omega() != Omega || Omega == 0.0) linear_.move_to(Omega);
  const Equilibrium& e = linear_.equilibrium();
  SteadySystem& running = linear_.running();
  running.set_whirl(lambda, true);
  const bool inside = running.tangent_at(e.state.frames, Omega, e.state.q, theta, raw_);
  running.set_whirl(0.0);
  if (!inside)
    throw run_error("E76", "no linearisation: the state lies outside the range of an element");
  const system::System& s = linear_.system();
  const la::BlockPattern& p = s.pattern();
  const la::MCK& fixed = motion_.reduce(raw_);
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
      turned_.C.block(k) = C + 2.0 * Omega * MJ;
      turned_.K.block(k) = T[idx(i)].transpose() * fixed.K.block(k) * T[idx(j)] +
                           Omega * C * D[idx(j)] + Omega * Omega * MJ * D[idx(j)];
    }
}

const la::MCK& RotatingAxes::at(double Omega, Complex lambda) {
  if (harmonics_ == 0) {
    sample(Omega, 0.0, lambda);
    return turned_;
  }
  // Galerkin in 1, cos h b theta, sin h b theta, by the trapezoidal rule: exact up to the harmonic
  // of its points less those of the product.
  const Index parts = 2 * harmonics_ + 1, points = 4 * harmonics_ + 8;
  const la::BlockPattern& p = linear_.system().pattern();
  for (la::BlockMatrix<6>* m : {&hill_.M, &hill_.C, &hill_.K})
    m->set_zero();
  VecX f(parts), g(parts), gg(parts);
  for (Index n = 0; n < points; ++n) {
    const double theta = two_pi / static_cast<double>(step_ * points) * static_cast<double>(n);
    sample(Omega, theta, lambda);
    f[0] = 1.0;
    g[0] = gg[0] = 0.0;
    for (Index h = 1; h <= harmonics_; ++h) {
      const double w = static_cast<double>(step_ * h), c = std::cos(w * theta),
                   s = std::sin(w * theta);
      f[2 * h - 1] = c;
      g[2 * h - 1] = -w * Omega * s;
      gg[2 * h - 1] = -w * w * Omega * Omega * c;
      f[2 * h] = s;
      g[2 * h] = w * Omega * c;
      gg[2 * h] = -w * w * Omega * Omega * s;
    }
    for (Index i = 0; i < p.size(); ++i)
      for (Index k = p.row_start()[idx(i)]; k < p.row_start()[idx(i) + 1]; ++k) {
        const Index j = p.cols()[idx(k)];
        const auto M = turned_.M.block(k), C = turned_.C.block(k), K = turned_.K.block(k);
        for (Index a = 0; a < parts; ++a) {
          const double w = (a == 0 ? 1.0 : 2.0) / static_cast<double>(points) * f[a];
          for (Index b = 0; b < parts; ++b) {
            const Index t = own_pattern_->slot(parts * i + a, parts * j + b);
            hill_.M.block(t) += (w * f[b]) * M;
            hill_.C.block(t) += (w * f[b]) * C + (2.0 * w * g[b]) * M;
            hill_.K.block(t) += (w * f[b]) * K + (w * g[b]) * C + (w * gg[b]) * M;
          }
        }
      }
  }
  return hill_;
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
    own += c.segment<3>(6 * i).squaredNorm();
    for (Index a = 0; a < parts; ++a)
      all += (a == 0 ? 1.0 : 0.5) * x.segment<3>(6 * (parts * i + a)).squaredNorm();
  }
  return all > 0 ? own / all : 0.0;
}

VecXc RotatingAxes::first_order_of(const VecX& x) const {
  const system::System& s = linear_.system();
  const Index parts = 2 * harmonics_ + 1;
  const Complex i(0, 1);
  VecXc a = VecXc::Zero(s.size());
  for (Index n = 0; n < s.nodes(); ++n) {
    const Matrix<6> J = turn(s, linear_.equilibrium().state.frames.axes(n), n, 0.0, true);
    const Matrix<6> lateral = -J * J;
    const auto part = [&](Index k) { return x.segment<6>(6 * (parts * n + k)).cast<Complex>(); };
    Eigen::Matrix<Complex, 6, 1> sum = (lateral - i * J) * part(0);
    for (Index h = 1; h <= harmonics_; ++h) {
      // cos and sin of m theta within axes that turn: cos theta and sin theta times those
      const auto c = part(2 * h - 1);
      const auto d = part(2 * h);
      if (step_ * h == 2) sum += 0.5 * ((lateral + i * J) * c + (J - i * lateral) * d);
      if (step_ * h == 1) sum += (Matrix<6>::Identity() - lateral) * (c - i * d);
    }
    a.segment<6>(6 * n) = sum;
  }
  return a;
}

VecXc RotatingAxes::response(double Omega, const VecXc& f) {
  WHIRL_EXPECTS(f.size() == linear_.system().size());
  const la::MCK& m = at(Omega);
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
    size = std::max(size, now.head<3>().norm());
    other = std::max(other, (-J * J * later - turned_on).head<3>().norm());
    x.segment<6>(6 * parts * n) = now;
  }
  for (Index k = 0; k < x.size(); ++k)
    if (!active_[idx(k)]) x[k] = 0.0;
  if (other > 1e-6 * size)
    throw run_error("E88", "forces once a revolution that do not turn with the asymmetric rotor",
                    "a transient step has no such limit");
  const auto direct = la::make_direct_solver<double>(*pattern_, active_);
  if (direct->factor(m, 0.0, 0.0, 1.0) != la::Status::ok)
    return VecXc::Constant(f.size(), Complex(nan, nan));
  direct->solve(x);
  return first_order_of(x);
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
  la::BlockLu<double> lu(linear_.system().pattern(), motion_.active());
  if (lu.factor(symmetric, 0.0, 0.0, 1.0) != la::Status::ok)
    return negative_stiffnesses(Omega * (1 + 1e-12));
  return lu.negative_eigenvalues();
}

namespace {

struct Growth {
  double rate = 0, frequency = 0;
};

class BandSearch {
 public:
  BandSearch(RotatingAxes& axes, const BandOptions& o)
      : axes_(axes),
        solver_(axes.pattern(), axes.active(), options(axes, o)),
        tolerance_(o.tolerance) {}

  Growth at(double Omega) {
    const la::MCK& m = axes_.at(Omega, Complex(0, infinity));
    Growth best{-infinity, 0};
    for (la::Mode x : solver_.solve(m)) {
      if (axes_.constant_share(x.x) < 0.2 || std::abs(x.lambda) == 0.0)
        continue;  // a copy; a rigid motion
      // hysteretic damping at the rate of the motion itself; a motion that stands in the rotor
      // loses nothing
      for (int round = 0; round < 40 && axes_.hysteretic() && x.lambda.imag() != 0.0; ++round) {
        const Complex rate = x.lambda;
        if (const auto next = solver_.follow(axes_.at(Omega, rate), x))
          x = *next;
        else
          break;
        if (std::abs(x.lambda - rate) <= 1e-12 * std::abs(rate)) break;
      }
      if (x.lambda.real() > best.rate) best = {x.lambda.real(), std::abs(x.lambda.imag())};
    }
    return best;
  }

  /// The speed between a stable and an unstable one, of this growth, where the growth is zero. It
  /// crosses zero there, or, without damping, two frequencies merge and it rises as a square root
  /// from the rounding of a double eigenvalue. Neutral motions (growth zero at every speed) hide
  /// the crossing, so it is extrapolated from within the band.
  double edge(double stable, double unstable, double growth) {
    const double level = noise(unstable);
    const double a = passage(stable, unstable, level);
    if (growth < 4.0 * level) return a;
    const double b = passage(a, unstable, 3.0 * level);
    const double x[3] = {a, 0.5 * (a + b), b};
    double r[3];
    for (int k = 0; k < 3; ++k)
      r[k] = at(x[k]).rate;
    const auto bend = [](double f0, double f1, double f2) {
      return std::abs(f2 - 2.0 * f1 + f0) / std::abs(f2 - f0);
    };
    const bool root = bend(r[0] * r[0], r[1] * r[1], r[2] * r[2]) < bend(r[0], r[1], r[2]);
    if (root)
      for (double& v : r)
        v *= v;
    // the parabola x(r) at r = 0
    double zero = 0.0;
    for (int k = 0; k < 3; ++k) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      zero += x[k] * r[p] * r[q] / ((r[k] - r[p]) * (r[k] - r[q]));
    }
    return std::abs(zero - a) < std::abs(b - a) + 1e-6 * std::abs(a) ? zero : a;
  }
  /// Growth that says nothing: harmonics left out of Hill's equations leave a false one of some
  /// 1e-5 of the speed.
  double noise(double Omega) const { return (axes_.constant() ? 1e-6 : 3e-5) * std::abs(Omega); }

 private:
  /// Where the growth passes this level.
  double passage(double stable, double unstable, double level) {
    for (int k = 0; k < 60 && std::abs(unstable - stable) > tolerance_ * std::abs(unstable); ++k) {
      const double middle = 0.5 * (stable + unstable);
      (at(middle).rate > level ? unstable : stable) = middle;
    }
    return unstable;
  }
  static la::ModeOptions options(const RotatingAxes& axes, const BandOptions& o) {
    la::ModeOptions l;
    l.count = o.modes * (2 * axes.harmonics() + 1);
    return l;
  }
  RotatingAxes& axes_;
  la::ModeSolver solver_;
  double tolerance_;
};

/// Speeds between which the rotation has taken one stiffness more than it should have: pairs of
/// zeros of the symmetric stiffness.
void add_seeds(RotatingAxes& axes, double a, Index na, double b, Index nb,
               std::vector<double>& edges, int depth) {
  if (na == nb) return;
  if (depth == 0 || b - a < 1e-7 * b) {
    for (Index k = 0; k < std::abs(nb - na); ++k)
      edges.push_back(0.5 * (a + b));
    return;
  }
  const double middle = 0.5 * (a + b);
  const Index n = axes.negative_stiffnesses(middle);
  add_seeds(axes, a, na, middle, n, edges, depth - 1);
  add_seeds(axes, middle, n, b, nb, edges, depth - 1);
}

/// The speeds asked for, and one within each stretch between seeds.
std::vector<double> list_speeds(RotatingAxes& axes, const BandOptions& o) {
  std::vector<double> speeds = o.speeds, edges;
  for (std::size_t k = 0; k + 1 < o.speeds.size(); ++k)
    if (o.speeds[k] > 0)
      add_seeds(axes, o.speeds[k], axes.negative_stiffnesses(o.speeds[k]), o.speeds[k + 1],
                axes.negative_stiffnesses(o.speeds[k + 1]), edges, 40);
  for (std::size_t k = 0; k + 1 < edges.size(); ++k)
    if (edges[k + 1] - edges[k] > 1e-6 * edges[k])
      speeds.push_back(0.5 * (edges[k] + edges[k + 1]));
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end()), speeds.end());
  return speeds;
}

/// The band of the samples first to last, which all grow while their neighbours do not.
InstabilityBand measure_band(BandSearch& search, const BandResult& samples, std::size_t first,
                             std::size_t last) {
  const std::vector<double>&speeds = samples.speeds, &growth = samples.growth;
  InstabilityBand band;
  if (first > 0) band.low = search.edge(speeds[first - 1], speeds[first], growth[first]);
  if (last + 1 < speeds.size())
    band.high = search.edge(speeds[last + 1], speeds[last], growth[last]);
  std::size_t top = first;
  for (std::size_t j = first; j <= last; ++j)
    if (growth[j] > growth[top]) top = j;
  // the largest growth between the neighbours of the largest sample, where the band has ends
  const double a = top > first ? speeds[top - 1] : band.low,
               b = top < last ? speeds[top + 1] : band.high;
  band.speed = speeds[top];
  if (std::isfinite(a) && std::isfinite(b))
    band.speed = find_maximum(a, speeds[top], growth[top], b, 1e-8,
                              [&](double Omega) { return search.at(Omega).rate; });
  const Growth g = search.at(band.speed);
  band.growth = g.rate;
  band.frequency = g.frequency;
  return band;
}

}  // namespace

BandResult find_bands(RotatingAxes& axes, const BandOptions& o) {
  WHIRL_EXPECTS(o.modes > 0 && o.tolerance > 0.0);
  WHIRL_EXPECTS(std::is_sorted(o.speeds.begin(), o.speeds.end()));
  const std::vector<double> speeds = list_speeds(axes, o);
  BandSearch search(axes, o);
  BandResult out;
  for (const double Omega : speeds) {
    const Growth g = search.at(Omega);
    out.speeds.push_back(Omega);
    out.growth.push_back(g.rate);
    out.frequency.push_back(g.frequency);
  }
  const auto grows = [&](std::size_t k) { return out.growth[k] > search.noise(speeds[k]); };
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    if (!grows(k)) continue;
    std::size_t last = k;
    while (last + 1 < speeds.size() && grows(last + 1))
      ++last;
    out.bands.push_back(measure_band(search, out, k, last));
    k = last;
  }
  return out;
}

}  // namespace whirl::analysis
