// Tracking filter of a transient's probes: CSV turn by turn, Bode and polar figures against speed,
// response peaks, orbits with keyphasor marks. Memory is bounded: long runs are thinned for the
// figures, the CSV holds every turn.
#include <analysis/spectra/whirl_modes.hpp>
#include <analysis/transient/revolutions.hpp>
#include <plot/plots.hpp>
#include <results/plot_buffer.hpp>
#include <results/transient_output.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

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

bool speed_changes(const std::vector<std::vector<double>>& rows) {
  double low = rows[0][1], high = low;
  for (const auto& r : rows) {
    low = std::min(low, r[1]);
    high = std::max(high, r[1]);
  }
  return high - low > 0.02 * std::max(std::abs(low), std::abs(high));
}

class KeyphasorOutput final : public TransientOutput {
 public:
  explicit KeyphasorOutput(const TransientSetup& s);
  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&revolutions_);
    parts.add_output({run::Part::keyphasor, content_}, *this);
  }
  analysis::Observer& observer() { return revolutions_; }
  void begin();
  void save(OutArchive& out);
  void restore(InArchive& in);
  void close() override {
    if (sink_) sink_->close();
  }
  void report(TransientEnd& end) override;

 private:
  struct Direction {
    std::string name;
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
  void take(const analysis::Turn& turn);
  void take_orbit(std::size_t probe, const analysis::Turn& turn);
  Orbit last_turns(std::size_t probe, double t, double speed, double size) const;
  std::size_t column(std::size_t probe, std::size_t direction, std::size_t what) const;
  std::vector<io::Channel> channels() const;
  double largest_envelope(std::size_t probe) const;
  void add_synchronous(io::ReportSection& section, std::size_t probe, double size) const;
  void add_bode(io::ReportSection& section, std::size_t probe, double size) const;
  void add_peaks(run::Job& job, io::ReportSection& section) const;
  void add_orbits(run::Job& job, io::ReportSection& section) const;

  static constexpr std::size_t most_orbits = 64;
  const model::Output& out_;
  const plot::Amplitude convention_ = plot::amplitude(out_.peak_to_peak);
  std::string step_, content_;  ///< content_: what decides whether a part of a checkpoint fits
  std::vector<Tracked> probes_;
  std::size_t per_direction_ = 0, columns_ = 0;
  io::TimeSeriesPtr sink_;
  PlotBuffer rows_;
  std::vector<double> row_, direction_values_;
  std::vector<std::vector<Orbit>> recent_;  ///< [probe] last turns
  std::vector<Orbit> largest_, passed_;
  double last_speed_ = nan;
  analysis::Revolutions revolutions_;
};

KeyphasorOutput::KeyphasorOutput(const TransientSetup& s)
    : out_(s.job.model.output),
      step_(s.step.name),
      rows_(0),
      revolutions_(probe_points(s.job), s.job.reference(), out_.tracking.samples,
                   [this](const analysis::Turn& t) { take(t); }) {
  per_direction_ = 2 * out_.tracking.orders.size() + 2;
  columns_ = 2;  // t, speed
  content_ = fmt::format("{}", out_.tracking.samples);
  for (double order : out_.tracking.orders)
    content_ += fmt::format(" {}X", order);
  for (double speed : out_.tracking.orbit_speeds)
    content_ += fmt::format(" @{}", speed);
  content_ += fmt::format(" turns {}", out_.tracking.orbit_turns);
  const std::vector<double> senses = probe_senses(s.job, s.start);
  for (std::size_t p = 0; p < senses.size(); ++p)
    add_probe(s.job.model.probes[p], senses[p]);
  row_.resize(columns_);
  rows_ = PlotBuffer(columns_ - 1, 2);  // whole rows alone are wanted
  recent_.resize(probes_.size());
  largest_.resize(probes_.size());
  if (out_.csv) sink_ = io::make_csv_series(s.job.folder.path(step_ + "_tracking.csv"));
}

void KeyphasorOutput::add_probe(const model::Probe& probe, double sense) {
  Tracked t;
  t.name = probe.name;
  t.sense = sense;
  if (probe.angles.empty()) t.directions = {{"y", 1.0, 0.0}, {"z", 0.0, 1.0}};
  for (double a : probe.angles)
    t.directions.push_back({fmt::format("{:.0f}deg", a * 180.0 / pi), std::cos(a), std::sin(a)});
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
      c.push_back(
          {name + " envelope", "m", "half the peak-to-peak value of the turn", {}, 1.0, {}});
      c.push_back({name + " mean", "m", "mean of the turn", {}, 1.0, {}});
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

void KeyphasorOutput::take(const analysis::Turn& turn) {
  const double speed = turn.speed(), t = 0.5 * (turn.t0 + turn.t1);
  row_[0] = t;
  row_[1] = speed;
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    const std::vector<double>&y = turn.y[p], &z = turn.z[p];
    double* out = row_.data() + probes_[p].column;
    direction_values_.resize(y.size());
    for (const Direction& d : probes_[p].directions) {
      for (std::size_t j = 0; j < y.size(); ++j)
        direction_values_[j] = d.c * y[j] + d.s * z[j];
      for (double k : out_.tracking.orders) {
        const Complex x = analysis::synchronous(turn, direction_values_, static_cast<int>(k));
        *out++ = std::abs(x);
        *out++ = analysis::lag_of(turn, x);
      }
      const analysis::Range r = analysis::range_of(direction_values_);
      *out++ = 0.5 * (r.high - r.low);
      *out++ = r.mean;
    }
    // against the angle of the reference, so that a rotor may turn either way
    const analysis::Orbit circles = analysis::orbit_of(
        analysis::synchronous(turn, y, 1), analysis::synchronous(turn, z, 1), probes_[p].sense);
    *out++ = circles.forward;
    *out++ = circles.backward;
    take_orbit(p, turn);
  }
  last_speed_ = speed;
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
  revolutions_.restore(in);
}

void KeyphasorOutput::report(TransientEnd& end) {
  if (!out_.report) return;
  const auto& rows = rows_.kept_rows();
  if (rows.size() < 3) return;
  if (sink_) end.section.files.emplace_back("tracking filter", step_ + "_tracking.csv");
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    const double size = largest_envelope(p);
    if (size == 0.0) continue;  // torsion alone: nothing to see here
    if (speed_changes(rows))
      add_bode(end.section, p, size);
    else
      add_synchronous(end.section, p, size);
  }
  add_peaks(end.job, end.section);
  add_orbits(end.job, end.section);
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
    for (const std::size_t what : {std::size_t{0}, per_direction_ - 2}) {
      plot::Series s;
      s.label = probe.directions[d].name +
                (what == 0 ? fmt::format(" {}X", out_.tracking.orders.front()) : " envelope");
      if (what != 0) {
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

/// Against speed, rising and falling apart.
void KeyphasorOutput::add_bode(io::ReportSection& section, std::size_t p, double size) const {
  const auto& rows = rows_.kept_rows();
  const Tracked& probe = probes_[p];
  const std::string id = step_ + "_" + safe_name(probe.name);
  const std::size_t top = turning_row(rows);
  const bool both = top >= 2 && rows.size() - top >= 3;
  std::vector<plot::ResponseCurve> curves, envelope;
  for (std::size_t d = 0; d < probe.directions.size(); ++d)
    for (const bool rising : {true, false}) {
      const std::size_t from = rising ? 0 : top, to = rising ? top + 1 : rows.size();
      if (to - from < 3) continue;
      plot::ResponseCurve c;
      c.label = probe.directions[d].name + (both ? rising ? " rising" : " falling" : "");
      plot::ResponseCurve e = c;
      for (std::size_t r = from; r < to; ++r) {
        const double amplitude = rows[r][column(p, d, 0)];
        // below a billionth of the largest motion the phase is that of rounding
        c.speed.push_back(rows[r][1]);
        c.amplitude.push_back(amplitude);
        c.phase_lag.push_back(amplitude > 1e-9 * size ? rows[r][column(p, d, 1)] : nan);
        e.speed.push_back(rows[r][1]);
        e.amplitude.push_back(rows[r][column(p, d, per_direction_ - 2)]);
        e.phase_lag.push_back(nan);
      }
      curves.push_back(std::move(c));
      envelope.push_back(std::move(e));
    }
  const std::string order = fmt::format("{}X", out_.tracking.orders.front());
  plot::Figure bode = plot::plot_bode(
      id + "_bode",
      probe.name + ": " + order + " amplitude and phase against speed (tracking filter)", curves,
      convention_);
  for (plot::Series& s : bode.axes[1].series)
    s = within_a_turn(s);
  bode.axes[1].y.min = 0.0;
  bode.axes[1].y.max = 360.0;
  bode.axes[1].y.ticks = {0, 90, 180, 270, 360};
  section.figures.push_back(std::move(bode));
  section.figures.push_back(plot::plot_polar(
      id + "_polar", probe.name + ": " + order + " vector (polar)", curves, convention_));
  plot::Figure all =
      plot::plot_bode(id + "_envelope", probe.name + ": envelope (all frequencies) against speed",
                      envelope, convention_);
  all.axes.resize(1);
  all.height = 360;
  section.figures.push_back(std::move(all));
}

void KeyphasorOutput::add_peaks(run::Job& job, io::ReportSection& section) const {
  const auto& rows = rows_.kept_rows();
  if (!speed_changes(rows)) return;
  io::Table t;
  t.title = fmt::format("Peaks of the {}X response", out_.tracking.orders.front());
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
          y.push_back(rows[r][column(p, d, 0)]);
        // a fifth of the largest: what is lower is mostly beat, not resonance
        for (const std::size_t k : peaks_of(y, 0.2)) {
          const auto& r = rows[from + k];
          t.add({probes_[p].name, probes_[p].directions[d].name, rising ? "rising" : "falling",
                 to_rpm(r[1]), y[k], r[column(p, d, 1)] * 180.0 / pi, r[0]});
        }
      }
  if (t.rows.empty()) return;
  job.folder.write_table(step_ + "_response_peaks.csv", t);
  section.tables.push_back(std::move(t));
  section.files.emplace_back("peaks of the response", step_ + "_response_peaks.csv");
}

void KeyphasorOutput::add_orbits(run::Job& job, io::ReportSection& section) const {
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
    const bool moves = std::any_of(o.y.begin(), o.y.end(), [](double x) { return x != 0.0; }) ||
                       std::any_of(o.z.begin(), o.z.end(), [](double x) { return x != 0.0; });
    if (moves) {
      const plot::Orbit d = drawn(o, fmt::format("{:.0f} rpm", to_rpm(o.speed)));
      plot::Figure f = plot::plot_orbit(
          id + "_orbit", fmt::format("{}: largest orbit, t = {:.4g} s", probes_[p].name, o.t),
          std::span(&d, 1));
      f.caption = "Displacement about its mean; a dot where the keyphasor fires.";
      section.figures.push_back(std::move(f));
      list(o);
    }
    std::vector<plot::Orbit> at_speeds;
    for (const Orbit& passing : passed_)
      if (passing.probe == p) {
        at_speeds.push_back(
            drawn(passing, fmt::format("{:.0f} rpm, {:.3g} s", to_rpm(passing.speed), passing.t)));
        list(passing);
      }
    if (!at_speeds.empty())
      section.figures.push_back(plot::plot_orbit(
          id + "_orbits", probes_[p].name + ": orbits at given speeds", at_speeds));
  }
  if (!t.rows.empty()) {
    job.folder.write_table(step_ + "_orbits.csv", t);
    section.files.emplace_back("orbits", step_ + "_orbits.csv");
  }
}

}  // namespace

void add_keyphasor(const TransientSetup& setup, TransientOutputs& outputs) {
  const model::Output& o = setup.job.model.output;
  if (o.tracking.on && !setup.job.model.probes.empty() && (o.csv || o.report))
    outputs.push_back(std::make_unique<KeyphasorOutput>(setup));
}

}  // namespace whirl::results
