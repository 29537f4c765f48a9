// Figures of a transient's time histories.
#include <run/job.hpp>
#include <results/plot_buffer.hpp>
#include <results/history_figures.hpp>
#include <plot/plots.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace whirl::results {

namespace {

using analysis::Measurement;

bool ends_with(const std::string& s, std::string_view tail) {
  return s.size() >= tail.size() && s.compare(s.size() - tail.size(), tail.size(), tail) == 0;
}

struct Source {
  const std::vector<Measurement>& all;
  const std::vector<std::size_t>& start;
  const PlotBuffer& buffer;
  std::ptrdiff_t find(const std::string& name) const {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) return static_cast<std::ptrdiff_t>(i);
    return -1;
  }
  PlotBuffer::Points column(std::size_t i, std::size_t component = 0, double scale = 1.0) const {
    PlotBuffer::Points p = buffer.channel(start[i] + component);
    for (double& y : p.y)
      y *= scale;
    return p;
  }
};

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

}  // namespace

void add_history_figures(const run::Job& job, const model::Step& step,
                         const std::vector<Measurement>& all, const std::vector<std::size_t>& start,
                         const PlotBuffer& buffer, io::ReportSection& section) {
  if (buffer.rows() < 2) return;
  const Source src{all, start, buffer};
  const bool peak_to_peak = job.model.output.peak_to_peak;
  const char* convention =
      plot::to_string(peak_to_peak ? plot::Amplitude::peak_to_peak : plot::Amplitude::zero_to_peak);
  const double factor = peak_to_peak ? 2.0 : 1.0;
  auto add = [&](plot::Figure f) { section.figures.push_back(std::move(f)); };

  const std::ptrdiff_t speed = src.find("speed");
  std::vector<double> rpm;  // of the kept rows
  const auto& rows = buffer.kept_rows();
  if (speed >= 0) {
    const double scale = all[static_cast<std::size_t>(speed)].scale;
    for (const auto& r : rows)
      rpm.push_back(r[1 + start[static_cast<std::size_t>(speed)]] * scale);
    std::vector<plot::Axes> axes{time_axes("spin", "rpm")};
    const bool several = std::any_of(all.begin(), all.end(), [](const Measurement& m) {
      return m.name.rfind("speed ", 0) == 0;
    });  // "speed" is one of them
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name.rfind("speed", 0) == 0 && !(all[i].name == "speed" && several))
        axes[0].series.push_back(series(all[i].name, src.column(i, 0, all[i].scale)));
    add(figure(step, "speed", "Spin", std::move(axes)));
  }
  const bool speed_varies = !rpm.empty() && *std::max_element(rpm.begin(), rpm.end()) -
                                                    *std::min_element(rpm.begin(), rpm.end()) >
                                                0.02 * std::max(1.0, largest(rpm));

  for (const model::Probe& probe : job.model.probes) {
    const std::ptrdiff_t i = src.find(probe.name);
    double size = 0.0;
    if (i >= 0)
      for (std::size_t c = 0; c < all[static_cast<std::size_t>(i)].width(); ++c)
        size = std::max(size, largest(src.column(static_cast<std::size_t>(i), c).y));
    if (size > 0.0) {  // a rotor that only twists has no picture of it
      const auto k = static_cast<std::size_t>(i);
      const Measurement& m = all[k];
      const plot::DisplayUnit unit = plot::length_unit(size);
      std::vector<plot::Axes> axes;
      for (std::size_t c = 0; c < m.width(); ++c) {
        axes.push_back(time_axes("displacement " + m.components[c], unit.name));
        axes.back().series.push_back(series("", src.column(k, c), unit.factor));
      }
      add(figure(step, probe.name + "_history", probe.name + ": displacement", std::move(axes)));
      if (m.width() == 2) {
        const std::size_t y = 1 + start[k];
        // about the place at the start: the static sag is not a vibration
        const double y0 = rows.front()[y], z0 = rows.front()[y + 1];
        std::size_t largest_row = 0;
        std::vector<double> radius(rows.size());
        for (std::size_t r = 0; r < rows.size(); ++r) {
          radius[r] = std::hypot(rows[r][y] - y0, rows[r][y + 1] - z0);
          if (radius[r] > radius[largest_row]) largest_row = r;
        }
        if (speed_varies) {
          plot::Axes a;
          a.x = plot::Axis("spin", "rpm");
          a.y = plot::Axis(fmt::format("orbit radius about the place at the start, {}", convention),
                           unit.name);
          a.y.include_zero = true;
          // up and down apart: they differ by the beat of the passage
          std::size_t top =
              static_cast<std::size_t>(std::max_element(rpm.begin(), rpm.end()) - rpm.begin());
          if (rpm[top] -
                  *std::min_element(rpm.begin() + static_cast<std::ptrdiff_t>(top), rpm.end()) <
              1e-3 * rpm[top])
            top = rpm.size() - 1;  // it stays up
          plot::Series up, down;
          up.label = top + 1 < rows.size() ? "speed rising" : "";
          down.label = "speed falling";
          up.style.width = down.style.width = 1.0;
          for (std::size_t r = 0; r < rows.size(); ++r) {
            plot::Series& s = r <= top ? up : down;
            s.x.push_back(rpm[r]);
            s.y.push_back(factor * unit.factor * radius[r]);
          }
          a.series.push_back(std::move(up));
          if (!down.x.empty()) a.series.push_back(std::move(down));
          add(figure(step, probe.name + "_amplitude", probe.name + ": orbit radius against spin",
                     {std::move(a)}));
        }
        plot::Axes a;
        a.x = plot::Axis(m.components[0], unit.name);
        a.y = plot::Axis(m.components[1], unit.name);
        a.equal_aspect = true;
        plot::Series s;
        s.style.width = 0.8;
        // ten turns about the largest radius when the spin is known and the run is long; else the
        // whole path
        const std::ptrdiff_t turn = src.find("phi");
        std::size_t from = 0, to = rows.size();
        if (turn >= 0 && speed_varies) {
          const std::size_t p = 1 + start[static_cast<std::size_t>(turn)];
          const double phi = rows[largest_row][p];
          while (from < largest_row && std::abs(rows[from][p] - phi) > 5.0 * two_pi)
            ++from;
          for (to = largest_row; to < rows.size() && std::abs(rows[to][p] - phi) <= 5.0 * two_pi;)
            ++to;
        }
        for (std::size_t r = from; r < to; ++r) {
          s.x.push_back(unit.factor * rows[r][y]);
          s.y.push_back(unit.factor * rows[r][y + 1]);
        }
        const bool part = to - from < rows.size();
        a.series.push_back(std::move(s));
        add(figure(
            step, probe.name + "_orbit",
            probe.name +
                (part ? fmt::format(": orbit, ten turns about the largest radius ({:.0f} rpm)",
                                    rpm[largest_row])
                      : ": orbit"),
            {std::move(a)}, 520));
      }
    }
    if (const std::ptrdiff_t j = src.find(probe.name + " position"); j >= 0) {
      const std::size_t c = 1 + start[static_cast<std::size_t>(j)];
      std::vector<double> x, y, z;
      for (const auto& r : rows) {
        x.push_back(r[c]);
        y.push_back(r[c + 1]);
        z.push_back(r[c + 2]);
      }
      add(plot::plot_path_in_space(step.name + "_" + probe.name + "_space",
                                   probe.name + ": trajectory in space", x, y, z));
      const plot::Curve path{"", y, z};
      add(plot::plot_path(step.name + "_" + probe.name + "_yz",
                          probe.name + ": trajectory in the yz plane", "y", "z",
                          std::span(&path, 1)));
    }
    if (const std::ptrdiff_t j = src.find(probe.name + " gamma"); j >= 0) {
      const auto g = static_cast<std::size_t>(j);
      plot::Axes a = time_axes("transverse Euler vector", "rad");
      a.series.push_back(series("gamma_y", src.column(g, 0)));
      a.series.push_back(series("gamma_z", src.column(g, 1)));
      add(figure(step, probe.name + "_gamma", probe.name + ": transverse Euler vector gamma",
                 {std::move(a)}));
    }
    const std::ptrdiff_t jp = src.find(probe.name + " phi"),
                         jw = src.find(probe.name + " omega_phi");
    if (jp >= 0 && jw >= 0) {
      PlotBuffer::Points phi = src.column(static_cast<std::size_t>(jp)),
                         omega = src.column(static_cast<std::size_t>(jw));
      const double omega0 = omega.y.front(), phi0 = phi.y.front(), t0 = phi.t.front();
      std::vector<plot::Axes> axes{time_axes("phi", "rad"), time_axes("phi - Omega0 t", "rad")};
      PlotBuffer::Points deviation = phi;
      for (std::size_t n = 0; n < phi.t.size(); ++n)
        deviation.y[n] -= phi0 + omega0 * (phi.t[n] - t0);
      axes[0].series.push_back(series("", std::move(phi)));
      axes[1].series.push_back(series("", std::move(deviation)));
      add(figure(step, probe.name + "_phi",
                 fmt::format("{}: axial angle and its deviation from {:.6g} rad/s x t", probe.name,
                             omega0),
                 std::move(axes)));
      for (double& w : omega.y)
        w -= omega0;
      plot::Axes a = time_axes("omega_phi - Omega0", "rad/s");
      a.series.push_back(series("", std::move(omega)));
      add(figure(step, probe.name + "_omega_phi",
                 fmt::format("{}: rate of the axial angle less {:.6g} rad/s", probe.name, omega0),
                 {std::move(a)}));
    }
  }

  for (std::size_t i = 0; i < all.size(); ++i) {
    const Measurement& m = all[i];
    if (!ends_with(m.name, " force") && !ends_with(m.name, " torque") &&
        !ends_with(m.name, " moment"))
      continue;
    double size = 0.0;
    for (std::size_t c = 0; c < m.width(); ++c)
      size = std::max(size, largest(src.column(i, c).y));
    if (size == 0.0) continue;  // a guide that nothing loads: the CSV says so
    const plot::DisplayUnit unit = plot::unit_for(m.unit, size);
    plot::Axes a = time_axes(ends_with(m.name, " force")    ? "force on the shaft"
                             : ends_with(m.name, " moment") ? "moment on the shaft (x: torque)"
                                                            : "torque on the shaft",
                             unit.name);
    for (std::size_t c = 0; c < m.width(); ++c) {
      const bool absent = m.width() == 3 && (c == 0 || ends_with(m.name, " moment")) &&
                          largest(src.column(i, c).y) == 0.0;
      if (!absent)
        a.series.push_back(
            series(m.components.empty() ? "" : m.components[c], src.column(i, c), unit.factor));
    }
    add(figure(step, m.name, m.name, {std::move(a)}));
  }

  if (const std::ptrdiff_t e = src.find("energy"); e >= 0) {
    const auto i = static_cast<std::size_t>(e);
    double size = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      size = std::max(size, largest(src.column(i, c).y));
    const plot::DisplayUnit unit = plot::unit_for("J", size);
    plot::Axes a = time_axes("energy", unit.name);
    for (std::size_t c = 0; c < 3; ++c)
      a.series.push_back(series(all[i].components[c], src.column(i, c), unit.factor));
    // the sum, from whole rows: extremes of the parts do not add up
    plot::Series sum;
    sum.label = "sum";
    sum.style.width = 1.1;
    sum.style.dash = plot::Dash::dashed;
    for (const auto& r : rows) {
      sum.x.push_back(r[0]);
      sum.y.push_back(unit.factor * (r[1 + start[i]] + r[2 + start[i]] + r[3 + start[i]]));
    }
    a.series.push_back(std::move(sum));
    add(figure(step, "energy", "Energies", {std::move(a)}));
  }
}

}  // namespace whirl::results
