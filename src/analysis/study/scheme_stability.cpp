#include <analysis/study/scheme_stability.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <time/integrator.hpp>
#include <time/stability.hpp>

#include <la/dense.hpp>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

using MatXc = Eigen::MatrixXcd;

/// The reduced rotor as the integrators see one.
class Dense final : public time::Problem {
 public:
  explicit Dense(const ReducedRotor& r)
      : r_(r),
        kinds_(static_cast<std::size_t>(r.M.rows()), time::Kind::displacement) {}
  Index size() const override { return r_.M.rows(); }
  std::span<const time::Kind> kinds() const override { return kinds_; }
  bool is_linear() const override { return true; }
  void impose(double, time::Ref, time::Ref, time::Ref) const override {}
  bool residual(double, time::CRef q, time::CRef v, time::CRef a, time::Ref r) override {
    r.noalias() = r_.M * a;
    r.noalias() += r_.C * v;
    r.noalias() += r_.K * q;
    return true;
  }
  void linearize(double, time::CRef, time::CRef, time::CRef) override {}
  void add_M(double s, time::CRef x, time::Ref y) const override { y.noalias() += s * (r_.M * x); }
  void add_C(double s, time::CRef x, time::Ref y) const override { y.noalias() += s * (r_.C * x); }
  void add_K(double s, time::CRef x, time::Ref y) const override { y.noalias() += s * (r_.K * x); }
  bool factor(double cm, double cc, double ck) override {
    real_.factor(cm * r_.M + cc * r_.C + ck * r_.K);
    return true;
  }
  bool factor(Complex cm, Complex cc, Complex ck) override {
    complex_.factor(cm * r_.M.cast<Complex>() + cc * r_.C.cast<Complex>() +
                    ck * r_.K.cast<Complex>());
    return true;
  }
  void solve(time::Ref b) const override { b = real_.solve(VecX(b)); }
  void solve(time::RefC b) const override { b = complex_.solve(VecXc(b)); }
  Power power(double, time::CRef q, time::CRef v, time::CRef, time::CRef) override {
    Power p;
    p.kinetic = 0.5 * v.dot(r_.M * v);
    p.stored = p.kinetic + 0.5 * q.dot(r_.K * q);
    return p;
  }

 private:
  const ReducedRotor& r_;
  std::vector<time::Kind> kinds_;
  la::DenseLu<double> real_;
  la::DenseLu<Complex> complex_;
};

std::vector<Complex> eigenvalues_of(const MatX& M, const MatX& C, const MatX& K) {
  const Index n = M.rows();
  MatX A = MatX::Zero(2 * n, 2 * n);
  const la::DenseLu<double> lu(M);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -lu.solve(K);
  A.bottomRightCorner(n, n) = -lu.solve(C);
  const VecXc e = la::eigenvalues(A);
  std::vector<Complex> out;
  for (Index i = 0; i < e.size(); ++i)
    if (e[i].imag() >= 0.0) out.push_back(e[i]);
  std::sort(out.begin(), out.end(), [](Complex a, Complex b) { return a.imag() < b.imag(); });
  return out;
}

/// (q, h v, h^2 b) -> the same a step later; b is the algorithmic acceleration (J. Chung, G. M.
/// Hulbert 1993).
MatX generalized_alpha_map(const ReducedRotor& r, double h, double rho) {
  const double am = (2.0 * rho - 1.0) / (rho + 1.0), af = rho / (rho + 1.0), g = 0.5 - am + af,
               b = 0.25 * (g + 0.5) * (g + 0.5);
  const Index n = r.M.rows();
  const MatX C = h * r.C, K = (h * h) * r.K;
  const MatX left = (1.0 - am) * r.M + (1.0 - af) * (g * C + b * K);
  // b1 = Q q0 + V h v0 + B h^2 b0
  const la::DenseLu<double> lu(left);
  const MatX Q = -lu.solve(K), V = -lu.solve(MatX(C + (1.0 - af) * K)),
             B = -lu.solve(MatX(am * r.M + (1.0 - af) * ((1.0 - g) * C + (0.5 - b) * K)));
  MatX A = MatX::Zero(3 * n, 3 * n);
  const MatX I = MatX::Identity(n, n);
  A << I + b * Q, I + b * V, (0.5 - b) * I + b * B, g * Q, I + g * V, (1.0 - g) * I + g * B, Q, V,
      B;
  return A;
}

}  // namespace

ReducedRotor ReducedRotor::conservative() const {
  ReducedRotor r{
      0.5 * (M + M.transpose()), 0.5 * (C - C.transpose()), 0.5 * (K + K.transpose()), {}};
  r.lambda = eigenvalues_of(r.M, r.C, r.K);
  return r;
}

ReducedRotor reduce_rotor(Linearizer& linear, double Omega, Index count) {
  WHIRL_EXPECTS(count > 0);
  ModesOptions options;
  const auto active = linear.active();
  options.count = std::min<Index>(
      count + 6,
      std::count(active.begin(), active.end(), 1));  // rigid motions are left out afterwards
  const std::vector<WhirlMode> modes = whirl_modes(linear, Omega, options);
  const la::MCK& m = linear.at(Omega);
  double largest = 0.0;
  for (const WhirlMode& x : modes)
    largest = std::max(largest, x.frequency);
  // a basis that is orthonormal in the absolute diagonal of M, so that shapes of very different
  // size keep their digits
  const Index n = linear.system().size();
  MatX V(n, 2 * static_cast<Index>(modes.size()));
  Index columns = 0, taken = 0;
  for (const WhirlMode& x : modes) {
    if (taken == count) break;
    if (!(x.frequency > 1e-6 * largest)) continue;
    ++taken;
    for (const bool imaginary : {false, true}) {
      VecX s = imaginary ? VecX(x.x.imag()) : VecX(x.x.real());
      const double before = s.norm();
      for (int pass = 0; pass < 2; ++pass)
        for (Index k = 0; k < columns; ++k)
          s -= V.col(k).dot(s) * V.col(k);
      if (!(s.norm() > 1e-8 * before) || !(before > 0.0)) continue;
      V.col(columns++) = s.normalized();
    }
  }
  if (columns == 0 && options.count <= 12) {
    // a single body: all of its unknowns but the spin
    V.resize(n, options.count);
    for (Index k = 0; k < n; ++k)
      if (active[static_cast<std::size_t>(k)] && k % 6 != system::spin_phi &&
          columns < options.count)
        V.col(columns++) = VecX::Unit(n, k);
  }
  if (columns == 0)
    throw run_error("E95", "the rotor has no mode that oscillates",
                    "a stability study needs elastic supports or shafts");
  V.conservativeResize(n, columns);
  const auto project = [&](const la::BlockMatrix<6>& x) {
    MatX y = MatX::Zero(n, columns);
    for (Index k = 0; k < columns; ++k) {
      VecX out = VecX::Zero(n);
      x.add_multiply(1.0, V.col(k), out);
      y.col(k) = out;
    }
    return MatX(V.transpose() * y);
  };
  ReducedRotor r{project(m.M), project(m.C), project(m.K), {}};
  r.lambda = eigenvalues_of(r.M, r.C, r.K);
  return r;
}

double spectral_radius(const ReducedRotor& rotor, std::string_view method, double h,
                       double rho_inf) {
  WHIRL_EXPECTS(h > 0.0 && rotor.M.rows() == rotor.K.rows());
  if (method == "generalized_alpha")
    return la::eigenvalues(generalized_alpha_map(rotor, h, rho_inf)).cwiseAbs().maxCoeff();
  double radius = 0.0;
  for (const Complex& l : rotor.lambda)
    radius = std::max(radius, method == "ida" ? time::bdf2_radius(h * l)
                                              : std::abs(time::stability_function(method, h * l)));
  return radius;
}

double energy_ratio(const ReducedRotor& rotor, std::string_view method, double h, long steps,
                    double rho_inf) {
  WHIRL_EXPECTS(h > 0.0 && steps > 0);
  Dense problem(rotor);
  time::Options o;
  o.dt_fixed = h;
  o.rho_inf = rho_inf;
  const auto integrator = time::make_integrator(method, problem, o);
  // unit energy in every natural motion of the rotor at rest
  const la::SymmetricEigenpairs shapes = la::symmetric_eigenpairs(rotor.K, rotor.M);
  VecX q = VecX::Zero(rotor.M.rows());
  const double stiffest = shapes.values.maxCoeff();
  for (Index k = 0; k < q.size(); ++k)
    if (shapes.values[k] > 1e-14 * stiffest)
      q += shapes.vectors.col(k) / std::sqrt(shapes.values[k]);
  integrator->start(0.0, q, VecX::Zero(q.size()));
  const auto energy = [&] {
    return problem.power(0.0, integrator->q(), integrator->v(), integrator->a(), q).stored;
  };
  const double before = energy();
  for (long k = 0; k < steps; ++k)
    if (!integrator->advance().ok() || !std::isfinite(integrator->q().sum())) return infinity;
  return energy() / before;
}

}  // namespace whirl::analysis
