#include <elements/magnetic/magnet.hpp>

#include <cmath>

namespace whirl::elements {
namespace {

/// A value and its slope.
struct Limited {
  double value, slope;
};

/// x/(1 + |x/limit|^p)^(1/p)
Limited limited(double x, double limit, double p) {
  if (limit <= 0) return {x, 1.0};
  const double r = std::abs(x) / limit;
  if (r > 1.0) {  // the same, without powers of large numbers
    const double small = std::pow(r, -p), root = std::pow(1.0 + small, -1.0 / p);
    return {std::copysign(limit * root, x), root * small / (1.0 + small) / r};
  }
  const double power = std::pow(r, p), root = std::pow(1.0 + power, -1.0 / p);
  return {x * root, root / (1.0 + power)};
}

/// 1/g, below `least` along its tangent there.
Limited inverse_gap(double g, double least) {
  if (g < least) return {(2.0 - g / least) / least, -1.0 / (least * least)};
  return {1.0 / g, -1.0 / (g * g)};
}

}  // namespace

Magnet::Pull Magnet::pull_of_pair(double x, double i, double side) const {
  const double c = per_current * gap * gap / (4.0 * bias);
  const double b = per_displacement * gap / (per_current * bias);
  constexpr double least = 0.05;  // of the gap
  const double coil = bias + side * i;
  if (coil <= 0) return {0.0, 0.0, 0.0};
  const Limited inverse = inverse_gap(gap - side * b * x, least * gap);
  const double flux = coil * inverse.value;
  const Limited f = limited(c * flux * flux, saturation, 4.0);
  const double by_flux = f.slope * 2.0 * c * flux;
  return {side * f.value, side * by_flux * coil * inverse.slope * (-side * b),
          side * by_flux * inverse.value * side};
}

Magnet::Pull Magnet::pull(double x, double i) const {
  const Limited current = limited(i, current_limit, 8.0);
  if (bias == 0)
    return {per_current * current.value + per_displacement * x, per_displacement,
            per_current * current.slope};
  const Pull near = pull_of_pair(x, current.value, 1.0), far = pull_of_pair(x, current.value, -1.0);
  return {near.force + far.force, near.by_displacement + far.by_displacement,
          (near.by_current + far.by_current) * current.slope};
}

template <bool Offsets>
typename MagnetJoint<Offsets>::AtAxis MagnetJoint<Offsets>::at_axis(const Vec2& r, const Nodes& x,
                                                                    const system::Context& c,
                                                                    std::size_t k) const {
  AtAxis out{axis[k].dot(r), current_unit * x[2 + k]->u.x(), {}};
  out.pull = magnet.pull(out.displacement, out.current);
  const double on = factor(c);
  out.pull.force *= on;
  out.pull.by_displacement *= on;
  out.pull.by_current *= on;
  return out;
}

template <bool Offsets>
typename MagnetJoint<Offsets>::AtAxis MagnetJoint<Offsets>::at_axis(const Nodes& x,
                                                                    const system::Context& c,
                                                                    std::size_t k) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  return at_axis(Link{offset}.motion(ends(x), c, s, false).r, x, c, k);
}

template <bool Offsets>
Vec2 MagnetJoint<Offsets>::force(const Nodes& x, const system::Context& c) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  const Vec2 r = Link{offset}.motion(ends(x), c, s, false).r;
  return at_axis(r, x, c, 0).pull.force * axis[0] + at_axis(r, x, c, 1).pull.force * axis[1];
}

template <bool Offsets>
double MagnetJoint<Offsets>::capacity(double displacement, double side,
                                      const system::Context& c) const {
  constexpr double endless = 1e9;  // A
  return std::abs(factor(c) * magnet.pull(displacement, std::copysign(endless, side)).force);
}

template <bool Offsets>
void MagnetJoint<Offsets>::add_force(const Nodes& x, const system::Context& c,
                                     system::ForceX<size>& f) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  Vector<4> z;
  z << force(x, c), 0.0, 0.0;
  system::ForceX<14> at_ends = system::ForceX<14>::Zero();
  Link{offset}.add_force(s, z, at_ends);
  f.template head<14>() += at_ends;
}

template <bool Offsets>
void MagnetJoint<Offsets>::add_tangent(const Nodes& x, const system::Context& c,
                                       system::TangentX<size>& t) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  const Vec2 r = Link{offset}.motion(ends(x), c, s, false).r;
  Vector<4> z = Vector<4>::Zero();
  LateralTangent slope;
  slope.set_zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec2& a = axis[k];
    const Magnet::Pull p = at_axis(r, x, c, k).pull;
    z.template head<2>() += p.force * a;
    slope.r.template topRows<2>() += p.by_displacement * a * a.transpose();
    Vector<4> z_current = Vector<4>::Zero();
    z_current.template head<2>() = p.by_current * current_unit * a;
    system::ForceX<14> column = system::ForceX<14>::Zero();
    Link{offset}.add_force(s, z_current, column);
    t.K.template block<14, 1>(0, 14 + 7 * static_cast<Index>(k)) += column;
  }
  system::TangentX<14> at_ends;
  at_ends.C.setZero();
  at_ends.K.setZero();
  Link{offset}.add_tangent(s, z, slope, false, at_ends);
  t.C.template topLeftCorner<14, 14>() += at_ends.C;
  t.K.template topLeftCorner<14, 14>() += at_ends.K;
}

template <bool Offsets>
void MagnetJoint<Offsets>::add_energy(const Nodes& x, const system::Context& c,
                                      system::Energy& e) const {
  const typename Link::Spins s{system::Spin(*x[0]), system::Spin(*x[1])};
  e.supplied += force(x, c).dot(Link{offset}.motion(ends(x), c, s, false).v);
}

template struct MagnetJoint<false>;
template struct MagnetJoint<true>;

}  // namespace whirl::elements
