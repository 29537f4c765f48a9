#include <elements/between_shafts/gear_mesh.hpp>

#include <core/error.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::NodeState;
using system::TangentX;

namespace {

[[noreturn]] void fail(const char* what) {
  throw run_error("E86", std::string("gear mesh: ") + what);
}

/// Angle in radians without whole turns of the mesh phase.
double phase(double z, const NodeState& n) { return z * n.phi; }

struct Mesh {
  double delta, rate;  // with the transmission error
  double k, k1, k2;    // stiffness and derivatives in theta
  double e1, e2;       // derivatives of the error
  double dtheta;
  Mesh(const GearMesh& g, const Nodes<2>& x, bool averaged = false) {
    const NodeState &n = *x[0], &o = *x[1];
    // Whole turns drop out of theta (an integer number of teeth) and stay in delta as an integer
    // number of teeth.
    const double teeth = g.z1 * n.turns + g.z2 * o.turns;
    delta = g.rotation * (phase(g.z1, n) + phase(g.z2, o) + two_pi * teeth);
    rate = g.rotation * (g.z1 * n.dphi + g.z2 * o.dphi);
    for (int i = 0; i < 2; ++i) {
      const NodeState& m = i == 0 ? n : o;
      const auto bu = g.b.segment<3>(7 * i), bd = g.b.segment<3>(7 * i + 3);
      delta += bu.dot(m.u) + bd.dot(m.t + m.e() - Vec3::UnitX());
      rate += bu.dot(m.du) + bd.dot(m.dd);
    }
    const double theta = g.z1 * n.phi;
    dtheta = g.z1 * n.dphi;
    k = g.k0;
    k1 = k2 = e1 = e2 = 0.0;
    for (int h = 0; h < g.harmonics && !averaged; ++h) {
      const double w = h + 1;
      const auto &a = g.stiffness[static_cast<std::size_t>(h)],
                 &e = g.error[static_cast<std::size_t>(h)];
      const double ca = std::cos(w * theta + a.phase), sa = std::sin(w * theta + a.phase),
                   ce = std::cos(w * theta + e.phase), se = std::sin(w * theta + e.phase);
      k += g.k0 * a.amplitude * ca;
      k1 -= g.k0 * a.amplitude * w * sa;
      k2 -= g.k0 * a.amplitude * w * w * ca;
      delta += e.amplitude * ce;
      e1 -= e.amplitude * w * se;
      e2 -= e.amplitude * w * w * ce;
    }
    rate += e1 * dtheta;
  }
};

/// d delta/dX with the error's share in phi_1.
Vector<14> gradient(const GearMesh& g, const Mesh& m) {
  Vector<14> b = g.b;
  b[6] += m.e1 * g.z1;
  return b;
}

}  // namespace

system::Dependence GearMesh::depends(const Context& context) const {
  const bool one_tooth = harmonics > 0 && !context.averaged;
  return {.angle = one_tooth ? system::each_angle : system::angle_sum(z1, z2), .spin = c != 0.0};
}

double GearMesh::compression(const Nodes<2>& x) const { return Mesh(*this, x).delta; }

void GearMesh::add_force(const Nodes<2>& x, const Context& context, ForceX<14>& f) const {
  const Mesh m(*this, x, context.averaged);
  f += (m.k * m.delta + c * m.rate) * gradient(*this, m);
  f[6] += 0.5 * m.k1 * z1 * m.delta * m.delta;
}

void GearMesh::add_tangent(const Nodes<2>& x, const Context& context, TangentX<14>& t) const {
  const Mesh m(*this, x, context.averaged);
  const Vector<14> g = gradient(*this, m);
  const double N = m.k * m.delta + c * m.rate;
  t.K.noalias() += m.k * g * g.transpose();
  t.K.row(6) += m.k1 * z1 * m.delta * g.transpose();
  t.K.col(6) += m.k1 * z1 * m.delta * g;
  t.K(6, 6) += N * m.e2 * z1 * z1 + 0.5 * m.k2 * z1 * z1 * m.delta * m.delta;
  t.K.col(6) += c * m.e2 * z1 * m.dtheta * g;  // d rate/d phi_1
  t.C.noalias() += c * g * g.transpose();
}

void GearMesh::add_energy(const Nodes<2>& x, const Context& context, Energy& e) const {
  const Mesh m(*this, x, context.averaged);
  e.elastic += 0.5 * m.k * m.delta * m.delta;
  e.dissipated += c * m.rate * m.rate;
}

namespace {

struct Flank {
  Mesh m;
  double delta, hold;  // hold: 1 + h rate, never negative
  Flank(const GearMesh& g, const Nodes<2>& x, double gap, double h, bool averaged)
      : m(g, x, averaged),
        delta(m.delta - gap),
        hold(std::max(0.0, 1.0 + h * m.rate)) {}
  bool open() const { return delta <= 0.0; }
};

}  // namespace

system::Dependence BacklashGearMesh::depends(const Context& context) const {
  return {.angle = drive.depends(context).angle, .spin = relaxation != 0.0};
}

void BacklashGearMesh::add_force(const Nodes<2>& x, const Context& context, ForceX<14>& f) const {
  for (const GearMesh* g : {&drive, &back}) {
    const Flank q(*g, x, g == &back ? backlash : 0.0, relaxation, context.averaged);
    if (q.open()) continue;
    f += q.m.k * q.delta * q.hold * gradient(*g, q.m);
    f[6] += 0.5 * q.m.k1 * g->z1 * q.delta * q.delta;
  }
}

void BacklashGearMesh::add_tangent(const Nodes<2>& x, const Context& context,
                                   TangentX<14>& t) const {
  for (const GearMesh* g : {&drive, &back}) {
    const Flank q(*g, x, g == &back ? backlash : 0.0, relaxation, context.averaged);
    if (q.open()) continue;
    const Vector<14> b = gradient(*g, q.m);
    const double z = g->z1, by_rate = q.hold > 0.0 ? q.m.k * q.delta * relaxation : 0.0;
    t.K.noalias() += q.m.k * q.hold * b * b.transpose();
    t.K.row(6) += q.m.k1 * z * q.delta * b.transpose();
    t.K.col(6) += (q.m.k1 * z * q.delta * q.hold + by_rate * q.m.e2 * z * q.m.dtheta) * b;
    t.K(6, 6) +=
        q.m.k * q.delta * q.hold * q.m.e2 * z * z + 0.5 * q.m.k2 * z * z * q.delta * q.delta;
    t.C.noalias() += by_rate * b * b.transpose();
  }
}

void BacklashGearMesh::add_energy(const Nodes<2>& x, const Context& context, Energy& e) const {
  for (const GearMesh* g : {&drive, &back}) {
    const Flank q(*g, x, g == &back ? backlash : 0.0, relaxation, context.averaged);
    if (q.open()) continue;
    e.elastic += 0.5 * q.m.k * q.delta * q.delta;
    e.dissipated += q.m.k * q.delta * (q.hold - 1.0) * q.m.rate;
  }
}

GearMesh make_gear_mesh(const GearGeometry& g, double k0, double c,
                        const std::vector<GearHarmonic>& stiffness,
                        const std::vector<GearHarmonic>& error) {
  if (g.z1 < 1 || g.z2 == 0 || (g.z2 < 0 && -g.z2 <= g.z1))
    fail("teeth: at least one on each gear, more on an internal gear than on its pinion");
  if (!(g.pitch_radius > 0)) fail("the pitch radius must be positive");
  if (!(g.pressure_angle > 0 && g.pressure_angle < 0.8))
    fail("the pressure angle must lie between 0 and 45 degrees");
  if (!(std::abs(g.base_helix) < 1.1)) fail("the helix angle must be below 63 degrees");
  if (!(k0 >= 0) || !(c >= 0)) fail("stiffness and damping must not be negative");
  const std::size_t n = std::max(stiffness.size(), error.size());
  if (n > GearMesh::max_harmonics) fail("at most 5 harmonics");
  GearMesh m;
  double swing = 0;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    m.stiffness[i] = stiffness[i];
    swing += std::abs(stiffness[i].amplitude);
  }
  for (std::size_t i = 0; i < error.size(); ++i)
    m.error[i] = error[i];
  if (swing >= 1.0)
    fail("the mesh stiffness would become negative: the harmonics add up to 1 or more");
  m.harmonics = static_cast<int>(n);
  m.k0 = k0;
  m.c = c;
  m.z1 = g.z1;
  m.z2 = g.z2;
  const double side = g.drive >= 0 ? 1.0 : -1.0, ca = std::cos(g.pressure_angle),
               sa = std::sin(g.pressure_angle);
  const double cb = std::cos(g.base_helix), sb = std::sin(g.base_helix);
  const double r1 = g.pitch_radius, r2 = r1 * g.z2 / g.z1;
  const Vec3 centre(0, std::cos(g.centre_angle), std::sin(g.centre_angle)),
      around(0, -centre.z(), centre.y());
  // teeth become thinner outwards: whatever they mesh with pushes the gear back to its own centre
  const Vec3 normal = cb * (side * ca * around + sa * centre) - side * sb * Vec3::UnitX();
  m.b.segment<3>(0) = normal;
  m.b.segment<3>(7) = -normal;
  m.b.segment<3>(3) = side * sb * r1 * centre;
  m.b.segment<3>(10) = side * sb * r2 * centre;
  m.rotation = side * cb * r1 * ca / g.z1;
  m.b[6] = m.rotation * g.z1;
  m.b[13] = m.rotation * g.z2;
  return m;
}

BacklashGearMesh make_backlash_gear_mesh(const GearGeometry& g, double k0, double relaxation,
                                         double backlash,
                                         const std::vector<GearHarmonic>& stiffness,
                                         const std::vector<GearHarmonic>& error) {
  if (!(backlash >= 0)) fail("the backlash must not be negative");
  if (!(relaxation >= 0)) fail("the damping must not be negative");
  BacklashGearMesh m;
  GearGeometry other = g;
  other.drive = -g.drive;
  // The error opens the back flank where it closes the drive flank.
  std::vector<GearHarmonic> opposite = error;
  for (auto& e : opposite)
    e.amplitude = -e.amplitude;
  m.drive = make_gear_mesh(g, k0, 0.0, stiffness, error);
  m.back = make_gear_mesh(other, k0, 0.0, stiffness, opposite);
  m.backlash = backlash;
  m.relaxation = relaxation;
  return m;
}

}  // namespace whirl::elements
