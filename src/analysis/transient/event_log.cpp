#include <analysis/transient/event_log.hpp>

#include <cmath>

namespace whirl::analysis {

void EventLog::begin(const Snapshot& s) {
  for (std::size_t i = 0; i < watches_.size(); ++i)
    last_[i] = watches_[i].g(s);
}

void EventLog::step(StepAccess& s) {
  // a step may span a good part of a whirl: four looks, as for stops
  constexpr int looks = 4;
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const Watch& w = watches_[i];
    double a = s.t0(), ga = last_[i];
    for (int k = 1; k <= looks; ++k) {
      const double b = k == looks ? s.t1() : s.t0() + (s.t1() - s.t0()) * k / looks,
                   gb = w.g(s.at(b));
      if ((ga < 0.0) != (gb < 0.0)) {
        const bool rising = ga < 0.0;
        if (w.direction == 0 || rising == (w.direction > 0)) {
          double lo = a, hi = b;
          // to 1e-12 of the time or the step, whichever is coarser: round-off of the dense output
          const double width = 1e-12 * std::max(std::abs(hi), s.t1() - s.t0());
          while (hi - lo > width) {
            const double m = 0.5 * (lo + hi);
            if (m == lo || m == hi) break;
            ((w.g(s.at(m)) < 0.0) == rising ? lo : hi) = m;
          }
          if (events_.size() < most)
            events_.push_back({i, hi, s.at(hi).node(reference_).spin(), rising});
          else
            ++more_;
        }
      }
      a = b;
      ga = gb;
    }
    last_[i] = ga;
  }
}

void EventLog::save(OutArchive& out) const {
  out.put(last_);
  out.put_count(more_);
  out.put_count(events_.size());
  for (const Happened& e : events_) {
    out.put_count(e.watch);
    out.put(e.t);
    out.put(e.speed);
    out.put_count(e.rising ? 1 : 0);
  }
}

void EventLog::restore(InArchive& in) {
  last_ = in.numbers();
  more_ = in.count();
  events_.resize(in.count());
  for (Happened& e : events_) {
    e.watch = in.count();
    e.t = in.number();
    e.speed = in.number();
    e.rising = in.count() != 0;
  }
}

}  // namespace whirl::analysis
