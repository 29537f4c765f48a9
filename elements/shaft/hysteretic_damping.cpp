#include <elements/shaft/hysteretic_damping.hpp>

#include <Eigen/LU>

#include <cmath>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::TangentX;

GeneralBeamDamping::GeneralBeamDamping(const GeneralBeam& beam, double beta, double along)
    : with(beam),
      without(beam) {
  with.c.beta = beta;
  with.c.beta_twist = with.c.beta_axial = along;
  without.c.beta = without.c.beta_twist = without.c.beta_axial = 0.0;
  with.c.alpha = without.c.alpha = 0.0;
}

SectionBeamDamping::SectionBeamDamping(const SectionBeam& beam, double beta, Part part)
    : with(beam),
      without(beam) {
  with.c.alpha = without.c.alpha = 0.0;
  without.c.damping.setZero();
  const Matrix<6> D = beta * beam.H0.inverse();
  Matrix<6> along = Matrix<6>::Zero();
  for (const Index i : {0, 3})
    for (const Index k : {0, 3})
      along(i, k) = D(i, k);
  with.c.damping = part == Part::along ? along : Matrix<6>(D - along);
}

namespace {

/// What the damping of a beam adds to the beam without.
template <class Damped>
void add_force_of(const Damped& d, const Nodes<2>& x, const Context& ctx, ForceX<14>& f) {
  ForceX<14> g = ForceX<14>::Zero();
  d.without.add_force(x, ctx, g);
  f -= g;
  d.with.add_force(x, ctx, f);
}

template <class Damped>
void add_tangent_of(const Damped& d, const Nodes<2>& x, const Context& ctx, TangentX<14>& t) {
  TangentX<14> g;
  g.set_zero();
  d.with.add_tangent(x, ctx, g);
  t.C += g.C;
  t.K += g.K;
  g.set_zero();
  d.without.add_tangent(x, ctx, g);
  t.C -= g.C;
  t.K -= g.K;
}

template <class Damped>
void add_energy_of(const Damped& d, const Nodes<2>& x, const Context& ctx, Energy& e) {
  Energy own;
  d.with.add_energy(x, ctx, own);
  e.dissipated += own.dissipated;
}

}  // namespace

void GeneralBeamDamping::add_force(const Nodes<2>& x, const Context& ctx, ForceX<14>& f) const {
  add_force_of(*this, x, ctx, f);
}
void GeneralBeamDamping::add_tangent(const Nodes<2>& x, const Context& ctx, TangentX<14>& t) const {
  add_tangent_of(*this, x, ctx, t);
}
void GeneralBeamDamping::add_energy(const Nodes<2>& x, const Context& ctx, Energy& e) const {
  add_energy_of(*this, x, ctx, e);
}

void SectionBeamDamping::add_force(const Nodes<2>& x, const Context& ctx, ForceX<14>& f) const {
  add_force_of(*this, x, ctx, f);
}
void SectionBeamDamping::add_tangent(const Nodes<2>& x, const Context& ctx, TangentX<14>& t) const {
  add_tangent_of(*this, x, ctx, t);
}
void SectionBeamDamping::add_energy(const Nodes<2>& x, const Context& ctx, Energy& e) const {
  add_energy_of(*this, x, ctx, e);
}

namespace {

/// Of the steady motion: small motions about it leave it as it is.
double spin_of(const Nodes<2>& x) { return 0.5 * (x[0]->dphi + x[1]->dphi); }

/// sign, zero where a and b are the same rate but for rounding.
double compare(double a, double b) {
  return std::abs(a - b) <= 1e-12 * std::abs(b) ? 0.0 : a > b ? 1.0 : -1.0;
}

/// a and b of the header.
struct Rule {
  double s, w, a, b;
  bool left_out;
  Rule(double spin, const Context& ctx) : s(spin), w(ctx.whirl), left_out(std::isinf(ctx.whirl)) {
    const double forward = w == 0.0 ? compare(0.0, s) : compare(ctx.whirl_side, s),
                 backward = w == 0.0 ? compare(s, 0.0) : compare(ctx.whirl_side, -s);
    a = 0.5 * (forward + backward);
    b = 0.5 * (backward - forward);
  }
};

}  // namespace

template <class Viscous>
system::Dependence HystereticDamping<Viscous>::depends(const Context& ctx) const {
  if (!ctx.hysteretic && stand_in == 0.0) return {};
  system::Dependence d = bending.depends(ctx) | along.depends(ctx);
  d.rate = ctx.hysteretic;
  return d;
}

template <class Viscous>
void HystereticDamping<Viscous>::add_force(const Nodes<2>& x, const Context& ctx,
                                           ForceX<14>& f) const {
  if (!ctx.hysteretic) {
    if (stand_in == 0.0) return;
    ForceX<14> g = ForceX<14>::Zero();
    bending.add_force(x, ctx, g);
    along.add_force(x, ctx, g);
    f += stand_in * g;
    return;
  }
  const Rule r(spin_of(x), ctx);
  if (r.left_out) return;
  // f = eta (a/w C X' + b S X): the steady spin alone gives s S X
  system::NodeState steady[2] = {*x[0], *x[1]};
  for (system::NodeState& n : steady) {
    n.du.setZero();
    n.dd.setZero();
    n.dphi = r.s;
  }
  ForceX<14> turning = ForceX<14>::Zero(), all = ForceX<14>::Zero();
  if (r.a != 0.0 || r.b != 0.0) bending.add_force({&steady[0], &steady[1]}, ctx, turning);
  if (r.a != 0.0) {
    bending.add_force(x, ctx, all);
    f += (r.a / r.w) * (all - turning);
  }
  if (r.b != 0.0) f += (r.b / r.s) * turning;
  if (r.w == 0.0) return;
  all.setZero();
  along.add_force(x, ctx, all);
  f += all / r.w;
}

template <class Viscous>
void HystereticDamping<Viscous>::add_tangent(const Nodes<2>& x, const Context& ctx,
                                             TangentX<14>& t) const {
  TangentX<14> v;
  v.set_zero();
  if (!ctx.hysteretic) {
    if (stand_in == 0.0) return;
    bending.add_tangent(x, ctx, v);
    along.add_tangent(x, ctx, v);
    t.C += stand_in * v.C;
    t.K += stand_in * v.K;
    return;
  }
  const Rule r(spin_of(x), ctx);
  if (r.left_out) return;
  if (ctx.whirl_rotates) {  // the rate in rotating axes itself: the viscous law with 1/w, and no
                            // circulation is left there
    if (r.w == 0.0) return;
    bending.add_tangent(x, ctx, v);
    along.add_tangent(x, ctx, v);
    t.C += v.C / r.w;
    t.K += v.K / r.w - (ctx.growth / r.w) * v.C;
    return;
  }
  if (r.a != 0.0 || r.b != 0.0) {
    bending.add_tangent(x, ctx, v);
    if (r.a != 0.0) {
      t.C += (r.a / r.w) * v.C;
      t.K -= (r.a * ctx.growth / r.w) * v.C;
    }
    if (r.b != 0.0) t.K += (r.b / r.s) * v.K;
  }
  if (r.w == 0.0) return;
  v.set_zero();
  along.add_tangent(x, ctx, v);
  t.C += v.C / r.w;
  t.K -= (ctx.growth / r.w) * v.C;
}

template <class Viscous>
void HystereticDamping<Viscous>::add_energy(const Nodes<2>& x, const Context& ctx,
                                            Energy& e) const {
  if (ctx.hysteretic || stand_in == 0.0) return;
  Energy lost;
  bending.add_energy(x, ctx, lost);
  along.add_energy(x, ctx, lost);
  e.dissipated += stand_in * lost.dissipated;
}

template struct HystereticDamping<ShaftDamping<true>>;
template struct HystereticDamping<GeneralBeamDamping>;
template struct HystereticDamping<SectionBeamDamping>;

}  // namespace whirl::elements
