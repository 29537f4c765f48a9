// Small dense problems for the time schemes, and an independent reference integrator.
#pragma once
#include <time/integrator.hpp>
#include <cmath>
#include <functional>
#include <vector>

namespace whirl::time::test {

/// LU with partial pivoting that never allocates after resize().
template <class S>
class DenseLu {
 public:
  using Mat = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;
  void resize(Index n) {
    lu_.resize(n, n);
    pivot_.resize(static_cast<std::size_t>(n));
  }
  Mat& matrix() { return lu_; }
  bool factor() {
    const Index n = lu_.rows();
    for (Index k = 0; k < n; ++k) {
      Index p = k;
      for (Index i = k + 1; i < n; ++i)
        if (std::abs(lu_(i, k)) > std::abs(lu_(p, k))) p = i;
      if (!(std::abs(lu_(p, k)) > 0.0)) return false;
      pivot_[static_cast<std::size_t>(k)] = p;
      for (Index j = 0; j < n && p != k; ++j)
        std::swap(lu_(k, j), lu_(p, j));
      for (Index i = k + 1; i < n; ++i) {
        const S f = lu_(i, k) / lu_(k, k);
        lu_(i, k) = f;
        for (Index j = k + 1; j < n; ++j)
          lu_(i, j) -= f * lu_(k, j);
      }
    }
    return true;
  }
  template <class V>
  void solve(V& b) const {
    const Index n = lu_.rows();
    for (Index k = 0; k < n; ++k)
      if (const Index p = pivot_[static_cast<std::size_t>(k)]; p != k) std::swap(b[k], b[p]);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j)
        b[i] -= lu_(i, j) * b[j];
    for (Index i = n - 1; i >= 0; --i) {
      for (Index j = i + 1; j < n; ++j)
        b[i] -= lu_(i, j) * b[j];
      b[i] /= lu_(i, i);
    }
  }

 private:
  Mat lu_;
  std::vector<Index> pivot_;
};

/// Keeps dense M, C, K; derived classes give R and its derivatives.
class DenseProblem : public Problem {
 public:
  explicit DenseProblem(std::vector<Kind> kinds)
      : kinds_(std::move(kinds)),
        n_(static_cast<Index>(kinds_.size())) {
    M = C = K = MatX::Zero(n_, n_);
    real_.resize(n_);
    complex_.resize(n_);
  }
  Index size() const override { return n_; }
  std::span<const Kind> kinds() const override { return kinds_; }
  void impose(double, Ref, Ref, Ref) const override {}
  void add_M(double s, CRef x, Ref y) const override { y.noalias() += (s * M).lazyProduct(x); }
  void add_C(double s, CRef x, Ref y) const override { y.noalias() += (s * C).lazyProduct(x); }
  void add_K(double s, CRef x, Ref y) const override { y.noalias() += (s * K).lazyProduct(x); }
  bool factor(double cm, double cc, double ck) override { return factor_any(real_, cm, cc, ck); }
  bool factor(Complex cm, Complex cc, Complex ck) override {
    return factor_any(complex_, cm, cc, ck);
  }
  void solve(Ref b) const override { real_.solve(b); }
  void solve(RefC b) const override { complex_.solve(b); }
  Power power(double, CRef, CRef, CRef, CRef) override { return {}; }
  void linearize(double t, CRef q, CRef v, CRef a) override {
    ++linearizations;
    tangent(t, q, v, a);
  }
  virtual void tangent(double t, CRef q, CRef v, CRef a) = 0;

  MatX M, C, K;
  int linearizations = 0;

 private:
  template <class S>
  bool factor_any(DenseLu<S>& lu, S cm, S cc, S ck) {
    auto& A = lu.matrix();
    for (Index j = 0; j < n_; ++j)
      for (Index i = 0; i < n_; ++i) {
        const bool held = kinds_[static_cast<std::size_t>(i)] == Kind::held ||
                          kinds_[static_cast<std::size_t>(j)] == Kind::held;
        A(i, j) = held ? S(i == j ? 1.0 : 0.0) : cm * M(i, j) + cc * C(i, j) + ck * K(i, j);
      }
    return lu.factor();
  }
  std::vector<Kind> kinds_;
  Index n_;
  DenseLu<double> real_;
  DenseLu<Complex> complex_;
};

/// M a + C v + K q = force(t), constant matrices.
class LinearProblem : public DenseProblem {
 public:
  using Force = std::function<void(double t, Ref f)>;
  LinearProblem(std::vector<Kind> kinds, const MatX& m, const MatX& c, const MatX& k,
                Force force = {}, bool linear = true)
      : DenseProblem(std::move(kinds)),
        force_(std::move(force)),
        linear_(linear),
        f_(VecX::Zero(m.rows())) {
    M = m;
    C = c;
    K = k;
  }
  bool is_linear() const override { return linear_; }
  bool residual(double t, CRef q, CRef v, CRef a, Ref r) override {
    r.noalias() = M.lazyProduct(a);
    r.noalias() += C.lazyProduct(v);
    r.noalias() += K.lazyProduct(q);
    if (force_) {
      f_.setZero();
      force_(t, f_);
      r -= f_;
    }
    return true;
  }
  void tangent(double, CRef, CRef, CRef) override {}

 private:
  Force force_;
  bool linear_;
  VecX f_;
};

inline std::vector<Kind> all(Index n, Kind k = Kind::displacement) {
  return std::vector<Kind>(static_cast<std::size_t>(n), k);
}

/// Undamped oscillator q'' + omega^2 q = 0.
inline LinearProblem oscillator(double omega, double zeta = 0.0) {
  return LinearProblem(all(1), MatX::Constant(1, 1, 1.0), MatX::Constant(1, 1, 2.0 * zeta * omega),
                       MatX::Constant(1, 1, omega * omega));
}

/// y' = f(t, y) by Gragg-Bulirsch-Stoer extrapolation to order 16 with n equal steps: independent
/// of every scheme tested.
inline VecX reference(const std::function<VecX(double, const VecX&)>& f, double t0, double t1,
                      VecX y, int n) {
  constexpr int levels = 8;
  const double H = (t1 - t0) / n;
  for (int step = 0; step < n; ++step) {
    const double t = t0 + H * step;
    std::vector<VecX> row(levels);
    for (int j = 0; j < levels; ++j) {
      const int m = 2 * (j + 1);
      const double h = H / m;
      VecX z0 = y, z1 = y + h * f(t, y);
      for (int k = 1; k < m; ++k) {
        const VecX z2 = z0 + 2.0 * h * f(t + k * h, z1);
        z0 = z1;
        z1 = z2;
      }
      VecX value = 0.5 * (z1 + z0 + h * f(t + H, z1));
      for (int i = 0; i < j; ++i) {
        // Neville in h^2: row[i] holds T(j-1, i)
        const double ratio =
            static_cast<double>((j + 1) * (j + 1)) / static_cast<double>((j - i) * (j - i));
        const VecX next = value + (value - row[static_cast<std::size_t>(i)]) / (ratio - 1.0);
        row[static_cast<std::size_t>(i)] = value;
        value = next;
      }
      row[static_cast<std::size_t>(j)] = value;
    }
    y = row[levels - 1];
  }
  return y;
}

/// Runs to t_end; the caller checks the status.
inline StepStatus run(Integrator& integrator, double t_end) {
  integrator.set_end(t_end);
  while (integrator.time() < t_end) {
    const StepReport step = integrator.advance();
    if (!step.ok()) return step.status;
  }
  return StepStatus::ok;
}

}  // namespace whirl::time::test
