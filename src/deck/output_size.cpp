// What a deck would write, and whether there is room for it.
#include <deck/deck.hpp>
#include <deck/mesh_size.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace whirl::deck {

namespace {

/// Characters a number takes in CSV files, bytes in binary ones.
constexpr double csv_bytes = 20;
constexpr double binary_bytes = 8;

struct Interval {
  double begin = 0, end = 0;
  double length() const { return std::max(0.0, end - begin); }
};

Interval common(const Interval& a, double t0, double t1) {
  return {std::max(a.begin, t0), std::min(a.end, t1)};
}

/// When each transient step runs: one that starts from another goes on where that one ends.
std::map<std::string, Interval> times_of_steps(const model::Model& m) {
  std::map<std::string, Interval> r;
  for (const auto& s : m.steps) {
    const auto before = r.find(s.from);
    const double begin = before == r.end() ? 0.0 : before->second.end;
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    r[s.name] = {begin, begin + (t ? t->duration : 0.0)};
  }
  return r;
}

double count_of_columns(const model::Model& m) {
  double columns = 2 + static_cast<double>(m.shafts.size());
  for (const auto& p : m.probes)
    columns += p.angles.empty() ? 2 : static_cast<double>(p.angles.size());
  return columns + 3.0 * static_cast<double>(m.bearings.size()) + 6;
}

/// Of pictures of one deck entry in one step.
struct Frames {
  double count = 0;
  bool at_most = false;  ///< there may be fewer
};

/// Turns of the reference between two times of a transient step, where a drive prescribes them.
std::optional<double> turns_of(const model::Model& m, const model::Step& s, double from,
                               double to) {
  for (const model::Drive& d : m.drives) {
    const auto* p = std::get_if<model::PrescribedSpin>(&d.law);
    const double ratio = std::abs(m.shafts[d.at.shaft].speed_ratio);
    if (!p || !p->angle || !(ratio > 0) || (!d.step.empty() && d.step != s.name)) continue;
    double angle = 0, last = p->angle->at(from).f;
    constexpr int looks = 1000;  // it may turn back
    for (int k = 1; k <= looks; ++k) {
      const double now = p->angle->at(std::lerp(from, to, static_cast<double>(k) / looks)).f;
      angle += std::abs(now - last);
      last = now;
    }
    return angle / two_pi / ratio;
  }
  return std::nullopt;
}

/// @param run when the step runs.
Frames frames_of(const model::Model& m, const model::VtkOutput& o, const model::Step& s,
                 const model::TransientStep& t, const Interval& run) {
  const Interval window = common(run, o.t0, o.t1);
  const double share = t.duration > 0 ? window.length() / t.duration : 0.0;
  if (!(share > 0)) return {};
  Frames f;
  if (o.every > 0)
    f.count = std::floor(window.length() / o.every) + 1;
  else if (o.frames_per_revolution > 0) {
    const std::optional<double> turns =
        turns_of(m, s, window.begin - run.begin, window.end - run.begin);
    f.at_most = !turns || share < 1;
    f.count = turns ? *turns * o.frames_per_revolution + 1 : o.max_frames;
  } else
    f.count = o.frames;
  f.count = std::min<double>(f.count, o.max_frames);
  f.at_most = f.at_most || t.stop_speed.has_value() || t.amplitude_limit < infinity;
  return f;
}

struct FramesOfAStep {
  const model::Model& m;
  const model::VtkOutput& o;
  const model::Step& s;
  const Interval& run;
  static Frames shapes(double n, bool at_most) {
    return {model::VtkOutput::frames_of_a_shape * n, at_most};
  }
  Frames operator()(const model::TransientStep& t) const { return frames_of(m, o, s, t, run); }
  Frames operator()(const model::StaticStep& x) const {
    if (x.path) {
      const bool arc = x.path->control == model::LoadPath::Control::arc_length;
      return {std::min<double>(o.max_frames, arc ? x.path->max_points : x.path->steps + 1), true};
    }
    return {static_cast<double>(x.speeds ? count_of(*x.speeds) : 1), false};
  }
  Frames operator()(const model::ModalStep& x) const {
    return shapes(std::min(x.shapes, x.modes), true);
  }
  Frames operator()(const model::CriticalStep& x) const { return shapes(x.shapes, true); }
  Frames operator()(const model::TorsionalStep& x) const { return shapes(x.modes, true); }
  Frames operator()(const model::BucklingStep& x) const { return shapes(x.modes, true); }
  Frames operator()(const model::StabilityStep&) const {
    return shapes(model::StabilityStep::most_onset_shapes, true);
  }
  Frames operator()(const model::UnbalanceStep& x) const { return at(x.shapes_at); }
  Frames operator()(const model::HarmonicStep& x) const { return at(x.shapes_at); }
  // tables and figures, but no frames
  Frames operator()(const model::CampbellStep&) const { return {}; }
  Frames operator()(const model::CriticalMapStep&) const { return {}; }
  Frames operator()(const model::SensitivityStep&) const { return {}; }
  Frames operator()(const model::BalancingStep&) const { return {}; }
  Frames operator()(const model::ApiLateralStep&) const { return {}; }
  Frames operator()(const model::ApiTorsionalStep&) const { return {}; }
  /// Operating shapes: where asked for, else at the peaks, whose number is a guess.
  static Frames at(const std::vector<double>& asked) {
    return asked.empty() ? shapes(peaks_expected, true)
                         : shapes(static_cast<double>(asked.size()), false);
  }
  static std::size_t count_of(const model::SpeedRange& r) {
    return r.values.empty() ? static_cast<std::size_t>(r.points) : r.values.size();
  }
  static constexpr int peaks_expected = 6;
};

/// Bytes over those of .vtp files with lz4. In one file cells that stay stand once, and bytes are
/// sorted before they are packed.
struct Packed {
  double line, surface, bearings, orbits;
};

Packed packed_of(const model::VtkOutput& o) {
  switch (o.compression) {
    case Compression::none:
      return o.one_file ? Packed{0.6, 1.3, 1.1, 0.9} : Packed{1.0, 2.0, 1.5, 1.0};
    case Compression::zlib:
      return o.one_file ? Packed{0.45, 0.3, 0.45, 0.9} : Packed{0.95, 0.65, 0.8, 0.9};
    case Compression::lz4: break;
  }
  return {1.0, 1.0, 1.0, 1.0};
}

/// Of a frame: measured on examples of one to thirty nodes, within a third (compression takes more
/// or less of different motions).
double bytes_of_frame(const model::Model& m, const model::VtkOutput& o, const NodeCount& nodes) {
  const Packed packed = packed_of(o);
  const auto shows = [&](const char* what) {
    return std::find(o.content.begin(), o.content.end(), what) != o.content.end();
  };
  const auto supports = static_cast<double>(m.bearings.size());
  return (shows("line") ? packed.line * (4000 + 350 * nodes.line) : 0) +
         (shows("surface") ? packed.surface * (5000 + 165 * nodes.surface * o.points_around) : 0) +
         (shows("bearings") ? packed.bearings * (1000 + 8000 * supports) : 0) +
         (shows("orbits") ? packed.orbits * (1500 + 6000 * static_cast<double>(m.probes.size()))
                          : 0);
}

}  // namespace

OutputEstimate estimate_output(const model::Model& m) {
  OutputEstimate e;
  const NodeCount nodes = count_of_nodes(m);
  const double columns = count_of_columns(m);
  const auto times = times_of_steps(m);
  double largest = 0;
  for (const auto& s : m.steps) {
    const Interval& run = times.at(s.name);
    const double before = e.total();
    if (const auto* t = std::get_if<model::TransientStep>(&s.law)) {
      // the adaptive step is not known beforehand, so only a given interval can be judged
      const double every = m.output.every > 0 ? m.output.every : t->integrator.dt;
      const double row =
          columns * ((m.output.csv ? csv_bytes : 0) + (m.output.binary ? binary_bytes : 0));
      e.open = e.open || (!(every > 0) && row > 0);
      if (every > 0) e.histories += common(run, m.output.t0, m.output.t1).length() / every * row;
    }
    for (const auto& o : m.output.vtk) {
      if (!o.step.empty() && o.step != s.name) continue;
      const Frames f = std::visit(FramesOfAStep{m, o, s, run}, s.law);
      e.frames += f.count;
      e.pictures += f.count * bytes_of_frame(m, o, nodes);
      e.fewer_frames = e.fewer_frames || (f.at_most && f.count > 0);
    }
    if (e.total() - before > largest) {
      largest = e.total() - before;
      e.where = s.where;
    }
  }
  // how long the speed or the amplitude stays inside its window is what the run is to find out
  const model::Output& o = m.output;
  e.at_most = o.speed_low > -infinity || o.speed_high < infinity || o.above > 0;
  return e;
}

std::string size_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
  if (bytes < 1e12) return fmt::format("{:.1f} GB", bytes / 1e9);
  return fmt::format("{:.1f} TB", bytes / 1e12);
}

std::vector<Diagnostic> check_output(const model::Model& m, double available, bool is_asked_for) {
  const OutputEstimate e = estimate_output(m);
  const double sure = (e.fewer_frames ? 0 : e.pictures) + (e.at_most ? 0 : e.histories);
  if (sure <= available) return {};
  Diagnostic d;
  d.code = "E33";
  d.message =
      fmt::format("the output would take about {} (histories {}, pictures {}), but {}",
                  size_text(e.total()), size_text(e.histories), size_text(e.pictures),
                  is_asked_for ? fmt::format("the limit is {} (--max-disk)", size_text(available))
                               : fmt::format("only {} are free", size_text(available)));
  d.hint = e.histories > e.pictures ? "write rows less often: output.every"
                                    : "ask for fewer frames or a window in [[output.vtk]]";
  d.where = e.where;
  return {d};
}

}  // namespace whirl::deck
