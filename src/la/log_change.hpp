// How much the logarithm of a function changes along a path, its argument followed from sample to
// sample: samples are put in until the slopes explain what changes between them, which no turn in
// between can hide from. (A zero close to the path turns the argument quickly, and its logarithm has
// the slope of one over the distance to either side.)
#pragma once
#include <core/types.hpp>
#include <cmath>
#include <functional>

namespace whirl::la {

/// The increment of log f with its argument in (-pi, pi].
inline Complex principal(Complex step) {
  return {step.real(), std::remainder(step.imag(), two_pi)};
}

class LogChange {
 public:
  /// log f at t, its imaginary part modulo 2 pi; false: f is zero or not finite there.
  using Function = std::function<bool(double t, Complex& log_f)>;
  explicit LogChange(Function f) : f_(std::move(f)) {}
  /// Change of log f from a to b (a < b or b < a), f smooth in between; it may bend at both ends.
  /// Quicker where a is the b of the last call.
  /// False: the samples do not settle.
  bool over(double a, double b, Complex& change);
  Index samples() const { return samples_; }  ///< of all calls

 private:
  struct Sample {
    double t;
    Complex log_f;
  };
  bool sample(double t, Sample& out);
  /// d log f/dt at a sample, from the side of `towards`.
  bool slope(const Sample& a, double towards, Complex& out);
  bool settle(const Sample& a, const Sample& b, Complex slope_a, Complex slope_b, int depth,
              Complex& change);

  Function f_;
  Sample last_{nan, {}};
  Index samples_ = 0, limit_ = 0;
};

}  // namespace whirl::la
