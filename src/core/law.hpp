// Time laws: a scalar function of time with its first two derivatives. Prescribed speeds and
// angles, loads, growing unbalance and base motion all use these.
#pragma once
#include <memory>
#include <span>
#include <vector>

namespace whirl {

struct LawValue {
  double f = 0.0;    ///< value
  double df = 0.0;   ///< first derivative, 1/s
  double ddf = 0.0;  ///< second derivative, 1/s^2
};

/// Within [from, to) a step of a time integrator longer than this may miss what a law does.
struct Pace {
  double from, to, step;  ///< s
};

class Law {
 public:
  virtual ~Law() = default;
  /// At a breakpoint: the limits from the right. Those from the left are at(std::nextafter(t,
  /// -infinity)).
  virtual LawValue at(double t) const = 0;
  /// Integral of the value from 0 to t (exact: a prescribed speed law becomes an angle law through
  /// it).
  virtual double integral(double t) const = 0;
  /// Times, increasing, at which the law or one of its derivatives jumps; the time integrator lands
  /// a step on each.
  virtual std::vector<double> breakpoints() const { return {}; }
  /// Where steps that are controlled by the motion alone may pass over the law itself: a shock that
  /// dies away before the next look at it, an oscillation met at one phase. Between breakpoints a
  /// table is seen as it is.
  virtual std::vector<Pace> paces() const { return {}; }
  /// The same value at all times, known without asking for any.
  virtual bool constant() const { return false; }
};

using LawPtr = std::shared_ptr<const Law>;
/// None where there is no law.
inline std::vector<double> breakpoints_of(const LawPtr& law) {
  return law ? law->breakpoints() : std::vector<double>{};
}

inline std::vector<Pace> paces_of(const LawPtr& law) {
  return law ? law->paces() : std::vector<Pace>{};
}
/// The longest step from a time on that misses nothing.
double longest_step(const std::vector<Pace>& paces, double t);

/// There is a law, and it is not constant.
inline bool varies(const LawPtr& law) { return law && !law->constant(); }

/// f = c
LawPtr make_constant(double c);
/// Straight lines through (t_i, f_i), held constant outside.
/// @throws Error if there is no point, lengths differ, t not increasing, not finite.
LawPtr make_table(std::vector<double> t, std::vector<double> f);
/// Slopes at the points of a monotone piecewise cubic (weighted harmonic means of Fritsch and Butland, doi
/// 10.1137/0905021; at the ends by three points, limited): f' where f is a parabola but for the limits.
/// @pre x increasing, at least two points, as many of f.
std::vector<double> pchip_slopes(std::span<const double> x, std::span<const double> f);
/// Monotone piecewise cubic (Fritsch-Carlson conditions, slopes by the weighted harmonic mean of
/// Fritsch and Butland, doi 10.1137/0905021) through (t_i, f_i), held constant outside. Errors as
/// make_table.
LawPtr make_pchip(std::vector<double> t, std::vector<double> f);
/// f0 before t0, f1 after t1, between them the quintic with zero first and second derivative at
/// both ends.
/// @throws Error if t1 <= t0 or anything is not finite (also the next).
LawPtr make_smooth_step(double t0, double t1, double f0, double f1);
/// f0 before t0, f1 after t1, between them f0 + (f1-f0)(1-cos(pi (t-t0)/(t1-t0)))/2.
LawPtr make_cosine_step(double t0, double t1, double f0, double f1);
/// f = mean + amplitude cos(omega t + phase)
LawPtr make_harmonic(double mean, double amplitude, double omega, double phase);
/// f = 0 before t0, amplitude exp(-(t-t0)/decay) cos(omega (t-t0) + phase) from there on.
/// @throws Error if decay is not above zero.
LawPtr make_decaying(double t0, double amplitude, double omega, double phase, double decay);
/// Polynomial sum c_k t^k
LawPtr make_polynomial(std::vector<double> coefficients);
/// Pieces in time: law k holds from start[k] to start[k+1]; each sees the global time; the first
/// also holds before start[0].
/// @throws Error if lengths differ or zero, start not increasing.
LawPtr make_piecewise(std::vector<double> start, std::vector<LawPtr> laws);
/// The sum of laws.
LawPtr make_sum(std::vector<LawPtr> laws);
/// The angle law phi0 + integral of a speed law (its value is the angle, df the speed, ddf the
/// acceleration). Its own integral is by quadrature, to round-off.
LawPtr make_angle_of_speed(LawPtr speed, double phi0);
/// A law and what is added to its value, which may be set later: f = law + *by.
LawPtr make_shifted(LawPtr law, std::shared_ptr<const double> by);

}  // namespace whirl
