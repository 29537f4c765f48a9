// Tracking filter of a transient's probes: CSV turn by turn, and what its report shows
// (keyphasor_report.cpp). Every shaft has its own keyphasor; casings are looked at by that of the
// reference. Memory is bounded: long runs are thinned for the figures, the CSV holds every turn.
#include <analysis/spectra/whirl_modes.hpp>
#include <analysis/transient/order_filter.hpp>
#include <core/text.hpp>
#include <results/channels.hpp>
#include <results/keyphasor_turns.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

/// A shaft and the probes that its keyphasor serves.
struct Keyphasor {
  Index node = 0;                   ///< whose angle it sees
  std::string shaft;                ///< empty: the reference
  std::vector<std::size_t> probes;  ///< of the model
};

class KeyphasorOutput final : public TransientOutput {
 public:
  KeyphasorOutput(const TransientSetup& s, const Keyphasor& keyphasor);
  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&revolutions_);
    parts.add_output({run::Part::keyphasor, content_}, *this);
  }
  analysis::Observer& observer() { return revolutions_; }
  void begin();
  void save(OutArchive& out);
  void restore(InArchive& in);
  void close() override {
    filter_.end();
    if (sink_) sink_->close();
  }
  void report(TransientEnd& end) override { report_turns(turns_, end); }

 private:
  void add_probe(const model::Probe& probe, double sense);
  void take(const analysis::Turn& turn, std::span<const Complex> y, std::span<const Complex> z,
            std::span<const analysis::Turn> seen);
  void take_orbit(std::size_t probe, const analysis::Turn& turn);
  TrackedOrbit last_turns(std::size_t probe, double t, double speed, double size) const;
  std::vector<io::Channel> channels() const;

  static constexpr std::size_t most_orbits = 64;
  const model::Output& out_;
  TrackedTurns turns_;
  std::string content_;           ///< whether a part of a checkpoint fits
  std::vector<double> filtered_;  ///< orders asked for, and 1 and 0 if they are not among them
  std::size_t first_ = 0, zeroth_ = 0;  ///< of filtered_: orders 1 and 0
  io::TimeSeriesPtr sink_;
  std::vector<double> row_;
  std::vector<std::vector<TrackedOrbit>> recent_;  ///< [probe] last turns
  double last_speed_ = nan;                        ///< of the orbits
  analysis::OrderFilter filter_;
  analysis::Revolutions revolutions_;
};

std::size_t place_of(const std::vector<double>& orders, double order) {
  return static_cast<std::size_t>(std::find(orders.begin(), orders.end(), order) - orders.begin());
}

std::vector<double> with_the_first_and_the_mean(std::vector<double> orders) {
  for (const double order : {1.0, 0.0})
    if (place_of(orders, order) == orders.size()) orders.push_back(order);
  return orders;
}

std::vector<analysis::Point> points_of(const run::Job& job, const Keyphasor& keyphasor) {
  const std::vector<analysis::Point> all = probe_points(job);
  std::vector<analysis::Point> points;
  for (const std::size_t p : keyphasor.probes)
    points.push_back(all[p]);
  return points;
}

/// Share of an amplitude that a filter of M turns lets through d orders away (OrderFilter).
double let_through(int turns, double away) {
  const double x = turns * away;
  if (x < 1e-9) return 1.0;
  if (std::abs(x - 1.0) < 1e-9) return 0.5;
  return std::abs(std::sin(pi * x) / (pi * x * (1.0 - x * x)));
}

/// As the bandwidth says, or so many more, up to 12, that as little as can be is let through of what
/// other shafts do once a turn of theirs: nothing where 2/M, 3/M, .. orders lie between.
int turns_of(const run::Job& job, const Keyphasor& keyphasor) {
  constexpr int most = 12;
  const int asked = job.model.output.tracking.filter_turns();
  const Index line = job.mesh.nodes[at(keyphasor.node)].line;
  if (asked == 1 || line < 0) return asked;
  const double own = std::abs(job.model.shafts[at(line)].speed_ratio);
  std::vector<double> others;  // orders away
  int turns = asked;
  for (const model::Shaft& other : job.model.shafts) {
    const double away = std::abs(std::abs(other.speed_ratio) / own - 1.0);
    if (!other.rotating || !(own > 0) || !(away > 1e-9)) continue;
    others.push_back(away);
    turns = std::max(turns, static_cast<int>(std::min<double>(most, std::ceil(2.0 / away - 1e-9))));
  }
  const auto largest = [&others](int m) {
    double share = 0.0;
    for (const double away : others)
      share = std::max(share, let_through(m, away));
    return share;
  };
  constexpr double nothing = 1e-6;
  int best = turns;
  for (int m = turns; m <= most && largest(best) > nothing; ++m)
    if (largest(m) < largest(best)) best = m;
  return best;
}

KeyphasorOutput::KeyphasorOutput(const TransientSetup& s, const Keyphasor& keyphasor)
    : out_(s.job.model.output),
      turns_{.step = s.step.name,
             .shaft = keyphasor.shaft,
             .tracking = out_.tracking,
             .convention = plot::amplitude(out_.peak_to_peak),
             .filter_turns = turns_of(s.job, keyphasor)},
      filtered_(with_the_first_and_the_mean(out_.tracking.orders)),
      first_(place_of(filtered_, 1.0)),
      zeroth_(place_of(filtered_, 0.0)),
      filter_(
          keyphasor.probes.size(), filtered_, out_.tracking.samples, turns_.filter_turns,
          [this](const analysis::Turn& t, std::span<const Complex> y, std::span<const Complex> z,
                 std::span<const analysis::Turn> seen) { take(t, y, z, seen); }),
      revolutions_(points_of(s.job, keyphasor), keyphasor.node, out_.tracking.samples,
                   [this](const analysis::Turn& t) {
                     for (std::size_t p = 0; p < turns_.probes.size(); ++p)
                       take_orbit(p, t);
                     last_speed_ = t.speed();
                     filter_.take(t);
                   }) {
  const std::size_t one = place_of(out_.tracking.orders, 1.0);
  turns_.shown = one < out_.tracking.orders.size() ? one : 0;
  content_ =
      fmt::format("{} filter {} {}", out_.tracking.samples, turns_.filter_turns, turns_.shaft);
  for (double order : out_.tracking.orders)
    content_ += fmt::format(" {}X", order);
  for (double speed : out_.tracking.orbit_speeds)
    content_ += fmt::format(" @{}", speed);
  content_ += fmt::format(" turns {}", out_.tracking.orbit_turns);
  const std::vector<double> senses = probe_senses(s.job, s.start);
  for (const std::size_t p : keyphasor.probes)
    add_probe(s.job.model.probes[p], turns_.shaft.empty() ? senses[p] : 1.0);
  row_.resize(turns_.columns);
  turns_.rows = PlotBuffer(turns_.columns - 1, 2);  // whole rows alone are wanted
  recent_.resize(turns_.probes.size());
  turns_.largest.resize(turns_.probes.size());
  if (out_.csv) sink_ = io::make_csv_series(s.job.folder.path(turns_.file("tracking.csv")));
}

}  // namespace

std::string TrackedTurns::file(const std::string& what) const {
  return shaft.empty() ? fmt::format("{}_{}", step, what)
                       : fmt::format("{}_{}_{}", step, safe_name(shaft), what);
}

namespace {

void KeyphasorOutput::add_probe(const model::Probe& probe, double sense) {
  TrackedProbe t;
  t.name = probe.name;
  t.sense = sense;
  if (probe.angles.empty()) t.directions = {{"y", "y", 1.0, 0.0}, {"z", "z", 0.0, 1.0}};
  for (double a : probe.angles)
    t.directions.push_back({fmt::format("{:.0f}deg", a * 180.0 / pi),
                            fmt::format("{:.0f}°", a * 180.0 / pi), std::cos(a), std::sin(a)});
  t.first_column = turns_.columns;
  turns_.columns += t.directions.size() * turns_.per_direction() + 2;
  content_ += " " + probe.name;
  for (const TrackedDirection& d : t.directions)
    content_ += "." + d.name;
  turns_.probes.push_back(std::move(t));
}

std::vector<io::Channel> KeyphasorOutput::channels() const {
  std::vector<io::Channel> c{{"t", "s", "middle of the turn", {}, 1.0, {}},
                             {"speed", "rpm", "mean spin of the turn", {}, to_rpm(1.0), {}}};
  for (const TrackedProbe& p : turns_.probes) {
    for (const TrackedDirection& d : p.directions) {
      const std::string name = p.name + "." + d.name;
      for (double k : out_.tracking.orders) {
        c.push_back({fmt::format("{} {}X", name, k), "m", "amplitude, 0-peak", {}, 1.0, {}});
        c.push_back({fmt::format("{} {}X lag", name, k),
                     "deg",
                     "phase lag behind the keyphasor",
                     {},
                     180.0 / pi,
                     {}});
      }
      c.push_back({name + " envelope",
                   "m",
                   "half the peak-to-peak value of the turns of the filter",
                   {},
                   1.0,
                   {}});
      c.push_back({name + " mean", "m", "mean of the turns of the filter", {}, 1.0, {}});
    }
    c.push_back({p.name + " 1X forward",
                 "m",
                 "radius of the circle that turns with the spin of the shaft there",
                 {},
                 1.0,
                 {}});
    c.push_back(
        {p.name + " 1X backward", "m", "radius of the circle that turns against it", {}, 1.0, {}});
  }
  return c;
}

void KeyphasorOutput::begin() {
  if (sink_) sink_->begin(channels());
}

void KeyphasorOutput::take(const analysis::Turn& turn, std::span<const Complex> y,
                           std::span<const Complex> z, std::span<const analysis::Turn> seen) {
  const std::size_t all = filtered_.size();
  row_[0] = 0.5 * (turn.t0 + turn.t1);
  row_[1] = turn.speed();
  for (std::size_t p = 0; p < turns_.probes.size(); ++p) {
    double* out = row_.data() + turns_.probes[p].first_column;
    for (const TrackedDirection& d : turns_.probes[p].directions) {
      for (std::size_t k = 0; k < out_.tracking.orders.size(); ++k) {
        const Complex x = d.c * y[p * all + k] + d.s * z[p * all + k];
        *out++ = std::abs(x);
        *out++ = analysis::lag_of(turn, x);
      }
      // a whirl slower than the spin takes several turns
      double low = infinity, high = -infinity;
      for (const analysis::Turn& s : seen)
        for (std::size_t j = 0; j < s.y[p].size(); ++j) {
          const double x = d.c * s.y[p][j] + d.s * s.z[p][j];
          low = std::min(low, x);
          high = std::max(high, x);
        }
      *out++ = 0.5 * (high - low);
      *out++ = d.c * y[p * all + zeroth_].real() + d.s * z[p * all + zeroth_].real();
    }
    // against the angle of the shaft, so that it may turn either way
    const analysis::Orbit circles =
        analysis::orbit_of(y[p * all + first_], z[p * all + first_], turns_.probes[p].sense);
    *out++ = circles.forward;
    *out++ = circles.backward;
  }
  turns_.rows.append(row_);
  if (sink_) sink_->append(row_);
}

/// Orbits: about the mean of the turn, the last few turns.
void KeyphasorOutput::take_orbit(std::size_t probe, const analysis::Turn& turn) {
  const double speed = turn.speed(), t = 0.5 * (turn.t0 + turn.t1);
  const std::vector<double>&y = turn.y[probe], &z = turn.z[probe];
  const analysis::Range ry = analysis::range_of(y), rz = analysis::range_of(z);
  const double size = std::max(ry.high - ry.low, rz.high - rz.low);
  auto& recent = recent_[probe];
  if (recent.size() == static_cast<std::size_t>(out_.tracking.orbit_turns))
    recent.erase(recent.begin());
  recent.push_back({probe, t, speed, size, y, z});
  if (size > turns_.largest[probe].size) turns_.largest[probe] = last_turns(probe, t, speed, size);
  for (double target : out_.tracking.orbit_speeds)
    if (turns_.passed.size() < most_orbits && (speed - target) * (last_speed_ - target) <= 0.0)
      turns_.passed.push_back(last_turns(probe, t, target, size));
}

TrackedOrbit KeyphasorOutput::last_turns(std::size_t probe, double t, double speed,
                                         double size) const {
  TrackedOrbit o{probe, t, speed, size, {}, {}};
  for (const TrackedOrbit& turn : recent_[probe]) {
    // a turn ends where the next begins
    const bool last = &turn == &recent_[probe].back();
    o.y.insert(o.y.end(), turn.y.begin(), turn.y.end() - (last ? 0 : 1));
    o.z.insert(o.z.end(), turn.z.begin(), turn.z.end() - (last ? 0 : 1));
  }
  return o;
}

void KeyphasorOutput::save(OutArchive& out) {
  if (sink_) sink_->flush();
  out.put_count(sink_ ? sink_->rows() : 0);
  out.put(last_speed_);
  turns_.rows.save(out);
  const auto put = [&out](const std::vector<TrackedOrbit>& list) {
    out.put_count(list.size());
    for (const TrackedOrbit& o : list) {
      out.put_count(o.probe);
      out.put(o.t);
      out.put(o.speed);
      out.put(o.size);
      out.put(o.y);
      out.put(o.z);
    }
  };
  for (const auto& r : recent_)
    put(r);
  put(turns_.largest);
  put(turns_.passed);
  filter_.save(out);
  revolutions_.save(out);
}

void KeyphasorOutput::restore(InArchive& in) {
  const std::uint64_t rows = in.count();
  if (sink_) sink_->resume(channels(), rows);
  last_speed_ = in.number();
  turns_.rows.restore(in);
  const auto get = [&in](std::vector<TrackedOrbit>& list) {
    list.resize(in.count());
    for (TrackedOrbit& o : list) {
      o.probe = in.count();
      o.t = in.number();
      o.speed = in.number();
      o.size = in.number();
      o.y = in.numbers();
      o.z = in.numbers();
    }
  };
  for (auto& r : recent_)
    get(r);
  get(turns_.largest);
  get(turns_.passed);
  filter_.restore(in);
  revolutions_.restore(in);
}

/// Every shaft that turns by itself has its own; lines on a joint with that of the reference, casings
/// and supports are seen by the reference's.
Index first_node_of(const run::Job& job, const model::Location& place) {
  const Index line = job.mesh.nodes[at(job.mesh.place(place).node)].line;
  return job.mesh.lines[at(line)].first_node;
}

std::vector<Keyphasor> keyphasors_of(const run::Job& job) {
  std::vector<Keyphasor> all{{job.reference(), {}, {}}};
  for (std::size_t p = 0; p < job.model.probes.size(); ++p) {
    const model::Location& place = job.model.probes[p].at;
    const std::string shaft = own_shaft(job, place);
    auto k =
        std::find_if(all.begin(), all.end(), [&](const Keyphasor& x) { return x.shaft == shaft; });
    if (k == all.end()) k = all.insert(all.end(), {first_node_of(job, place), shaft, {}});
    k->probes.push_back(p);
  }
  std::erase_if(all, [](const Keyphasor& k) { return k.probes.empty(); });
  return all;
}

}  // namespace

void add_keyphasor(const TransientSetup& setup, TransientOutputs& outputs) {
  const model::Output& o = setup.job.model.output;
  if (!o.tracking.on || setup.job.model.probes.empty() || !(o.csv || o.report)) return;
  for (const Keyphasor& k : keyphasors_of(setup.job))
    outputs.push_back(std::make_unique<KeyphasorOutput>(setup, k));
}

}  // namespace whirl::results
