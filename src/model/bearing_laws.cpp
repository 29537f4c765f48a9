#include <model/bearing_laws.hpp>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::model {
namespace {

constexpr std::nullopt_t none = std::nullopt;
using Curves = std::vector<StiffnessCurve>;

Directions on_diagonal(const Matrix<6>& K) {
  Directions out{};
  for (Index c = 0; c < 6; ++c)
    out[static_cast<std::size_t>(c)] = K(c, c) != 0;
  return out;
}

NodeLoads loads_of(const Matrix<6>& K, const Matrix<6>& C) {
  const auto row = [&](Index c) { return !K.row(c).isZero(0.0) || !C.row(c).isZero(0.0); };
  return {row(1) || row(2), K(4, 4) + K(5, 5) > 0, K(3, 3) > 0};
}

/// A film round a journal that turns: it carries by turning.
SupportTraits traits_of_journal() {
  return {.held = lateral_directions,
          .loads = NodeLoads{.lateral = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = true,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = true,
          .nonlinear = true,
          .needs_load = true,
          .mapped = true,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

}  // namespace

SupportTraits traits(const LinearBearing& b) {
  Curves curves{{" kyy", {b.K(1, 1)}, {}}};
  if (b.K(2, 2) != b.K(1, 1)) curves.push_back({" kzz", {b.K(2, 2)}, {}});
  return {.held = on_diagonal(b.K),
          .loads = loads_of(b.K, b.C),
          .stiffness = b.K,
          .bias = Bias{b.setpoint, b.preload},
          .curves = curves,
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = false,
          .needs_load = false,
          .mapped = b.K(1, 1) != 0 || b.K(2, 2) != 0,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

LinearBearing linear_form(const SpringBlock& b) {
  LinearBearing linear;
  linear.K.diagonal() << b.C1, b.C1, b.C1, 0, b.C2, b.C2;
  return linear;
}

SupportTraits traits(const SpringBlock& b) {
  return {.held = on_diagonal(linear_form(b).K),
          .loads = NodeLoads{.lateral = true, .tilting = true},
          .stiffness = linear_form(b).K,
          .bias = Bias{},
          .curves = Curves{{"", {b.C1}, {}}},
          .acts = Acts::on_the_shaft,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = false,
          .needs_load = false,
          .mapped = b.C1 != 0,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::spring};
}

namespace {

/// Of a table against frequency the synchronous values: the frequency nearest to the speed.
std::size_t synchronous_row(const TableBearing& b, std::size_t speed) {
  const auto& f = b.frequency;
  if (f.empty()) return speed;
  std::size_t j = 0;
  for (std::size_t k = 1; k < f.size(); ++k)
    if (std::abs(f[k] - b.speed[speed]) < std::abs(f[j] - b.speed[speed])) j = k;
  return speed * f.size() + j;
}

Curves curves_of(const TableBearing& b) {
  Curves out;
  for (const auto& [entry, label] : {std::pair{1, " kyy"}, std::pair{2, " kzz"}}) {
    StiffnessCurve c{label, {}, {}};
    for (std::size_t i = 0; i < b.speed.size(); ++i) {
      const double k = b.K[synchronous_row(b, i)](entry, entry);
      if (!(b.speed[i] > 0) || !(k > 0)) continue;
      c.k.push_back(k);
      c.speed.push_back(b.speed[i]);
    }
    if (!c.k.empty()) out.push_back(std::move(c));
  }
  return out;
}

}  // namespace

SupportTraits traits(const TableBearing& b) {
  Directions held{};
  NodeLoads loads;
  for (std::size_t i = 0; i < b.K.size(); ++i) {
    const Directions here = on_diagonal(b.K[i]);
    for (std::size_t c = 0; c < 6; ++c)
      held[c] = held[c] || here[c];
    const NodeLoads l = loads_of(b.K[i], i < b.C.size() ? b.C[i] : Matrix<6>(Matrix<6>::Zero()));
    loads = {loads.lateral || l.lateral, loads.tilting || l.tilting, loads.torque || l.torque};
  }
  return {.held = held,
          .loads = loads,
          .stiffness = none,
          .bias = Bias{b.setpoint, b.preload},
          .curves = curves_of(b),
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = true,
          .nonlinear = false,
          .needs_load = false,
          .mapped = held[1] || held[2],
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const RigidSupport& b) {
  return {.held = b.held,
          .loads = NodeLoads{},  // what is held does not move
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::as_constraint,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = false,
          .needs_load = false,
          .mapped = false,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const NonlinearSpring& b) {
  using Along = NonlinearSpring::Along;
  using Shape = ForceLaw::Shape;
  const bool radial = b.along == Along::radial;
  const Directions held{b.along == Along::x,           radial || b.along == Along::y,
                        radial || b.along == Along::z, b.along == Along::rx,
                        b.along == Along::ry,          b.along == Along::rz};
  const bool lateral = held[1] || held[2];
  const bool gap = b.force.shape == Shape::clearance || b.force.shape == Shape::one_sided;
  return {.held = held,
          .loads = NodeLoads{lateral, held[4] || held[5], held[3]},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = gap,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = lateral,
          .needs_load = false,
          .mapped = lateral && !gap,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const ShortJournal&) { return traits_of_journal(); }

SupportTraits traits(const FiniteJournal&) { return traits_of_journal(); }

std::vector<TiltingPadJournal::Pad> TiltingPadJournal::pads() const {
  std::vector<Pad> out = own;
  if (out.empty()) {
    out.assign(static_cast<std::size_t>(count), like);
    for (int k = 0; k < count; ++k)
      out[static_cast<std::size_t>(k)].pivot = first + two_pi * k / count;
  }
  for (Pad& p : out)
    if (p.clearance == 0) p.clearance = clearance;
  return out;
}

SupportTraits traits(const TiltingPadJournal&) { return traits_of_journal(); }

double FloatingRing::ring_mass() const {
  if (mass > 0) return mass;
  const double out = 0.5 * outer.diameter, in = bore();
  const double solid = pi * (out * out - in * in) * std::max(inner.length, outer.length);
  const double drilled = 0.25 * pi * holes.number * holes.diameter * holes.diameter * thickness();
  return ring_density * (solid - drilled);
}

double FloatingRing::ring_inertia() const {
  if (inertia > 0) return inertia;
  const double out = 0.5 * outer.diameter, in = bore();
  return 0.5 * ring_mass() * (out * out + in * in);
}

double FloatingRing::inner_clearance_at(double temperature) const {
  if (!heat) return inner.clearance;
  return inner.clearance +
         0.5 * inner.diameter * (heat->ring - heat->shaft) * (temperature - heat->reference);
}

double FloatingRing::outer_clearance_at(double temperature) const {
  if (!heat) return outer.clearance;
  return outer.clearance +
         0.5 * outer.diameter * (heat->housing - heat->ring) * (temperature - heat->reference);
}

SupportTraits traits(const FloatingRing&) { return traits_of_journal(); }

SupportTraits traits(const SqueezeFilm& b) {
  // the film alone carries nothing at rest
  return {.held = b.stiffness > 0 ? lateral_directions : no_direction,
          .loads = NodeLoads{.lateral = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = true,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = true,
          .needs_load = false,
          .mapped = b.stiffness != 0,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

/// The cage turns by (1 -+ lambda)/2 of what the rings do; lambda: diameter of an element, seen along the
/// axis, over that of the pitch circle.
static Passing elements_of(int count, double lambda) {
  return {0.5 * count * (1.0 - lambda), 0.5 * count * (1.0 + lambda)};
}

SupportTraits traits(const BallBearing& b) {
  return {.held = Directions{true, true, true, false, true, true},
          .loads = NodeLoads{.lateral = true, .tilting = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = b.clearance > 0,
          .rolling = true,
          .passing =
              elements_of(b.balls, b.ball_diameter * std::cos(b.contact_angle) / b.pitch_diameter),
          .follows_spin = false,
          .nonlinear = true,
          .needs_load = b.preload == 0 && b.clearance >= 0,
          .mapped = true,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const RollerBearing& b) {
  return {.held = Directions{false, true, true, false, true, true},
          .loads = NodeLoads{.lateral = true, .tilting = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = b.clearance > 0,
          .rolling = true,
          .passing = elements_of(b.rollers, b.roller_diameter / b.pitch_diameter),
          .follows_spin = false,
          .nonlinear = true,
          .needs_load = b.clearance >= 0,
          .mapped = true,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const RollingEstimate& b) {
  const EstimatedStiffness k = estimate_stiffness(b);
  return {.held = Directions{b.kxx > 0, true, true, false, false, false},
          .loads = NodeLoads{.lateral = true},
          .stiffness = linear_form(b).K,
          .bias = Bias{},
          .curves = Curves{{" along its load", {k.along}, {}}, {" across", {k.across}, {}}},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = false,
          .needs_load = false,
          .mapped = true,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

namespace {

double interpolate(int n, double at8, double at12, double at16) {
  const double x = std::clamp(static_cast<double>(n), 8.0, 16.0);
  return x < 12.0 ? at8 + (x - 8.0) / 4.0 * (at12 - at8) : at12 + (x - 12.0) / 4.0 * (at16 - at12);
}

EstimatedStiffness estimate_ball_bearing(int balls, double diameter, double load, double alpha) {
  const double k = 13e6 * std::pow(balls, 2.0 / 3.0) * std::cbrt(diameter * load) *
                   std::pow(std::cos(alpha), 5.0 / 3.0);
  return {k, k * interpolate(balls, 0.46, 0.64, 0.73)};
}

EstimatedStiffness estimate_roller_bearing(int rollers, double length, double load, double alpha) {
  const double k = 1e9 * std::pow(rollers, 0.9) * std::pow(length, 0.8) * std::pow(load, 0.1) *
                   std::pow(std::cos(alpha), 1.9);
  return {k, k * interpolate(rollers, 0.49, 0.66, 0.74)};
}

}  // namespace

EstimatedStiffness estimate_stiffness(const RollingEstimate& b) {
  return b.roller ? estimate_roller_bearing(b.elements, b.size, b.load, b.contact_angle)
                  : estimate_ball_bearing(b.elements, b.size, b.load, b.contact_angle);
}

LinearBearing linear_form(const RollingEstimate& b) {
  const EstimatedStiffness k = estimate_stiffness(b);
  const Mat2 turn = Eigen::Rotation2Dd(b.load_angle).toRotationMatrix();
  LinearBearing linear;
  linear.K.block<2, 2>(1, 1) = turn * Vec2(k.along, k.across).asDiagonal() * turn.transpose();
  linear.K(0, 0) = b.kxx;
  linear.C(1, 1) = linear.C(2, 2) = b.c_radial;
  return linear;
}

SupportTraits traits(const MagneticBearing& b) {
  return {.held = lateral_directions,
          .loads = NodeLoads{.lateral = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = true,  // with its control
          .needs_load = false,
          .mapped = false,
          .pair = none,
          .sensor = b.sensor_at ? &*b.sensor_at : nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const Rub& b) {
  return {.held = lateral_directions,
          .loads = NodeLoads{},  // stops are left most of the time
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = true,
          .rolling = false,
          .passing = none,
          .follows_spin = b.friction > 0,
          .nonlinear = true,
          .needs_load = false,
          .mapped = false,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const AnnularSeal&) {
  return {.held = lateral_directions,
          .loads = NodeLoads{.lateral = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = true,
          .nonlinear = false,
          .needs_load = false,
          .mapped = false,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const CrossCoupling&) {
  // circulatory: it holds nothing
  return {.held = no_direction,
          .loads = NodeLoads{.lateral = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = false,
          .nonlinear = false,
          .needs_load = false,
          .mapped = false,
          .pair = none,
          .sensor = nullptr,
          .picture = Picture::bearing};
}

bool is_unequal(const Coupling& c, double share) {
  constexpr double angle = 1.0;  // rad: a matrix that this leaves as it is, every angle does
  Matrix<6> turn = Matrix<6>::Identity();
  const Eigen::Matrix2d across = Eigen::Rotation2Dd(angle).toRotationMatrix();
  turn.block<2, 2>(1, 1) = turn.block<2, 2>(4, 4) = across;
  const auto changes = [&](const Matrix<6>& A, Index from) {
    const Matrix<6> change = turn * A * turn.transpose() - A;
    const double size = A.block<2, 2>(from, from).cwiseAbs().maxCoeff();
    return change.block<2, 2>(from, from).cwiseAbs().maxCoeff() > share * size + 1e-12 * size;
  };
  return changes(c.K, 1) || changes(c.K, 4) || changes(c.C, 1) || changes(c.C, 4);
}

SupportTraits traits(const Coupling& b) {
  return {.held = on_diagonal(b.K),
          .loads = NodeLoads{.lateral = true, .tilting = true, .torque = true},
          .stiffness = none,  // it turns with its shafts
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = false,
          .rolling = false,
          .passing = none,
          .follows_spin = !b.C.isZero(0.0),
          .nonlinear = false,
          .needs_load = false,
          .mapped = false,
          .pair = ShaftPair{.speed_ratio = 1, .noun = "coupling", .details = {}},
          .sensor = nullptr,
          .picture = Picture::bearing};
}

SupportTraits traits(const GearPair& b) {
  ShaftPair pair{.noun = "gear pair",
                 .details = fmt::format("({} and {} teeth)", b.teeth, b.other_teeth),
                 .mesh = true};
  pair.speed_ratio = -static_cast<double>(b.teeth) / b.other_teeth;
  const std::vector<double>& varying = b.stiffness_harmonics;
  const bool passes =
      std::any_of(varying.begin(), varying.end(), [](double x) { return x != 0.0; });
  // one direction in space: not counted as holding y and z
  return {.held = Directions{b.helix != 0, false, false, false, false, false},
          .loads = NodeLoads{.lateral = true, .tilting = b.helix != 0, .torque = true},
          .stiffness = none,
          .bias = Bias{},
          .curves = Curves{},
          .acts = Acts::between_nodes,
          .film = false,
          .gap = b.backlash >= 0,
          .rolling = false,
          .passing = passes ? std::optional(Passing{.own = static_cast<double>(b.teeth)}) : none,
          .follows_spin = false,
          .nonlinear = b.backlash >= 0,
          .needs_load = false,
          .mapped = false,
          .pair = std::move(pair),
          .sensor = nullptr,
          .picture = Picture::bearing};
}

}  // namespace whirl::model
