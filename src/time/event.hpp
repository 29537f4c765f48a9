// Events: where inside a step the motion passes from one side of something to another (a function
// changes sign, a gap closes), located on the step's dense output.
#pragma once
#include <core/contract.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

  /// Sign changes of g(t), zero counted as positive. last: g at t0; left with g at the end of what was
  /// looked at. found(passage, rising) returns whether to look on. Where three neighbouring looks
  /// bend towards zero, the turning between them is looked at too: a passage there and back is two
  /// events.
  template <class G, class Found>
  void sign_changes(double t0, double t1, double& last, G&& g, Found&& found) const {
    WHIRL_EXPECTS(looks_.size() <= most_looks);
    std::array<Look, 2 * most_looks + 1> look;
    const std::size_t n = look_at(t0, t1, last, g, look);
    double side = last;  // that the motion is on
    for (std::size_t k = 1; k < n; ++k) {
      last = look[k].value;
      if ((last < 0.0) == (side < 0.0)) continue;
      const Passage passage = bracket({look[k - 1].time, look[k].time}, t1 - t0,
                                      [&](double t) { return (g(t) < 0.0) != (side < 0.0); });
      side = last;
      if (!found(passage, last >= 0.0)) return;
    }
  }

 private:
  static constexpr std::size_t most_looks = 8;
  struct Look {
    double time, value;
  };

  /// The beginning, the looks, and between them the turnings of g that reach the other side of zero.
  template <class G>
  std::size_t look_at(double t0, double t1, double first, G&& g,
                      std::array<Look, 2 * most_looks + 1>& out) const {
    const double side = first < 0.0 ? -1.0 : 1.0;
    const auto distance = [&](double t) { return side * g(t); };
    std::size_t n = 0;
    out[n++] = {t0, first};
    Look before{t0, first}, here = before;
    for (const double part : looks_) {
      const double t = part == 1.0 ? t1 : t0 + (t1 - t0) * part;
      const Look next{t, g(t)};
      std::optional<double> turning;
      if (before.time < here.time)
        turning =
            turning_below({before.time, here.time, next.time},
                          {side * before.value, side * here.value, side * next.value}, distance);
      const bool known = n > 1 && side * out[n - 2].value < 0.0;  // from the looks before
      if (turning && *turning > here.time) {
        out[n++] = {*turning, g(*turning)};
      } else if (turning && !known) {
        out[n - 1] = {*turning, g(*turning)};
        out[n++] = here;
      }
      out[n++] = next;
      before = here;
      here = next;
    }
    return n;
  }

  /// Where a distance that is not below zero at three looks is so between them.
  template <class F>
  static std::optional<double> turning_below(std::array<double, 3> x, std::array<double, 3> f,
                                             F&& distance) {
    if (*std::min_element(f.begin(), f.end()) < 0.0) return {};
    for (int round = 0; round < 40; ++round) {
      // the parabola through the three
      const double left = (f[1] - f[0]) / (x[1] - x[0]), right = (f[2] - f[1]) / (x[2] - x[1]);
      const double bend = (right - left) / (x[2] - x[0]);
      if (!(bend > 0.0)) return {};
      const double least = 0.5 * (x[0] + x[1] - left / bend);
      if (!(least > x[0] && least < x[2])) return {};
      const double predicted = f[0] + (least - x[0]) * (left + bend * (least - x[1]));
      // three looks see the bottom to a part of their own height above it
      const double lowest = *std::min_element(f.begin(), f.end());
      const double seen = std::max(0.5 * lowest, 0.05 * std::min(f[0], f[2]));
      if (round == 0 && predicted > seen) return {};
      const double value = distance(least);
      if (value < 0.0) return least;
      if (std::abs(least - x[1]) <= 1e-9 * (x[2] - x[0])) return {};
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
    return {};
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
