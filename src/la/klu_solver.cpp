#include <la/klu_solver.hpp>
#include <core/contract.hpp>
#include <klu.h>
#include <cmath>
#include <new>
#include <type_traits>

namespace whirl::la {

namespace {

/// Pivots kept from an earlier factorisation are given up when entries grow by more than this
/// (largest entry of U over largest of the matrix, by columns). That is measured when a pivot falls
/// below its reciprocal times its column.
constexpr double refactor_growth = 1e4;

/// Rows and columns are scaled to largest entry 1 before KLU sees them, so that neither the pivot
/// threshold nor the test for zero pivots depends on units. Refactorisations keep the scaling.
template <class Scalar>
class KluSolver final : public DirectSolver<Scalar> {
  static constexpr bool complex = std::is_same_v<Scalar, Complex>;

 public:
  KluSolver(const BlockPattern& pattern, std::span<const unsigned char> active) {
    WHIRL_EXPECTS(active.size() == at(6 * pattern.size()));
    klu_defaults(&common_);
    common_.ordering = 0;  // AMD; COLAMD is up to three times slower on rotors
    common_.btf = 0;       // block patterns couple everything that is connected
    common_.scale = -1;    // scaled here
    std::vector<int> compact(active.size(), -1);
    for (std::size_t u = 0; u < active.size(); ++u)
      if (active[u]) {
        compact[u] = static_cast<int>(unknown_.size());
        unknown_.push_back(static_cast<Index>(u));
      }
    start_.assign(1, 0);
    for (Index j = 0; j < pattern.size(); ++j)
      for (int c = 0; c < 6; ++c) {
        if (compact[at(6 * j + c)] < 0) continue;
        // The pattern is structurally symmetric: row j lists the rows of column j.
        for (Index k = pattern.row_start()[at(j)]; k < pattern.row_start()[at(j) + 1]; ++k) {
          const Index i = pattern.cols()[at(k)];
          const Index slot = pattern.slot(i, j);
          for (int r = 0; r < 6; ++r) {
            const int row = compact[at(6 * i + r)];
            if (row < 0) continue;
            row_.push_back(row);
            source_.push_back(static_cast<int>(36 * slot + 6 * c + r));
          }
        }
        start_.push_back(static_cast<int>(row_.size()));
      }
    value_.resize(row_.size());
    row_scale_.resize(unknown_.size());
    col_scale_.resize(unknown_.size());
    col_size_.resize(unknown_.size());
    work_.resize(unknown_.size());
    if (!unknown_.empty()) {
      symbolic_ = klu_analyze(n(), start_.data(), row_.data(), &common_);
      if (!symbolic_) throw std::bad_alloc();
    }
  }
  ~KluSolver() override {
    if (numeric_) free_numeric();
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }
  KluSolver(const KluSolver&) = delete;
  KluSolver& operator=(const KluSolver&) = delete;

  Status factor(const MCK& m, Scalar cm, Scalar cc, Scalar ck) override {
    singular_ = -1;
    growth_ = 1.0;
    if (unknown_.empty()) return Status::ok;
    if (numeric_) {
      form(m, cm, cc, ck);
      if (refactor()) return Status::ok;
      free_numeric();
      growth_ = 1.0;
    }
    std::fill(row_scale_.begin(), row_scale_.end(), 1.0);
    std::fill(col_scale_.begin(), col_scale_.end(), 1.0);
    form(m, cm, cc, ck);
    if (!scale()) return Status::singular;
    common_.halt_if_singular = 1;
    if constexpr (complex)
      numeric_ = klu_z_factor(start_.data(), row_.data(), raw(value_), symbolic_, &common_);
    else
      numeric_ = klu_factor(start_.data(), row_.data(), raw(value_), symbolic_, &common_);
    if (common_.status == KLU_OUT_OF_MEMORY || common_.status == KLU_TOO_LARGE)
      throw std::bad_alloc();
    if (!numeric_ || common_.status != KLU_OK) {
      const Index j = common_.singular_col;
      if (numeric_) free_numeric();
      singular_ = j >= 0 && j < n() ? unknown_[at(j)] : unknown_[0];
      return Status::singular;
    }
    int worst = 0;
    const double least = least_pivot(worst);
    if (!(least > tolerance())) {
      singular_ = unknown_[at(symbolic_->Q[worst])];
      free_numeric();
      return Status::singular;
    }
    if (least < 1.0 / refactor_growth) measure_growth();
    return Status::ok;
  }

  void solve(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> b) override {
    WHIRL_EXPECTS(numeric_ || unknown_.empty());
    WHIRL_EXPECTS(unknown_.empty() || b.size() > unknown_.back());
    if (unknown_.empty()) return;
    for (std::size_t i = 0; i < unknown_.size(); ++i)
      work_[i] = row_scale_[i] * b(unknown_[i]);
    if constexpr (complex)
      klu_z_solve(symbolic_, numeric_, n(), 1, raw(work_), &common_);
    else
      klu_solve(symbolic_, numeric_, n(), 1, raw(work_), &common_);
    for (std::size_t i = 0; i < unknown_.size(); ++i)
      b(unknown_[i]) = col_scale_[i] * work_[i];
  }
  Index singular_unknown() const override { return singular_; }
  std::string_view name() const override { return "klu"; }
  double growth() const override { return growth_; }

 private:
  int n() const { return static_cast<int>(unknown_.size()); }
  static double* raw(std::vector<Scalar>& v) { return reinterpret_cast<double*>(v.data()); }

  /// Values of cm M + cc C + ck K with the present scales, and the largest of each column.
  void form(const MCK& m, Scalar cm, Scalar cc, Scalar ck) {
    if (cc == Scalar(0.0)) return form_terms(m.M.data(), cm, m.K.data(), ck, nullptr, cc);
    if (cm == Scalar(0.0)) return form_terms(m.C.data(), cc, m.K.data(), ck, nullptr, cm);
    form_terms(m.M.data(), cm, m.K.data(), ck, m.C.data(), cc);
  }
  void form_terms(const double* a, Scalar ca, const double* b, Scalar cb, const double* c,
                  Scalar cc) {
    for (int j = 0; j < n(); ++j) {
      double largest = 0.0;
      for (int e = start_[at(j)]; e < start_[at(j) + 1]; ++e) {
        const int from = source_[at(e)];
        // A matrix with a zero coefficient is not looked at: it may hold anything.
        Scalar x = Scalar(0.0);
        if (ca != Scalar(0.0)) x += ca * a[from];
        if (cb != Scalar(0.0)) x += cb * b[from];
        if (c) x += cc * c[from];
        x *= row_scale_[at(row_[at(e)])] * col_scale_[at(j)];
        value_[at(e)] = x;
        largest = std::max(largest, size(x));
      }
      col_size_[at(j)] = largest;
    }
  }
  static double size(double x) { return std::abs(x); }
  static double size(Complex x) { return std::max(std::abs(x.real()), std::abs(x.imag())); }

  /// Scales freshly formed values; false when a row or column is zero (or not finite): singular.
  bool scale() {
    std::fill(row_scale_.begin(), row_scale_.end(), 0.0);
    for (std::size_t e = 0; e < value_.size(); ++e) {
      double& s = row_scale_[at(row_[e])];
      if (!(size(value_[e]) <= s)) s = size(value_[e]);  // NaN is kept
    }
    if (!invert(row_scale_)) return false;
    for (int j = 0; j < n(); ++j) {
      double s = 0.0;
      for (int e = start_[at(j)]; e < start_[at(j) + 1]; ++e)
        s = std::max(s, row_scale_[at(row_[at(e)])] * size(value_[at(e)]));
      col_scale_[at(j)] = s;
    }
    if (!invert(col_scale_)) return false;
    for (int j = 0; j < n(); ++j) {
      for (int e = start_[at(j)]; e < start_[at(j) + 1]; ++e)
        value_[at(e)] *= row_scale_[at(row_[at(e)])] * col_scale_[at(j)];
      col_size_[at(j)] = 1.0;
    }
    return true;
  }
  bool invert(std::vector<double>& s) {
    for (std::size_t i = 0; i < s.size(); ++i) {
      if (!(s[i] > 0.0 && s[i] < std::numeric_limits<double>::infinity())) {
        singular_ = unknown_[i];
        return false;
      }
      s[i] = 1.0 / s[i];
    }
    return true;
  }

  /// New values on the old pivots; false when those do not serve.
  bool refactor() {
    int done = 0;
    if constexpr (complex)
      done = klu_z_refactor(start_.data(), row_.data(), raw(value_), symbolic_, numeric_, &common_);
    else
      done = klu_refactor(start_.data(), row_.data(), raw(value_), symbolic_, numeric_, &common_);
    if (!done || common_.status != KLU_OK) return false;
    int worst = 0;
    const double least = least_pivot(worst);
    if (!(least > tolerance())) return false;
    if (least < 1.0 / refactor_growth) measure_growth();
    return growth_ <= refactor_growth;
  }

  void measure_growth() {
    if constexpr (complex)
      klu_z_rgrowth(start_.data(), row_.data(), raw(value_), symbolic_, numeric_, &common_);
    else
      klu_rgrowth(start_.data(), row_.data(), raw(value_), symbolic_, numeric_, &common_);
    growth_ = common_.rgrowth > 0.0 ? std::max(1.0, 1.0 / common_.rgrowth)
                                    : std::numeric_limits<double>::infinity();
  }

  /// Rounding leaves pivots of a singular matrix at a few times 1e-16 of the scaled entries.
  double tolerance() const {
    return std::numeric_limits<double>::epsilon() * (16.0 + std::sqrt(static_cast<double>(n())));
  }

  /// Smallest pivot relative to the largest entry of its column (NaN when there is one), and its
  /// step.
  double least_pivot(int& worst) const {
    const Scalar* const u = static_cast<const Scalar*>(numeric_->Udiag);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < n(); ++k) {
      const double s = size(u[k]) / col_size_[at(symbolic_->Q[k])];
      if (!(s >= least)) {
        worst = k;
        least = s;
      }
      if (s != s) break;
    }
    return least;
  }

  void free_numeric() {
    if constexpr (complex)
      klu_z_free_numeric(&numeric_, &common_);
    else
      klu_free_numeric(&numeric_, &common_);
    numeric_ = nullptr;
  }

  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  std::vector<Index> unknown_;
  std::vector<int> start_, row_, source_;
  std::vector<Scalar> value_, work_;
  std::vector<double> row_scale_, col_scale_, col_size_;
  double growth_ = 1.0;
  Index singular_ = -1;
};

}  // namespace

template <class Scalar>
std::unique_ptr<DirectSolver<Scalar>> make_klu_solver(const BlockPattern& pattern,
                                                      std::span<const unsigned char> active) {
  return std::make_unique<KluSolver<Scalar>>(pattern, active);
}

template std::unique_ptr<DirectSolver<double>> make_klu_solver(const BlockPattern&,
                                                               std::span<const unsigned char>);
template std::unique_ptr<DirectSolver<Complex>> make_klu_solver(const BlockPattern&,
                                                                std::span<const unsigned char>);

}  // namespace whirl::la
