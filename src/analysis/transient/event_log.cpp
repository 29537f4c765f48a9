#include <analysis/transient/event_log.hpp>
#include <time/event.hpp>

namespace whirl::analysis {

void EventLog::begin(const Snapshot& s) {
  for (std::size_t i = 0; i < watches_.size(); ++i)
    last_[i] = watches_[i].g(s);
}

void EventLog::step(StepAccess& s) {
  // to the round-off of the dense output
  static constexpr time::EventLocator locator(time::quarters, {1e-12, 1e-12});
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const Watch& w = watches_[i];
    locator.sign_changes(
        s.t0(), s.t1(), last_[i], [&](double t) { return w.g(s.at(t)); },
        [&](const time::Passage& passage, bool rising) {
          if (w.direction != 0 && rising != (w.direction > 0)) return true;
          const double t = passage.after;
          if (events_.size() < most)
            events_.push_back({i, t, s.at(t).node(reference_).spin(), rising});
          else
            ++more_;
          return true;
        });
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
