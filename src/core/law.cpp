#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/law.hpp>
#include <core/rotation.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace whirl {

namespace {

[[noreturn]] void refuse(const std::string& message, const std::string& hint) {
  throw Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E72", message, hint, {}});
}

void require_increasing(const std::vector<double>& t, std::size_t values, const char* what) {
  if (t.empty()) refuse(std::string(what) + " has no points", "give at least one time");
  if (t.size() != values) refuse(std::string(what) + ": as many values as times are needed", "");
  for (std::size_t i = 0; i < t.size(); ++i)
    if (!std::isfinite(t[i]) || (i > 0 && !(t[i] > t[i - 1])))
      refuse(std::string(what) + ": times must be finite and increasing", "");
}

void require_finite(const std::vector<double>& f, const char* what) {
  for (double x : f)
    if (!std::isfinite(x)) refuse(std::string(what) + ": values must be finite", "");
}

void require_interval(double t0, double t1, const char* what) {
  if (!(t1 > t0) || !std::isfinite(t1 - t0))
    refuse(std::string(what) + ": the end time must be later than the start time", "");
}

/// A quarter of a period.
double quarter(double omega) { return omega == 0.0 ? infinity : 0.5 * pi / std::abs(omega); }

/// Parts of a change from one value to another that looks do not pass over.
constexpr double parts_of_a_change = 20.0;

// Polynomials between knots: piece k, in powers of t - origin, holds from knot[k-1] to knot[k] (the
// first from -infinity, the last to +infinity).
class PiecewisePolynomial final : public Law {
 public:
  struct Piece {
    double origin = 0.0;
    std::vector<double> c;
    double base = 0.0;  // integral from 0 to origin
  };

  PiecewisePolynomial(std::vector<double> knots, std::vector<Piece> pieces)
      : knots_(std::move(knots)),
        pieces_(std::move(pieces)) {
    for (std::size_t k = 1; k < pieces_.size(); ++k) {
      const double t = knots_[k - 1];
      pieces_[k].base = primitive(pieces_[k - 1], t) - (primitive(pieces_[k], t) - pieces_[k].base);
    }
    const double zero = primitive(piece(0.0), 0.0);
    for (auto& p : pieces_)
      p.base -= zero;
  }

  LawValue at(double t) const override {
    const Piece& p = piece(t);
    const double x = t - p.origin;
    LawValue v;
    for (std::size_t j = p.c.size(); j-- > 0;) {
      v.ddf = v.ddf * x + 2.0 * v.df;
      v.df = v.df * x + v.f;
      v.f = v.f * x + p.c[j];
    }
    return v;
  }
  double integral(double t) const override { return primitive(piece(t), t); }
  std::vector<double> breakpoints() const override { return knots_; }
  bool constant() const override {
    return pieces_.size() == 1 && std::all_of(pieces_[0].c.begin() + (pieces_[0].c.empty() ? 0 : 1),
                                              pieces_[0].c.end(), [](double x) { return x == 0; });
  }

 private:
  const Piece& piece(double t) const {
    const auto k = std::upper_bound(knots_.begin(), knots_.end(), t) - knots_.begin();
    return pieces_[static_cast<std::size_t>(k)];
  }
  static double primitive(const Piece& p, double t) {
    const double x = t - p.origin;
    double s = 0.0;
    for (std::size_t j = p.c.size(); j-- > 0;)
      s = s * x + p.c[j] / static_cast<double>(j + 1);
    return p.base + s * x;
  }

  std::vector<double> knots_;
  std::vector<Piece> pieces_;
};

// Pieces between the knots with a constant before and after.
LawPtr make_held(std::vector<double> t, double first, double last,
                 std::vector<std::vector<double>> inner) {
  std::vector<PiecewisePolynomial::Piece> pieces;
  pieces.push_back({t.front(), {first}});
  for (std::size_t k = 0; k < inner.size(); ++k)
    pieces.push_back({t[k], std::move(inner[k])});
  pieces.push_back({t.back(), {last}});
  return std::make_shared<PiecewisePolynomial>(std::move(t), std::move(pieces));
}

/// Another law with a pace.
class Paced final : public Law {
 public:
  Paced(LawPtr law, std::vector<Pace> paces) : law_(std::move(law)), paces_(std::move(paces)) {}
  LawValue at(double t) const override { return law_->at(t); }
  double integral(double t) const override { return law_->integral(t); }
  std::vector<double> breakpoints() const override { return law_->breakpoints(); }
  std::vector<Pace> paces() const override { return paces_; }
  bool constant() const override { return law_->constant(); }

 private:
  LawPtr law_;
  std::vector<Pace> paces_;
};

class CosineStep final : public Law {
 public:
  CosineStep(double t0, double t1, double f0, double f1)
      : t0_(t0),
        t1_(t1),
        f0_(f0),
        f1_(f1),
        w_(pi / (t1 - t0)) {
    zero_ = primitive(0.0);
  }
  LawValue at(double t) const override {
    if (t < t0_) return {f0_, 0.0, 0.0};
    if (t >= t1_) return {f1_, 0.0, 0.0};
    const double h = 0.5 * (f1_ - f0_), c = std::cos(w_ * (t - t0_)), s = std::sin(w_ * (t - t0_));
    return {f0_ + h * (1.0 - c), h * w_ * s, h * w_ * w_ * c};
  }
  double integral(double t) const override { return primitive(t) - zero_; }
  std::vector<double> breakpoints() const override { return {t0_, t1_}; }
  std::vector<Pace> paces() const override { return {{t0_, t1_, (t1_ - t0_) / parts_of_a_change}}; }

 private:
  double primitive(double t) const {  // from t0
    if (t <= t0_) return f0_ * (t - t0_);
    if (t >= t1_) return 0.5 * (f0_ + f1_) * (t1_ - t0_) + f1_ * (t - t1_);
    const double x = t - t0_, z = w_ * x;
    // x - sin(w x)/w without the difference
    return f0_ * x + 0.5 * (f1_ - f0_) * x * z * z * rotation::g_minus_sin_ratio(z * z);
  }
  double t0_, t1_, f0_, f1_, w_, zero_ = 0.0;
};

class Decaying final : public Law {
 public:
  Decaying(double t0, double amplitude, double omega, double phase, double decay)
      : t0_(t0),
        amplitude_(std::polar(amplitude, phase)),
        rate_(-1.0 / decay, omega) {}
  LawValue at(double t) const override {
    if (t < t0_) return {};
    const std::complex<double> z = amplitude_ * std::exp(rate_ * (t - t0_));
    return {z.real(), (rate_ * z).real(), (rate_ * rate_ * z).real()};
  }
  double integral(double t) const override { return primitive(t) - primitive(0.0); }
  std::vector<double> breakpoints() const override { return {t0_}; }
  std::vector<Pace> paces() const override {
    constexpr double lives = 14.0;  // decay times: then a millionth is left
    const double decay = -1.0 / rate_.real();
    return {{t0_, t0_ + lives * decay, std::min(quarter(rate_.imag()), 0.5 * decay)}};
  }

 private:
  double primitive(double t) const {  // from t0
    if (t <= t0_) return 0.0;
    return (amplitude_ * (std::exp(rate_ * (t - t0_)) - 1.0) / rate_).real();
  }
  double t0_;
  std::complex<double> amplitude_, rate_;
};

class Harmonic final : public Law {
 public:
  Harmonic(double mean, double amplitude, double omega, double phase)
      : mean_(mean),
        amplitude_(amplitude),
        omega_(omega),
        phase_(phase) {}
  LawValue at(double t) const override {
    const double a = omega_ * t + phase_, c = amplitude_ * std::cos(a),
                 s = amplitude_ * std::sin(a);
    return {mean_ + c, -omega_ * s, -omega_ * omega_ * c};
  }
  double integral(double t) const override {
    const double h = 0.5 * omega_ * t, sinc = h == 0.0 ? 1.0 : std::sin(h) / h;
    return t * (mean_ + amplitude_ * sinc * std::cos(h + phase_));
  }
  std::vector<Pace> paces() const override {
    if (amplitude_ == 0.0 || omega_ == 0.0) return {};
    return {{-infinity, infinity, quarter(omega_)}};
  }

 private:
  double mean_, amplitude_, omega_, phase_;
};

class Piecewise final : public Law {
 public:
  Piecewise(std::vector<double> start, std::vector<LawPtr> laws)
      : start_(std::move(start)),
        laws_(std::move(laws)) {
    base_.assign(laws_.size(), 0.0);
    for (std::size_t k = 1; k < laws_.size(); ++k)
      base_[k] = base_[k - 1] + laws_[k - 1]->integral(start_[k]) - laws_[k]->integral(start_[k]);
    const double zero = base_[index(0.0)];
    for (double& b : base_)
      b -= zero;
  }
  LawValue at(double t) const override { return laws_[index(t)]->at(t); }
  double integral(double t) const override {
    return base_[index(t)] + laws_[index(t)]->integral(t);
  }
  std::vector<double> breakpoints() const override {
    std::vector<double> b(start_.begin() + 1, start_.end());
    for (std::size_t k = 0; k < laws_.size(); ++k)
      for (double t : laws_[k]->breakpoints())
        if ((k == 0 || t > start_[k]) && (k + 1 == laws_.size() || t < start_[k + 1]))
          b.push_back(t);
    std::sort(b.begin(), b.end());
    return b;
  }
  std::vector<Pace> paces() const override {
    std::vector<Pace> out;
    for (std::size_t k = 0; k < laws_.size(); ++k)
      for (const Pace& p : laws_[k]->paces()) {
        const double from = k == 0 ? p.from : std::max(p.from, start_[k]),
                     to = k + 1 == laws_.size() ? p.to : std::min(p.to, start_[k + 1]);
        if (from < to) out.push_back({from, to, p.step});
      }
    return out;
  }

 private:
  std::size_t index(double t) const {
    const auto k = std::upper_bound(start_.begin() + 1, start_.end(), t) - (start_.begin() + 1);
    return static_cast<std::size_t>(k);
  }
  std::vector<double> start_, base_;
  std::vector<LawPtr> laws_;
};

class Sum final : public Law {
 public:
  explicit Sum(std::vector<LawPtr> laws) : laws_(std::move(laws)) {}
  LawValue at(double t) const override {
    LawValue s;
    for (const auto& l : laws_) {
      const LawValue v = l->at(t);
      s.f += v.f;
      s.df += v.df;
      s.ddf += v.ddf;
    }
    return s;
  }
  double integral(double t) const override {
    double s = 0.0;
    for (const auto& l : laws_)
      s += l->integral(t);
    return s;
  }
  std::vector<double> breakpoints() const override {
    std::vector<double> b;
    for (const auto& l : laws_) {
      const auto x = l->breakpoints();
      b.insert(b.end(), x.begin(), x.end());
    }
    std::sort(b.begin(), b.end());
    b.erase(std::unique(b.begin(), b.end()), b.end());
    return b;
  }
  std::vector<Pace> paces() const override {
    std::vector<Pace> out;
    for (const LawPtr& law : laws_)
      for (const Pace& p : law->paces())
        out.push_back(p);
    return out;
  }
  bool constant() const override {
    return std::all_of(laws_.begin(), laws_.end(), [](const LawPtr& l) { return l->constant(); });
  }

 private:
  std::vector<LawPtr> laws_;
};

// Gauss-Legendre with 10 points on [-1, 1]: exact to degree 19.
template <class F>
double gauss10(const F& f, double a, double b) {
  static constexpr std::array<double, 5> x{0.14887433898163121, 0.43339539412924719,
                                           0.67940956829902441, 0.86506336668898451,
                                           0.97390652851717172};
  static constexpr std::array<double, 5> w{0.29552422471475287, 0.26926671930999636,
                                           0.21908636251598204, 0.14945134915058059,
                                           0.066671344308688138};
  const double m = 0.5 * (a + b), h = 0.5 * (b - a);
  double s = 0.0;
  for (std::size_t i = 0; i < 5; ++i)
    s += w[i] * (f(m - h * x[i]) + f(m + h * x[i]));
  return s * h;
}

class AngleOfSpeed final : public Law {
 public:
  AngleOfSpeed(LawPtr speed, double phi0) : speed_(std::move(speed)), phi0_(phi0) {}
  LawValue at(double t) const override {
    const LawValue v = speed_->at(t);
    return {phi0_ + speed_->integral(t), v.f, v.df};
  }
  double integral(double t) const override {
    // Cauchy: the repeated integral of the speed, by quadrature between its breakpoints, halved
    // until two levels agree.
    const double a = std::min(0.0, t), b = std::max(0.0, t);
    std::vector<double> knots{a};
    for (double x : speed_->breakpoints())
      if (x > a && x < b) knots.push_back(x);
    knots.push_back(b);
    const auto f = [this](double x) { return speed_->integral(x); };
    double s = 0.0;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      double before = gauss10(f, knots[k], knots[k + 1]);
      for (int n = 2; n <= 1 << 14; n *= 2) {
        double now = 0.0, size = 0.0;
        const double h = (knots[k + 1] - knots[k]) / n;
        for (int i = 0; i < n; ++i) {
          const double part = gauss10(f, knots[k] + i * h, knots[k] + (i + 1) * h);
          now += part;
          size += std::abs(part);
        }
        const bool settled = std::abs(now - before) <= 4e-15 * size;
        before = now;
        if (settled) break;
      }
      s += before;
    }
    return phi0_ * t + (t < 0.0 ? -s : s);
  }
  std::vector<double> breakpoints() const override { return speed_->breakpoints(); }
  std::vector<Pace> paces() const override { return speed_->paces(); }

 private:
  LawPtr speed_;
  double phi0_;
};

class Shifted final : public Law {
 public:
  Shifted(LawPtr law, std::shared_ptr<const double> by)
      : law_(std::move(law)),
        by_(std::move(by)) {}
  LawValue at(double t) const override {
    LawValue v = law_->at(t);
    v.f += *by_;
    return v;
  }
  double integral(double t) const override { return law_->integral(t) + *by_ * t; }
  std::vector<double> breakpoints() const override { return law_->breakpoints(); }
  std::vector<Pace> paces() const override { return law_->paces(); }

 private:
  LawPtr law_;
  std::shared_ptr<const double> by_;
};

}  // namespace

double longest_step(const std::vector<Pace>& paces, double t) {
  double step = infinity;
  for (const Pace& p : paces)
    if (t >= p.from && t < p.to) step = std::min(step, p.step);
  return step;
}

LawPtr make_constant(double c) { return make_polynomial({c}); }

LawPtr make_polynomial(std::vector<double> coefficients) {
  require_finite(coefficients, "polynomial");
  std::vector<PiecewisePolynomial::Piece> piece(1);
  piece[0].c = std::move(coefficients);
  return std::make_shared<PiecewisePolynomial>(std::vector<double>{}, std::move(piece));
}

LawPtr make_table(std::vector<double> t, std::vector<double> f) {
  require_increasing(t, f.size(), "table");
  require_finite(f, "table");
  std::vector<std::vector<double>> inner;
  for (std::size_t k = 0; k + 1 < t.size(); ++k)
    inner.push_back({f[k], (f[k + 1] - f[k]) / (t[k + 1] - t[k])});
  if (t.size() == 1) return make_constant(f[0]);
  return make_held(std::move(t), f.front(), f.back(), std::move(inner));
}

std::vector<double> pchip_slopes(std::span<const double> x, std::span<const double> f) {
  WHIRL_EXPECTS(x.size() == f.size() && x.size() >= 2);
  const std::size_t n = x.size();
  std::vector<double> h(n - 1), secant(n - 1), slope(n);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    h[k] = x[k + 1] - x[k];
    secant[k] = (f[k + 1] - f[k]) / h[k];
  }
  if (n == 2) return {secant[0], secant[0]};
  for (std::size_t k = 1; k + 1 < n; ++k) {
    if (secant[k - 1] * secant[k] <= 0.0) continue;
    const double w1 = 2.0 * h[k] + h[k - 1], w2 = h[k] + 2.0 * h[k - 1];
    slope[k] = (w1 + w2) / (w1 / secant[k - 1] + w2 / secant[k]);
  }
  // One-sided three-point slopes at the ends, limited so that the end pieces stay monotone.
  const auto end = [](double h0, double h1, double s0, double s1) {
    double m = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if (m * s0 <= 0.0) return 0.0;
    if (s0 * s1 <= 0.0 && std::abs(m) > 3.0 * std::abs(s0)) m = 3.0 * s0;
    return m;
  };
  slope[0] = end(h[0], h[1], secant[0], secant[1]);
  slope[n - 1] = end(h[n - 2], h[n - 3], secant[n - 2], secant[n - 3]);
  return slope;
}

LawPtr make_pchip(std::vector<double> t, std::vector<double> f) {
  require_increasing(t, f.size(), "table");
  require_finite(f, "table");
  const std::size_t n = t.size();
  if (n < 3) return make_table(std::move(t), std::move(f));
  const std::vector<double> slope = pchip_slopes(t, f);
  std::vector<std::vector<double>> inner;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double h = t[k + 1] - t[k], secant = (f[k + 1] - f[k]) / h;
    inner.push_back({f[k], slope[k], (3.0 * secant - 2.0 * slope[k] - slope[k + 1]) / h,
                     (slope[k] + slope[k + 1] - 2.0 * secant) / (h * h)});
  }
  return make_held(std::move(t), f.front(), f.back(), std::move(inner));
}

LawPtr make_smooth_step(double t0, double t1, double f0, double f1) {
  require_interval(t0, t1, "smooth step");
  require_finite({f0, f1}, "smooth step");
  const double T = t1 - t0, a = (f1 - f0) / (T * T * T);
  return std::make_shared<Paced>(
      make_held({t0, t1}, f0, f1, {{f0, 0.0, 0.0, 10.0 * a, -15.0 * a / T, 6.0 * a / (T * T)}}),
      std::vector<Pace>{{t0, t1, T / parts_of_a_change}});
}

LawPtr make_cosine_step(double t0, double t1, double f0, double f1) {
  require_interval(t0, t1, "cosine step");
  require_finite({f0, f1}, "cosine step");
  return std::make_shared<CosineStep>(t0, t1, f0, f1);
}

LawPtr make_decaying(double t0, double amplitude, double omega, double phase, double decay) {
  if (!(decay > 0.0)) refuse("decaying law: the decay time must be above zero", "");
  require_finite({t0, amplitude, omega, phase, decay}, "decaying law");
  return std::make_shared<Decaying>(t0, amplitude, omega, phase, decay);
}

LawPtr make_harmonic(double mean, double amplitude, double omega, double phase) {
  require_finite({mean, amplitude, omega, phase}, "harmonic");
  return std::make_shared<Harmonic>(mean, amplitude, omega, phase);
}

LawPtr make_piecewise(std::vector<double> start, std::vector<LawPtr> laws) {
  require_increasing(start, laws.size(), "piecewise law");
  return std::make_shared<Piecewise>(std::move(start), std::move(laws));
}

LawPtr make_sum(std::vector<LawPtr> laws) { return std::make_shared<Sum>(std::move(laws)); }

LawPtr make_angle_of_speed(LawPtr speed, double phi0) {
  return std::make_shared<AngleOfSpeed>(std::move(speed), phi0);
}

LawPtr make_shifted(LawPtr law, std::shared_ptr<const double> by) {
  return std::make_shared<Shifted>(std::move(law), std::move(by));
}

}  // namespace whirl
