// A transient that can be played back in the report.
#include <plot/plots.hpp>

#include <core/text.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot {

namespace {

/// Lines on one axis show their displacement to scale; others stand where they stand, and the
/// motion is magnified.
struct Frame {
  DisplayUnit along, across;
  bool one_axis = true;
  double magnification = 1;
};

Frame frame_of(const Replay& r, double most) {
  Vec3 lo = Vec3::Constant(infinity), hi = -lo;
  for (const Vec3& p : r.rest) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  Frame f;
  const Vec3 size = hi - lo;
  f.along = size.maxCoeff() >= 10 ? DisplayUnit{1, "m"} : DisplayUnit{1e3, "mm"};
  f.one_axis = size.tail<2>().maxCoeff() < 1e-9;
  f.across = f.one_axis ? length_unit(most) : f.along;
  if (!f.one_axis) f.magnification = 0.14 * std::max(size.maxCoeff(), 1e-6) / most;
  return f;
}

void put(SpaceSeries& s, const Vec3& p) {
  s.x.push_back(p.x());
  s.y.push_back(p.y());
  s.z.push_back(p.z());
}

}  // namespace

Figure plot_replay(std::string name, std::string title, Replay motion,
                   std::span<const ReplayedLine> lines) {
  double most = 0;
  for (std::size_t i = 0; i < motion.y.size(); ++i)
    most = std::max(most, static_cast<double>(std::hypot(motion.y[i], motion.z[i])));
  const Frame frame = frame_of(motion, most);
  motion.gain = frame.across.factor * frame.magnification;
  for (Vec3& p : motion.rest)
    p = Vec3(frame.along.factor * p.x(), frame.across.factor * p.y(), frame.across.factor * p.z());
  const auto place = [&](std::size_t sample, std::size_t point) {
    const std::size_t i = (motion.shown * motion.samples + sample) * motion.points + point;
    return Vec3(motion.rest[point] + motion.gain * Vec3(0, motion.y[i], motion.z[i]));
  };
  Axes a;
  a.kind = AxesKind::space;
  a.view = {-62, 20};
  a.x = Axis("axial position", frame.along.name);
  const std::string enlarged =
      frame.one_axis ? "" : ", motion enlarged " + readable(frame.magnification, 2) + " times";
  a.y = Axis("y" + enlarged, frame.across.name);
  a.z = Axis("z" + enlarged, frame.across.name);
  if (frame.one_axis) {
    a.space_aspect = {2.4, 1, 1};
    const double reach = 1.06 * motion.gain * most;
    a.y.min = motion.rest.front().y() - reach;
    a.y.max = motion.rest.front().y() + reach;
    a.z.min = motion.rest.front().z() - reach;
    a.z.max = motion.rest.front().z() + reach;
  } else {
    a.equal_aspect = true;
  }
  int color = 0;
  for (const ReplayedLine& l : lines) {
    SpaceSeries rest{"", {}, {}, {}, Style{ink, Dash::dash_dot, 0.8}};
    SpaceSeries trails{"", {}, {}, {}, Style{color, Dash::solid, 0.8}};
    SpaceSeries line{l.label, {}, {}, {}, Style{color++, Dash::solid, 2.4}};
    trails.style.opacity = 0.6;
    trails.played = {l.from, l.to, true};
    line.played = {l.from, l.to, false};
    for (std::size_t p = l.from; p < l.to; ++p) {
      put(rest, motion.rest[p]);
      put(line, place(0, p));
      for (std::size_t k = 0; k < motion.samples; ++k)
        put(trails, place(k, p));
      put(trails, Vec3::Constant(nan));
    }
    a.space.push_back(std::move(rest));
    a.space.push_back(std::move(trails));
    a.space.push_back(std::move(line));
  }
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 430;
  f.caption = "Shown: t = " + readable(motion.time[motion.shown], 5) + " s, " +
              readable(rpm * motion.speed[motion.shown], 5) +
              " rpm, with the paths over a turn of the reference. The slider sets the time.";
  f.axes.push_back(std::move(a));
  f.replay = std::make_shared<const Replay>(std::move(motion));
  return f;
}

}  // namespace whirl::plot
