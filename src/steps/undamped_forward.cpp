#include <steps/undamped_forward.hpp>

#include <core/rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::steps {

std::vector<analysis::Critical> undamped_forward(analysis::Linearizer& linear, double max_speed,
                                                 double order) {
  analysis::CriticalOptions o;
  o.max_speed = max_speed;
  o.order = order;
  o.motion = analysis::Motion::lateral;
  std::vector<analysis::Critical> found = analysis::critical_speeds(linear, o);
  std::erase_if(found, [](const analysis::Critical& c) {
    return c.mode.kind != analysis::ModeKind::lateral;
  });
  // without gyroscopic effect both directions have one speed, and any two shapes of it: one counts
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); };
  std::vector<analysis::Critical> out;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const bool before = k > 0 && same(found[k - 1].speed, found[k].speed);
    const bool after = k + 1 < found.size() && same(found[k + 1].speed, found[k].speed);
    const bool forward = found[k].mode.forwardness > 0;
    if (before || after ? !before : forward) out.push_back(found[k]);
  }
  return out;
}

bool moves(const meshes::Mesh& mesh, const system::System& system, const VecXc& shape,
           std::size_t line, double share) {
  double here = 0, largest = 0;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const meshes::Line& of = mesh.lines[l];
    for (Index k = of.first_station; k < of.first_station + of.stations; ++k) {
      const meshes::Place& at = mesh.stations[static_cast<std::size_t>(k)].at;
      if (at.node < 0 || at.offset == 0.0) continue;
      // gamma (y, z) is the tilt of the axis where it is small
      const Eigen::Vector2cd u =
          shape.segment<2>(6 * at.node + 1) + at.offset * shape.segment<2>(6 * at.node + 4);
      largest = std::max(largest, u.norm());
      if (l == line) here = std::max(here, u.norm());
    }
  }
  for (Index i = 0; i < system.nodes(); ++i) {
    if (system.node(i).scalar) continue;
    const double u = shape.segment<2>(6 * i + 1).norm();
    largest = std::max(largest, u);
    if (system.node(i).line == static_cast<Index>(line)) here = std::max(here, u);
  }
  return here > share * largest;
}

void keep_modes_of(const meshes::Mesh& mesh, const system::System& system, std::size_t line,
                   std::vector<analysis::Critical>& modes) {
  constexpr double with_it = 0.01;
  std::erase_if(modes, [&](const analysis::Critical& c) {
    return !moves(mesh, system, c.mode.x, line, with_it);
  });
}

double RealShape::at(double place) const {
  const auto after = std::lower_bound(s.begin(), s.end(), place);
  if (after == s.begin()) return u.front();
  if (after == s.end()) return u.back();
  const auto k = static_cast<std::size_t>(after - s.begin());
  if (s[k] == s[k - 1]) return u[k];
  return u[k - 1] + (u[k] - u[k - 1]) * (place - s[k - 1]) / (s[k] - s[k - 1]);
}

RealShape shape_along(const results::FrequencyStep& s, const VecXc& x, std::size_t l) {
  const meshes::Mesh& mesh = s.job.mesh;
  const meshes::Line& line = mesh.lines[l];
  RealShape out;
  std::array<std::vector<Complex>, 2> u;  // along both directions: a plane shape may lie in either
  const auto tilt = [&](Index n) {
    rotation::Director d;
    const system::State& state = s.linear.equilibrium().state;
    rotation::director(state.q.segment<2>(6 * n + 4), d);
    return Eigen::Vector3cd(d.D * x.segment<2>(6 * n + 4));
  };
  const auto value = [&](const meshes::Station& st) {
    const Eigen::Vector3cd t = tilt(st.at.node);
    const Eigen::Vector3cd at = analysis::local_displacement(s.linear, x, st.at.node);
    return std::pair<Eigen::Vector2cd, Eigen::Vector2cd>(at.tail<2>() + st.at.offset * t.tail<2>(),
                                                         t.tail<2>());
  };
  for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
    const meshes::Station& st = mesh.stations[static_cast<std::size_t>(k)];
    const auto [y, slope] = value(st);
    if (!out.s.empty() && st.s > out.s.back()) {
      const meshes::Station& before = mesh.stations[static_cast<std::size_t>(k - 1)];
      const auto [y0, slope0] = value(before);
      const double h = st.s - before.s;
      constexpr int parts = 8;
      for (int i = 1; i < parts; ++i) {
        const double a = static_cast<double>(i) / parts, a2 = a * a, a3 = a2 * a;
        out.s.push_back(before.s + a * h);
        for (Index c = 0; c < 2; ++c)
          u[static_cast<std::size_t>(c)].push_back(
              (1 - 3 * a2 + 2 * a3) * y0[c] + (a - 2 * a2 + a3) * h * slope0[c] +
              (3 * a2 - 2 * a3) * y[c] + (a3 - a2) * h * slope[c]);
      }
    }
    out.s.push_back(st.s);
    u[0].push_back(y[0]);
    u[1].push_back(y[1]);
  }
  const auto smaller = [](const Complex& p, const Complex& q) { return std::abs(p) < std::abs(q); };
  const auto top_y = std::max_element(u[0].begin(), u[0].end(), smaller),
             top_z = std::max_element(u[1].begin(), u[1].end(), smaller);
  const bool along_z = std::abs(*top_z) > std::abs(*top_y) * (1 + 1e-9);
  const Complex top = along_z ? *top_z : *top_y;
  for (const Complex& x_of : u[along_z ? 1 : 0])
    out.u.push_back((x_of / top).real());
  return out;
}

}  // namespace whirl::steps
