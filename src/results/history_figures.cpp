// Figures of a transient's time histories.
#include <results/history_figures.hpp>
#include <plot/plots.hpp>

#include <core/text.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

namespace whirl::results {

namespace {

using analysis::Measurement;

plot::Axes time_axes(std::string label, std::string unit) {
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis(std::move(label), std::move(unit));
  return a;
}

plot::Series series(std::string label, PlotBuffer::Points p, double factor = 1.0) {
  plot::Series s;
  s.label = std::move(label);
  for (double& y : p.y)
    y *= factor;
  s.x = std::move(p.t);
  s.y = std::move(p.y);
  s.style.width = 1.1;
  return s;
}

double largest(const std::vector<double>& y) {
  double m = 0.0;
  for (double v : y)
    m = std::max(m, std::abs(v));
  return m;
}

plot::Figure figure(const model::Step& step, const std::string& name, std::string title,
                    std::vector<plot::Axes> axes, double height = 0) {
  plot::Figure f;
  f.name = step.name + "_" + name;
  for (char& c : f.name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  f.title = std::move(title);
  f.axes = std::move(axes);
  f.height = height > 0 ? height : 120.0 + 220.0 * static_cast<double>(f.axes.size());
  for (std::size_t i = 1; i < f.axes.size(); ++i)
    f.axes[i].share_x = true;
  return f;
}

/// Means of a path over the angle turned, rad, under Hann windows of one width: sums of what the window
/// consists of, 1 and the cosine and sine of the angle, from the first row on.
class HannMeans {
 public:
  /// half: of the window's width, rad. turned: increasing, one a point.
  HannMeans(std::span<const double> turned, std::span<const Vec2> path, double half)
      : turned_(turned),
        half_(half) {
    const std::size_t n = turned.size();
    sums_.reserve(n + 1);
    sums_.emplace_back();
    for (std::size_t k = 0; k < n; ++k) {
      const double wide = turned[std::min(n - 1, k + 1)] - turned[k - std::min<std::size_t>(k, 1)];
      const double angle = pi / half * (turned[k] - turned.front());
      const Eigen::Vector3d part = wide * Eigen::Vector3d(1.0, std::cos(angle), std::sin(angle));
      const Sums& last = sums_.back();
      const int turned_on = wide > 1e-6 * half ? 1 : 0;
      sums_.push_back(
          {last.weight + part, last.path + path[k] * part.transpose(), last.points + turned_on});
    }
  }
  /// About an angle, or the nearest at which the window lies within the path; none where less
  /// than eight points stand apart in it: a shaft that stands after turns of which few are known.
  std::optional<Vec2> about(double angle) const {
    const double middle =
        std::max(turned_.front() + half_, std::min(angle, turned_.back() - half_));
    const auto first = std::lower_bound(turned_.begin(), turned_.end(), middle - half_);
    const auto last = std::upper_bound(first, turned_.end(), middle + half_);
    const Sums& before = sums_[static_cast<std::size_t>(first - turned_.begin())];
    const Sums& behind = sums_[static_cast<std::size_t>(last - turned_.begin())];
    const double phase = pi / half_ * (middle - turned_.front());
    const Eigen::Vector3d window(1.0, std::cos(phase), std::sin(phase));
    constexpr int fewest = 8;
    if (behind.points - before.points < fewest) return std::nullopt;
    return (behind.path - before.path) * window / window.dot(behind.weight - before.weight);
  }

 private:
  /// Of 1, the cosine and the sine, with the widths of the rows as weights.
  struct Sums {
    Eigen::Vector3d weight = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 2, 3> path = Eigen::Matrix<double, 2, 3>::Zero();
    int points = 0;  ///< that stand apart from their neighbours
  };
  std::span<const double> turned_;
  double half_;
  std::vector<Sums> sums_;
};

/// Of the box about a path.
Vec2 middle_of(std::span<const Vec2> path) {
  Vec2 low = Vec2::Constant(infinity), high = Vec2::Constant(-infinity);
  for (const Vec2& u : path) {
    low = low.cwiseMin(u);
    high = high.cwiseMax(u);
  }
  return 0.5 * (low + high);
}

/// Diagonal of the box about the nodes, m; 1 where all stand at one place.
double size_of(const meshes::Mesh& mesh) {
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (const meshes::Node& n : mesh.nodes) {
    low = low.cwiseMin(n.position);
    high = high.cwiseMax(n.position);
  }
  const double size = (high - low).norm();
  return size > 0 && std::isfinite(size) ? size : 1.0;
}

class HistoryFigures {
 public:
  HistoryFigures(const run::Job& job, const model::Step& step, const Channels& channels,
                 const PlotBuffer& buffer, double unresolved, io::ReportSection& section)
      : job_(job),
        step_(step),
        all_(channels.all),
        start_(channels.start),
        buffer_(buffer),
        rows_(buffer.kept_rows()),
        convention_(plot::amplitude(job.model.output.peak_to_peak)),
        unresolved_(unresolved),
        size_(size_of(job.mesh)),
        section_(section) {
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (is_load(all_[i].name)) largest_load_ = std::max(largest_load_, load_of(i));
  }
  void add_speed();
  void add_displacement(const model::Probe& probe);
  void add_path(const model::Probe& probe);
  void add_tilt(const model::Probe& probe);
  void add_twist(const model::Probe& probe);
  void add_forces();
  void add_torques_against_angle();
  void add_energies();
  void say_what_is_not_drawn();

 private:
  /// Of the kept rows about the middle of their orbit: neither sag nor drift is a vibration.
  struct Radii {
    std::vector<double> size;
    std::size_t largest = 0;  ///< row
  };
  /// Rows [from, to).
  struct Range {
    std::size_t from, to;
  };

  std::optional<std::size_t> find(const std::string& name) const;
  PlotBuffer::Points column(std::size_t channel, std::size_t component = 0,
                            double scale = 1.0) const;
  double largest_of(std::size_t channel, std::size_t components) const;
  static bool is_load(const std::string& name);
  double load_of(std::size_t channel) const;
  bool is_drawn(const std::string& name, double value, const plot::DisplayUnit& unit, double least);
  /// Place of a channel's first component in a kept row.
  std::size_t place(std::size_t channel) const { return 1 + start_[channel]; }
  /// How a shaft turns, at the kept rows; empty where the speeds are not recorded.
  struct Turning {
    std::string of;  ///< " of hp"; empty: the reference
    std::vector<double> rpm;
    std::vector<double> phi;  ///< rad
    bool speed_varies = false;
  };
  const Turning& turning_of(const model::Probe& probe);
  Turning read_turning(const std::string& shaft) const;
  Radii radii_of(std::size_t channel, const Turning& turning) const;
  std::vector<Vec2> middles_of_all(std::size_t channel) const;
  std::vector<Vec2> means_of_turns(std::size_t channel, const std::vector<double>& turned) const;
  static std::size_t turning_row(const Turning& turning);
  void add_amplitude(const std::string& probe, const Radii& radii, const Turning& turning,
                     const plot::DisplayUnit& unit);
  Range turns_about(std::size_t row, const Turning& turning) const;
  static double rows_a_turn(const Range& range, const Turning& turning);
  void add_orbit(const std::string& probe, std::size_t channel, std::size_t largest_row,
                 const Turning& turning, const plot::DisplayUnit& unit);
  void add_force(const Measurement& m, std::size_t channel);
  void add(const std::string& name, std::string title, std::vector<plot::Axes> axes,
           double height = 0) {
    section_.figures.push_back(figure(step_, name, std::move(title), std::move(axes), height));
  }

  const run::Job& job_;
  const model::Step& step_;
  const std::vector<Measurement>& all_;
  const std::vector<std::size_t>& start_;
  const PlotBuffer& buffer_;
  const PlotBuffer::Rows rows_;
  const plot::Amplitude convention_;
  const double unresolved_, size_;     ///< size_: of the machine, m
  double largest_load_ = 0;            ///< N; moments as forces at the machine's size
  std::vector<std::string> left_out_;  ///< "joint elbow moment (up to 0.2 mN.m)"
  io::ReportSection& section_;
  std::map<std::string, Turning> turnings_;  ///< by shaft
};

std::optional<std::size_t> HistoryFigures::find(const std::string& name) const {
  for (std::size_t i = 0; i < all_.size(); ++i)
    if (all_[i].name == name) return i;
  return std::nullopt;
}

PlotBuffer::Points HistoryFigures::column(std::size_t channel, std::size_t component,
                                          double scale) const {
  PlotBuffer::Points p = buffer_.channel(start_[channel] + component);
  for (double& y : p.y)
    y *= scale;
  return p;
}

double HistoryFigures::largest_of(std::size_t channel, std::size_t components) const {
  double size = 0.0;
  for (std::size_t c = 0; c < components; ++c)
    size = std::max(size, largest(column(channel, c).y));
  return size;
}

bool HistoryFigures::is_load(const std::string& name) {
  return name.ends_with(" force") || name.ends_with(" moment") || name.ends_with(" torque");
}

/// Largest of a load, N: that of a moment as a pair of forces as far apart as the machine is long.
double HistoryFigures::load_of(std::size_t channel) const {
  const double largest = largest_of(channel, all_[channel].width());
  return all_[channel].name.ends_with(" force") ? largest : largest / size_;
}

/// What is below the least is noted instead.
bool HistoryFigures::is_drawn(const std::string& name, double value, const plot::DisplayUnit& unit,
                              double least) {
  if (value > least) return true;
  if (value > 0)
    left_out_.push_back(
        fmt::format("{} (up to {} {})", name, readable(unit.factor * value, 2), unit.name));
  return false;
}

const HistoryFigures::Turning& HistoryFigures::turning_of(const model::Probe& probe) {
  const std::string shaft = own_shaft(job_, probe.at);
  const auto known = turnings_.find(shaft);
  return known != turnings_.end() ? known->second
                                  : turnings_.emplace(shaft, read_turning(shaft)).first->second;
}

HistoryFigures::Turning HistoryFigures::read_turning(const std::string& shaft) const {
  Turning t;
  const auto speed = find(shaft.empty() ? "speed" : "speed " + shaft);
  if (!speed || rows_.empty()) return t;
  if (!shaft.empty()) t.of = " of " + shaft;
  for (const auto& r : rows_)
    t.rpm.push_back(r[place(*speed)] * all_[*speed].scale);
  const auto [low, high] = std::minmax_element(t.rpm.begin(), t.rpm.end());
  t.speed_varies = *high - *low > 0.02 * std::max(1.0, largest(t.rpm));
  if (const auto phi = find("phi"); shaft.empty() && phi) {
    for (const auto& r : rows_)
      t.phi.push_back(r[place(*phi)]);
    return t;
  }
  t.phi.push_back(0.0);
  for (std::size_t r = 1; r < rows_.size(); ++r)  // by the trapezoidal rule
    t.phi.push_back(t.phi.back() + 0.5 * (rows_[r][0] - rows_[r - 1][0]) *
                                       (rows_[r][place(*speed)] + rows_[r - 1][place(*speed)]));
  return t;
}

void HistoryFigures::add_speed() {
  if (!find("speed")) return;
  std::vector<plot::Axes> axes{time_axes("spin", "rpm")};
  const bool several = std::any_of(all_.begin(), all_.end(), [](const Measurement& m) {
    return m.name.starts_with("speed ");
  });  // "speed" is one of them
  for (std::size_t i = 0; i < all_.size(); ++i)
    if (all_[i].name.starts_with("speed") && !(all_[i].name == "speed" && several))
      axes[0].series.push_back(series(all_[i].name, column(i, 0, all_[i].scale)));
  add("speed", "Spin", std::move(axes));
}

void HistoryFigures::add_displacement(const model::Probe& probe) {
  const auto channel = find(probe.name);
  if (!channel) return;
  const Measurement& m = all_[*channel];
  const double size = largest_of(*channel, m.width());
  if (!(size > 0.0)) return;  // a rotor that only twists has no picture of it
  const plot::DisplayUnit unit = plot::length_unit(size);
  std::vector<plot::Axes> axes;
  for (std::size_t c = 0; c < m.width(); ++c) {
    axes.push_back(time_axes("displacement " + m.components[c], unit.name));
    axes.back().series.push_back(series("", column(*channel, c), unit.factor));
  }
  add(probe.name + "_history", probe.name + ": displacement", std::move(axes));
  if (m.width() != 2) return;
  const Turning& turning = turning_of(probe);
  const Radii radii = radii_of(*channel, turning);
  const double radius = radii.size[radii.largest];
  if (!is_drawn("motion of " + probe.name, radius, plot::length_unit(radius), unresolved_ * size))
    return;
  if (turning.speed_varies) add_amplitude(probe.name, radii, turning, unit);
  add_orbit(probe.name, *channel, radii.largest, turning, unit);
}

HistoryFigures::Radii HistoryFigures::radii_of(std::size_t channel, const Turning& turning) const {
  std::vector<double> turned{0.0};  // through which angle up to each row, forward or backward
  for (std::size_t r = 1; r < turning.phi.size(); ++r)
    turned.push_back(turned.back() + std::abs(turning.phi[r] - turning.phi[r - 1]));
  const bool turns = turned.size() == rows_.size() && turned.back() >= 2.0 * two_pi;
  const std::vector<Vec2> centre =
      turns ? means_of_turns(channel, turned) : middles_of_all(channel);
  const std::size_t y = place(channel);
  Radii radii;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    radii.size.push_back((Vec2(rows_[r][y], rows_[r][y + 1]) - centre[r]).norm());
    if (radii.size[r] > radii.size[radii.largest]) radii.largest = r;
  }
  return radii;
}

/// The middle of what a shaft that hardly turns passes through, for every row.
std::vector<Vec2> HistoryFigures::middles_of_all(std::size_t channel) const {
  std::vector<Vec2> path;
  for (const auto& r : rows_)
    path.emplace_back(r[place(channel)], r[place(channel) + 1]);
  return std::vector<Vec2>(rows_.size(), middle_of(path));
}

/// Means of four turns about every row (at the ends those of the nearest four), or of sixteen rows where
/// those are more, under a Hann window in the angle turned, rad: what grows or fades once a turn leaves
/// less than a hundredth in them, where a plain mean of two turns keeps a tenth.
std::vector<Vec2> HistoryFigures::means_of_turns(std::size_t channel,
                                                 const std::vector<double>& turned) const {
  const std::size_t y = place(channel), n = rows_.size();
  std::vector<Vec2> path;
  for (const auto& r : rows_)
    path.emplace_back(r[y], r[y + 1]);
  const double common = std::min(2.0 * two_pi, 0.5 * turned.back());
  const HannMeans of_turns(turned, path, common);
  constexpr std::size_t few = 8;
  std::vector<Vec2> means;
  for (std::size_t r = 0; r < n; ++r) {
    const std::size_t from = r - std::min(r, few), to = std::min(n - 1, r + few);
    const double half = std::min(0.5 * (turned[to] - turned[from]), 0.5 * turned.back());
    std::optional<Vec2> mean;
    if (half <= common) {
      mean = of_turns.about(turned[r]);
    } else {
      const std::size_t first = from - std::min(from, few);
      const std::size_t count = std::min(n, to + few + 1) - first;
      const HannMeans of_rows(std::span<const double>(turned).subspan(first, count),
                              std::span<const Vec2>(path).subspan(first, count), half);
      mean = of_rows.about(turned[r]);
    }
    means.push_back(mean ? *mean
                         : middle_of(std::span<const Vec2>(path).subspan(from, to - from + 1)));
  }
  return means;
}

/// Up to it the speed rises: the last row where it stays up. @pre the speed is recorded.
std::size_t HistoryFigures::turning_row(const Turning& turning) {
  std::size_t top = 0;
  double last = infinity;  // the lowest after it
  for (std::size_t r = 0; r < turning.rpm.size(); ++r) {
    const double speed = std::abs(turning.rpm[r]);  // backwards too
    if (speed > std::abs(turning.rpm[top])) {
      top = r;
      last = speed;
    }
    last = std::min(last, speed);
  }
  const double highest = std::abs(turning.rpm[top]);
  const bool stays = highest - last < 1e-3 * highest;
  return stays ? turning.rpm.size() - 1 : top;
}

void HistoryFigures::add_amplitude(const std::string& probe, const Radii& radii,
                                   const Turning& turning, const plot::DisplayUnit& unit) {
  plot::Axes a;
  a.x = plot::Axis("spin" + turning.of, "rpm");
  a.y = plot::Axis(fmt::format("radius about the orbit's centre, {}", plot::to_string(convention_)),
                   unit.name);
  a.y.include_zero = true;
  // up and down apart: they differ by the beat of the passage
  const std::size_t top = turning_row(turning);
  plot::Series up, down;
  up.label = top + 1 < rows_.size() ? "speed rising" : "";
  down.label = "speed falling";
  up.style.width = down.style.width = 1.0;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    plot::Series& s = r <= top ? up : down;
    s.x.push_back(turning.rpm[r]);
    s.y.push_back(plot::factor_of(convention_) * unit.factor * radii.size[r]);
  }
  if (up.x.size() > 1 || down.x.empty()) a.series.push_back(std::move(up));
  if (!down.x.empty()) a.series.push_back(std::move(down));
  add(probe + "_amplitude", probe + ": orbit radius against spin" + turning.of, {std::move(a)});
}

/// Ten turns about a row when the spin is known and the run is long; else the whole path.
HistoryFigures::Range HistoryFigures::turns_about(std::size_t row, const Turning& turning) const {
  Range range{0, rows_.size()};
  if (turning.phi.empty() || !turning.speed_varies) return range;
  const auto near = [&](std::size_t r) {
    return std::abs(turning.phi[r] - turning.phi[row]) <= 5.0 * two_pi;
  };
  while (range.from < row && !near(range.from))
    ++range.from;
  range.to = row;
  while (range.to < rows_.size() && near(range.to))
    ++range.to;
  return range;
}

/// Many where the angle is not known.
double HistoryFigures::rows_a_turn(const Range& range, const Turning& turning) {
  if (turning.phi.empty() || range.to < range.from + 2) return infinity;
  const double turns = std::abs(turning.phi[range.to - 1] - turning.phi[range.from]) / two_pi;
  return turns > 0 ? static_cast<double>(range.to - range.from - 1) / turns : infinity;
}

void HistoryFigures::add_orbit(const std::string& probe, std::size_t channel,
                               std::size_t largest_row, const Turning& turning,
                               const plot::DisplayUnit& unit) {
  const Measurement& m = all_[channel];
  const std::size_t y = place(channel);
  plot::Axes a;
  a.x = plot::Axis(m.components[0], unit.name);
  a.y = plot::Axis(m.components[1], unit.name);
  a.equal_aspect = true;
  plot::Series s;
  s.style.width = 0.8;
  const Range range = turns_about(largest_row, turning);
  const double each_turn = rows_a_turn(range, turning);
  if (each_turn < 12) {  // straight lines between them would show a path that there is not
    s.style.width = 0;
    s.style.marker = plot::Marker::circle;
    s.style.marker_size = range.to - range.from < 200 ? 5 : 2;
  }
  for (std::size_t r = range.from; r < range.to; ++r) {
    s.x.push_back(unit.factor * rows_[r][y]);
    s.y.push_back(unit.factor * rows_[r][y + 1]);
  }
  a.series.push_back(std::move(s));
  const bool part = range.to - range.from < rows_.size();
  add(probe + "_turns",  // "_orbit" is that of the keyphasor
      probe + (part ? fmt::format(": orbit, ten turns about the largest radius ({:.0f} rpm)",
                                  turning.rpm[largest_row])
                    : ": orbit"),
      {std::move(a)}, 520);
  if (each_turn < 12)
    section_.figures.back().caption = fmt::format(
        "Rows of the history, {:.2g} a turn: too few to draw the path between them.", each_turn);
}

void HistoryFigures::add_path(const model::Probe& probe) {
  const auto channel = find(probe.name + " position");
  if (!channel) return;
  const std::size_t c = place(*channel);
  std::vector<double> x, y, z;
  for (const auto& r : rows_) {
    x.push_back(r[c]);
    y.push_back(r[c + 1]);
    z.push_back(r[c + 2]);
  }
  section_.figures.push_back(plot::plot_path_in_space(
      step_.name + "_" + probe.name + "_space", probe.name + ": trajectory in space", x, y, z));
  const plot::Curve path{"", y, z};
  section_.figures.push_back(plot::plot_path(step_.name + "_" + probe.name + "_yz",
                                             probe.name + ": trajectory in the yz plane", "y", "z",
                                             std::span(&path, 1)));
}

void HistoryFigures::add_tilt(const model::Probe& probe) {
  const auto gamma = find(probe.name + " gamma");
  if (!gamma) return;
  plot::Axes a = time_axes("transverse Euler vector", "rad");
  a.series.push_back(series("gamma_y", column(*gamma, 0)));
  a.series.push_back(series("gamma_z", column(*gamma, 1)));
  add(probe.name + "_gamma", probe.name + ": transverse Euler vector gamma", {std::move(a)});
}

void HistoryFigures::add_twist(const model::Probe& probe) {
  const auto angle = find(probe.name + " phi"), rate = find(probe.name + " omega_phi");
  if (!angle || !rate) return;
  PlotBuffer::Points phi = column(*angle), omega = column(*rate);
  const double omega0 = omega.y.front(), phi0 = phi.y.front(), t0 = phi.t.front();
  std::vector<plot::Axes> axes{time_axes("phi", "rad"), time_axes("phi - Omega0 t", "rad")};
  PlotBuffer::Points deviation = phi;
  for (std::size_t n = 0; n < phi.t.size(); ++n)
    deviation.y[n] -= phi0 + omega0 * (phi.t[n] - t0);
  axes[0].series.push_back(series("", std::move(phi)));
  axes[1].series.push_back(series("", std::move(deviation)));
  add(probe.name + "_phi",
      fmt::format("{}: axial angle and its deviation from {:.6g} rad/s x t", probe.name, omega0),
      std::move(axes));
  for (double& w : omega.y)
    w -= omega0;
  plot::Axes a = time_axes("omega_phi - Omega0", "rad/s");
  a.series.push_back(series("", std::move(omega)));
  add(probe.name + "_omega_phi",
      fmt::format("{}: rate of the axial angle less {:.6g} rad/s", probe.name, omega0),
      {std::move(a)});
}

void HistoryFigures::add_forces() {
  for (std::size_t i = 0; i < all_.size(); ++i)
    for (const char* what : {" force", " torque", " moment"})
      if (all_[i].name.ends_with(what)) add_force(all_[i], i);
}

void HistoryFigures::add_force(const Measurement& m, std::size_t channel) {
  const double size = largest_of(channel, m.width());
  if (size == 0.0) return;  // a guide that nothing loads: the CSV says so
  const bool moment = m.name.ends_with(" moment");
  const plot::DisplayUnit unit = plot::unit_for(m.unit, size);
  const double per_newton = size / load_of(channel);
  if (!m.name.ends_with(" torque") &&
      !is_drawn(m.name, size, unit, per_newton * unresolved_ * largest_load_))
    return;
  plot::Axes a = time_axes(m.name.ends_with(" force")          ? "force on the shaft"
                           : moment                            ? "moment on the shaft (x: torque)"
                           : m.name.ends_with(" shaft torque") ? "torque in the shaft"
                                                               : "torque on the shaft",
                           unit.name);
  for (std::size_t c = 0; c < m.width(); ++c) {
    const bool absent =
        m.width() == 3 && (c == 0 || moment) && largest(column(channel, c).y) == 0.0;
    if (!absent)
      a.series.push_back(
          series(m.components.empty() ? "" : m.components[c], column(channel, c), unit.factor));
  }
  add(m.name, m.name, {std::move(a)});
}

/// Torques of drives and in shafts, and those that supports between shafts pass on.
void HistoryFigures::add_torques_against_angle() {
  const auto angle = find("phi");
  if (!angle) return;
  struct Shown {
    std::size_t channel, component;
  };
  std::vector<Shown> shown;
  double size = 0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const bool torque = all_[i].name.ends_with(" torque"),
               moment = all_[i].name.ends_with(" moment");
    if ((!torque && !moment) || !(largest(column(i).y) > 0)) continue;
    size = std::max(size, largest(column(i).y));
    shown.push_back({i, 0});  // of a moment the part about the axis
  }
  if (shown.empty()) return;
  const plot::DisplayUnit unit = plot::unit_for("N.m", size);
  plot::Axes a;
  a.x = plot::Axis("angle of the reference shaft", "turns");
  a.y = plot::Axis("torque", unit.name);
  for (const Shown& x : shown) {
    PlotBuffer::Points p = column(x.channel, x.component);
    std::vector<double> turns = buffer_.values_at(start_[*angle], p.t);
    for (double& t : turns)
      t /= two_pi;
    p.t = std::move(turns);
    a.series.push_back(series(all_[x.channel].name, std::move(p), unit.factor));
  }
  add("torque_angle", "Recorded torques against the angle of the machine", {std::move(a)});
}

void HistoryFigures::say_what_is_not_drawn() {
  if (left_out_.empty()) return;
  section_.text += fmt::format(
      "\n\nNot drawn: {}. The step resolves nothing below {} of the largest of its kind (of a "
      "motion: its displacement; of a moment: the largest force times the size of the machine).",
      fmt::join(left_out_, ", "), readable(unresolved_, 2));
}

void HistoryFigures::add_energies() {
  const auto energy = find("energy");
  if (!energy) return;
  const plot::DisplayUnit unit = plot::unit_for("J", largest_of(*energy, 3));
  plot::Axes a = time_axes("energy", unit.name);
  for (std::size_t c = 0; c < 3; ++c)
    a.series.push_back(series(all_[*energy].components[c], column(*energy, c), unit.factor));
  // the sum, from whole rows: extremes of the parts do not add up
  plot::Series sum;
  sum.label = "sum";
  sum.style.width = 1.1;
  sum.style.dash = plot::Dash::dashed;
  const std::size_t e = place(*energy);
  for (const auto& r : rows_) {
    sum.x.push_back(r[0]);
    sum.y.push_back(unit.factor * (r[e] + r[e + 1] + r[e + 2]));
  }
  a.series.push_back(std::move(sum));
  add("energy", "Energies", {std::move(a)});
}

}  // namespace

void add_history_figures(const run::Job& job, const model::Step& step, const Channels& channels,
                         const PlotBuffer& buffer, double unresolved, io::ReportSection& section) {
  if (buffer.rows() < 2) return;
  HistoryFigures figures(job, step, channels, buffer, unresolved, section);
  figures.add_speed();
  for (const model::Probe& probe : job.model.probes) {
    figures.add_displacement(probe);
    figures.add_path(probe);
    figures.add_tilt(probe);
    figures.add_twist(probe);
  }
  figures.add_forces();
  figures.add_torques_against_angle();
  figures.add_energies();
  figures.say_what_is_not_drawn();
}

}  // namespace whirl::results
