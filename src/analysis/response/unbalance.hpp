// Steady response to what turns with the rotor: unbalance, skew, bow (and 1X gravity effects),
// found from the exact residual. Bode and polar data of probes, operating shapes, forces of
// bearings; peaks and their half-power points solved for.
#pragma once
#include <analysis/response/harmonic.hpp>
#include <analysis/response/periodic_response.hpp>
#include <analysis/spectra/rotating_axes.hpp>

namespace whirl::analysis {

struct ResponseProbe {
  std::string name;
  Point point;
  std::vector<double>
      angles;  ///< rad from e2 towards e3; what "amplitude" means to the user; empty: major axis
};

struct UnbalanceOptions {
  std::vector<double> speeds;  ///< rad/s, ascending
  std::vector<ResponseProbe> probes;
  std::vector<Measurement> outputs;  ///< bearing forces and the like
  bool refine_peaks = true;  ///< add speeds at and around the peaks of the probes to the response
  bool shapes = false;       ///< keep the amplitudes of all unknowns
  bool turns_with_rotor = false;  ///< solve in axes that turn with an asymmetric rotor
  Index harmonics = -1;           ///< there; -1: enough_harmonics()
  /// Its forces breathe with its turning (periodic_response.hpp).
  bool breathes = false;
  /// Multiples of the speed that are looked at of a rotor that turns unevenly or breathes; 0: none.
  int multiples = 0;
  /// Put speeds in between those given until amplitudes between them are straight to a tenth: where
  /// supports answer by frequency peaks need not stand near critical speeds, nor be as wide as these
  /// say.
  bool resolve = false;
  int threads = 1;  ///< 0: all processors; the results are the same for any number
};

/// The one of largest magnitude. @pre ascending, not empty.
double fastest_of(const std::vector<double>& speeds);

/// Harmonics of Hill's equations with which the steady motion of an asymmetric rotor changes by no more than
/// 1e-4 when there are two more, at some of these speeds: on unequal supports they are many where it turns
/// slowly. 0 on isotropic ones; `most` if that is not enough.
Index enough_harmonics(Linearizer& linear, const std::vector<double>& speeds, Index most = 27);

/// Amplitudes at one speed; [order] first: a rotor whose lines turn at different speeds responds
/// with each of them.
struct SteadyPoint {
  double Omega = 0;
  std::vector<std::vector<PointAmplitude>> probe;         ///< [order][probe]
  std::vector<std::vector<std::vector<Complex>>> output;  ///< [order][output][component]
  std::vector<VecXc> shape;                               ///< [order], when asked for
  /// [h][probe]: amplitudes of h times the speed; of 0 the mean place against the undeformed shaft,
  /// real. Of a rotor that turns unevenly or breathes.
  std::vector<std::vector<PointAmplitude>> multiple;
  /// Besides shape, when asked for: what the mean place is off the equilibrium by, and amplitudes of
  /// the multiples of the speed from the second on.
  std::vector<VecXc> shape_of_multiples;
  double left_out = 0;  ///< of the last harmonic that was computed, share of the largest
  bool found = true;    ///< false: no periodic motion was; the amplitudes are NaN
};

struct UnbalanceResponse {
  std::vector<double> orders;       ///< excitation frequency / reference speed
  std::vector<SteadyPoint> points;  ///< ascending speeds
};

/// A peak of the major axis of a probe's orbit.
struct ResponsePeak {
  std::size_t order = 0, probe = 0;  ///< numbers in UnbalanceResponse::orders and the probes
  double speed = 0, amplitude = 0;   ///< rad/s, m
  /// False: nothing damps it (or the rotor, whose stiffness turns, begins to bend out there): the response
  /// turns its sign round as the speed passes, and its amplitude is infinite; or there is no periodic
  /// motion beside it.
  bool bounded = true;
  double phase_lag = 0;  ///< of the forward circle behind the rotor mark, rad
  double low = nan,
         high = nan;  ///< speeds with 1/sqrt(2) of the amplitude; nan: not within the range
  double low_seen = nan, high_seen = nan;  ///< speeds between which it is larger than that
  /// Nc/(N2 - N1); from one side, Nc/(2 |N - Nc|), when the other is missing; nan without either.
  double amplification() const;
  /// What it is not above, where it is not known: from the speeds between which it was seen.
  double amplification_bound() const;
};

/// A peak of a multiple of the speed, from the second on, in the motion of a probe: the major axis of its orbit.
struct MultiplePeak {
  std::size_t multiple = 2, probe = 0;
  double speed = 0, amplitude = 0;  ///< rad/s, m
  bool bounded = true;              ///< as of ResponsePeak
};

class UnbalanceSolver {
 public:
  UnbalanceSolver(Linearizer& linear, const UnbalanceOptions& options);
  /// Response at one speed; with_outputs = false: probes only.
  SteadyPoint at(double Omega, bool with_outputs = true);
  UnbalanceResponse run();
  /// Peaks of the last run, by order, probe, speed. Found to 1e-9 of the speed, half-power points
  /// too.
  const std::vector<ResponsePeak>& peaks() const { return peaks_; }
  /// The same of the multiples, where peaks are refined. Found to 1e-8 of the speed.
  const std::vector<MultiplePeak>& peaks_of_multiples() const { return peaks_of_multiples_; }

 private:
  /// At the speeds in their order: equilibria one after the other, responses side by side.
  std::vector<SteadyPoint> points_at(const std::vector<double>& speeds);
  /// Major axes of the orbit of a probe, m.
  static std::vector<double> sizes_of(const std::vector<SteadyPoint>& points, std::size_t order,
                                      std::size_t probe);
  void find_peaks(std::size_t order, std::size_t probe, const std::vector<SteadyPoint>& coarse,
                  std::vector<SteadyPoint>& extra);
  /// Where points without a motion begin and end the response has no bound.
  void add_edges_of_no_motion(std::size_t order, std::size_t probe,
                              const std::vector<SteadyPoint>& points);
  /// The first and the last speed, where they meet a resonance that nothing damps.
  void add_unbounded_ends(const std::vector<SteadyPoint>& points);
  /// A maximum among the points that is none of the peaks: points about one peak may show another.
  bool shows_another(const std::vector<SteadyPoint>& points, std::size_t order,
                     std::size_t probe) const;
  /// Puts points in until amplitudes between them are straight to a tenth.
  void resolve(std::vector<SteadyPoint>& points);
  bool is_straight(const SteadyPoint& a, const SteadyPoint& middle, const SteadyPoint& b) const;
  /// Peaks of pairs order * probes + probe, in place of those known of them; points about them are
  /// sorted into the points.
  void find_peaks_of(const std::vector<std::size_t>& numbers, std::vector<SteadyPoint>& points);
  /// The response keeps its sense across the peak.
  bool is_bounded(const ResponsePeak& peak);
  /// Takes out what stands at peaks without bound: rounding.
  void drop_unbounded(std::vector<SteadyPoint>& points) const;
  /// Peaks of the multiples of the speed between points, and points there.
  void find_peaks_of_multiples(std::vector<SteadyPoint>& points);
  void find_peaks_of_multiple(std::size_t h, std::size_t probe,
                              const std::vector<SteadyPoint>& points);
  PointAmplitude multiple_at(double Omega, std::size_t h, std::size_t probe);
  /// Half-power points of a peak near the sample i.
  void find_half_power(const std::vector<SteadyPoint>& coarse, std::size_t i, ResponsePeak& peak);
  /// Enough points to draw a peak: at fractions of the half-power width on both sides, between low
  /// and high and nearer than `reach`.
  void add_points(const ResponsePeak& peak, double low, double high, double reach,
                  std::vector<SteadyPoint>& extra);
  Linearizer& linear_;
  UnbalanceOptions options_;
  HarmonicSolver solver_;
  /// What an order of the speed drives the unknowns with.
  VecXc force_of(std::size_t order, double Omega);
  /// Of a rotor that breathes: amplitude of the speed itself, the others into p; NaN and p.found =
  /// false where there is no periodic motion.
  VecXc breathe(double Omega, SteadyPoint& p);
  void make_axes();
  /// The motion at the speed itself of a rotor that turns unevenly, its multiples into p.
  VecXc turn(double Omega, const VecXc& forcing, bool with_multiples, SteadyPoint& p);
  void put_multiple(const VecXc& a, SteadyPoint& p) const;
  /// The same of all multiples; of 0 about the equilibrium.
  void put_multiples(std::vector<VecXc> amplitudes, SteadyPoint& p) const;
  /// At rest.
  void stand_still(SteadyPoint& p) const;

  std::unique_ptr<RotatingAxes> axes_;
  std::unique_ptr<PeriodicResponse> periodic_;
  std::unique_ptr<VariationMeter> meter_;
  std::vector<ResponsePeak> peaks_;
  std::vector<MultiplePeak> peaks_of_multiples_;
};

}  // namespace whirl::analysis
