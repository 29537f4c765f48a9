#include <analysis/transient/event_log.hpp>
#include <time/event.hpp>

#include <algorithm>

namespace whirl::analysis {

void EventLog::begin(const Snapshot& s) {
  step_begin_ = s.t();
  for (std::size_t i = 0; i < watches_.size(); ++i)
    passages_[i].begin(watches_[i].g(s));
}

void EventLog::add(std::size_t watch, double t, const Snapshot& s, bool rising) {
  if (events_.size() < most)
    events_.push_back({watch, t, s.node(reference_).spin(), rising});
  else
    ++more_;
}

void EventLog::step(StepAccess& s) {
  // to the round-off of the dense output
  static constexpr time::EventLocator locator(time::quarters, {1e-12, 1e-12});
  step_begin_ = s.t0();
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const Watch& w = watches_[i];
    passages_[i].search(
        locator, s.t0(), s.t1(), [&](double t) { return w.g(s.at(t)); },
        [&](double t, bool rising) {
          if (w.direction != 0 && rising != (w.direction > 0)) return true;
          // one that turned out to be none of rounding later than its step
          add(i, t, s.at(std::max(t, s.t0())), rising);
          return true;
        });
  }
}

/// The step that ends where a run stops may end a rounding before it.
void EventLog::stopped(const Snapshot& s, std::size_t event) {
  WHIRL_EXPECTS(event < watches_.size());
  const auto in_last_step = [&](const Happened& e) {
    return e.watch == event && e.t >= step_begin_;
  };
  if (std::any_of(events_.begin(), events_.end(), in_last_step)) return;
  add(event, s.t(), s, passages_[event].comes_from_below());
}

void EventLog::save(OutArchive& out) const {
  for (const LevelPassages& p : passages_)
    p.save(out);
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
  for (LevelPassages& p : passages_)
    p.restore(in);
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
