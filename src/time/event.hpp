// Events: where inside a step the motion passes from one side of something to another (a function
// changes sign, a gap closes), located on the step's dense output.
#pragma once
#include <core/contract.hpp>
#include <array>
#include <cmath>
#include <span>

namespace whirl::time {

/// Bracket of an event: the motion is on the old side at `before`, s, and on the new one at
/// `after`, s.
struct Passage {
  double before, after;
};

/// A bracket is halved until it is no wider than of_step times the step or of_time times the time,
/// whichever is coarser.
struct EventPrecision {
  double of_step, of_time;
};

/// Where a step is looked at, as parts of it: a step may span a good part of a whirl.
inline constexpr std::array<double, 4> quarters{0.25, 0.5, 0.75, 1.0};

/// Finds the events of a step in order. An even number of passages between two neighbouring looks
/// is missed; an event at the very start of a step belongs to the step before.
class EventLocator {
 public:
  /// looks: parts of a step, ascending, the last one 1; they are not copied.
  constexpr EventLocator(std::span<const double> looks, EventPrecision precision)
      : looks_(looks),
        precision_(precision) {}

  /// moved(t): whether the motion at t stands on another side than it did at t0 or, later, at the
  /// last passage. found(passage): makes passage.after the state that moved() compares with, and
  /// returns whether to look on.
  template <class Moved, class Found>
  void search(double t0, double t1, Moved&& moved, Found&& found) const {
    WHIRL_EXPECTS(t1 >= t0);
    double before = t0;
    for (const double part : looks_) {
      const double look = part == 1.0 ? t1 : t0 + (t1 - t0) * part;
      while (before < look && moved(look)) {
        const Passage passage = bracket({before, look}, t1 - t0, moved);
        if (!found(passage)) return;
        before = passage.after;
      }
      before = look;
    }
  }

  /// Sign changes of g(t), zero counted as positive. last: a value of the sign g has at t0; left
  /// with the sign at the end of what was looked at. found(passage, rising) returns whether to look
  /// on.
  template <class G, class Found>
  void sign_changes(double t0, double t1, double& last, G&& g, Found&& found) const {
    search(
        t0, t1, [&](double t) { return (g(t) < 0.0) != (last < 0.0); },
        [&](const Passage& passage) {
          const bool rising = last < 0.0;
          last = rising ? 1.0 : -1.0;
          return found(passage, rising);
        });
  }

 private:
  template <class Moved>
  Passage bracket(Passage p, double step, Moved&& moved) const {
    WHIRL_EXPECTS(p.after >= p.before);
    while (p.after - p.before > precision_.of_step * step &&
           p.after - p.before > precision_.of_time * std::abs(p.after)) {
      const double middle = 0.5 * (p.before + p.after);
      (moved(middle) ? p.after : p.before) = middle;
    }
    return p;
  }

  std::span<const double> looks_;
  EventPrecision precision_;
};

}  // namespace whirl::time
