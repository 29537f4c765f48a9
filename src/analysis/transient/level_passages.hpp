// Passages of a level that the motion may reach and stay at: what is next to the level by rounding,
// or by the error of the integrator, is no passage.
#pragma once
#include <core/archive.hpp>
#include <time/event.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace whirl::analysis {

/// Of g = value - level. The motion passes where g changes its sign after it was farther than `hold`
/// from the level, at that instant. A change of sign after which it was not counts where it goes on
/// to more than `hold` on the other side. Once it was farther away, what comes nearer than `reach`
/// has reached the level: a law that ends there.
class LevelPassages {
 public:
  LevelPassages(double reach, double hold) : reach_(reach), hold_(hold) {}

  /// g at the start. away: as if it came from farther than `hold`.
  void begin(double g, bool away = false) {
    above_ = g >= 0.0;
    left_ = away || std::abs(g) > hold_;
    pending_.reset();
    last_ = g;
  }
  /// found(t, rising) of every passage, t at most the end of the step; returns whether to look on.
  template <class G, class Found>
  void search(const time::EventLocator& locator, double t0, double t1, G&& g, Found&& found) {
    seen_.assign(1, {t0, std::abs(last_)});
    const double shift = toward();
    double shifted = last_ + shift, from = t0;
    bool more = true;
    const auto distance = [&](double t) {
      const double value = g(t);
      seen_.push_back({t, std::abs(value)});
      if (t == t1) last_ = value;
      return value + shift;
    };
    locator.sign_changes(t0, t1, shifted, distance, [&](const time::Passage& p, bool rising) {
      more = leave(from, p.before, found) && pass({p.after, rising}, found);
      from = p.after;
      return more;
    });
    if (more) leave(from, t1, found);
  }

  /// The side it was on last.
  bool comes_from_below() const { return !above_; }

  void save(OutArchive& out) const {
    out.put(last_);
    out.put_count((above_ ? 1 : 0) + (left_ ? 2 : 0) + (pending_ ? 4 : 0));
    if (pending_) out.put(pending_->t);
  }
  void restore(InArchive& in) {
    last_ = in.number();
    const auto flags = in.count();
    above_ = flags & 1;
    left_ = flags & 2;
    pending_.reset();
    if (flags & 4) pending_ = {in.number(), !above_};
  }

 private:
  struct Crossing {
    double t;
    bool rising;
  };
  struct Look {
    double t, distance;
  };

  /// What comes near has reached the level; what has left it must go as far to come back.
  double toward() const { return above_ == left_ ? -reach_ : reach_; }

  /// Whether it was farther than `hold` from the level between two times on one side of it.
  template <class Found>
  bool leave(double t0, double t1, Found&& found) {
    const bool away = hold_ == 0.0 || std::any_of(seen_.begin(), seen_.end(), [&](const Look& x) {
                        return x.t >= t0 && x.t <= t1 && x.distance > hold_;
                      });
    if (!away) return true;
    left_ = true;
    if (!pending_) return true;
    const Crossing late = *pending_;
    pending_.reset();
    above_ = late.rising;
    return found(late.t, late.rising);
  }
  template <class Found>
  bool pass(Crossing c, Found&& found) {
    if (c.rising == above_) {
      pending_.reset();
      return true;
    }
    if (!left_) {
      pending_ = c;
      return true;
    }
    above_ = c.rising;
    left_ = false;
    return found(c.t, c.rising);
  }

  double reach_, hold_;
  double last_ = 0.0;  ///< g at the end of the last step
  bool above_ = true, left_ = false;
  std::optional<Crossing> pending_;  ///< a change of sign that may be none
  std::vector<Look> seen_;           ///< of one step
};

}  // namespace whirl::analysis
