#include <analysis/search.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

double find_maximum(double a, double m, double fm, double b, double tolerance,
                    const std::function<double(double)>& f) {
  WHIRL_EXPECTS(((a < m && m < b) || (b < m && m < a)) && tolerance > 0.0);
  const double golden = 0.3819660112501051;
  double x = m, w = m, v = m, fx = fm, fw = fm, fv = fm, d = 0, e = 0;
  for (int it = 0; it < 80; ++it) {
    const double middle = 0.5 * (a + b), tol = tolerance * std::abs(x) + 1e-300;
    if (std::abs(x - middle) <= 2 * tol - 0.5 * (b - a)) break;
    bool parabola = false;
    if (std::abs(e) > tol) {
      const double r = (x - w) * (fx - fv), q0 = (x - v) * (fx - fw), q = 2 * (q0 - r);
      const double p = (x - v) * q0 - (x - w) * r;
      const double s = q > 0 ? -p : p, t = std::abs(q);
      if (std::abs(s) < std::abs(0.5 * t * e) && s > t * (a - x) && s < t * (b - x)) {
        e = d;
        d = s / t;
        parabola = true;
      }
    }
    if (!parabola) {
      e = x < middle ? b - x : a - x;
      d = golden * e;
    }
    const double u = x + (std::abs(d) >= tol ? d : d > 0 ? tol : -tol), fu = f(u);
    if (fu >= fx) {
      (u < x ? b : a) = x;
      v = w;
      fv = fw;
      w = x;
      fw = fx;
      x = u;
      fx = fu;
    } else {
      (u < x ? a : b) = u;
      if (fu >= fw || w == x) {
        v = w;
        fv = fw;
        w = u;
        fw = fu;
      } else if (fu >= fv || v == x || v == w) {
        v = u;
        fv = fu;
      }
    }
  }
  return x;
}

double find_crossing(double a, double fa, double b, double fb, double tolerance,
                     const std::function<double(double)>& f) {
  WHIRL_EXPECTS((fa < 0.0) != (fb < 0.0) || fa == 0.0 || fb == 0.0);
  WHIRL_EXPECTS(tolerance > 0.0);
  for (int it = 0; it < 80 && std::abs(b - a) > tolerance * std::abs(b); ++it) {
    const double x = (a * fb - b * fa) / (fb - fa), fx = f(x);
    if (fx == 0.0) return x;
    if ((fx > 0) == (fb > 0))
      fa *= 0.5;
    else {
      a = b;
      fa = fb;
    }
    b = x;
    fb = fx;
  }
  return b;
}

namespace {

/// The lowest sample that is reached downhill.
double valley(const std::vector<double>& samples, std::size_t from, bool towards_the_end) {
  std::size_t k = from;
  if (towards_the_end)
    while (k + 1 < samples.size() && samples[k + 1] <= samples[k])
      ++k;
  else
    while (k > 0 && samples[k - 1] <= samples[k])
      --k;
  return samples[k];
}

}  // namespace

std::vector<std::size_t> ends_that_stand_out(const std::vector<double>& samples) {
  constexpr double more = 10.0;
  if (samples.size() < 2) return std::vector<std::size_t>(samples.size(), 0);
  const std::size_t last = samples.size() - 1;
  std::vector<std::size_t> out;
  if (samples.front() > more * samples[1]) out.push_back(0);
  if (samples.back() > more * samples[last - 1]) out.push_back(last);
  return out;
}

std::vector<std::size_t> maxima_of(const std::vector<double>& samples) {
  constexpr double of_itself = 1e-7, of_the_largest = 1e-14;
  double largest = 0;
  for (const double f : samples)
    largest = std::max(largest, std::abs(f));
  std::vector<std::size_t> out;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const double here = samples[i];
    if (!(here > samples[i - 1] && here >= samples[i + 1])) continue;
    const double foot = std::max(valley(samples, i, false), valley(samples, i, true));
    if (here - foot >= of_itself * std::abs(here) + of_the_largest * largest) out.push_back(i);
  }
  return out;
}

}  // namespace whirl::analysis
