// Moments of a transient kept for its replay in the report: the lines of the machine and the paths
// of their stations over a turn, a hundred times a run. Bounded in size whatever the run.
#include <results/transient_output.hpp>

#include <plot/plots.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

constexpr std::size_t most_moments = 96, samples_each = 24, most_points = 32;

/// The points of a line that are shown.
struct ShownLine {
  std::string name;
  std::size_t from = 0, to = 0;
};

/// Motion of points about their places at the start.
class ReplayRecorder final : public analysis::Observer {
 public:
  ReplayRecorder(std::vector<analysis::Point> points, Index reference, double t0, double t1)
      : points_(std::move(points)),
        reference_(reference),
        moments_(t0, (t1 - t0) / most_moments),
        interval_((t1 - t0) / most_moments) {}
  void begin(const analysis::Snapshot& s) override {
    start_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i)
      start_[i] = analysis::displacement(s, points_[i]).tail<2>();
    for (std::vector<float>* v : {&kept_.y, &kept_.z})
      v->reserve(most_moments * samples_each * points_.size());
  }
  void step(analysis::StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  /// Whole moments alone. @pre every point has its place in `rest`.
  plot::Replay taken() const;

 private:
  void begin_moment(analysis::StepAccess& s);

  std::vector<analysis::Point> points_;
  Index reference_;
  analysis::Ticker moments_;
  double interval_;
  std::vector<Vec2> start_, now_;
  std::size_t filled_ = samples_each;  ///< samples of the last moment
  plot::Replay kept_;
};

void ReplayRecorder::begin_moment(analysis::StepAccess& s) {
  const double t = moments_.next(), speed = s.at(t).node(reference_).spin();
  moments_.advance();
  kept_.time.push_back(t);
  kept_.speed.push_back(speed);
  kept_.span.push_back(std::min(two_pi / std::max(std::abs(speed), 1e-9), 0.95 * interval_));
  filled_ = 0;
}

void ReplayRecorder::step(analysis::StepAccess& s) {
  for (;;) {
    if (filled_ == samples_each) {
      if (kept_.time.size() == most_moments || moments_.next() > s.t1()) return;
      begin_moment(s);
    }
    const double t = kept_.time.back() + kept_.span.back() * static_cast<double>(filled_) /
                                             static_cast<double>(samples_each - 1);
    if (t > s.t1()) return;
    s.displacements(std::max(t, s.t0()), points_, now_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec2 u = now_[i] - start_[i];
      kept_.y.push_back(static_cast<float>(u.x()));
      kept_.z.push_back(static_cast<float>(u.y()));
    }
    ++filled_;
  }
}

void ReplayRecorder::save(OutArchive& out) const {
  out.put_count(static_cast<std::uint64_t>(moments_.count()));
  out.put_count(filled_);
  for (const Vec2& u : start_) {
    out.put(u.x());
    out.put(u.y());
  }
  out.put(kept_.time);
  out.put(kept_.speed);
  out.put(kept_.span);
  out.put(std::vector<double>(kept_.y.begin(), kept_.y.end()));
  out.put(std::vector<double>(kept_.z.begin(), kept_.z.end()));
}

void ReplayRecorder::restore(InArchive& in) {
  moments_.set_count(static_cast<long>(in.count()));
  filled_ = in.count();
  start_.resize(points_.size());
  for (Vec2& u : start_) {
    u.x() = in.number();
    u.y() = in.number();
  }
  kept_.time = in.numbers();
  kept_.speed = in.numbers();
  kept_.span = in.numbers();
  const auto floats = [](const std::vector<double>& x) {
    std::vector<float> out;
    out.reserve(x.size());
    for (const double v : x)
      out.push_back(static_cast<float>(v));
    return out;
  };
  kept_.y = floats(in.numbers());
  kept_.z = floats(in.numbers());
}

plot::Replay ReplayRecorder::taken() const {
  plot::Replay r = kept_;
  r.samples = samples_each;
  r.points = points_.size();
  const std::size_t each = samples_each * points_.size();
  const std::size_t moments = each > 0 ? r.y.size() / each : 0;
  for (std::vector<double>* v : {&r.time, &r.speed, &r.span})
    v->resize(std::min(v->size(), moments));
  r.y.resize(moments * each);
  r.z.resize(moments * each);
  float most = 0;
  for (std::size_t i = 0; i < r.y.size(); ++i)
    if (const float size = std::hypot(r.y[i], r.z[i]); size > most) {
      most = size;
      r.shown = i / each;
    }
  return r;
}

/// Stations of every line, ends always; not more than most_points in all where that leaves five a
/// line.
struct ShownPoints {
  std::vector<ShownLine> lines;
  std::vector<analysis::Point> points;
  std::vector<Vec3> rest;  ///< m
};
ShownPoints shown_points(const run::Job& job) {
  ShownPoints out;
  const meshes::Mesh& mesh = job.mesh;
  const std::size_t most = std::max<std::size_t>(5, most_points / mesh.lines.size());
  for (const meshes::Line& line : mesh.lines) {
    ShownLine shown{line.name, out.points.size(), 0};
    const auto n = at(line.stations), k = std::min(n, most);
    for (std::size_t i = 0; i < k; ++i) {
      const meshes::Station& st =
          mesh.stations[at(line.first_station) + (k > 1 ? i * (n - 1) / (k - 1) : 0)];
      out.points.push_back({st.at.node, st.at.offset});
      out.rest.push_back(st.position);
    }
    shown.to = out.points.size();
    out.lines.push_back(std::move(shown));
  }
  return out;
}

class ReplayOutput final : public TransientOutput {
 public:
  ReplayOutput(const TransientSetup& s, ShownPoints shown)
      : shown_(std::move(shown)),
        content_(
            fmt::format("{} points {} {}", shown_.points.size(), s.t_begin, s.integration.t_end)),
        recorder_(shown_.points, s.job.reference(), s.t_begin, s.integration.t_end) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&recorder_);
    parts.add({run::Part::replay, content_}, recorder_);
  }

  void report(TransientEnd& end) override {
    plot::Replay r = recorder_.taken();
    if (r.time.size() < 3) return;
    double most = 0;
    for (std::size_t i = 0; i < r.y.size(); ++i)
      most = std::max(most, static_cast<double>(std::hypot(r.y[i], r.z[i])));
    if (!(most > 0)) return;  // nothing moves sideways
    r.rest = shown_.rest;
    std::vector<plot::ReplayedLine> of;
    for (const ShownLine& l : shown_.lines)
      of.push_back({l.name, l.from, l.to});
    end.section.figures.push_back(plot::plot_replay(
        end.step.name + "_replay", "Replay: lines of the machine about their places at the start",
        std::move(r), of));
  }

 private:
  ShownPoints shown_;
  std::string content_;
  ReplayRecorder recorder_;
};

}  // namespace

void add_replay(const TransientSetup& setup, TransientOutputs& outputs) {
  const model::Output& o = setup.job.model.output;
  const bool asked = o.report && o.replay && (o.csv || o.binary || !o.vtk.empty());
  // lines along a path move in directions of their own: ParaView shows them
  const auto straight = [](const model::Shaft& s) { return s.path.empty(); };
  if (!asked ||
      !std::all_of(setup.job.model.shafts.begin(), setup.job.model.shafts.end(), straight))
    return;
  ShownPoints shown = shown_points(setup.job);
  if (shown.points.size() <= 8 * most_points)
    outputs.push_back(std::make_unique<ReplayOutput>(setup, std::move(shown)));
}

}  // namespace whirl::results
