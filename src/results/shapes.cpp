// Mode shapes and operating shapes as figures and as frames for ParaView.
#include <results/frequency.hpp>

#include <core/rotation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

/// Change of the director of a node, global axes.
Eigen::Vector3cd tilt_of(const analysis::Linearizer& linear, const VecXc& a, Index node) {
  const system::State& s = linear.equilibrium().state;
  rotation::Director d;
  rotation::director(s.q.segment<2>(6 * node + 4), d);
  return s.frames.axes(node) * (d.D * a.segment<2>(6 * node + 4));
}

struct Station {
  double s;
  Eigen::Vector3cd u, t;
};

/// Displacement and tilt at the stations of a line, axes of the line.
std::vector<Station> stations_of(const FrequencyStep& step, const VecXc& a, std::size_t l) {
  const meshes::Mesh& mesh = step.job.mesh;
  const meshes::Line& line = mesh.lines[l];
  const Mat3 axes = step.linear.equilibrium().state.frames.chart[l].transpose();
  std::vector<Station> out;
  for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
    const meshes::Station& st = mesh.stations[at(k)];
    const Eigen::Vector3cd t = tilt_of(step.linear, a, st.at.node);
    out.push_back({st.s, axes * (a.segment<3>(6 * st.at.node) + st.at.offset * t), axes * t});
  }
  return out;
}

/// Names of disks and bearings on a line.
std::vector<std::pair<std::string, double>> names_on(const run::Job& job, std::size_t l) {
  std::vector<std::pair<std::string, double>> out;
  for (const model::Disk& d : job.model.disks)
    if (d.at.shaft == l) out.emplace_back(d.name, d.at.s);
  for (const model::Bearing& b : job.model.bearings) {
    if (b.at.shaft == l) out.emplace_back(b.name, b.at.s);
    if (b.to && b.to->shaft == l) out.emplace_back(b.name, b.to->s);
  }
  return out;
}

plot::Figure along_figure(const FrequencyStep& s, const ShapeDrawing& d) {
  const int c = d.kind == analysis::ModeKind::torsional ? 3 : 0;
  plot::Axes axes;
  axes.x = plot::Axis("axial position", "m");
  axes.y = plot::Axis(c == 3 ? "twist, largest = 1" : "axial motion, largest = 1", "-");
  axes.y.include_zero = true;
  double largest = 0;
  Complex top = 1;
  for (Index n = 0; n < s.linear.system().nodes(); ++n)
    if (const Complex x = (*d.a)[6 * n + c];
        !s.linear.system().node(n).scalar && std::abs(x) > largest) {
      largest = std::abs(x);
      top = x;
    }
  for (std::size_t l = 0; l < s.job.mesh.lines.size(); ++l) {
    const meshes::Line& line = s.job.mesh.lines[l];
    plot::Series y;
    y.label = s.job.mesh.lines.size() > 1 ? line.name : "";
    y.style.marker = plot::Marker::circle;
    y.style.marker_size = 4;
    y.keep_all = true;
    for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
      const meshes::Station& st = s.job.mesh.stations[at(k)];
      y.x.push_back(st.position.x());
      y.y.push_back(((*d.a)[6 * st.at.node + c] / top).real());
    }
    axes.series.push_back(std::move(y));
  }
  plot::Figure f;
  f.name = s.file(d.name);
  f.title = d.title;
  f.caption = d.caption;
  f.height = 300;
  f.axes.push_back(std::move(axes));
  return f;
}

}  // namespace

void add_shape_figures(FrequencyStep& s, const ShapeDrawing& d) {
  if (!s.job.model.output.report) return;
  if (d.kind != analysis::ModeKind::lateral) {
    s.add_figure(along_figure(s, d));
    return;
  }
  const std::size_t lines = s.job.mesh.lines.size();
  std::vector<std::vector<Station>> stations;
  std::vector<double> size(lines, 0.0);
  for (std::size_t l = 0; l < lines; ++l) {
    stations.push_back(stations_of(s, *d.a, l));
    for (const Station& x : stations.back())
      size[l] = std::max({size[l], std::abs(x.u[1]), std::abs(x.u[2])});
  }
  const double largest = *std::max_element(size.begin(), size.end());
  for (std::size_t l = 0; l < lines; ++l) {
    if (!(size[l] > 1e-3 * largest)) continue;
    plot::ModeShape m;
    m.stations = names_on(s.job, l);
    const std::vector<Station>& st = stations[l];
    for (std::size_t k = 0; k < st.size(); ++k) {
      // between stations the cubic with the tilts as end slopes: a few elements bend like many
      constexpr int parts = 6;
      const double h = k + 1 < st.size() ? st[k + 1].s - st[k].s : 0.0;
      for (int i = 0; i < (h > 0 ? parts : 1); ++i) {
        const double x = static_cast<double>(i) / parts, x2 = x * x, x3 = x2 * x;
        const auto value = [&](int c) -> Complex {
          if (i == 0) return st[k].u[c];
          return (1 - 3 * x2 + 2 * x3) * st[k].u[c] + (x - 2 * x2 + x3) * h * st[k].t[c] +
                 (3 * x2 - 2 * x3) * st[k + 1].u[c] + (x3 - x2) * h * st[k + 1].t[c];
        };
        m.s.push_back(st[k].s + x * h);
        m.y.push_back(value(1));
        m.z.push_back(value(2));
      }
    }
    const std::string of = lines > 1 ? fmt::format(" of {}", s.job.mesh.lines[l].name) : "";
    plot::Figure f = plot::plot_mode_shape(
        s.file(d.name + (lines > 1 ? "_" + s.job.mesh.lines[l].name : "")), d.title + of, m);
    f.caption = d.caption;
    s.add_figure(std::move(f));
  }
}

void write_shape_frames(FrequencyStep& s, const std::string& name, const VecXc& a,
                        double amplitude) {
  const model::Output& out = s.job.model.output;
  for (const model::VtkOutput& v : out.vtk) {
    if (!v.step.empty() && v.step != s.step.name) continue;
    io::VtkFrameOptions options;
    options.directory = s.job.folder.subfolder("vtk");
    options.name = s.file(name);
    io::set_content(options, v.content);
    options.deformation_scale = 1.0;  // in the amplitude
    options.points_around = v.points_around;
    const Index nodes = static_cast<Index>(s.job.mesh.nodes.size());
    io::HarmonicShape shape;
    double largest = 0, length = 0;
    for (Index n = 0; n < nodes; ++n) {
      shape.u.push_back(a.segment<3>(6 * n));
      shape.tilt.push_back(tilt_of(s.linear, a, n));
      shape.phi.push_back(a[6 * n + 3]);
      largest = std::max(largest, shape.u.back().cwiseAbs().maxCoeff());
    }
    double twist = 0;
    for (const Complex& p : shape.phi)
      twist = std::max(twist, std::abs(p));
    for (const meshes::Line& l : s.job.mesh.lines)
      length = std::max(length, l.length);
    double factor = amplitude;
    if (factor == 0)
      factor = largest * 0.5 > twist * 0.05 * length ? 0.05 * length / largest
               : twist > 0                           ? 0.5 / twist
                                                     : 0.0;  // a torsional mode: half a radian
    const auto writer = io::make_vtk_frames(options);
    io::write_harmonic(*writer, s.job.scene, shape, factor * v.deformation_scale, 24);
  }
}

}  // namespace whirl::results
