// General beams along any line: nodes on the line, triads from its tangent and a normal, one chart
// for all.
#pragma once
#include <analysis/statics/equilibrium.hpp>
#include <core/rotation.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <system/problem.hpp>
#include <functional>
#include <string>

namespace whirl::test {

/// Stiffness of a section about its own axes (B, C): EI_B bends about B (deflection along C).
struct BeamSection {
  double EA = 0, kGA_B = 0, kGA_C = 0, GJ = 0, EI_B = 0, EI_C = 0;  // kGA 0: no shear deformation
  double rhoA = 0, rhoI_B = 0, rhoI_C = 0;  // rho int c^2 dA about B, rho int b^2 dA about C
};

inline elements::GeneralBeamConstants general_constants(const BeamSection& s, double l) {
  const auto plane = [&](double EI, double kGA) {
    elements::ElementSection e;
    e.constants = true;
    e.given = {s.EA, kGA, s.GJ, EI, s.rhoA, std::min(s.rhoI_B, s.rhoI_C), 0};
    return elements::make_shaft_constants(e, l);
  };
  const auto y = plane(s.EI_C, s.kGA_B), z = plane(s.EI_B, s.kGA_C);
  elements::GeneralBeamConstants c;
  c.length = l;
  c.EA_l = y.EA_l;
  c.GJ_l = y.GJ_l;
  c.ky_def11 = y.k11;
  c.ky_def12 = y.k12;
  c.ky_def22 = y.k22;
  c.kz_def11 = z.k11;
  c.kz_def12 = z.k12;
  c.kz_def22 = z.k22;
  c.b11 = 0.5 * (y.b11 + z.b11);
  c.b12 = 0.5 * (y.b12 + z.b12);
  c.b22 = 0.5 * (y.b22 + z.b22);
  c.M4 = 0.5 * (y.M4 + z.M4);
  const auto& stiffer = s.rhoI_C > s.rhoI_B ? y : z;
  c.triads = {l * Vec3(s.rhoI_B + s.rhoI_C, s.rhoI_B, s.rhoI_C).asDiagonal().toDenseMatrix(),
              elements::shear_share(stiffer.k11, stiffer.k12, stiffer.k22)};
  return c;
}

/// Point and triad (tangent, B, C) of a line at arc length s.
struct LinePoint {
  Vec3 r;
  Mat3 triad;
};

/// Beam of n elements from s0 to s1 on nodes that exist already (first) or are added; returns the
/// last node.
inline Index add_beam(system::Builder& b, Index line, const Mat3& chart,
                      const std::function<LinePoint(double)>& at, double s0, double s1, int n,
                      const BeamSection& section, Index first = -1) {
  if (first < 0) first = b.add_node({at(s0).r, line, "node at the start", false});
  const auto c = general_constants(section, (s1 - s0) / n);
  for (int i = 0; i < n; ++i) {
    const LinePoint p = at(s0 + (s1 - s0) * i / n), q = at(s0 + (s1 - s0) * (i + 1) / n);
    const Index next = b.add_node({q.r, line, "node " + std::to_string(i + 1), false});
    b.add(elements::GeneralBeam(c, q.r - p.r, p.triad, q.triad, Vec3::Zero(), Vec3::Zero(), chart,
                                chart),
          {first, next}, "general beam elements");
    first = next;
  }
  return first;
}

inline void clamp(system::Builder& b, Index node) {
  for (int k = 0; k < 6; ++k)
    b.hold(node, k);
}

/// Static equilibrium with nothing spinning.
inline system::State settle(const system::System& s, int load_steps = 1,
                            const system::State* start = nullptr, double load = 1.0) {
  analysis::SteadyRotation still;
  still.ratio.assign(static_cast<std::size_t>(s.lines()), 0.0);
  analysis::SteadySystem running(s, still);
  running.set_load(load);
  analysis::EquilibriumOptions o;
  o.load_steps = load_steps;
  return analysis::EquilibriumSolver(running, o).solve(0.0, start).state;
}

inline Vec3 displacement(const system::State& s, Index n) { return s.q.segment<3>(6 * n); }

/// Rotation of a node against the reference configuration, from its angles in the present chart.
/// `chart0`: the chart at rest.
inline Mat3 rotation_of(const system::State& s, Index n, Index line, const Mat3& chart0) {
  const Mat3& T = s.frames.axes(n);
  const double phi = s.q[6 * n + 3] + two_pi * s.frames.turns[static_cast<std::size_t>(line)];
  const Vec2 g = s.q.segment<2>(6 * n + 4);
  return T * rotation::L(Vec3(0, g[0], g[1])) * rotation::L(Vec3(phi, 0, 0)) * chart0.transpose();
}

}  // namespace whirl::test
