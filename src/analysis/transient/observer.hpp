// Observers watch a transient step by step: time histories, frames, peaks, energy balance,
// checkpoints. The stepping loop knows none of them; what a deck does not ask for is an observer
// that does not exist.
#pragma once
#include <analysis/transient/measurement.hpp>
#include <analysis/transient/orbit_width.hpp>
#include <core/archive.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace whirl::analysis {

/// The accepted step [t0, t1] with its dense output. at() evaluates a state inside it; the
/// reference is good until the next call.
class StepAccess {
 public:
  virtual ~StepAccess() = default;
  virtual double t0() const = 0;
  virtual double t1() const = 0;
  virtual const Snapshot& at(double t) = 0;
  const Snapshot& end() { return at(t1()); }
  /// Lateral displacements (y, z) of points, global axes, m: as at(t) says, and cheaper where the
  /// unknowns of these points can be interpolated alone. What at() gave stays good.
  virtual void displacements(double t, std::span<const Point> points, std::vector<Vec2>& out) {
    lateral(at(t), points, out);
  }
  /// How a node turns about its axis: the angle with its whole turns, rad, and its rate, rad/s.
  struct Angle {
    double phi = 0, rate = 0;
  };
  /// As at(t) says, and cheaper in the same way.
  virtual Angle angle(double t, Index node) {
    const Snapshot& s = at(t);
    return {s.total_phi(node), s.node(node).dphi};
  }
  /// Spin of a node, rad/s, in the same way.
  virtual double spin(double t, Index node) { return at(t).node(node).spin(); }
  /// Power supplied and dissipated at t, as at(t).exchange() says, and cheaper where few elements do
  /// either. What at() gave before is no longer good.
  virtual time::Problem::Power exchange(double t) { return at(t).exchange(); }
  /// Power dissipated at t, W, in the same way.
  virtual double dissipation(double t) { return at(t).dissipation(); }
  /// time::Integrator::residual_work of the step.
  virtual std::optional<double> residual_work() { return std::nullopt; }

 protected:
  static void lateral(const Snapshot& s, std::span<const Point> points, std::vector<Vec2>& out) {
    out.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      out[i] = displacement(s, points[i]).tail<2>();
  }
};

class Observer {
 public:
  virtual ~Observer() = default;
  /// The initial state, once.
  virtual void begin(const Snapshot& s) { (void)s; }
  virtual void step(StepAccess& s) = 0;
  /// An event, by its number in the deck, has ended the run.
  virtual void stopped(const Snapshot& s, std::size_t event) {
    (void)s;
    (void)event;
  }
  virtual void end() {}
  /// What it knows so far, for a checkpoint; restore() of an observer made alike instead of begin()
  /// continues bit for bit.
  virtual void save(OutArchive& out) const { (void)out; }
  virtual void restore(InArchive& in) { (void)in; }
};

/// Times k * every from t_begin on, free of accumulated rounding.
class Ticker {
 public:
  Ticker(double t_begin, double every) : t0_(t_begin), every_(every) {}
  double next() const { return t0_ + static_cast<double>(k_) * every_; }
  void advance() { ++k_; }
  /// To the first time beyond t, as if by advance() alone.
  void pass(double t) {
    const double turns = every_ > 0 ? std::floor((t - t0_) / every_) - 1 : 0;
    if (turns > static_cast<double>(k_) && turns < 9e18) k_ = static_cast<long>(turns);
    while (next() <= t)
      advance();
  }
  long count() const { return k_; }
  void set_count(long k) { k_ = k; }

 private:
  double t0_, every_;
  long k_ = 0;
};

/// Receives rows of measured values.
using RowSink = std::function<void(const std::vector<double>&)>;

/// Rows of measurements (time first) at fixed intervals, or at every accepted step (every = 0).
/// Decimation by interval; window by [t0, t1]. Values are SI and unscaled.
class Recorder final : public Observer {
 public:
  /// gate: rows only where it says so (null: everywhere).
  using Gate = std::function<bool(const Snapshot&)>;
  Recorder(std::vector<Measurement> channels, RowSink sink, double t_begin, double every,
           double t0 = -infinity, double t1 = infinity, Gate gate = {});
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  long rows() const { return rows_; }

 private:
  void write(const Snapshot& s);
  std::vector<Measurement> channels_;
  RowSink sink_;
  Gate gate_;
  Ticker ticker_;
  double every_, t0_, t1_;
  long rows_ = 0;
  std::vector<double> row_;
};

/// Largest lateral amplitude of a point, where on the speed axis it happened, refined inside steps.
struct Peak {
  std::string name;
  double amplitude = 0, time = 0, speed = 0;  ///< m, s, rad/s
};
class PeakTracker final : public Observer {
 public:
  /// reference: node whose spin is the speed axis. All points share the looks at the dense output
  /// of a step, four of them and nine where one comes near its peak; between looks each point moves
  /// by the polynomial through them (a thousand points cost little more than one).
  /// turns_of: for each point the node that turns with its shaft, for its motion apart from sag and
  /// drift (OrbitWidth); empty: not asked for.
  PeakTracker(const std::vector<std::pair<std::string, Point>>& points, Index reference,
              double t_from = -infinity, std::vector<Index> turns_of = {});
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  const std::vector<Peak>& peaks() const { return peaks_; }
  /// Of each point, where the turns of its shaft are known.
  const std::vector<OrbitWidth>& motions() const { return motions_; }

 private:
  static constexpr int looks = 9;  ///< at k/8 of the step, k = 0 .. 8
  static double time_of(const StepAccess& s, double k) {
    return k == looks - 1 ? s.t1() : s.t0() + (s.t1() - s.t0()) * k / (looks - 1);
  }
  void look(StepAccess& s, int k);
  void widen(StepAccess& s);
  void refine(StepAccess& s, std::size_t point, double best, double where);
  /// Where in [a, b] the amplitude of a point has its maximum nearest to x, by Newton's iteration;
  /// -1 where that does not lead there.
  double vertex_in(double a, double b, double x, std::size_t point) const;
  double spin_at(StepAccess& s, double k);

  std::vector<Point> points_;
  std::vector<Peak> peaks_;
  std::vector<Index> turns_of_;  ///< a node of each point; empty: their motion is not asked for
  std::vector<OrbitWidth> motions_;
  std::vector<Vec2> last_;  ///< where the points of motions_ were at the end of the last step, m
  Index reference_;
  double t_from_;
  std::array<std::vector<Vec2>, looks> seen_;  ///< lateral displacements of all points
  /// Spin at every other look of this step; looked up where a new peak asks for it.
  static constexpr int spins = (looks + 1) / 2;
  std::array<double, spins> spin_{};
  bool spin_known_ = false;
};

/// Work and energy: E(t) - E(0) = work supplied - energy dissipated; the defect is the run's own
/// measure of accuracy. Where a law jumps, mass may come or go at an instant (blade loss): the
/// energy it brings counts as supplied.
class EnergyBalance final : public Observer {
 public:
  /// A node whose angle is prescribed: its torque is known to the rounding of angles times the
  /// torsional stiffness of the shaft beside it, N m/rad.
  struct Driven {
    Index node;
    double stiffness;
  };
  /// jumps: times, increasing, at which laws jump and steps end.
  explicit EnergyBalance(std::vector<double> jumps = {}, std::vector<Driven> driven = {})
      : jumps_(std::move(jumps)),
        driven_(std::move(driven)) {}
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  double stored0() const { return e0_; }
  double stored() const { return e1_; }
  double supplied() const { return supplied_; }
  double dissipated() const { return dissipated_; }
  double defect() const { return e1_ - e0_ - supplied_ + dissipated_; }
  double worst_defect() const { return worst_; }
  /// Energy that changed its place, J: the largest of the vibration's at the start, of what was
  /// supplied, what was dissipated, and how far the kinetic, the potential and the stored energy departed from their starts. What a
  /// defect is measured by: in a conservative motion nothing but the exchange between kinetic and
  /// potential energy. The defect itself is no part of it.
  double exchanged() const { return exchanged_; }
  /// Largest kinetic or potential energy, J: the measure of a motion that turns over nothing (a
  /// steady whirl without damping).
  double largest_energy() const { return std::max(largest_kinetic_, largest_potential_); }
  /// False when the motion left the range in which the energies of its elements are defined (a
  /// film's clearance).
  bool known() const { return known_; }
  /// What the defect may reach by rounding alone: twenty last digits of the stored energy, a sum
  /// over elements, a step; and the work of what is rounding in the torques that hold prescribed
  /// angles.
  double rounding() const { return rounding_; }

 private:
  std::vector<double> jumps_;
  std::vector<Driven> driven_;
  void add_rounding(StepAccess& s, double stored, double kinetic);
  /// Where the power supplied is what closes the balance but for the work of the residual, its
  /// integral is known without it.
  void step_by_residual(StepAccess& s, double work);
  bool jumps_at(double t) const;
  void look(const time::Problem::Power& p);
  double rounding_ = 0;
  double e0_ = 0, kinetic0_ = 0, e1_ = 0, supplied_ = 0, dissipated_ = 0, worst_ = 0,
         largest_kinetic_ = 0, largest_potential_ = 0, exchanged_ = 0;
  bool known_ = true;
};

/// Largest tilt |gamma| of any node, where and when: how far the run was from the limit of the
/// chart (pi).
class TiltWatch final : public Observer {
 public:
  void begin(const Snapshot& s) override { look(s); }
  void step(StepAccess& s) override { look(s.end()); }
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  double tilt() const { return tilt_; }
  double time() const { return time_; }
  Index node() const { return node_; }

 private:
  void look(const Snapshot& s);
  double tilt_ = 0, time_ = 0;
  Index node_ = 0;
};

}  // namespace whirl::analysis
