// What elements keep (system::Frames::kept) while time goes on: temperatures of films as viscosities
// and clearances.
//
// Every value x goes towards the one x_b that the motion would have in balance,
//   x' = (x_b(q, v) - x)/tau,   tau: system::Keeper::time_constant,
// from one look at the balance to the next in a straight line, so that forces have no jumps:
// x += (1 - exp(-dt/tau)) (x_b - x). A balance of the moment differs along an orbit: the looks fall on
// its phases in no order (golden ratio), and each counts for a twentieth of tau or less where two thousand
// looks are enough for that, so that what is kept follows the mean. It lags by half the time between two
// looks.
#pragma once
#include <analysis/transient/observer.hpp>

#include <functional>
#include <span>

namespace whirl::analysis {

class KeptInTime final : public Observer {
 public:
  /// A look: time s, the values kept there and those in balance.
  using Sink =
      std::function<void(double t, std::span<const double> kept, std::span<const double> balance)>;

  /// dt_fixed: of equal steps, s; 0: they adapt, and must not be longer than every().
  /// @pre at least one keeper of the system has a finite time constant; duration > 0.
  KeptInTime(const system::System& system, double t_begin, double duration, double dt_fixed,
             Sink sink);

  /// Whether there is something that time changes.
  static bool any(const system::System& system);

  void begin(const Snapshot& s) override { look(s); }
  void step(StepAccess& s) override;
  /// After a look: goes on at time t from what is kept there, with new rates.
  void apply(double t, system::Frames& frames);
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;

  /// Time between two looks in the mean, s.
  double every() const { return every_; }
  /// Of `count` values from `first` on, from one look to the next.
  double largest_change(std::size_t first, std::size_t count) const;

 private:
  double look_at(long k) const;
  void look(const Snapshot& s);

  const system::System& system_;
  double t_begin_, every_;
  long looks_ = 0;
  Sink sink_;
  bool due_ = false;
  double last_step_ = 0;
  std::vector<double> settled_, largest_, kept_;
};

}  // namespace whirl::analysis
