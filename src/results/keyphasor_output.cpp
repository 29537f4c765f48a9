// Tracking filter of a transient's probes: CSV turn by turn, Bode and polar figures against speed,
// orders, the path of the shaft's centre, response peaks, orbits with keyphasor marks. Every shaft
// has its own keyphasor; casings are looked at by that of the reference. Memory is bounded: long
// runs are thinned for the figures, the CSV holds every turn.
#include <analysis/spectra/whirl_modes.hpp>
#include <analysis/transient/order_filter.hpp>
#include <plot/plots.hpp>
#include <results/channels.hpp>
#include <results/plot_buffer.hpp>
#include <results/transient_output.hpp>
#include <core/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

/// Local maxima of y that stand above both sides by `share` of the largest value.
std::vector<std::size_t> peaks_of(const std::vector<double>& y, double share) {
  std::vector<std::size_t> out;
  if (y.size() < 3) return out;
  const double rise = share * *std::max_element(y.begin(), y.end());
  // alternate: climb to a maximum, fall by `rise`, climb again
  double high = y[0], low = y[0];
  std::size_t at = 0;
  bool climbing = true;
  for (std::size_t i = 1; i < y.size(); ++i) {
    if (climbing) {
      if (y[i] > high) {
        high = y[i];
        at = i;
      } else if (y[i] < high - rise) {
        if (at > 0 && high - low >= rise) out.push_back(at);
        climbing = false;
        low = y[i];
      }
    } else if (y[i] < low) {
      low = y[i];
    } else if (y[i] > low + rise) {
      climbing = true;
      high = y[i];
      at = i;
    }
  }
  return out;
}

/// A phase in degrees put into 0 .. 360; the line breaks where it leaves one side and comes back on
/// the other. A beat may carry a phase round by a turn: unwrapped, the curves would part for good.
plot::Series within_a_turn(const plot::Series& in) {
  plot::Series out = in;
  out.x.clear();
  out.y.clear();
  for (std::size_t i = 0; i < in.x.size(); ++i) {
    double y = std::fmod(in.y[i], 360.0);
    if (y < 0.0) y += 360.0;
    if (!out.y.empty() && std::abs(y - out.y.back()) > 180.0) {
      out.x.push_back(in.x[i]);
      out.y.push_back(nan);
    }
    out.x.push_back(in.x[i]);
    out.y.push_back(y);
  }
  return out;
}

/// Where the speed turns back for good: rows up to it rise, later ones fall (or the other way
/// round). While the speed is held it neither rises nor falls but for rounding: its end counts.
std::size_t turning_row(const std::vector<std::vector<double>>& rows) {
  double most = 0;
  for (const auto& r : rows)
    most = std::max(most, std::abs(r[1]));
  std::size_t top = 0;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (std::abs(rows[r][1]) >= (1 - 1e-6) * most) top = r;
  return top;
}

std::string length_text(double length) {
  const plot::DisplayUnit unit = plot::length_unit(length);
  return readable(unit.factor * length, 2) + " " + unit.name;
}

bool speed_changes(const std::vector<std::vector<double>>& rows) {
  double low = rows[0][1], high = low;
  for (const auto& r : rows) {
    low = std::min(low, r[1]);
    high = std::max(high, r[1]);
  }
  return high - low > 0.02 * std::max(std::abs(low), std::abs(high));
}

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
  void report(TransientEnd& end) override;

 private:
  struct Direction {
    std::string name, shown;  ///< shown: in figures
    double c = 1, s = 0;
  };
  struct Tracked {
    std::string name;
    std::vector<Direction> directions;
    std::size_t column = 0;
    double sense = 1;  ///< -1: the shaft there turns against the reference
  };
  /// Some turns of one probe.
  struct Orbit {
    std::size_t probe = 0;
    double t = 0, speed = 0, size = 0;
    std::vector<double> y, z;
  };
  void add_probe(const model::Probe& probe, double sense);
  void take(const analysis::Turn& turn, std::span<const Complex> y, std::span<const Complex> z,
            std::span<const analysis::Turn> seen);
  void take_orbit(std::size_t probe, const analysis::Turn& turn);
  Orbit last_turns(std::size_t probe, double t, double speed, double size) const;
  std::size_t column(std::size_t probe, std::size_t direction, std::size_t what) const;
  std::vector<io::Channel> channels() const;
  double largest_envelope(std::size_t probe) const;
  double largest_shown(std::size_t probe) const;
  double largest_displacement() const;
  void add_synchronous(io::ReportSection& section, std::size_t probe, double size) const;
  /// Of one probe: the order that is shown, and all frequencies together.
  struct Responses {
    std::vector<plot::ResponseCurve> order, envelope;
  };
  Responses responses_of(std::size_t probe, double size) const;
  void add_bode(io::ReportSection& section, std::size_t probe, double size) const;
  void add_envelope(io::ReportSection& section, std::size_t probe, double size) const;
  void add_orders(io::ReportSection& section, std::size_t probe, double size) const;
  std::vector<Vec2> centres(std::size_t probe) const;
  void add_centreline(const TransientEnd& end, std::size_t probe) const;
  std::string file(const char* what) const;
  std::string shown_order() const { return fmt::format("{}X", out_.tracking.orders[shown_]); }
  std::string others_than_orders(std::size_t probe) const;
  std::string speed_name() const { return shaft_.empty() ? "speed" : "speed of " + shaft_; }
  void add_peaks(run::Job& job, io::ReportSection& section, double unresolved) const;
  void add_orbits(run::Job& job, io::ReportSection& section, double unresolved) const;
  void say_unresolved(io::ReportSection& section, const std::vector<std::string>& what,
                      double unresolved) const;

  static constexpr std::size_t most_orbits = 64;
  const model::Output& out_;
  const plot::Amplitude convention_ = plot::amplitude(out_.peak_to_peak);
  std::string step_, shaft_, content_;  ///< content_: whether a part of a checkpoint fits
  std::vector<Tracked> probes_;
  std::vector<double> filtered_;  ///< orders asked for, and 1 and 0 if they are not among them
  std::size_t first_ = 0, zeroth_ = 0;  ///< of filtered_: orders 1 and 0
  std::size_t shown_ = 0;  ///< of the orders asked for: of Bode plots and peaks, 1 or the first
  int turns_ = 1;          ///< of the filter
  std::size_t per_direction_ = 0, columns_ = 0;
  io::TimeSeriesPtr sink_;
  PlotBuffer rows_;
  std::vector<double> row_;
  std::vector<std::vector<Orbit>> recent_;  ///< [probe] last turns
  std::vector<Orbit> largest_, passed_;
  double last_speed_ = nan;  ///< of the orbits
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

/// As the bandwidth says, or so many more, up to 12, that nothing is let through of what other
/// shafts do once a turn of theirs: 2/M orders away and further (OrderFilter).
int turns_of(const run::Job& job, const Keyphasor& keyphasor) {
  constexpr int most = 12;
  const int asked = job.model.output.tracking.filter_turns();
  const Index line = job.mesh.nodes[at(keyphasor.node)].line;
  if (asked == 1 || line < 0) return asked;
  const double own = std::abs(job.model.shafts[at(line)].speed_ratio);
  int turns = asked;
  for (const model::Shaft& other : job.model.shafts) {
    const double away = std::abs(std::abs(other.speed_ratio) / own - 1.0);
    if (!other.rotating || !(own > 0) || !(away > 1e-9)) continue;
    turns = std::max(turns, static_cast<int>(std::min<double>(most, std::ceil(2.0 / away - 1e-9))));
  }
  return turns;
}

KeyphasorOutput::KeyphasorOutput(const TransientSetup& s, const Keyphasor& keyphasor)
    : out_(s.job.model.output),
      step_(s.step.name),
      shaft_(keyphasor.shaft),
      filtered_(with_the_first_and_the_mean(out_.tracking.orders)),
      first_(place_of(filtered_, 1.0)),
      zeroth_(place_of(filtered_, 0.0)),
      turns_(turns_of(s.job, keyphasor)),
      rows_(0),
      filter_(
          keyphasor.probes.size(), filtered_, out_.tracking.samples, turns_,
          [this](const analysis::Turn& t, std::span<const Complex> y, std::span<const Complex> z,
                 std::span<const analysis::Turn> seen) { take(t, y, z, seen); }),
      revolutions_(points_of(s.job, keyphasor), keyphasor.node, out_.tracking.samples,
                   [this](const analysis::Turn& t) {
                     for (std::size_t p = 0; p < probes_.size(); ++p)
                       take_orbit(p, t);
                     last_speed_ = t.speed();
                     filter_.take(t);
                   }) {
  const std::size_t one = place_of(out_.tracking.orders, 1.0);
  shown_ = one < out_.tracking.orders.size() ? one : 0;
  per_direction_ = 2 * out_.tracking.orders.size() + 2;
  columns_ = 2;  // t, speed
  content_ = fmt::format("{} filter {} {}", out_.tracking.samples, turns_, shaft_);
  for (double order : out_.tracking.orders)
    content_ += fmt::format(" {}X", order);
  for (double speed : out_.tracking.orbit_speeds)
    content_ += fmt::format(" @{}", speed);
  content_ += fmt::format(" turns {}", out_.tracking.orbit_turns);
  const std::vector<double> senses = probe_senses(s.job, s.start);
  for (const std::size_t p : keyphasor.probes)
    add_probe(s.job.model.probes[p], shaft_.empty() ? senses[p] : 1.0);
  row_.resize(columns_);
  rows_ = PlotBuffer(columns_ - 1, 2);  // whole rows alone are wanted
  recent_.resize(probes_.size());
  largest_.resize(probes_.size());
  if (out_.csv) sink_ = io::make_csv_series(s.job.folder.path(file("tracking.csv")));
}

std::string KeyphasorOutput::file(const char* what) const {
  return shaft_.empty() ? fmt::format("{}_{}", step_, what)
                        : fmt::format("{}_{}_{}", step_, safe_name(shaft_), what);
}

void KeyphasorOutput::add_probe(const model::Probe& probe, double sense) {
  Tracked t;
  t.name = probe.name;
  t.sense = sense;
  if (probe.angles.empty()) t.directions = {{"y", "y", 1.0, 0.0}, {"z", "z", 0.0, 1.0}};
  for (double a : probe.angles)
    t.directions.push_back({fmt::format("{:.0f}deg", a * 180.0 / pi),
                            fmt::format("{:.0f}°", a * 180.0 / pi), std::cos(a), std::sin(a)});
  t.column = columns_;
  columns_ += t.directions.size() * per_direction_ + 2;
  content_ += " " + probe.name;
  for (const Direction& d : t.directions)
    content_ += "." + d.name;
  probes_.push_back(std::move(t));
}

std::size_t KeyphasorOutput::column(std::size_t probe, std::size_t direction,
                                    std::size_t what) const {
  return probes_[probe].column + direction * per_direction_ + what;
}

std::vector<io::Channel> KeyphasorOutput::channels() const {
  std::vector<io::Channel> c{{"t", "s", "middle of the turn", {}, 1.0, {}},
                             {"speed", "rpm", "mean spin of the turn", {}, to_rpm(1.0), {}}};
  for (const Tracked& p : probes_) {
    for (const Direction& d : p.directions) {
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
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    double* out = row_.data() + probes_[p].column;
    for (const Direction& d : probes_[p].directions) {
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
        analysis::orbit_of(y[p * all + first_], z[p * all + first_], probes_[p].sense);
    *out++ = circles.forward;
    *out++ = circles.backward;
  }
  rows_.append(row_);
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
  if (size > largest_[probe].size) largest_[probe] = last_turns(probe, t, speed, size);
  for (double target : out_.tracking.orbit_speeds)
    if (passed_.size() < most_orbits && (speed - target) * (last_speed_ - target) <= 0.0)
      passed_.push_back(last_turns(probe, t, target, size));
}

KeyphasorOutput::Orbit KeyphasorOutput::last_turns(std::size_t probe, double t, double speed,
                                                   double size) const {
  Orbit o{probe, t, speed, size, {}, {}};
  for (const Orbit& turn : recent_[probe]) {
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
  rows_.save(out);
  const auto put = [&out](const std::vector<Orbit>& list) {
    out.put_count(list.size());
    for (const Orbit& o : list) {
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
  put(largest_);
  put(passed_);
  filter_.save(out);
  revolutions_.save(out);
}

void KeyphasorOutput::restore(InArchive& in) {
  const std::uint64_t rows = in.count();
  if (sink_) sink_->resume(channels(), rows);
  last_speed_ = in.number();
  rows_.restore(in);
  const auto get = [&in](std::vector<Orbit>& list) {
    list.resize(in.count());
    for (Orbit& o : list) {
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
  get(largest_);
  get(passed_);
  filter_.restore(in);
  revolutions_.restore(in);
}

void KeyphasorOutput::report(TransientEnd& end) {
  if (!out_.report) return;
  const auto& rows = rows_.kept_rows();
  if (rows.size() < 3) return;
  if (sink_)
    end.section.files.emplace_back(
        shaft_.empty() ? "tracking filter" : "tracking filter of " + shaft_, file("tracking.csv"));
  constexpr std::size_t fewest = 8;  // turns that make a curve
  const bool few = rows.size() < fewest && speed_changes(rows);
  if (few)
    end.section.text += fmt::format(
        "\n\n{} turns are too few to show amplitude and phase against {}: they stand in {}.",
        rows.size(), speed_name(), file("tracking.csv"));
  const double unresolved = unresolved_share(end.law) * largest_displacement();
  std::vector<std::string> left_out;
  for (std::size_t p = 0; p < probes_.size() && !few; ++p) {
    const double size = largest_envelope(p), shown = largest_shown(p);
    if (size == 0.0) continue;  // torsion alone: nothing to see here
    if (shown <= unresolved)
      left_out.push_back(
          fmt::format("{} of {} (up to {})", shown_order(), probes_[p].name, length_text(shown)));
    else if (speed_changes(rows))
      add_bode(end.section, p, size);
    else
      add_synchronous(end.section, p, size);
    if (size <= unresolved) continue;
    if (speed_changes(rows)) add_envelope(end.section, p, size);
    add_orders(end.section, p, std::max(size, 1e3 * unresolved));
    add_centreline(end, p);
  }
  say_unresolved(end.section, left_out, unresolved);
  add_peaks(end.job, end.section, unresolved);
  add_orbits(end.job, end.section, unresolved);
}

void KeyphasorOutput::say_unresolved(io::ReportSection& section,
                                     const std::vector<std::string>& what,
                                     double unresolved) const {
  if (what.empty()) return;
  section.text += fmt::format(
      "\n\nNot drawn: {}. Below {} the integrator resolves nothing at its tolerance, beside "
      "displacements of {}; the numbers stand in {}.",
      fmt::join(what, ", "), length_text(unresolved), length_text(largest_displacement()),
      file("tracking.csv"));
}

/// Of the order that Bode plots show.
double KeyphasorOutput::largest_shown(std::size_t probe) const {
  double size = 0.0;
  for (std::size_t d = 0; d < probes_[probe].directions.size(); ++d)
    for (const auto& r : rows_.kept_rows())
      size = std::max(size, r[column(probe, d, 2 * shown_)]);
  return size;
}

/// From the line at rest, of all probes: what the tolerance of the integrator is relative to.
double KeyphasorOutput::largest_displacement() const {
  double size = 0.0;
  for (std::size_t p = 0; p < probes_.size(); ++p)
    for (std::size_t d = 0; d < probes_[p].directions.size(); ++d)
      for (const auto& r : rows_.kept_rows())
        size = std::max(size, std::abs(r[column(p, d, per_direction_ - 1)]) +
                                  r[column(p, d, per_direction_ - 2)]);
  return size;
}

double KeyphasorOutput::largest_envelope(std::size_t probe) const {
  double size = 0.0;
  for (std::size_t d = 0; d < probes_[probe].directions.size(); ++d)
    for (const auto& r : rows_.kept_rows())
      size = std::max(size, r[column(probe, d, per_direction_ - 2)]);
  return size;
}

/// At constant speed: amplitude and envelope against time.
void KeyphasorOutput::add_synchronous(io::ReportSection& section, std::size_t p,
                                      double size) const {
  const Tracked& probe = probes_[p];
  const plot::DisplayUnit unit = plot::length_unit(size);
  plot::Figure f;
  f.name = step_ + "_" + safe_name(probe.name) + "_synchronous";
  f.title = probe.name + ": synchronous amplitude and envelope, turn by turn";
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis(std::string("amplitude, ") + plot::to_string(convention_), unit.name);
  a.y.include_zero = true;
  const double factor = unit.factor * plot::factor_of(convention_);
  for (std::size_t d = 0; d < probe.directions.size(); ++d)
    for (const std::size_t what : {2 * shown_, per_direction_ - 2}) {
      plot::Series s;
      s.label =
          probe.directions[d].shown + (what == 2 * shown_ ? " " + shown_order() : " envelope");
      if (what != 2 * shown_) {
        s.style.dash = plot::Dash::dashed;
        s.style.width = 1.1;
      }
      for (const auto& r : rows_.kept_rows()) {
        s.x.push_back(r[0]);
        s.y.push_back(factor * r[column(p, d, what)]);
      }
      a.series.push_back(std::move(s));
    }
  f.axes.push_back(std::move(a));
  section.figures.push_back(std::move(f));
}

/// Where most of the motion is at none of the orders: what of it the filter lets through beats in
/// their amplitudes and phases. Empty where it is not so.
std::string KeyphasorOutput::others_than_orders(std::size_t p) const {
  double other = 0, all = 0, speed = 0;
  for (const auto& r : rows_.kept_rows())
    for (std::size_t d = 0; d < probes_[p].directions.size(); ++d) {
      double orders = 0;
      for (std::size_t k = 0; k < out_.tracking.orders.size(); ++k)
        orders += r[column(p, d, 2 * k)];
      const double envelope = r[column(p, d, per_direction_ - 2)];
      if (!(envelope - orders > other)) continue;
      other = envelope - orders;
      all = envelope;
      speed = r[1];
    }
  if (!(other > 0.5 * all) || !(other > 0.1 * largest_envelope(p))) return {};
  return fmt::format(
      " At {} rpm most of the motion is of other frequencies (see the spectra): as far as the "
      "filter lets it through, amplitudes and phases beat; a smaller output.tracking.bandwidth "
      "lets less through.",
      readable(to_rpm(speed), 4));
}

/// Against speed, rising and falling apart.
KeyphasorOutput::Responses KeyphasorOutput::responses_of(std::size_t p, double size) const {
  const auto& rows = rows_.kept_rows();
  const Tracked& probe = probes_[p];
  const std::size_t top = turning_row(rows);
  const bool both = top >= 2 && rows.size() - top >= 3;
  Responses out;
  for (std::size_t d = 0; d < probe.directions.size(); ++d)
    for (const bool rising : {true, false}) {
      const std::size_t from = rising ? 0 : top, to = rising ? top + 1 : rows.size();
      if (to - from < 3) continue;
      plot::ResponseCurve c;
      c.label = probe.directions[d].shown + (both ? rising ? " rising" : " falling" : "");
      plot::ResponseCurve e = c;
      for (std::size_t r = from; r < to; ++r) {
        e.speed.push_back(rows[r][1]);
        e.amplitude.push_back(rows[r][column(p, d, per_direction_ - 2)]);
        e.phase_lag.push_back(nan);
        const double amplitude = rows[r][column(p, d, 2 * shown_)];
        // below a billionth of the largest motion the phase is that of rounding
        c.speed.push_back(rows[r][1]);
        c.amplitude.push_back(amplitude);
        c.phase_lag.push_back(amplitude > 1e-9 * size ? rows[r][column(p, d, 2 * shown_ + 1)]
                                                      : nan);
      }
      out.order.push_back(std::move(c));
      out.envelope.push_back(std::move(e));
    }
  return out;
}

void KeyphasorOutput::add_bode(io::ReportSection& section, std::size_t p, double size) const {
  const Tracked& probe = probes_[p];
  const std::string id = step_ + "_" + safe_name(probe.name);
  const std::vector<plot::ResponseCurve> curves = responses_of(p, size).order;
  const std::string order = shown_order();
  plot::Figure bode = plot::plot_bode(
      id + "_bode",
      probe.name + ": " + order + " amplitude and phase against speed (tracking filter)", curves,
      convention_);
  for (plot::Series& s : bode.axes[1].series)
    s = within_a_turn(s);
  bode.axes[1].y.min = 0.0;
  bode.axes[1].y.max = 360.0;
  bode.axes[1].y.ticks = {0, 90, 180, 270, 360};
  bode.axes[1].x.label = speed_name();
  bode.caption = fmt::format("Filter of {} turn{}: half of what is {:.3g} orders away.", turns_,
                             turns_ == 1 ? "" : "s",
                             turns_ == 1 ? 0.5 * out_.tracking.bandwidth : 1.0 / turns_);
  bode.caption += others_than_orders(p);
  section.figures.push_back(std::move(bode));
  section.figures.push_back(plot::plot_polar(
      id + "_polar", probe.name + ": " + order + " vector (polar)", curves, convention_));
}

void KeyphasorOutput::add_envelope(io::ReportSection& section, std::size_t p, double size) const {
  const std::string& probe = probes_[p].name;
  plot::Figure all = plot::plot_bode(step_ + "_" + safe_name(probe) + "_envelope",
                                     probe + ": envelope (all frequencies) against speed",
                                     responses_of(p, size).envelope, convention_);
  all.axes.resize(1);
  all.axes[0].x.label = speed_name();
  all.height = 360;
  section.figures.push_back(std::move(all));
}

/// All orders that are more than a thousandth of the motion, against speed or time.
void KeyphasorOutput::add_orders(io::ReportSection& section, std::size_t p, double size) const {
  const auto& rows = rows_.kept_rows();
  const bool by_speed = speed_changes(rows);
  const plot::DisplayUnit unit = plot::length_unit(size);
  const double factor = unit.factor * plot::factor_of(convention_);
  plot::Axes a;
  a.x = by_speed ? plot::Axis(speed_name(), "rpm") : plot::Axis("time", "s");
  a.y = plot::Axis(std::string("amplitude, ") + plot::to_string(convention_), unit.name);
  a.y.include_zero = true;
  std::size_t shown = 0;
  for (std::size_t k = 0; k < out_.tracking.orders.size(); ++k) {
    bool counts = false;
    for (std::size_t d = 0; d < probes_[p].directions.size(); ++d) {
      plot::Series s;
      s.label = fmt::format("{} {}X", probes_[p].directions[d].shown, out_.tracking.orders[k]);
      s.style = {static_cast<int>(k), d == 0 ? plot::Dash::solid : plot::Dash::dashed, 1.2};
      for (const auto& r : rows) {
        s.x.push_back(by_speed ? to_rpm(r[1]) : r[0]);
        s.y.push_back(factor * r[column(p, d, 2 * k)]);
        counts = counts || r[column(p, d, 2 * k)] > 1e-3 * size;
      }
      if (counts) a.series.push_back(std::move(s));
    }
    shown += counts;
  }
  if (shown < 2) return;
  plot::Figure f;
  f.name = step_ + "_" + safe_name(probes_[p].name) + "_orders";
  f.title = probes_[p].name + ": orders of the speed";
  f.height = 360;
  f.axes.push_back(std::move(a));
  section.figures.push_back(std::move(f));
}

/// Clearance of a film or stop at the place of a probe, m; 0: none there.
double clearance_at(const run::Job& job, const std::string& probe) {
  const auto found = std::find_if(job.model.probes.begin(), job.model.probes.end(),
                                  [&](const model::Probe& x) { return x.name == probe; });
  const Index node = job.mesh.place(found->at).node;
  const system::State still = job.system().make_state();
  system::Workspace w = job.system().make_workspace();
  job.system().evaluate_nodes(w, still.frames, still.t, still.q, still.v, still.a);
  for (const assembly::SupportCondition& c : job.built.conditions)
    if (const meshes::BearingNodes& at = job.mesh.bearings[c.bearing]; at.shaft.node == node)
      if (const auto x =
              c.state([&](Index n) -> const system::NodeState& { return w.in_own_axes(n); });
          x.gap > 0)
        return x.gap;
  return 0.0;
}

namespace {

/// Of a clearance, m; factor: to the unit shown.
plot::Series circle_of(double gap, double factor) {
  plot::Series circle;
  circle.label = "clearance";
  circle.style = {plot::ink, plot::Dash::dashed, 1.0};
  for (int k = 0; k <= 120; ++k) {
    circle.x.push_back(factor * gap * std::cos(two_pi * k / 120));
    circle.y.push_back(factor * gap * std::sin(two_pi * k / 120));
  }
  return circle;
}

}  // namespace

/// Means of a probe's turns along y and z; empty where its directions do not give them.
std::vector<Vec2> KeyphasorOutput::centres(std::size_t p) const {
  const std::vector<Direction>& d = probes_[p].directions;
  if (d.size() != 2) return {};
  const Mat2 along{{d[0].c, d[0].s}, {d[1].c, d[1].s}};
  if (std::abs(along.determinant()) < 1e-3) return {};  // both along one line
  const Mat2 back = along.inverse();
  std::vector<Vec2> out;
  for (const auto& r : rows_.kept_rows())
    out.push_back(back *
                  Vec2(r[column(p, 0, per_direction_ - 1)], r[column(p, 1, per_direction_ - 1)]));
  return out;
}

/// Where the middle of the orbit goes: what a journal in its film does while the speed changes.
void KeyphasorOutput::add_centreline(const TransientEnd& end, std::size_t p) const {
  const Tracked& probe = probes_[p];
  const auto& rows = rows_.kept_rows();
  const std::vector<Vec2> centre = centres(p);
  if (centre.empty()) return;
  double path = 0, most = 0;
  for (const Vec2& c : centre) {
    path = std::max(path, (c - centre.front()).norm());
    most = std::max(most, c.norm());
  }
  const double gap = clearance_at(end.job, probe.name);
  if (!(gap > 0) || !(path > 0.01 * gap)) return;  // elsewhere it is the beat of single turns
  const plot::DisplayUnit unit = plot::length_unit(std::max(most, gap));
  plot::Axes a;
  a.x = plot::Axis("y, mean of the turns", unit.name);
  a.y = plot::Axis("z, mean of the turns", unit.name);
  a.equal_aspect = true;
  plot::Series s;
  s.trace_label = "centre of the shaft";
  plot::Extra speed{speed_name(), "rpm", {}};
  const std::size_t stride = 1 + rows.size() / 1500;
  for (std::size_t r = 0; r < rows.size(); r += stride) {
    s.x.push_back(unit.factor * centre[r].x());
    s.y.push_back(unit.factor * centre[r].y());
    speed.values.push_back(to_rpm(rows[r][1]));
  }
  s.extra.push_back(std::move(speed));
  std::vector<std::size_t> noted{0, turning_row(rows), rows.size() - 1};
  noted.erase(std::unique(noted.begin(), noted.end()), noted.end());
  for (const std::size_t r : noted)
    if (r == 0 || (centre[r] - centre[0]).norm() > 0.1 * path)
      a.notes.push_back(
          {unit.factor * centre[r].x(), unit.factor * centre[r].y(),
           fmt::format("{:.4g} s, {} rpm", rows[r][0], readable(to_rpm(rows[r][1]), 4))});
  a.series.push_back(std::move(s));
  plot::Figure f;
  f.width = 560;
  f.height = 520;
  if (path < 0.2 * gap) {  // the path alone beside it, or nobody could read it
    plot::Axes whole = a;
    whole.notes.clear();
    whole.legend = a.legend = false;
    whole.title = "within the clearance";
    whole.series.push_back(circle_of(gap, unit.factor));
    a.title = "enlarged";
    f.columns = 2;
    f.width = 860;
    f.height = 460;
    f.axes.push_back(std::move(whole));
  } else
    a.series.push_back(circle_of(gap, unit.factor));
  f.name = step_ + "_" + safe_name(probe.name) + "_centreline";
  f.title = probe.name + ": path of the shaft's centre";
  f.axes.push_back(std::move(a));
  end.section.figures.push_back(std::move(f));
}

void KeyphasorOutput::add_peaks(run::Job& job, io::ReportSection& section,
                                double unresolved) const {
  const auto& rows = rows_.kept_rows();
  if (!speed_changes(rows)) return;
  io::Table t;
  t.title = fmt::format("Peaks of the {} response{}", shown_order(),
                        shaft_.empty() ? "" : " to shaft " + shaft_);
  t.columns = {{"probe", "-", ""},   {"direction", "-", ""},        {"speed is", "-", ""},
               {"speed", "rpm", ""}, {"amplitude 0-peak", "m", ""}, {"phase lag", "deg", ""},
               {"time", "s", ""}};
  const std::size_t top = turning_row(rows);
  for (std::size_t p = 0; p < probes_.size(); ++p)
    for (std::size_t d = 0; d < probes_[p].directions.size(); ++d)
      for (const bool rising : {true, false}) {
        const std::size_t from = rising ? 0 : top, to = rising ? top + 1 : rows.size();
        std::vector<double> y;
        for (std::size_t r = from; r < to; ++r)
          y.push_back(rows[r][column(p, d, 2 * shown_)]);
        // a fifth of the largest: what is lower is mostly beat, not resonance
        for (const std::size_t k : peaks_of(y, 0.2)) {
          const auto& r = rows[from + k];
          if (y[k] <= unresolved) continue;
          t.add({probes_[p].name, probes_[p].directions[d].name, rising ? "rising" : "falling",
                 to_rpm(r[1]), y[k], r[column(p, d, 2 * shown_ + 1)] * 180.0 / pi, r[0]});
        }
      }
  if (t.rows.empty()) return;
  job.folder.write_table(file("response_peaks.csv"), t);
  section.tables.push_back(std::move(t));
  section.files.emplace_back("peaks of the response", file("response_peaks.csv"));
}

void KeyphasorOutput::add_orbits(run::Job& job, io::ReportSection& section,
                                 double unresolved) const {
  io::Table t;
  t.columns = {{"probe", "-", ""},
               {"speed", "rpm", ""},
               {"time", "s", "middle of the last turn"},
               {"angle", "deg", "of the shaft from the first keyphasor mark"},
               {"y", "m", ""},
               {"z", "m", ""}};
  const auto n = static_cast<std::size_t>(out_.tracking.samples);
  const auto list = [&](const Orbit& o) {
    for (std::size_t j = 0; j < o.y.size(); ++j)
      t.add({probes_[o.probe].name, to_rpm(o.speed), o.t,
             360.0 * static_cast<double>(j) / static_cast<double>(n), o.y[j], o.z[j]});
  };
  const auto drawn = [&](const Orbit& o, std::string label) {
    plot::Orbit d;
    d.label = std::move(label);
    const analysis::Range y = analysis::range_of(o.y), z = analysis::range_of(o.z);
    for (std::size_t j = 0; j < o.y.size(); ++j) {
      d.y.push_back(o.y[j] - y.mean);
      d.z.push_back(o.z[j] - z.mean);
    }
    for (std::size_t j = 0; j + 1 < o.y.size(); j += n)
      d.keyphasor.push_back(j);
    return d;
  };
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    const std::string id = step_ + "_" + safe_name(probes_[p].name);
    const Orbit& o = largest_[p];
    if (o.size > unresolved) {
      const plot::Orbit d = drawn(o, fmt::format("{:.0f} rpm", to_rpm(o.speed)));
      plot::Figure f = plot::plot_orbit(
          id + "_orbit", fmt::format("{}: largest orbit, t = {:.4g} s", probes_[p].name, o.t),
          std::span(&d, 1));
      f.caption = "Displacement about its mean; a dot where the keyphasor fires.";
      section.figures.push_back(std::move(f));
    }
    list(o);
    std::vector<plot::Orbit> at_speeds;
    for (const Orbit& passing : passed_)
      if (passing.probe == p) {
        list(passing);
        if (passing.size > unresolved)
          at_speeds.push_back(drawn(
              passing, fmt::format("{:.0f} rpm, {:.3g} s", to_rpm(passing.speed), passing.t)));
      }
    if (!at_speeds.empty())
      section.figures.push_back(plot::plot_orbit(
          id + "_orbits", probes_[p].name + ": orbits at given speeds", at_speeds));
  }
  if (!t.rows.empty()) {
    job.folder.write_table(file("orbits.csv"), t);
    section.files.emplace_back("orbits", file("orbits.csv"));
  }
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
