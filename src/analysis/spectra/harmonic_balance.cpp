#include <analysis/spectra/harmonic_balance.hpp>

#include <cmath>
#include <cstdlib>

namespace whirl::analysis {

namespace {

constexpr std::size_t position(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

Index count_parts(const std::vector<Index>& orders) {
  return 2 * static_cast<Index>(orders.size()) - (orders.front() == 0 ? 1 : 0);
}

VecX waves_at(const std::vector<Index>& orders, double theta) {
  VecX out(count_parts(orders));
  Index a = 0;
  for (const Index m : orders) {
    out[a++] = std::cos(static_cast<double>(m) * theta);
    if (m > 0) out[a++] = std::sin(static_cast<double>(m) * theta);
  }
  return out;
}

HarmonicBalance::HarmonicBalance(const std::vector<Index>& orders, Index step)
    : parts_(count_parts(orders)) {
  std::vector<Wave> own;
  for (const Index m : orders) {
    own.push_back({m, false});
    if (m > 0) own.push_back({m, true});
  }
  for (Index h = 0; h <= 2 * orders.back(); h += step) {
    waves_.push_back({h, false});
    if (h > 0) waves_.push_back({h, true});
  }
  terms_.resize(waves_.size());
  for (std::size_t h = 0; h < waves_.size(); ++h)
    for (Index a = 0; a < parts_; ++a)
      for (Index b = 0; b < parts_; ++b)
        add_term(own[position(a)], a, own[position(b)], b, h);
}

void HarmonicBalance::weigh(double theta, Index points, VecX& out) const {
  out.resize(waves());
  for (Index h = 0; h < waves(); ++h) {
    const Wave& wave = waves_[position(h)];
    const double angle = static_cast<double>(wave.order) * theta;
    const double size = (wave.order > 0 ? 2.0 : 1.0) / static_cast<double>(points);
    out[h] = size * (wave.sine ? std::sin(angle) : std::cos(angle));
  }
}

void HarmonicBalance::add(Index h, Index i, Index j, double W, const Matrix<6>& M,
                          const Matrix<6>& C, const Matrix<6>& K, la::MCK& out) const {
  for (const Term& t : terms_[position(h)]) {
    const Index k = out.K.pattern().slot(parts_ * i + t.a, parts_ * j) + t.b;
    out.M.block(k) += t.value * M;
    out.C.block(k) += t.value * C + 2.0 * W * t.rate * M;
    out.K.block(k) += t.value * K + W * t.rate * C + W * W * t.acceleration * M;
  }
}

double HarmonicBalance::mean(const Wave& a, const Wave& b, const Wave& h) {
  const auto amplitude = [](const Wave& w, Index sign) {
    return w.sine ? Complex(0, -0.5 * static_cast<double>(sign)) : Complex(0.5);
  };
  Complex sum = 0;
  for (const Index p : {-1, 1})
    for (const Index q : {-1, 1})
      for (const Index r : {-1, 1})
        if (p * a.order + q * b.order + r * h.order == 0)
          sum += amplitude(a, p) * amplitude(b, q) * amplitude(h, r);
  return sum.real();
}

void HarmonicBalance::add_term(const Wave& of_a, Index a, const Wave& of_b, Index b,
                               std::size_t h) {
  const Wave& wave = waves_[h];
  if (wave.order != of_a.order + of_b.order && wave.order != std::abs(of_a.order - of_b.order))
    return;
  const double share = of_a.order > 0 ? 2.0 : 1.0, m = static_cast<double>(of_b.order);
  // cos' = -m sin, sin' = m cos
  const Wave rate{of_b.order, !of_b.sine};
  Term t{a, b, 0, 0, 0};
  t.value = share * mean(of_a, of_b, wave);
  t.rate = share * (of_b.sine ? m : -m) * mean(of_a, rate, wave);
  t.acceleration = -m * m * t.value;
  if (t.value != 0 || t.rate != 0) terms_[h].push_back(t);
}

}  // namespace whirl::analysis
