// The system turning at constant speed: what every analysis in the frequency domain is about.
//
// Each spinning line l turns at Omega ratio_l and nothing else moves. R(q; Omega) is the residual
// averaged over the revolution: what turns with a rotor and has no mean (unbalance, skew, bow, key
// ways) drops out and stands in the forcing instead,
//   R(theta) = R + sum_k Re(f_k exp(i order_k theta)) + ...,   theta = Omega t,  order_k = |ratio|,
//   distinct values,
// found from samples of the exact residual over theta (when all lines have one speed four a
// revolution, more where a term declares harmonics; else a least-squares fit with first and second
// harmonics of every speed, up to eight where declared; exact for what has no higher harmonics). No element is known by name: what it depends on, it declares
// (system/dependence.hpp). The same averages of the tangents are the matrices M, C(Omega),
// K(Omega); an axisymmetric balanced rotor needs no average.
//
// Terms that are quadratic in the rates keep their (mean) matrices and forcing as polynomials in
// Omega (C linear, K and forcing quadratic: exact), so a sweep over speeds re-evaluates films and
// the like only.
#pragma once
#include <system/system.hpp>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace whirl::analysis {

struct SteadyRotation {
  std::vector<double>
      ratio;  ///< spin of each line relative to the reference speed (negative: the other way);
              ///< empty = all 1; shorter than the lines: the rest (ground) stand still
  double time = 0;  ///< laws of time are read here
  bool hysteretic =
      true;          ///< hysteretic damping in its own form; false: as its stand-in in motions
  bool mean = true;  ///< average over the revolution; false: rotor angles as they stand (statics)
  double top_speed = 0;  ///< highest |Omega| expected, rad/s (keeps the polynomials from being made
                         ///< twice); 0 = unknown
  /// rad/s, in any order: frequencies at which coefficients are given of supports that answer
  /// differently to motions of different frequency (Context::frequency); between neighbours they
  /// change smoothly. Empty: there are none.
  std::vector<double> table_frequencies;
  /// rad/s: up to it controllers act; 0: there is none. No energy argument bounds what they drive, so
  /// stability is looked for up to here at least.
  double control_bandwidth = 0;
  /// Lines that nothing resists or loads along their axis, one of each group that moves together: an
  /// equilibrium holds u_x of their first node (it may stand anywhere); small motions leave it free.
  std::vector<Index> axially_free;
  bool frequency_dependent() const { return !table_frequencies.empty(); }
};

class SteadySystem {
 public:
  explicit SteadySystem(const system::System& system, SteadyRotation running = {});

  /// Takes over the polynomials that another one, of the same system and rotation, has made: they
  /// are found from tangents at several speeds.
  void take_polynomials(const SteadySystem& other);

  const system::System& system() const { return system_; }
  const SteadyRotation& running() const { return running_; }
  double ratio(Index line) const { return ratio_[static_cast<std::size_t>(line)]; }
  /// 1 where phi turns with the line.
  std::span<const unsigned char> spinning() const { return spinning_; }
  bool phase_dependent() const { return !turning_.empty() || !turning_smooth_.empty(); }
  /// At one state forces and matrices are polynomials of second degree in the speed: no film, table or
  /// contact asks for more.
  bool quadratic_in_speed() const { return other_.empty() && turning_.empty(); }
  /// Distinct |ratio| > 0, ascending.
  std::span<const double> orders() const { return orders_; }
  /// +1 or -1: sign of the spin (at a positive reference speed) that whirl at a node is measured
  /// against; see spin_senses().
  double sense(Index node) const { return sense_[static_cast<std::size_t>(node)]; }

  /// Factor on gravity and given loads.
  void set_load(double factor);
  /// How hysteretic damping (elements that depend on the rate of the motion) enters the matrices:
  /// at the rate lambda, 1/s, of a small motion; infinite Im: not at all; 0: as for the steady
  /// state. rotates: lambda is seen in axes turning with the shaft. side: the frequency that
  /// decides whether the whirl is faster than the spin, Im lambda unless given.
  void set_whirl(Complex lambda, bool rotates = false, double side = nan);
  /// rad/s: the frequency of the small motions that are asked about (Context::frequency), either
  /// sign; NaN: none.
  void set_frequency(double w);
  /// Something in the system depends on the rate of set_whirl().
  bool hysteretic() const { return hysteretic_; }
  double load() const { return workspace_.context.load; }

  /// v of the steady motion: Omega ratio at spinning phi, else zero.
  /// @pre v of length system().size().
  /// @throws Error (E78) when a line that shall turn is held against it.
  void set_rates(double Omega, Eigen::Ref<VecX> v) const;
  /// Held unknowns at their laws (running.time), spinning phi that is prescribed: relative to the
  /// first prescribed one, or, where nothing is a mean over a revolution, as it stands, with its line.
  void impose(const system::Frames& f, Eigen::Ref<VecX> q) const;
  /// Internal unknowns that elements balance themselves (system::System::relax) into q.
  void relax(const system::Frames& f, double Omega, VecX& q);
  /// Mean residual; held rows are the reactions. False outside the domain of charts or elements.
  /// @pre q of length system().size(); the same of all that follow.
  bool residual(const system::Frames& f, double Omega, const VecX& q, VecX& r);
  /// Mean matrices.
  bool tangent(const system::Frames& f, double Omega, const VecX& q, la::MCK& out);
  /// K of all terms that do not see phi: what can hold a rotor's angle.
  bool blind_tangent(const system::Frames& f, double Omega, const VecX& q, la::MCK& out) {
    workspace_.context.averaged =
        true;  // a mesh whose stiffness varies joins its shafts all the same
    const bool inside = evaluate_tangent(f, Omega, q, 0.0, out, blind_);
    workspace_.context.averaged = running_.mean;
    return inside;
  }
  /// At rest: shafts that know their angle (a bow, a section that is not round, a crack) are among
  /// what blind_tangent() sees. Their weight turns them, and nothing else does.
  bool shafts_see_angle() const { return without_shafts_.size() < blind_.size(); }
  /// K of blind_tangent() without them.
  bool tangent_without_shafts(const system::Frames& f, double Omega, const VecX& q, la::MCK& out) {
    return evaluate_tangent(f, Omega, q, 0.0, out, without_shafts_);
  }
  /// f_k of orders(): complex amplitudes of what stands in the residual; the response solves S a =
  /// -f.
  bool forcing(const system::Frames& f, double Omega, const VecX& q, std::vector<VecXc>& out);
  /// Visits the states of the nodes over the revolution with the weights of the mean (once where
  /// nothing that was built sees the angle): the mean of any result is the weighted sum of what it
  /// is at the visits. False outside the domain.
  bool visit_revolution(const system::Frames& f, double Omega, const VecX& q,
                        const std::function<void(double weight, const system::Workspace&)>& visit);
  /// Samples of tangents over the revolution, for periodic systems: f(theta) with theta = 2 pi k/n,
  /// k = 0 .. n-1.
  bool tangent_at(const system::Frames& f, double Omega, const VecX& q, double theta, la::MCK& out);
  /// Compliances in series, whose harmonics are those of their moments.
  const std::vector<system::SeriesCompliance>& series() const { return series_; }
  /// Numbers of the terms they are in.
  const std::vector<std::size_t>& series_terms() const { return in_series_; }
  /// The same without them.
  bool tangent_without_series_at(const system::Frames& f, double Omega, const VecX& q, double theta,
                                 la::MCK& out);
  /// Sees an evaluation of theirs.
  bool visit_series_at(const system::Frames& f, double Omega, const VecX& q, double theta,
                       const std::function<void(const system::Workspace&)>& visit);
  /// Force of given kinks (Context::kinks) alone.
  bool series_force_at(const system::Frames& f, double Omega, const VecX& q, double theta,
                       std::span<const Vec2> kinks, VecX& r);
  /// The residual at an angle of the reference, rad; else as residual().
  bool residual_at(const system::Frames& f, double Omega, const VecX& q, double theta, VecX& r);

 private:
  /// Turns all of a line, rad.
  void turn_line(Index line, double by, Eigen::Ref<VecX> q) const;
  using Terms = std::vector<std::size_t>;
  bool evaluate_residual(const system::Frames& f, double Omega, const VecX& q, double theta,
                         VecX& r, const Terms& only);
  bool evaluate_tangent(const system::Frames& f, double Omega, const VecX& q, double theta,
                        la::MCK& out, const Terms& only);
  /// These blocks of the tangent at an angle, into sample_.
  bool evaluate_blocks(const system::Frames& f, double Omega, const VecX& q, double theta,
                       const Terms& only, const system::System::Blocks& where);
  bool add_mean_residual(const system::Frames& f, double Omega, const VecX& q, const Terms& only,
                         VecX& r);
  bool add_mean_tangent(const system::Frames& f, double Omega, const VecX& q, const Terms& only,
                        const system::System::Blocks& where, la::MCK& out);
  bool add_forcing(const system::Frames& f, double Omega, const VecX& q, const Terms& only,
                   std::vector<VecXc>& out);
  bool smooth_residual(const system::Frames& f, double Omega, const VecX& q, VecX& r);
  bool smooth_tangent(const system::Frames& f, double Omega, const VecX& q, la::MCK& out);
  /// All but what is asked_.
  bool fixed_tangent(const system::Frames& f, double Omega, const VecX& q, la::MCK& out);
  /// What depends on the rate of a small motion alone, as it is evaluated.
  bool rated_tangent(const system::Frames& f, double Omega, const VecX& q, la::MCK& out);
  /// The same, by what is kept of it.
  bool add_rated(const system::Frames& f, double Omega, const VecX& q, la::MCK& out);
  bool make_rated(const system::Frames& f, double Omega, const VecX& q);
  std::vector<int> sides(double Omega) const;
  la::MCK& part();  ///< part_, made when it is first wanted
  bool make_polynomial(const system::Frames& f, double Omega, const VecX& q);
  bool fits_polynomial(const system::Frames& f, double Omega, const VecX& q) const;
  void find_spinning();
  void sort_terms();
  /// Elements of shafts that turn as a whole, and see at what angle they stand.
  bool is_shaft_at_angle(const system::Term& term, const system::Context& mean) const;
  void set_apart_asked_terms();
  /// Multiples of the angle that the terms declare, at least 2.
  Index most_harmonics() const;
  void make_samples();
  void find_unsteady_joint();
  void make_samples_of_orders();

  const system::System& system_;
  SteadyRotation running_;
  std::vector<double> ratio_, orders_;
  std::vector<double> sense_;  ///< of the nodes
  std::vector<unsigned char> spinning_;
  std::vector<std::pair<Index, Index>>
      held_;                        ///< line that cannot turn, and the node at which it is held
  std::string unsteady_joint_;      ///< of lines that do not turn as one; empty: none
  Terms smooth_, other_;            ///< blind to phi: quadratic in the rates; the rest
  Terms turning_smooth_, turning_;  ///< that see phi: the same
  Terms blind_, without_shafts_, all_;
  std::vector<system::SeriesCompliance> series_;
  Terms in_series_, without_series_;
  /// Of other_ and of turning_: those that answer differently to motions of another frequency or rate
  /// (tables, hysteretic damping); the rest.
  Terms asked_, steady_, turning_asked_, turning_steady_;
  /// Those on the rate alone.
  Terms rated_, turning_rated_;
  /// Where the tangents of what turns stand.
  system::System::Blocks of_turning_smooth_, of_turning_asked_, of_turning_rated_,
      of_turning_steady_;
  /// Tangents that depend on the rate alone, as they do: base + by_whirl/w + by_growth g/w for a motion
  /// exp((g + iw) t), while it stays on its side of the spin of every line.
  struct Rated {
    double Omega = nan, load = nan;
    bool rotates = false;
    std::vector<int> sides;
    VecX q;
    std::vector<Mat3> charts;
    la::MCK base, by_whirl, by_growth;
  };
  std::unique_ptr<Rated> rates_;
  std::vector<double> theta_;  ///< samples
  MatX weights_;               ///< rows: mean, then cos and sin of each order; columns: samples
  bool hysteretic_ = false;
  system::Workspace workspace_;
  VecX q_, v_, a_, r_;  // scratch
  la::MCK part_, sample_;
  // Of means: the sum over the samples, and of what they are without signs; of tangents M, C, K one
  // after another, block after block
  VecX mean_, size_, mean_r_, size_r_;
  // What depends on neither the frequency nor the rate asked about, kept while the state stays
  la::MCK fixed_;
  bool have_fixed_ = false;
  double fixed_speed_ = 0, fixed_load_ = 1;
  VecX fixed_q_;
  std::vector<Mat3> fixed_charts_;
  /// Smooth terms as polynomials in the speed, at one q.
  struct Polynomials {
    double scale = 0;  ///< rad/s, of the speeds they were made from
    VecX q;
    std::vector<Mat3> charts;
    la::MCK p0, p1;         ///< constant part; slopes of C and K
    la::BlockMatrix<6> k2;  ///< curvature of K
    VecX r0, r1, r2;
    std::vector<VecXc> f0, f1, f2;  ///< forcing
  };
  std::shared_ptr<const Polynomials> polynomial_;  ///< null: there are none
  bool seen_ = false;
  double seen_speed_ = 0;
  VecX seen_q_;
};

/// Sign of the spin that whirl at each node is measured against, +1 or -1, one a node, at a
/// positive reference speed. ratio: spin of each line relative to the reference (lines beyond its
/// end stand still). A node of a shaft that turns has the sign of that shaft. What stands (casing,
/// pedestal, foundation) follows the shaft it carries: the nearest one along its own elements and
/// supports; where shafts that turn either way are equally near, the first turning shaft decides.
/// So it does for parts that carry no shaft. Without any turning shaft all are +1. A mirrored
/// machine has the opposite signs throughout.
std::vector<double> spin_senses(const system::System& system, std::span<const double> ratio);

}  // namespace whirl::analysis
