// The motion seen from the keyphasor: probes sampled at equal angles of a rotor, one turn at a
// time, and what follows from a turn: synchronous amplitudes (tracking filter), envelope, mean,
// orbit.
//
// The keyphasor fires when the axial angle phi of the reference node passes a whole turn. A turn is
// sampled at N + 1 equally spaced angles on the dense output; the order-k amplitude of x is
//   X_k = (1/pi) int_0^{2 pi} x exp(-i k phi) dphi,   x(phi) = mean + sum_k Re(X_k exp(i k phi)),
// by the trapezoidal rule, which is exact for orders below N - k when x repeats. |X_k| is 0-peak;
// the phase lag behind the keyphasor is -arg X_k where phi rises and arg X_k where it falls: later
// in time, whichever way the rotor turns. While the speed changes within a turn the filter is as
// sharp as one turn allows.
#pragma once
#include <analysis/transient/observer.hpp>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace whirl::analysis {

/// One turn of the reference. y, z: displacement of a probe at the angles (fixed axes, m), N + 1
/// values, both ends included.
struct Turn {
  long number = 0;                        ///< whole turns since phi = 0, of its lower end
  double t0 = 0, t1 = 0;                  ///< s
  bool backward = false;                  ///< phi falls: samples run from the upper end down
  int n = 0;                              ///< N
  std::vector<std::vector<double>> y, z;  ///< [probe][sample]
  /// Mean spin, rad/s, with its sign.
  double speed() const { return (backward ? -two_pi : two_pi) / (t1 - t0); }
};

/// Order-k amplitude of samples of a turn (see above).
/// @pre turn.n + 1 samples, order >= 0.
Complex synchronous(const Turn& turn, std::span<const double> x, int order);
/// Phase lag of an order behind the keyphasor, rad, 0 to 2 pi.
double lag_of(const Turn& turn, Complex amplitude);
struct Range {
  double low = 0, high = 0, mean = 0;
};
/// @pre not empty.
Range range_of(std::span<const double> x);

/// Samples turns and hands each whole one on.
class Revolutions final : public Observer {
 public:
  using Sink = std::function<void(const Turn&)>;
  /// @pre samples > 0, a sink.
  Revolutions(std::vector<Point> probes, Index reference, int samples, Sink sink);
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;

 private:
  double angle(const Snapshot& s) const { return s.total_phi(reference_); }
  double time_of(StepAccess& s, double phi);
  void take(StepAccess& s, double t);
  std::vector<Point> probes_;
  Index reference_;
  Sink sink_;
  Turn turn_;
  std::vector<Vec2> at_probes_;  ///< (y, z), m
  double step_angle_;
  double phi_ = 0, rate_ = 0;            ///< at the end of the last step
  double step_phi_ = 0, step_rate_ = 0;  ///< at the start of the present one
  long next_ = 0;      ///< number of the next sample: it stands at next_ * step_angle_
  int direction_ = 0;  ///< of the samples being collected; 0: none
  int filled_ = 0;
};

}  // namespace whirl::analysis
