// Figures and tables of a tracking filter: Bode and polar plots against speed, orders, the path of the
// shaft's centre, response peaks, orbits with keyphasor marks.
#include <results/keyphasor_turns.hpp>

#include <analysis/transient/order_filter.hpp>
#include <core/text.hpp>
#include <results/channels.hpp>

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
std::size_t turning_row(const PlotBuffer::Rows& rows) {
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

bool speed_changes(const PlotBuffer::Rows& rows) {
  double low = rows[0][1], high = low;
  for (const auto& r : rows) {
    low = std::min(low, r[1]);
    high = std::max(high, r[1]);
  }
  return high - low > 0.02 * std::max(std::abs(low), std::abs(high));
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

/// The section of one keyphasor in the making.
class KeyphasorReport {
 public:
  KeyphasorReport(const TrackedTurns& turns, TransientEnd& end)
      : turns_(turns),
        rows_(turns.rows.kept_rows()),
        end_(end),
        section_(end.section) {}
  void write();

 private:
  double largest_shown(std::size_t probe) const;
  double largest_envelope(std::size_t probe) const;
  double largest_displacement() const;
  void add_synchronous(std::size_t probe, double size);
  /// Of one probe: the order that is shown, and all frequencies together.
  struct Responses {
    std::vector<plot::ResponseCurve> order, envelope;
  };
  Responses responses_of(std::size_t probe, double size) const;
  void add_bode(std::size_t probe, double size);
  void add_envelope(std::size_t probe, double size);
  void add_orders(std::size_t probe, double size);
  std::vector<Vec2> centres(std::size_t probe) const;
  void add_centreline(std::size_t probe);
  plot::Axes path_of(const std::vector<Vec2>& centre, double length,
                     const plot::DisplayUnit& unit) const;
  void add_peaks(double unresolved);
  void add_orbits();
  void draw(double unresolved);
  void draw_orbits(std::size_t probe, double unresolved);
  void list_orbit(const TrackedOrbit& orbit, io::Table& points) const;
  plot::Orbit drawn(const TrackedOrbit& orbit, std::string label) const;
  void say_unresolved(const std::vector<std::string>& what, double unresolved);
  std::string others_than_orders(std::size_t probe) const;
  std::string shown_order() const {
    return fmt::format("{}X", turns_.tracking.orders[turns_.shown]);
  }
  std::string speed_name() const {
    return turns_.shaft.empty() ? "speed" : "speed of " + turns_.shaft;
  }
  std::string figure_name(std::size_t probe) const {
    return turns_.step + "_" + safe_name(turns_.probes[probe].name);
  }

  const TrackedTurns& turns_;
  const PlotBuffer::Rows rows_;
  TransientEnd& end_;
  io::ReportSection& section_;
};

void KeyphasorReport::write() {
  if (end_.job.model.output.csv)
    section_.files.emplace_back(
        turns_.shaft.empty() ? "tracking filter" : "tracking filter of " + turns_.shaft,
        turns_.file("tracking.csv"));
  const double unresolved = unresolved_share(end_.law) * largest_displacement();
  add_peaks(unresolved);
  add_orbits();
  if (end_.job.model.output.report) draw(unresolved);
}

void KeyphasorReport::draw(double unresolved) {
  constexpr std::size_t fewest = 8;  // turns that make a curve
  const bool few = rows_.size() < fewest && speed_changes(rows_);
  if (few)
    section_.text += fmt::format(
        "\n\n{} turns are too few to show amplitude and phase against {}: they stand in {}.",
        rows_.size(), speed_name(), turns_.file("tracking.csv"));
  std::vector<std::string> left_out;
  for (std::size_t p = 0; p < turns_.probes.size() && !few; ++p) {
    const double size = largest_envelope(p), shown = largest_shown(p);
    if (size == 0.0) continue;  // torsion alone: nothing to see here
    if (shown <= unresolved)
      left_out.push_back(fmt::format("{} of {} (up to {})", shown_order(), turns_.probes[p].name,
                                     length_text(shown)));
    else if (speed_changes(rows_))
      add_bode(p, size);
    else
      add_synchronous(p, size);
    if (size <= unresolved) continue;
    if (speed_changes(rows_)) add_envelope(p, size);
    add_orders(p, std::max(size, 1e3 * unresolved));
    add_centreline(p);
  }
  say_unresolved(left_out, unresolved);
  for (std::size_t p = 0; p < turns_.probes.size(); ++p)
    draw_orbits(p, unresolved);
}

void KeyphasorReport::say_unresolved(const std::vector<std::string>& what, double unresolved) {
  if (what.empty()) return;
  section_.text += fmt::format(
      "\n\nNot drawn: {}. Below {} the integrator resolves nothing at its tolerance, beside "
      "displacements of {}; the numbers stand in {}.",
      fmt::join(what, ", "), length_text(unresolved), length_text(largest_displacement()),
      turns_.file("tracking.csv"));
}

/// Of the order that Bode plots show.
double KeyphasorReport::largest_shown(std::size_t probe) const {
  double size = 0.0;
  for (std::size_t d = 0; d < turns_.probes[probe].directions.size(); ++d)
    for (const auto& r : rows_)
      size = std::max(size, r[turns_.amplitude(probe, d, turns_.shown)]);
  return size;
}

/// From the line at rest, of all probes: what the tolerance of the integrator is relative to.
double KeyphasorReport::largest_displacement() const {
  double size = 0.0;
  for (std::size_t p = 0; p < turns_.probes.size(); ++p)
    for (std::size_t d = 0; d < turns_.probes[p].directions.size(); ++d)
      for (const auto& r : rows_)
        size = std::max(size, std::abs(r[turns_.mean(p, d)]) + r[turns_.envelope(p, d)]);
  return size;
}

double KeyphasorReport::largest_envelope(std::size_t probe) const {
  double size = 0.0;
  for (std::size_t d = 0; d < turns_.probes[probe].directions.size(); ++d)
    for (const auto& r : rows_)
      size = std::max(size, r[turns_.envelope(probe, d)]);
  return size;
}

/// At constant speed: amplitude and envelope against time.
void KeyphasorReport::add_synchronous(std::size_t p, double size) {
  const TrackedProbe& probe = turns_.probes[p];
  const plot::DisplayUnit unit = plot::length_unit(size);
  plot::Figure f;
  f.name = figure_name(p) + "_synchronous";
  f.title = probe.name + ": synchronous amplitude and envelope, turn by turn";
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis(std::string("amplitude, ") + plot::to_string(turns_.convention), unit.name);
  a.y.include_zero = true;
  const double factor = unit.factor * plot::factor_of(turns_.convention);
  for (std::size_t d = 0; d < probe.directions.size(); ++d)
    for (const bool all : {false, true}) {
      plot::Series s;
      s.label = probe.directions[d].shown + (all ? " envelope" : " " + shown_order());
      if (all) {
        s.style.dash = plot::Dash::dashed;
        s.style.width = 1.1;
      }
      const std::size_t column = all ? turns_.envelope(p, d) : turns_.amplitude(p, d, turns_.shown);
      for (const auto& r : rows_) {
        s.x.push_back(r[0]);
        s.y.push_back(factor * r[column]);
      }
      a.series.push_back(std::move(s));
    }
  f.axes.push_back(std::move(a));
  section_.figures.push_back(std::move(f));
}

/// Where most of the motion is at none of the orders: what of it the filter lets through beats in
/// their amplitudes and phases. Empty where it is not so.
std::string KeyphasorReport::others_than_orders(std::size_t p) const {
  double other = 0, all = 0, speed = 0;
  for (const auto& r : rows_)
    for (std::size_t d = 0; d < turns_.probes[p].directions.size(); ++d) {
      double orders = 0;
      for (std::size_t k = 0; k < turns_.tracking.orders.size(); ++k)
        orders += r[turns_.amplitude(p, d, k)];
      const double envelope = r[turns_.envelope(p, d)];
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
KeyphasorReport::Responses KeyphasorReport::responses_of(std::size_t p, double size) const {
  const TrackedProbe& probe = turns_.probes[p];
  const std::size_t top = turning_row(rows_);
  const bool both = top >= 2 && rows_.size() - top >= 3;
  Responses out;
  for (std::size_t d = 0; d < probe.directions.size(); ++d)
    for (const bool rising : {true, false}) {
      const std::size_t from = rising ? 0 : top, to = rising ? top + 1 : rows_.size();
      if (to - from < 3) continue;
      plot::ResponseCurve c;
      c.label = probe.directions[d].shown + (both ? rising ? " rising" : " falling" : "");
      plot::ResponseCurve e = c;
      for (std::size_t r = from; r < to; ++r) {
        e.speed.push_back(rows_[r][1]);
        e.amplitude.push_back(rows_[r][turns_.envelope(p, d)]);
        e.phase_lag.push_back(nan);
        const double amplitude = rows_[r][turns_.amplitude(p, d, turns_.shown)];
        // below a billionth of the largest motion the phase is that of rounding
        c.speed.push_back(rows_[r][1]);
        c.amplitude.push_back(amplitude);
        c.phase_lag.push_back(
            amplitude > 1e-9 * size ? rows_[r][turns_.phase_lag(p, d, turns_.shown)] : nan);
      }
      out.order.push_back(std::move(c));
      out.envelope.push_back(std::move(e));
    }
  return out;
}

void KeyphasorReport::add_bode(std::size_t p, double size) {
  const TrackedProbe& probe = turns_.probes[p];
  const std::string id = figure_name(p);
  const std::vector<plot::ResponseCurve> curves = responses_of(p, size).order;
  const std::string order = shown_order();
  plot::Figure bode = plot::plot_bode(
      id + "_bode",
      probe.name + ": " + order + " amplitude and phase against speed (tracking filter)", curves,
      turns_.convention);
  for (plot::Series& s : bode.axes[1].series)
    s = within_a_turn(s);
  bode.axes[1].y.min = 0.0;
  bode.axes[1].y.max = 360.0;
  bode.axes[1].y.ticks = {0, 90, 180, 270, 360};
  bode.axes[1].x.label = speed_name();
  bode.caption = fmt::format(
      "Filter of {} turn{}: half of what is {:.3g} orders away.", turns_.filter_turns,
      turns_.filter_turns == 1 ? "" : "s",
      turns_.filter_turns == 1 ? 0.5 * turns_.tracking.bandwidth : 1.0 / turns_.filter_turns);
  bode.caption += others_than_orders(p);
  section_.figures.push_back(std::move(bode));
  section_.figures.push_back(plot::plot_polar(
      id + "_polar", probe.name + ": " + order + " vector (polar)", curves, turns_.convention));
}

void KeyphasorReport::add_envelope(std::size_t p, double size) {
  const std::string& probe = turns_.probes[p].name;
  plot::Figure all = plot::plot_bode(figure_name(p) + "_envelope",
                                     probe + ": envelope (all frequencies) against speed",
                                     responses_of(p, size).envelope, turns_.convention);
  all.axes.resize(1);
  all.axes[0].x.label = speed_name();
  all.height = 360;
  section_.figures.push_back(std::move(all));
}

/// All orders that are more than a thousandth of the motion, against speed or time.
void KeyphasorReport::add_orders(std::size_t p, double size) {
  const bool by_speed = speed_changes(rows_);
  const plot::DisplayUnit unit = plot::length_unit(size);
  const double factor = unit.factor * plot::factor_of(turns_.convention);
  plot::Axes a;
  a.x = by_speed ? plot::Axis(speed_name(), "rpm") : plot::Axis("time", "s");
  a.y = plot::Axis(std::string("amplitude, ") + plot::to_string(turns_.convention), unit.name);
  a.y.include_zero = true;
  std::size_t shown = 0;
  for (std::size_t k = 0; k < turns_.tracking.orders.size(); ++k) {
    bool counts = false;
    for (std::size_t d = 0; d < turns_.probes[p].directions.size(); ++d) {
      plot::Series s;
      s.label =
          fmt::format("{} {}X", turns_.probes[p].directions[d].shown, turns_.tracking.orders[k]);
      s.style = {static_cast<int>(k), d == 0 ? plot::Dash::solid : plot::Dash::dashed, 1.2};
      for (const auto& r : rows_) {
        s.x.push_back(by_speed ? to_rpm(r[1]) : r[0]);
        s.y.push_back(factor * r[turns_.amplitude(p, d, k)]);
        counts = counts || r[turns_.amplitude(p, d, k)] > 1e-3 * size;
      }
      if (counts) a.series.push_back(std::move(s));
    }
    shown += counts;
  }
  if (shown < 2) return;
  plot::Figure f;
  f.name = figure_name(p) + "_orders";
  f.title = turns_.probes[p].name + ": orders of the speed";
  f.height = 360;
  f.axes.push_back(std::move(a));
  section_.figures.push_back(std::move(f));
}

/// Means of a probe's turns along y and z; empty where its directions do not give them.
std::vector<Vec2> KeyphasorReport::centres(std::size_t p) const {
  const std::vector<TrackedDirection>& d = turns_.probes[p].directions;
  if (d.size() != 2) return {};
  const Mat2 along{{d[0].c, d[0].s}, {d[1].c, d[1].s}};
  if (std::abs(along.determinant()) < 1e-3) return {};  // both along one line
  const Mat2 back = along.inverse();
  std::vector<Vec2> out;
  for (const auto& r : rows_)
    out.push_back(back * Vec2(r[turns_.mean(p, 0)], r[turns_.mean(p, 1)]));
  return out;
}

/// Where the middle of the orbit goes: what a journal in its film does while the speed changes.
void KeyphasorReport::add_centreline(std::size_t p) {
  const std::vector<Vec2> centre = centres(p);
  if (centre.empty()) return;
  double path = 0, most = 0;
  for (const Vec2& c : centre) {
    path = std::max(path, (c - centre.front()).norm());
    most = std::max(most, c.norm());
  }
  const double gap = clearance_at(end_.job, turns_.probes[p].name);
  if (!(gap > 0) || !(path > 0.01 * gap)) return;  // elsewhere it is the beat of single turns
  const plot::DisplayUnit unit = plot::length_unit(std::max(most, gap));
  plot::Axes a = path_of(centre, path, unit);
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
  } else {
    a.series.push_back(circle_of(gap, unit.factor));
  }
  f.name = figure_name(p) + "_centreline";
  f.title = turns_.probes[p].name + ": path of the shaft's centre";
  f.axes.push_back(std::move(a));
  section_.figures.push_back(std::move(f));
}

/// With time and speed noted at its ends and where the speed turns back; length of the path in m.
plot::Axes KeyphasorReport::path_of(const std::vector<Vec2>& centre, double length,
                                    const plot::DisplayUnit& unit) const {
  plot::Axes a;
  a.x = plot::Axis("y, mean of the turns", unit.name);
  a.y = plot::Axis("z, mean of the turns", unit.name);
  a.equal_aspect = true;
  plot::Series s;
  s.trace_label = "centre of the shaft";
  plot::Extra speed{speed_name(), "rpm", {}};
  const std::size_t stride = 1 + rows_.size() / 1500;
  for (std::size_t r = 0; r < rows_.size(); r += stride) {
    s.x.push_back(unit.factor * centre[r].x());
    s.y.push_back(unit.factor * centre[r].y());
    speed.values.push_back(to_rpm(rows_[r][1]));
  }
  s.extra.push_back(std::move(speed));
  std::vector<std::size_t> noted{0, turning_row(rows_), rows_.size() - 1};
  noted.erase(std::unique(noted.begin(), noted.end()), noted.end());
  for (const std::size_t r : noted)
    if (r == 0 || (centre[r] - centre[0]).norm() > 0.1 * length)
      a.notes.push_back(
          {unit.factor * centre[r].x(), unit.factor * centre[r].y(),
           fmt::format("{:.4g} s, {} rpm", rows_[r][0], readable(to_rpm(rows_[r][1]), 4))});
  a.series.push_back(std::move(s));
  return a;
}

void KeyphasorReport::add_peaks(double unresolved) {
  if (!speed_changes(rows_)) return;
  io::Table t;
  t.title = fmt::format("Peaks of the {} response{}", shown_order(),
                        turns_.shaft.empty() ? "" : " to shaft " + turns_.shaft);
  t.columns = {{"probe", "-", ""},   {"direction", "-", ""},        {"speed is", "-", ""},
               {"speed", "rpm", ""}, {"amplitude 0-peak", "m", ""}, {"phase lag", "deg", ""},
               {"time", "s", ""}};
  const std::size_t top = turning_row(rows_);
  for (std::size_t p = 0; p < turns_.probes.size(); ++p)
    for (std::size_t d = 0; d < turns_.probes[p].directions.size(); ++d)
      for (const bool rising : {true, false}) {
        const std::size_t from = rising ? 0 : top, to = rising ? top + 1 : rows_.size();
        std::vector<double> y;
        for (std::size_t r = from; r < to; ++r)
          y.push_back(rows_[r][turns_.amplitude(p, d, turns_.shown)]);
        // a fifth of the largest: what is lower is mostly beat, not resonance
        for (const std::size_t k : peaks_of(y, 0.2)) {
          const auto& r = rows_[from + k];
          if (y[k] <= unresolved) continue;
          t.add({turns_.probes[p].name, turns_.probes[p].directions[d].name,
                 rising ? "rising" : "falling", to_rpm(r[1]), y[k],
                 r[turns_.phase_lag(p, d, turns_.shown)] * 180.0 / pi, r[0]});
        }
      }
  if (t.rows.empty()) return;
  end_.job.folder.write_table(turns_.file("response_peaks.csv"), t);
  section_.tables.push_back(std::move(t));
  section_.files.emplace_back("peaks of the response", turns_.file("response_peaks.csv"));
}

void KeyphasorReport::add_orbits() {
  io::Table t;
  t.columns = {{"probe", "-", ""},
               {"speed", "rpm", ""},
               {"time", "s", "middle of the last turn"},
               {"angle", "deg", "of the shaft from the first keyphasor mark"},
               {"y", "m", ""},
               {"z", "m", ""}};
  for (std::size_t p = 0; p < turns_.probes.size(); ++p) {
    list_orbit(turns_.largest[p], t);
    for (const TrackedOrbit& passing : turns_.passed)
      if (passing.probe == p) list_orbit(passing, t);
  }
  if (t.rows.empty()) return;
  end_.job.folder.write_table(turns_.file("orbits.csv"), t);
  section_.files.emplace_back("orbits", turns_.file("orbits.csv"));
}

void KeyphasorReport::draw_orbits(std::size_t p, double unresolved) {
  const std::string& name = turns_.probes[p].name;
  const TrackedOrbit& largest = turns_.largest[p];
  if (largest.size > unresolved) {
    const plot::Orbit d = drawn(largest, fmt::format("{:.0f} rpm", to_rpm(largest.speed)));
    plot::Figure f = plot::plot_orbit(
        figure_name(p) + "_orbit", fmt::format("{}: largest orbit, t = {:.4g} s", name, largest.t),
        std::span(&d, 1));
    f.caption = "Displacement about its mean; a dot where the keyphasor fires.";
    section_.figures.push_back(std::move(f));
  }
  std::vector<plot::Orbit> at_speeds;
  for (const TrackedOrbit& passing : turns_.passed)
    if (passing.probe == p && passing.size > unresolved)
      at_speeds.push_back(
          drawn(passing, fmt::format("{:.0f} rpm, {:.3g} s", to_rpm(passing.speed), passing.t)));
  if (!at_speeds.empty())
    section_.figures.push_back(
        plot::plot_orbit(figure_name(p) + "_orbits", name + ": orbits at given speeds", at_speeds));
}

void KeyphasorReport::list_orbit(const TrackedOrbit& orbit, io::Table& points) const {
  const auto n = static_cast<double>(turns_.tracking.samples);
  for (std::size_t j = 0; j < orbit.y.size(); ++j)
    points.add({turns_.probes[orbit.probe].name, to_rpm(orbit.speed), orbit.t,
                360.0 * static_cast<double>(j) / n, orbit.y[j], orbit.z[j]});
}

/// About its mean.
plot::Orbit KeyphasorReport::drawn(const TrackedOrbit& orbit, std::string label) const {
  plot::Orbit d;
  d.label = std::move(label);
  const analysis::Range y = analysis::range_of(orbit.y), z = analysis::range_of(orbit.z);
  for (std::size_t j = 0; j < orbit.y.size(); ++j) {
    d.y.push_back(orbit.y[j] - y.mean);
    d.z.push_back(orbit.z[j] - z.mean);
  }
  const auto n = static_cast<std::size_t>(turns_.tracking.samples);
  for (std::size_t j = 0; j + 1 < orbit.y.size(); j += n)
    d.keyphasor.push_back(j);
  return d;
}

}  // namespace

void report_turns(const TrackedTurns& turns, TransientEnd& end) {
  constexpr std::size_t fewest = 3;
  if (turns.rows.kept_rows().size() >= fewest) KeyphasorReport(turns, end).write();
}

}  // namespace whirl::results
