#include <elements/films/floating_ring.hpp>
#include <core/contract.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace whirl::elements {

// ---------------------------------------------------------------- films at other clearances

template <class Film>
void ScaledFilm<Film>::evaluate(const FilmPoint& p, FilmForce& f) const {
  WHIRL_EXPECTS(film != nullptr);
  if (!(clearance > 0.0)) return set_outside(f);
  const double scale = 1.0 / clearance;
  film->evaluate({scale * p.r, scale * p.w, p.slip}, f);
  f.F *= viscosity * scale * scale;
  f.T *= viscosity * scale;
}

template <class Film>
void ScaledFilm<Film>::evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const {
  WHIRL_EXPECTS(film != nullptr);
  if (!(clearance > 0.0)) return set_outside(f, t);
  const double scale = 1.0 / clearance;
  film->evaluate({scale * p.r, scale * p.w, p.slip}, f, t);
  const double torque = viscosity * scale, force = torque * scale;
  f.F *= force;
  f.T *= torque;
  t.F_r *= force * scale;
  t.F_w *= force * scale;
  t.F_slip *= force;
  t.T_r *= torque * scale;
  t.T_w *= torque * scale;
  t.T_slip *= torque;
}

template struct ScaledFilm<ShortJournal>;
template struct ScaledFilm<FiniteJournal>;

// ---------------------------------------------------------------- the ring

template <class Film>
auto FloatingRing<Film>::clearances(const Vec2& excess) const -> Clearances {
  const double fed = heat.supply_temperature - heat.reference;
  Clearances out;
  out.slope << inner.radius * (0.5 * heat.ring - heat.shaft), 0.5 * inner.radius * heat.ring,
      -0.5 * outer.radius * heat.ring, outer.radius * (heat.housing - 0.5 * heat.ring);
  out.c = Vec2(inner.clearance, outer.clearance) + out.slope * (excess + Vec2::Constant(fed));
  return out;
}

template <class Film>
double FloatingRing<Film>::closing_excess() const {
  const Clearances now = clearances(Vec2::Zero());
  double out = infinity;
  for (Index k = 0; k < 2; ++k)
    if (const double slope = now.slope.row(k).sum(); slope < 0.0)
      out = std::min(out, -now.c[k] / slope);
  return out;
}

template <class Film>
double FloatingRing<Film>::centred_spin(double shaft, double housing) const {
  if (pinned) return 0.0;
  const auto drag = [](const Side& s) {
    return s.viscosity * s.length * s.radius * s.radius * s.radius / s.clearance;
  };
  const double of_inner = drag(inner), of_outer = drag(outer);
  return (of_inner * shaft + of_outer * housing) / (of_inner + of_outer);
}

template struct FloatingRing<ShortJournal>;
template struct FloatingRing<FiniteJournal>;

// ---------------------------------------------------------------- both films at a state

namespace {

const Mat3 straight_axes = Mat3::Identity();

constexpr int y_at = 14, z_at = 21, spin_at = 28, heat_at = 35;

/// Where the coordinates of a film's two sides stand among those of the joint, -1: nowhere. The
/// ring is the second side of the inner film, the first of the outer one.
using Places = std::array<int, 14>;
constexpr std::array<Places, 2> places{
    {{0, 1, 2, 3, 4, 5, 6, -1, y_at, z_at, -1, -1, -1, spin_at},
     {-1, y_at, z_at, -1, -1, -1, spin_at, 7, 8, 9, 10, 11, 12, 13}}};

/// Oil through a film, m3/s, with its derivatives.
struct Flow {
  double Q = 0;
  LateralTangent by_motion;                                    ///< in row 0
  double by_pressure = 0, by_viscosity = 0, by_clearance = 0;  ///< of ln eta, ln c
};

/// The feed pressure without a corner where it ends, and its slope.
std::array<double, 2> smooth_pressure(double p, double supply) {
  const double edge = 0.02 * supply, root = std::sqrt(p * p + edge * edge);
  return {0.5 * (p + root), root > 0.0 ? 0.5 * (1.0 + p / root) : 0.5};
}

Flow flow_through(const LateralMotion& m, double radius, double length, double clearance,
                  double viscosity, double pressure) {
  Flow out;
  out.by_motion.set_zero();
  const double c2 = clearance * clearance, r2 = m.r.squaredNorm();
  const double gap = pi * radius * clearance / (3.0 * viscosity * length);
  const double driven = gap * (c2 + 1.5 * r2);
  const double mean = 0.5 * (m.spin + m.housing_spin);
  const Vec2 w(m.v.x() + mean * m.r.y(), m.v.y() - mean * m.r.x());
  // far below the speed of any wedge: without a corner where nothing is displaced
  const double still = 1e-3 * clearance * 1e3;
  const double speed = std::sqrt(w.squaredNorm() + still * still), wide = 2.0 * radius * length;
  out.Q = driven * pressure + wide * speed;
  const Vec2 by_w = wide / speed * w;
  out.by_motion.r.row(0) =
      (3.0 * gap * pressure * m.r + mean * Vec2(-by_w.y(), by_w.x())).transpose();
  out.by_motion.v.row(0) = by_w.transpose();
  out.by_motion.spin[0] = 0.5 * (by_w.x() * m.r.y() - by_w.y() * m.r.x());
  out.by_motion.housing_spin[0] = out.by_motion.spin[0];
  out.by_pressure = driven;
  out.by_viscosity = -driven * pressure;
  out.by_clearance = gap * (3.0 * c2 + 1.5 * r2) * pressure + wide * still * still / speed;
  return out;
}

template <class Film, bool Heat, bool Offsets>
class Evaluation {
 public:
  using Joint = FloatingRingJoint<Film, Heat, Offsets>;
  using Nodes = typename Joint::Nodes;
  using Law = FilmLaw<ScaledFilm<Film>>;
  using Link = LateralLink<Offsets>;
  using Force = system::ForceX<Joint::size>;
  using Tangent = system::TangentX<Joint::size>;

  Evaluation(const Joint& joint, const Nodes& x, const system::Context& c)
      : joint_(joint),
        ring_(joint.ring),
        x_(x),
        node_(ring_node(joint.ring, x)),
        spins_{system::Spin(*x[0]), system::Spin(node_), system::Spin(*x[1])},
        gravity_(c.gravity) {
    for (std::size_t k = 0; k < 2; ++k)
      motion_[k] = link(k).motion(ends(k), c, spins(k), false);
    find_films();
  }

  const LateralMotion& motion(std::size_t k) const { return motion_[k]; }
  Law law(std::size_t k) const { return Law{film_[k]}; }
  double spin() const { return spins_[1].s; }
  double viscosity(std::size_t k) const { return side(k).viscosity * film_[k].viscosity; }
  double clearance(std::size_t k) const { return grown_.c[index(k)]; }
  double excess(std::size_t k) const { return excess_[index(k)]; }

  void add_force(Force& f) const {
    const auto rows = row_factors();
    for (std::size_t k = 0; k < 2; ++k) {
      Vector<4> z;
      law(k).force(motion_[k], z);
      const Vector<14> film = on_sides(k, z);
      add(k, film, rows, f);
      if constexpr (Heat) f[heat_at + 7 * index(k)] += heat_left(k, film.dot(rates(k)));
    }
    add(1, on_sides(1, centring()), rows, f);
    add_body(f);
  }

  void add_tangent(Tangent& t) const {
    for (std::size_t k = 0; k < 2; ++k)
      add_film(k, t);
    add_centring(t);
    for (const int at : {y_at, z_at})
      t.M(at, at) += ring_.mass;
    t.C(spin_at, spin_at) += ring_.spin_row() * ring_.inertia * ring_.spin_unit();
  }

  void add_energy(system::Energy& e) const {
    for (std::size_t k = 0; k < 2; ++k)
      law(k).energy(motion_[k], e);
    const Vec2 place(x_[2]->u.x(), x_[3]->u.x()), rate(x_[2]->du.x(), x_[3]->du.x());
    e.kinetic += 0.5 * ring_.mass * rate.squaredNorm() + 0.5 * ring_.inertia * spin() * spin();
    e.gravity -= ring_.mass * gravity_.tail<2>().dot(place);
    e.elastic += 0.5 * ring_.stiffness * motion_[1].r.squaredNorm();
    e.dissipated += ring_.damping * motion_[1].v.squaredNorm();
  }

  Flow flow(std::size_t k) const {
    const auto& s = side(k);
    return flow_through(motion_[k], s.radius, s.length, clearance(k), viscosity(k), pressure(k)[0]);
  }

 private:
  static Index index(std::size_t k) { return static_cast<Index>(k); }
  const typename FloatingRing<Film>::Side& side(std::size_t k) const {
    return k == 0 ? ring_.inner : ring_.outer;
  }
  static system::NodeState ring_node(const FloatingRing<Film>& ring, const Nodes& x) {
    system::NodeState n;
    n.chart = &straight_axes;
    n.u = Vec3(0.0, x[2]->u.x(), x[3]->u.x());
    n.du = Vec3(0.0, x[2]->du.x(), x[3]->du.x());
    n.ddu = n.t = n.dd = n.ddd = Vec3::Zero();
    n.dphi = ring.spin_unit() * x[4]->u.x();
    return n;
  }
  system::Nodes<2> ends(std::size_t k) const {
    return k == 0 ? system::Nodes<2>{x_[0], &node_} : system::Nodes<2>{&node_, x_[1]};
  }
  std::array<system::Spin, 2> spins(std::size_t k) const { return {spins_[k], spins_[k + 1]}; }
  Link link(std::size_t k) const {
    return k == 0 ? Link{{joint_.offset[0], 0.0}} : Link{{0.0, joint_.offset[1]}};
  }
  Vector<14> on_sides(std::size_t k, const Vector<4>& z) const {
    Vector<14> f = Vector<14>::Zero();
    link(k).add_force(spins(k), z, f);
    return f;
  }
  Vector<14> rates(std::size_t k) const {
    const system::Nodes<2> n = ends(k);
    Vector<14> out;
    out << n[0]->du, n[0]->dd, n[0]->dphi, n[1]->du, n[1]->dd, n[1]->dphi;
    return out;
  }

  void find_films() {
    excess_.setZero();
    grown_.c = Vec2(ring_.inner.clearance, ring_.outer.clearance);
    if constexpr (Heat) {
      excess_ = ring_.temperature_unit() * Vec2(x_[5]->u.x(), x_[6]->u.x());
      grown_ = ring_.clearances(excess_);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      film_[k] = {&side(k).film, 1.0, grown_.c[index(k)] / side(k).clearance};
      if constexpr (Heat)
        film_[k].viscosity = ring_.heat.oil.at(ring_.heat.supply_temperature + excess_[index(k)]) /
                             side(k).viscosity;
    }
  }

  /// Of every coordinate of a film's sides.
  std::array<double, 2> row_factors() const { return {1.0, ring_.spin_row()}; }
  void add(std::size_t k, const Vector<14>& f, const std::array<double, 2>& rows,
           Force& out) const {
    for (Index i = 0; i < 14; ++i)
      if (const int to = places[k][static_cast<std::size_t>(i)]; to >= 0)
        out[to] += rows[to == spin_at ? 1 : 0] * f[i];
  }
  Vector<4> centring() const {
    Vector<4> z;
    z << -ring_.stiffness * motion_[1].r - ring_.damping * motion_[1].v, 0.0, 0.0;
    return z;
  }
  void add_body(Force& f) const {
    f[y_at] += ring_.mass * (x_[2]->ddu.x() - gravity_.y());
    f[z_at] += ring_.mass * (x_[3]->ddu.x() - gravity_.z());
    f[spin_at] += ring_.spin_row() * ring_.inertia * ring_.spin_unit() * x_[4]->du.x();
  }

  /// Feed pressure of a film with its derivative by the spin of the ring.
  std::array<double, 2> pressure(std::size_t k) const {
    const RingSupply& s = ring_.supply;
    if (k == 1) return {s.pressure, 0.0};
    const auto [p, slope] = smooth_pressure(s.behind_ring(spin()), s.pressure);
    return {p, -slope * s.density * spin() * s.lever};
  }
  double carried() const { return ring_.supply.density * ring_.heat.specific_heat; }
  double heat_left(std::size_t k, double power) const {
    const RingHeat& h = ring_.heat;
    const double rate = ring_.temperature_unit() * x_[5 + k]->du.x();
    return ring_.heat_row() * (h.capacity * rate + carried() * flow(k).Q * excess(k) +
                               h.conductance * (excess(k) - excess(1 - k)) - h.share * power);
  }

  void add_film(std::size_t k, Tangent& out) const {
    Vector<4> z;
    LateralTangent t;
    law(k).tangent(motion_[k], z, t);
    system::TangentX<14> pair;
    pair.C.setZero();
    pair.K.setZero();
    link(k).add_tangent(spins(k), z, t, false, pair);
    add_pair(k, pair, out);
    if constexpr (Heat) add_heat(k, z, t, pair, out);
  }

  void add_pair(std::size_t k, const system::TangentX<14>& pair, Tangent& out) const {
    const auto rows = row_factors();
    for (std::size_t i = 0; i < 14; ++i) {
      const int row = places[k][i];
      if (row < 0) continue;
      const double by = rows[row == spin_at ? 1 : 0];
      add_row(k, row, by, pair.K.row(static_cast<Index>(i)), pair.C.row(static_cast<Index>(i)),
              out);
    }
  }
  /// A row by displacements and rates of a film's sides; the rate of the ring's angle is an unknown.
  template <class Row, class RateRow>
  void add_row(std::size_t k, int row, double by, const Row& K, const RateRow& C,
               Tangent& out) const {
    for (std::size_t j = 0; j < 14; ++j) {
      const int column = places[k][j];
      if (column < 0) continue;
      if (column == spin_at) {
        out.K(row, spin_at) += by * ring_.spin_unit() * C[static_cast<Index>(j)];
        continue;
      }
      out.K(row, column) += by * K[static_cast<Index>(j)];
      out.C(row, column) += by * C[static_cast<Index>(j)];
    }
  }

  void add_heat(std::size_t k, const Vector<4>& z, const LateralTangent& t,
                const system::TangentX<14>& pair, Tangent& out) const {
    const RingHeat& h = ring_.heat;
    const double by = ring_.heat_row(), unit = ring_.temperature_unit();
    const int row = heat_at + 7 * static_cast<int>(k);
    const Flow q = flow(k);
    const Vector<14> X = rates(k), f = on_sides(k, z);
    // the flow as a force along y of the first side stands in row 1, with the sign changed
    system::TangentX<14> of_flow;
    of_flow.C.setZero();
    of_flow.K.setZero();
    link(k).add_tangent(spins(k), Vector<4>::Zero(), q.by_motion, false, of_flow);
    const double warm = carried() * excess(k);
    const Vector<14> gK = -warm * of_flow.K.row(1).transpose() - h.share * pair.K.transpose() * X;
    const Vector<14> gC =
        -warm * of_flow.C.row(1).transpose() - h.share * (pair.C.transpose() * X + f);
    add_row(k, row, by, gK, gC, out);
    out.K(row, spin_at) += by * ring_.spin_unit() * warm * q.by_pressure * pressure(k)[1];
    // z by ln c, from the degrees of force and torque in (r, v, c)
    Vector<4> by_clearance = -(t.r * motion_[k].r + t.v * motion_[k].v);
    by_clearance.head<2>() -= 2.0 * z.head<2>();
    by_clearance.tail<2>() -= z.tail<2>();
    const auto rows = row_factors();
    for (std::size_t j = 0; j < 2; ++j) {
      const double thinner =
          j == k ? h.oil.slope(h.supply_temperature + excess(k)) : 0.0;  // d ln eta/dtheta
      const double wider = grown_.slope(index(k), index(j)) / clearance(k);
      const Vector<14> change = on_sides(k, thinner * z + wider * by_clearance);
      const int column = heat_at + 7 * static_cast<int>(j);
      for (std::size_t i = 0; i < 14; ++i)
        if (const int to = places[k][i]; to >= 0)
          out.K(to, column) += unit * rows[to == spin_at ? 1 : 0] * change[static_cast<Index>(i)];
      const double left = warm * (thinner * q.by_viscosity + wider * q.by_clearance) -
                          h.share * change.dot(X) +
                          (j == k ? carried() * q.Q + h.conductance : -h.conductance);
      out.K(row, column) += by * unit * left;
    }
    out.C(row, row) += by * unit * h.capacity;
  }

  void add_centring(Tangent& out) const {
    LateralTangent t;
    t.set_zero();
    t.r.topRows<2>() = -ring_.stiffness * Mat2::Identity();
    t.v.topRows<2>() = -ring_.damping * Mat2::Identity();
    system::TangentX<14> pair;
    pair.C.setZero();
    pair.K.setZero();
    link(1).add_tangent(spins(1), centring(), t, false, pair);
    add_pair(1, pair, out);
  }

  const Joint& joint_;
  const FloatingRing<Film>& ring_;
  const Nodes& x_;
  system::NodeState node_;
  std::array<system::Spin, 3> spins_;
  Vec3 gravity_;
  std::array<LateralMotion, 2> motion_;
  std::array<ScaledFilm<Film>, 2> film_;
  Vec2 excess_;
  typename FloatingRing<Film>::Clearances grown_;
};

// ---------------------------------------------------------------- the ring in balance

/// The joint with journal and housing where they are, at rest, as equations of the ring's unknowns.
template <class Joint>
class Balance {
 public:
  static constexpr int own = Joint::own;
  using Values = Vector<own>;

  Balance(const Joint& joint, const typename Joint::Nodes& x, const system::Context& c)
      : joint_(joint),
        context_(c),
        nodes_(x) {
    for (std::size_t k = 0; k < own; ++k) {
      states_[k] = *x[2 + k];
      states_[k].du = states_[k].ddu = Vec3::Zero();
      nodes_[2 + k] = &states_[k];
    }
  }
  /// Newton's method with simplified corrections that must shrink (natural monotonicity).
  bool solve(Values& q) {
    Values f;
    if (!residual(q, f)) return false;
    for (int pass = 0; pass < 60; ++pass) {
      const Eigen::PartialPivLU<Matrix<own>> lu(slopes(q));
      const Values step = -held(lu.solve(f));
      if (!step.allFinite()) return false;
      const double size = step.norm();
      if (size <= 1e-13 * joint_.ring.outer.clearance) return true;
      double part = 1.0;
      for (;; part *= 0.5) {
        if (part < 1e-6) return false;
        Values next;
        if (residual(q + part * step, next) &&
            held(lu.solve(next)).norm() <= (1.0 - 0.25 * part) * size) {
          f = next;
          break;
        }
      }
      q += part * step;
      if (part == 1.0 && size <= 1e-9 * joint_.ring.outer.clearance) return true;
    }
    return false;
  }
  const typename Joint::Nodes& nodes_at(const Values& q) {
    for (std::size_t k = 0; k < own; ++k)
      states_[k].u.x() = q[static_cast<Index>(k)];
    return nodes_;
  }

 private:
  static constexpr int spin = 2;
  Values held(Values v) const {
    if (joint_.ring.pinned) v[spin] = 0.0;
    return v;
  }
  bool residual(const Values& q, Values& out) {
    system::ForceX<Joint::size> f = system::ForceX<Joint::size>::Zero();
    joint_.add_force(nodes_at(q), context_, f);
    for (Index k = 0; k < own; ++k)
      out[k] = f[14 + 7 * k];
    out = held(out);
    return out.allFinite();
  }
  Matrix<own> slopes(const Values& q) {
    system::TangentX<Joint::size> t;
    t.set_zero();
    joint_.add_tangent(nodes_at(q), context_, t);
    Matrix<own> K;
    for (Index i = 0; i < own; ++i)
      for (Index j = 0; j < own; ++j)
        K(i, j) = t.K(14 + 7 * i, 14 + 7 * j);
    if (joint_.ring.pinned) {
      K.row(spin).setZero();
      K(spin, spin) = 1.0;
    }
    return K;
  }

  const Joint& joint_;
  const system::Context& context_;
  typename Joint::Nodes nodes_;
  std::array<system::NodeState, own> states_;
};

}  // namespace

// ---------------------------------------------------------------- the kernel

template <class Film, bool Heat, bool Offsets>
void FloatingRingJoint<Film, Heat, Offsets>::add_force(const Nodes& x, const system::Context& c,
                                                       system::ForceX<size>& f) const {
  Evaluation<Film, Heat, Offsets>(*this, x, c).add_force(f);
}

template <class Film, bool Heat, bool Offsets>
void FloatingRingJoint<Film, Heat, Offsets>::add_tangent(const Nodes& x, const system::Context& c,
                                                         system::TangentX<size>& t) const {
  Evaluation<Film, Heat, Offsets>(*this, x, c).add_tangent(t);
}

template <class Film, bool Heat, bool Offsets>
void FloatingRingJoint<Film, Heat, Offsets>::add_energy(const Nodes& x, const system::Context& c,
                                                        system::Energy& e) const {
  Evaluation<Film, Heat, Offsets>(*this, x, c).add_energy(e);
}

template <class Film, bool Heat, bool Offsets>
void FloatingRingJoint<Film, Heat, Offsets>::relax(const Nodes& x, const system::Context& c,
                                                   std::array<double, own>& q) const {
  using Values = Vector<own>;
  Balance<FloatingRingJoint> balance(*this, x, c);
  Values now = Eigen::Map<const Values>(q.data());
  const bool fresh = now.isZero(0.0);
  const auto take = [&](const Values& v) { Eigen::Map<Values>{q.data()} = v; };
  if (!fresh && balance.solve(now)) return take(now);
  // in the middle of what both clearances leave it, turning as if it were centred
  const system::Spin shaft(*x[0]), housing(*x[1]);
  const LateralMotion m =
      LateralLink<Offsets>{offset}.motion({x[0], x[1]}, c, {shaft, housing}, false);
  const Vec2 foot = (x[1]->u + offset[1] * x[1]->t).template tail<2>();
  const double share = ring.outer.clearance / (ring.inner.clearance + ring.outer.clearance);
  Values start = Values::Zero();
  start.template head<2>() = foot + share * m.r;
  start[2] = ring.centred_spin(shaft.s, housing.s) / ring.spin_unit();
  now = start;
  if (balance.solve(now))
    take(now);
  else if (fresh)
    take(start);
}

template <class Film, bool Heat, bool Offsets>
RingStanding FloatingRingJoint<Film, Heat, Offsets>::standing(const Nodes& x,
                                                              const system::Context& c) const {
  const Evaluation<Film, Heat, Offsets> now(*this, x, c);
  RingStanding out;
  out.spin = now.spin();
  for (std::size_t k = 0; k < 2; ++k) {
    RingFilmStanding& f = k == 0 ? out.inner : out.outer;
    const LateralMotion& m = now.motion(k);
    Vector<4> z;
    now.law(k).force(m, z);
    f.place = m.r;
    f.clearance = now.clearance(k);
    f.eccentricity = m.r.norm() / f.clearance;
    f.force = -z.template head<2>();
    f.viscosity = now.viscosity(k);
    f.power = -(z.template head<2>().dot(m.v) + z[2] * m.spin + z[3] * m.housing_spin);
    if (Heat) f.temperature = ring.heat.supply_temperature + now.excess(k);
    if (ring.supply.pressure > 0.0) f.flow = now.flow(k).Q;
    out.torque += k == 0 ? z[3] : z[2];
  }
  if (ring.supply.pressure > 0.0) out.feed_pressure = ring.supply.behind_ring(out.spin);
  return out;
}

template <class Film, bool Heat, bool Offsets>
double FloatingRingJoint<Film, Heat, Offsets>::capacity(const Nodes& x, const system::Context& c,
                                                        bool of_inner, double at) const {
  WHIRL_EXPECTS(at > 0.0 && at < 1.0);
  const Evaluation<Film, Heat, Offsets> now(*this, x, c);
  const std::size_t k = of_inner ? 0 : 1;
  LateralMotion m = now.motion(k);
  const double reach = at * now.clearance(k), away = m.r.norm();
  m.r = away > 0.0 ? Vec2(m.r * (reach / away)) : Vec2(0.0, -reach);
  m.v.setZero();
  Vector<4> z;
  now.law(k).force(m, z);
  return z.template head<2>().norm();
}

template struct FloatingRingJoint<ShortJournal, false, false>;
template struct FloatingRingJoint<ShortJournal, false, true>;
template struct FloatingRingJoint<ShortJournal, true, false>;
template struct FloatingRingJoint<ShortJournal, true, true>;
template struct FloatingRingJoint<FiniteJournal, false, false>;
template struct FloatingRingJoint<FiniteJournal, false, true>;
template struct FloatingRingJoint<FiniteJournal, true, false>;
template struct FloatingRingJoint<FiniteJournal, true, true>;

}  // namespace whirl::elements
