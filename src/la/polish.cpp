#include <core/contract.hpp>
#include <Eigen/LU>
#include <cmath>
#include <la/dense.hpp>
#include <la/multiply.hpp>
#include <la/polish.hpp>
#include <optional>

namespace whirl::la {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

void diagonal_of(const BlockMatrix<6>& a, VecX& d) {
  const BlockPattern& p = a.pattern();
  for (Index i = 0; i < p.size(); ++i)
    d.segment<6>(6 * i) = a.block(p.diagonal(i)).diagonal().cwiseAbs();
}

double size_of(Complex z) { return std::abs(z.real()) + std::abs(z.imag()); }

}  // namespace

Polisher::Polisher(const BlockPattern& pattern, std::span<const unsigned char> active)
    : active_(active.begin(), active.end()),
      block_(make_direct_solver<Complex>(pattern, active, SolverKind::block)),
      pattern_(pattern) {
  WHIRL_EXPECTS(active.size() == at(6 * pattern.size()));
  const Index n = 6 * pattern.size();
  for (VecX* v : {&abs_x_, &size_, &diagonal_k_, &diagonal_c_, &diagonal_m_})
    v->resize(n);
  y_.resize(n);
  for (Index u = 0; u < n; ++u)
    if (!active_[at(u)]) held_.push_back(u);
}

void Polisher::set(const MCK& m) {
  WHIRL_EXPECTS(m.K.pattern().size() == pattern_.size());
  m_ = &m;
  diagonal_of(m.M, diagonal_m_);
  diagonal_of(m.C, diagonal_c_);
  diagonal_of(m.K, diagonal_k_);
}

bool Polisher::factor(Complex shift) {
  ++factorizations;
  solver_ = block_.get();
  if (block_->factor(*m_, shift * shift, shift, 1.0) == Status::ok) return true;
  if (!general_) general_ = make_direct_solver<Complex>(pattern_, active_, SolverKind::klu);
  solver_ = general_.get();
  return general_->factor(*m_, shift * shift, shift, 1.0) == Status::ok;
}

void Polisher::mask(VecXc& v) const {
  for (const Index u : held_)
    v(u) = 0.0;
}

bool Polisher::evaluate(Pair& p, bool exact) {
  WHIRL_EXPECTS(m_ != nullptr);
  WHIRL_EXPECTS(p.x.size() == 6 * pattern_.size());
  mask(p.x);
  Index big = 0;
  double size = 0.0;
  for (Index u = 0; u < p.x.size(); ++u) {
    const double v = std::norm(p.x(u));
    if (!(v <= size)) {
      size = v;
      big = u;
    }
  }
  if (!(size > 0.0 && size < std::numeric_limits<double>::infinity())) return false;
  p.x *= 1.0 / p.x(big);
  // What a mode does not move decays from iteration to iteration; denormal numbers would cost a
  // hundred times as much.
  for (Index u = 0; u < p.x.size(); ++u)
    if (size_of(p.x(u)) < 1e-40) p.x(u) = 0.0;
  for (VecXc* v : {&p.Mx, &p.Cx, &p.Kx})
    v->resize(p.x.size());
  multiply(*m_, p.x, p.Mx, p.Cx, p.Kx);
  if (exact) multiply_exact(m_->K, p.x, p.Kx);
  for (VecXc* v : {&p.Mx, &p.Cx, &p.Kx})
    mask(*v);
  return true;
}

Complex Polisher::rayleigh_root(const Pair& p, Complex s0) {
  WHIRL_EXPECTS(p.Mx.size() == p.x.size() && p.Cx.size() == p.x.size() &&
                p.Kx.size() == p.x.size());
  const Complex a = p.x.dot(p.Mx), b = p.x.dot(p.Cx), c = p.x.dot(p.Kx);
  // Both roots without cancellation: q = -(b + sign sqrt(b^2 - 4ac))/2, s = q/a and c/q.
  Complex d = std::sqrt(b * b - 4.0 * a * c);
  if ((std::conj(b) * d).real() < 0.0) d = -d;
  const Complex q = -0.5 * (b + d);
  Complex best = s0;
  double distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](Complex s) {
    const double r = std::abs(s - s0);
    if (r < distance) {
      distance = r;
      best = s;
    }  // false for NaN
  };
  if (a != 0.0) consider(q / a);
  if (q != 0.0) consider(c / q);
  return best;
}

/// Residual in the scaling by diagonal entries that makes forces and moments comparable.
double Polisher::residual_norm(const Pair& p, Complex lambda) {
  const double s = std::abs(lambda), s2 = s * s;
  double worst = 0.0;
  for (Index u = 0; u < p.x.size(); ++u) {
    const double w = diagonal_k_(u) + s * diagonal_c_(u) + s2 * diagonal_m_(u);
    const double r = std::norm(lambda * (lambda * p.Mx(u) + p.Cx(u)) + p.Kx(u));
    if (r > 0.0) worst = std::max(worst, r / w);
    if (r != r) return r;
  }
  return worst;
}

bool Polisher::polish(Pair& p, double tolerance, bool near) {
  WHIRL_EXPECTS(m_ != nullptr);
  WHIRL_EXPECTS(tolerance > 0.0);
  if (p.Kx.size() == 0 && !evaluate(p)) return false;
  // What rounding of K x alone can do to lambda: beams of many elements need sums better than
  // working precision.
  const bool exact = uncertainty(p) > 1e-10 * std::abs(p.lambda);
  const Complex start = p.lambda;
  // Roots near zero are known no better than rounding of K allows.
  const double floor =
      std::max(std::numeric_limits<double>::epsilon() * std::abs(start), 1e3 * uncertainty(p)) +
      1e-300;
  Complex shift;
  // Beside a neighbour that is nearer than the last shift was, refinement does not converge: from
  // where it stopped, Newton's method puts the shift closer.
  for (int attempt = 0; attempt < 4; ++attempt) {
    if (!iterate_newton(p, near, exact, floor, shift)) return false;
    if (refine(p, tolerance, exact, floor, shift)) return true;
    near = false;
  }
  return false;
}

/// Quadratic, so that a change of 1e-3 leaves about 1e-6 for the linear phase.
bool Polisher::iterate_newton(Pair& p, bool near, bool exact, double floor, Complex& shift) {
  double change = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 12 && change > 1e-3; ++k) {
    // A little beside: a start that is an eigenvalue already must not make Q singular.
    shift = p.lambda * (1.0 + 1e-6);
    if (!factor(shift)) {
      // A soft support under parts a billion times stiffer: so close to the eigenvalue its share of
      // the last pivot is rounding.
      shift = p.lambda * (1.0 + 5e-4);
      if (!factor(shift)) return false;
    }
    for (int inner = 0; inner < (near ? 2 : 1); ++inner) {
      const double xx = p.x.squaredNorm();
      y_ = 2.0 * shift * p.Mx + p.Cx;
      solver_->solve(y_);
      const Complex newton = shift - xx / p.x.dot(y_);
      p.x.swap(y_);
      if (!evaluate(p, exact)) return false;
      const Complex ritz = rayleigh_root(p, newton);
      p.lambda = residual_norm(p, newton) < residual_norm(p, ritz) ? newton : ritz;
    }
    change = std::abs(p.lambda - shift) / std::max(std::abs(p.lambda), floor);
    if (!(change < 1e12)) return false;
    near = false;
  }
  return change <= 1e-3;
}

/// x -= Q(shift)^-1 Q(lambda) x: the error falls by |lambda - shift| / gap each time.
bool Polisher::refine(Pair& p, double tolerance, bool exact, double floor, Complex shift) {
  double last = 0.5, step = 1.0;
  for (int k = 0; k < 8; ++k) {
    y_ = p.lambda * (p.lambda * p.Mx + p.Cx) + p.Kx;
    solver_->solve(y_);
    // Along x the correction only rescales, and near the eigenvalue rounding makes that part large.
    y_ -= p.x.dot(y_) / p.x.squaredNorm() * p.x;
    step = 0.0;
    for (Index u = 0; u < y_.size(); ++u)
      step = std::max(step, size_of(y_(u)));
    if (!(step < last)) break;  // the limit that rounding sets
    p.x -= y_;
    if (!evaluate(p, exact)) return false;
    const Complex next = rayleigh_root(p, p.lambda);
    const double change = std::abs(next - p.lambda) / std::max(std::abs(next), floor);
    p.lambda = next;
    // The vector converges linearly; what its last step leaves in lambda is below the product of
    // both.
    if (change <= tolerance && step <= 1e-8) break;
    last = 0.5 * step;
  }
  // What is left, relative to the largest component. Eigenvalues closer together than this shift
  // can resolve keep the vectors mixed; the caller separates them.
  return step < 1e-3 || std::abs(p.lambda - shift) < 1e-5 * std::abs(p.lambda);
}

void Polisher::sizes(const Pair& p, double cm, double cc, double ck) {
  abs_x_ = p.x.cwiseAbs2().cwiseSqrt();  // without the care of hypot: shapes are of size 1
  size_.setZero();
  if (cm > 0.0) add_multiply_size(m_->M, cm, abs_x_, size_);
  if (cc > 0.0) add_multiply_size(m_->C, cc, abs_x_, size_);
  if (ck > 0.0) add_multiply_size(m_->K, ck, abs_x_, size_);
}

double Polisher::uncertainty(const Pair& p) {
  sizes(p, 0.0, 0.0, 1.0);
  const double slope = std::abs(2.0 * p.lambda * p.x.dot(p.Mx) + p.x.dot(p.Cx));
  return slope > 0.0 ? eps * abs_x_.dot(size_) / slope : 0.0;
}

void Polisher::assess(Pair& p) {
  WHIRL_EXPECTS(p.Kx.size() == p.x.size());
  const double s = std::abs(p.lambda);
  p.uncertainty = uncertainty(p);
  if (s > 0.0) {
    add_multiply_size(m_->M, s * s, abs_x_, size_);
    add_multiply_size(m_->C, s, abs_x_, size_);
  }
  double residual = 0.0, size = 0.0;
  for (Index u = 0; u < p.x.size(); ++u) {
    const double w = diagonal_k_(u) + s * diagonal_c_(u) + s * s * diagonal_m_(u);
    if (!(w > 0.0)) continue;
    residual =
        std::max(residual, std::norm(p.lambda * (p.lambda * p.Mx(u) + p.Cx(u)) + p.Kx(u)) / w);
    size = std::max(size, size_(u) * size_(u) / w);
  }
  p.residual = residual > 0.0 ? std::sqrt(residual / size) : 0.0;
}

double Polisher::rounding_of_stiffness(const Pair& p) {
  WHIRL_EXPECTS(p.x.size() == 6 * pattern_.size());
  sizes(p, 0.0, 0.0, 1.0);
  // Rounding of n products of random sign; 16 eps is far below any support that could be told from
  // none.
  double rounding = 16.0 * eps * abs_x_.dot(size_);
  // Components below eps are rounding of the largest, which is 1: what K makes of them is none
  // either.
  abs_x_.setConstant(eps);
  for (const Index u : held_)
    abs_x_(u) = 0.0;
  size_.setZero();
  add_multiply_size(m_->K, 1.0, abs_x_, size_);
  rounding += abs_x_.dot(size_);
  return rounding;
}

VecX Polisher::weights(Complex lambda) const {
  WHIRL_EXPECTS(m_ != nullptr);
  const double s = std::abs(lambda);
  return (diagonal_k_ + s * diagonal_c_ + s * s * diagonal_m_).cwiseSqrt();
}

bool Polisher::is_unresisted(const Pair& p) {
  WHIRL_EXPECTS(p.Kx.size() == p.x.size());
  return std::abs(p.x.dot(p.Kx)) <= rounding_of_stiffness(p);
}

namespace {

/// The space that a group of eigenpairs spans, by vectors of length one.
struct Subspace {
  MatXc X, MX, CX, KX;
  Complex centre = 0.0;  ///< of the eigenvalues
  double radius = 0.0;
  bool real = true;  ///< overdamped roots with real vectors: a real projected problem
  explicit Subspace(std::span<Pair* const> group) {
    const Index k = static_cast<Index>(group.size()), n = group[0]->x.size();
    for (MatXc* m : {&X, &MX, &CX, &KX})
      m->resize(n, k);
    for (Index j = 0; j < k; ++j) {
      const Pair& p = *group[at(j)];
      real = real && p.lambda.imag() == 0.0;
      const double s = 1.0 / p.x.norm();
      X.col(j) = s * p.x;
      MX.col(j) = s * p.Mx;
      CX.col(j) = s * p.Cx;
      KX.col(j) = s * p.Kx;
      centre += p.lambda / static_cast<double>(k);
    }
    for (Index j = 0; j < k; ++j)
      radius = std::max(radius, std::abs(group[at(j)]->lambda - centre));
  }
  Index size() const { return X.cols(); }
};

struct ProjectedPairs {
  VecXc lambda;
  MatXc y;  ///< vectors of length one, in terms of X
};

/// The eigenpairs of the projected problem nearest to the centre of the group. Nothing when its
/// vectors are dependent.
std::optional<ProjectedPairs> solve_projected(const Subspace& s) {
  const Index k = s.size();
  // A shift off the group, so that none of its eigenvalues is hit.
  const Complex c =
      s.centre + 0.3 * std::max(s.radius, 1e-2 * std::abs(s.centre)) * Complex(1.0, 0.2);
  const MatXc gram = s.X.adjoint() * s.X;
  if (hermitian_eigenvalues(gram)(0) < 1e-8) return std::nullopt;
  const MatXc a2 = s.X.adjoint() * s.MX, a1 = s.X.adjoint() * s.CX, a0 = s.X.adjoint() * s.KX;
  const DenseLu<Complex> q(c * c * a2 + c * a1 + a0);
  const double alpha = std::max(std::abs(c), 1e-300);
  MatXc op(2 * k, 2 * k);
  op.topLeftCorner(k, k) = -q.solve(MatXc(a1 + c * a2));
  op.topRightCorner(k, k) = -alpha * q.solve(a2);
  op.bottomLeftCorner(k, k) = (MatXc::Identity(k, k) + c * op.topLeftCorner(k, k)) / alpha;
  op.bottomRightCorner(k, k) = c * op.topRightCorner(k, k) / alpha;
  if (!op.allFinite()) return std::nullopt;
  const DenseEigenpairs eig = eigenpairs(op);
  std::vector<Index> order(at(2 * k));
  for (Index j = 0; j < 2 * k; ++j)
    order[at(j)] = j;
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::abs(eig.values(a)) > std::abs(eig.values(b)); });
  ProjectedPairs out{VecXc(k), MatXc(k, k)};
  for (Index j = 0; j < k; ++j) {
    const Index e = order[at(j)];
    out.lambda(j) = c + 1.0 / eig.values(e);
    out.y.col(j) = eig.vectors.col(e).head(k);
    out.y.col(j) /= out.y.col(j).norm();
  }
  if (!out.lambda.allFinite() || !out.y.allFinite()) return std::nullopt;
  return out;
}

/// For each old vector (row of y) the new one that contains most of it, best matches first.
std::vector<Index> match_vectors(const MatXc& y) {
  const Index k = y.cols();
  std::vector<bool> taken(at(k), false), given(at(k), false);
  std::vector<Index> of(at(k), 0);
  for (Index round = 0; round < k; ++round) {
    double best = -1.0;
    Index bi = 0, bj = 0;
    for (Index i = 0; i < k; ++i)
      for (Index j = 0; j < k; ++j)
        if (!taken[at(j)] && !given[at(i)] && std::abs(y(i, j)) > best) {
          best = std::abs(y(i, j));
          bi = i;
          bj = j;
        }
    taken[at(bj)] = given[at(bi)] = true;
    of[at(bi)] = bj;
  }
  return of;
}

}  // namespace

void Polisher::separate(std::span<Pair*> group) {
  WHIRL_EXPECTS(!group.empty());
  const Index k = static_cast<Index>(group.size());
  if (k == 1) {
    const Complex root = rayleigh_root(*group[0], group[0]->lambda);
    if (group[0]->lambda.imag() != 0.0 || root.imag() == 0.0) group[0]->lambda = root;
    return;
  }
  const Subspace s(group);
  const std::optional<ProjectedPairs> found = solve_projected(s);
  if (!found) return;
  const std::vector<Index> of = match_vectors(found->y);
  for (Index i = 0; i < k; ++i) {
    Pair& p = *group[at(i)];
    VecXc w = found->y.col(of[at(i)]);
    p.lambda = found->lambda(of[at(i)]);
    Index big = 0;
    w.cwiseAbs().maxCoeff(&big);
    w *= 1.0 / w(big);
    if (s.real && std::abs(p.lambda.imag()) < 1e-9 * std::abs(p.lambda)) {
      // of a double root rounding may make a pair: its vectors are the real and the imaginary part
      const bool second = p.lambda.imag() < 0.0 && w.imag().norm() > 1e-3 * w.norm();
      p.lambda = p.lambda.real();
      w = (second ? VecX(w.imag()) : VecX(w.real())).cast<Complex>();
    }
    p.x = s.X * w;
    p.Mx = s.MX * w;
    p.Cx = s.CX * w;
    p.Kx = s.KX * w;
  }
}

}  // namespace whirl::la
