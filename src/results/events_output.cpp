// When what [[event]] names happened.
#include <analysis/transient/event_log.hpp>
#include <results/speed_level.hpp>
#include <results/transient_output.hpp>

#include <fmt/format.h>

namespace whirl::results {

namespace {

/// g of a level of the reference speed.
void watch_speed(const TransientSetup& setup, double speed, analysis::EventLog::Watch& w) {
  const Index node = setup.job.reference();
  const SpeedLevel level = speed_level(setup.job, speed, setup.law.integrator.tolerance);
  w.reach = level.reach;
  w.hold = level.hold;
  w.g = [node, level](const analysis::Snapshot& s) {
    return (level.angle ? level.angle->at(s.t()).df : s.node(node).spin()) - level.spin;
  };
  // a shaft that turns against the reference passes it from the other side
  if (setup.job.reference_ratio() < 0.0)
    w.g = [against = w.g](const analysis::Snapshot& s) { return -against(s); };
}

std::vector<analysis::EventLog::Watch> watches_of(const TransientSetup& setup) {
  const run::Job& job = setup.job;
  std::vector<analysis::EventLog::Watch> out;
  for (const model::Event& e : job.model.events) {
    analysis::EventLog::Watch w{e.name, {}, e.direction};
    if (e.kind == model::Event::Kind::speed)
      watch_speed(setup, e.value, w);
    else
      w.g = [p = point_of(job, *e.at), x = e.value](const analysis::Snapshot& s) {
        return analysis::displacement(s, p).tail<2>().norm() - x;
      };
    out.push_back(std::move(w));
  }
  return out;
}

class EventsOutput final : public TransientOutput {
 public:
  explicit EventsOutput(const TransientSetup& s) : log_(watches_of(s), s.job.reference()) {
    for (const model::Event& e : s.job.model.events)
      content_ += fmt::format(" {} {} {}", e.name, e.value, e.direction);
  }

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&log_);
    parts.add({run::Part::events, content_}, log_);
  }

  void report(TransientEnd& end) override {
    io::Table t;
    t.title = "Events";
    t.columns = {{"event", "-", ""}, {"passage", "-", ""}, {"time", "s", ""}, {"speed", "rpm", ""}};
    for (const analysis::EventLog::Happened& e : log_.events())
      t.add({log_.watches()[e.watch].name, e.rising ? "rising" : "falling", e.t, to_rpm(e.speed)});
    const std::string file = end.step.name + "_events.csv";
    end.job.folder.write_table(file, t);
    end.summary["events"] = log_.events().size() + log_.more();
    if (t.rows.size() > 100) {
      t.title = "Events (the first 100)";
      t.rows.resize(100);
    }
    end.section.tables.push_back(std::move(t));
    end.section.files.emplace_back("events", file);
  }

 private:
  std::string content_;
  analysis::EventLog log_;
};

}  // namespace

void add_events(const TransientSetup& setup, TransientOutputs& outputs) {
  if (!setup.job.model.events.empty()) outputs.push_back(std::make_unique<EventsOutput>(setup));
}

}  // namespace whirl::results
