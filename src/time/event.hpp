// Events: where inside a step the motion passes from one side of something to another (a function
// changes sign, a gap closes), located on the step's dense output.
#pragma once
#include <core/contract.hpp>
#include <algorithm>
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

/// Finds the events of a step in order. Of an even number of passages between two neighbouring looks
/// only a single turning is found, and only by sign_changes(); an event at the very start of a step belongs to the step before.
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
  /// on. Where three neighbouring looks bend towards zero, the turning between them is looked at too:
  /// a passage there and back is two events.
  template <class G, class Found>
  void sign_changes(double t0, double t1, double& last, G&& g, Found&& found) const {
    std::array<double, 2 * most_looks> parts;
    const std::size_t n = add_turnings(t0, t1, last, g, parts);
    const EventLocator closer(std::span(parts.data(), n), precision_);
    closer.search(
        t0, t1, [&](double t) { return (g(t) < 0.0) != (last < 0.0); },
        [&](const Passage& passage) {
          const bool rising = last < 0.0;
          last = rising ? 1.0 : -1.0;
          return found(passage, rising);
        });
  }

 private:
  static constexpr std::size_t most_looks = 8;

  /// The looks, and between them the turnings of g that reach the other side of zero.
  template <class G>
  std::size_t add_turnings(double t0, double t1, double last, G&& g,
                           std::array<double, 2 * most_looks>& parts) const {
    WHIRL_EXPECTS(looks_.size() <= most_looks);
    const double side = last < 0.0 ? -1.0 : 1.0;
    std::size_t n = 0;
    // distance from zero on the side the step begins on
    const auto distance = [&](double part) { return side * g(t0 + (t1 - t0) * part); };
    double before = 0.0, here = 0.0, at_before = 0.0, at_here = distance(0.0), last_turning = 0.0;
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      const double next = looks_[k], at_next = distance(next);
      const bool above = at_before >= 0.0 && at_here >= 0.0 && at_next >= 0.0;
      const double turning = k > 0 && above ? turning_below({before, here, next},
                                                            {at_before, at_here, at_next}, distance)
                                            : 0.0;
      if (turning > last_turning) {
        last_turning = turning;
        if (turning < here) parts[n - 1] = turning;
        parts[n++] = std::max(turning, here);
      }
      parts[n++] = next;
      before = here;
      at_before = at_here;
      here = next;
      at_here = at_next;
    }
    return n;
  }

  /// Where a distance between three looks, all above zero, is least and below zero; else 0.
  template <class F>
  static double turning_below(std::array<double, 3> x, std::array<double, 3> f, F&& distance) {
    for (int round = 0; round < 40; ++round) {
      // the parabola through the three
      const double left = (f[1] - f[0]) / (x[1] - x[0]), right = (f[2] - f[1]) / (x[2] - x[1]);
      const double bend = (right - left) / (x[2] - x[0]);
      if (!(bend > 0.0)) return 0.0;
      const double least = 0.5 * (x[0] + x[1] - left / bend);
      if (!(least > x[0] && least < x[2])) return 0.0;
      const double predicted = f[0] + (least - x[0]) * (left + bend * (least - x[1]));
      // three looks see the bottom to a part of their own height above it
      const double lowest = *std::min_element(f.begin(), f.end());
      const double seen = std::max(0.5 * lowest, 0.05 * std::min(f[0], f[2]));
      if (round == 0 && predicted > seen) return 0.0;
      const double value = distance(least);
      if (value < 0.0) return least;
      if (std::abs(least - x[1]) <= 1e-9 * (x[2] - x[0])) return 0.0;
      // the lowest of the four and its neighbours
      const bool left_of = least < x[1], lower = value < f[1];
      const std::size_t replaced = lower ? 1 : left_of ? 0 : 2;
      if (lower) {
        const std::size_t end = left_of ? 2 : 0;
        x[end] = x[1];
        f[end] = f[1];
      }
      x[replaced] = least;
      f[replaced] = value;
    }
    return 0.0;
  }

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
