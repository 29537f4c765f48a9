#include <analysis/spectra/whirl_mode.hpp>

#include <core/contract.hpp>
#include <la/multiply.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace whirl::analysis {

namespace {

/// Entries of the matrices are sums of some dozen rounded terms, and the equilibrium they are taken
/// at is known to a multiple of eps.
constexpr double roundings_an_entry = 64.0;

}  // namespace

double rounding_of(const la::Mode& m) {
  return roundings_an_entry * m.uncertainty + 1e-13 * std::abs(m.lambda);
}

std::string_view to_string(Direction d) {
  constexpr std::string_view names[] = {"forward", "backward", "mixed", "planar", "none"};
  return names[static_cast<int>(d)];
}
std::string_view to_string(ModeKind k) {
  constexpr std::string_view names[] = {"lateral", "torsional", "axial"};
  return names[static_cast<int>(k)];
}

Orbit orbit_of(Complex Y, Complex Z, double sense) {
  // y + i z = f e^(i w t) + b e^(-i w t)
  const Complex i(0, 1);
  const Complex f = 0.5 * (Y + i * Z);
  const Complex b = 0.5 * std::conj(Y - i * Z);
  Orbit o;
  o.forward = std::abs(sense < 0 ? b : f);
  o.backward = std::abs(sense < 0 ? f : b);
  o.major = o.forward + o.backward;
  o.minor = o.forward - o.backward;
  o.angle = o.forward > 0 && o.backward > 0 ? 0.5 * (std::arg(f) + std::arg(b)) : 0.0;
  return o;
}

Eigen::Vector3cd local_displacement(const Linearizer& linear, const VecXc& x, Index node) {
  WHIRL_EXPECTS(x.size() == linear.system().size());
  const Index line = linear.system().node(node).line;
  return linear.equilibrium().state.frames.chart[at(line)].transpose() * x.segment<3>(6 * node);
}

double likeness(const la::MCK& m, const VecXc& x, const VecXc& y) {
  WHIRL_EXPECTS(x.size() == y.size());
  VecXc mx, my;
  la::multiply(m.M, x, mx);
  la::multiply(m.M, y, my);
  const double a = std::abs(x.dot(mx)), b = std::abs(y.dot(my));
  return a > 0 && b > 0 ? std::norm(x.dot(my)) / (a * b) : 0.0;
}

namespace {

/// Energy of the components of one kind of motion. Films feed as well as store, and magnets take: what
/// is stored may be negative, and is then as large all the same.
struct Part {
  double kinetic = 0, stored = 0;
  double size() const { return std::max(kinetic, 0.0) + std::abs(stored); }
};

/// Shares of the energy by component, in axes of the line (e, e2, e3), and the kind of motion they
/// make it. Returns their sum.
double find_energy_shares(const la::MCK& m, const Linearizer& linear, WhirlMode& w) {
  const system::System& s = linear.system();
  VecXc mx, kx;
  la::multiply(m.M, w.x, mx);
  la::multiply(m.K, w.x, kx);
  Part lateral, torsional, axial;
  const double w2 = std::norm(w.lambda);
  const auto share = [](Complex a, Complex b) { return (std::conj(a) * b).real(); };
  for (Index i = 0; i < s.nodes(); ++i) {
    const auto x = w.x.segment<6>(6 * i);
    if (s.node(i).scalar || x.isZero(0.0)) continue;
    const Mat3& E = linear.equilibrium().state.frames.axes(i);
    const Eigen::Vector3cd u = E.transpose() * x.head<3>();
    const auto add = [&](const VecXc& force, double factor, double Part::*energy) {
      const Eigen::Matrix<Complex, 6, 1> f = factor * force.segment<6>(6 * i);
      const Eigen::Vector3cd g = E.transpose() * f.head<3>();
      axial.*energy += share(u[0], g[0]);
      lateral.*energy +=
          share(u[1], g[1]) + share(u[2], g[2]) + share(x[4], f[4]) + share(x[5], f[5]);
      torsional.*energy += share(x[3], f[3]);
    };
    add(mx, w2, &Part::kinetic);
    // where nothing oscillates potential and kinetic energy cancel: by the kinetic energy alone
    if (w.oscillates()) add(kx, 1.0, &Part::stored);
  }
  const double total = lateral.size() + torsional.size() + axial.size();
  if (total > 0) {
    w.lateral = lateral.size() / total;
    w.torsional = torsional.size() / total;
    w.axial = axial.size() / total;
  }
  w.kind = w.torsional > w.lateral && w.torsional >= w.axial ? ModeKind::torsional
           : w.axial > w.lateral                             ? ModeKind::axial
                                                             : ModeKind::lateral;
  return total;
}

/// The kind of a rigid motion without stiffness: by its largest part.
ModeKind kind_by_size(const Linearizer& linear, const WhirlMode& w) {
  const system::System& s = linear.system();
  double twist = 0, along = 0, across = 0;
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).scalar) continue;
    const Eigen::Vector3cd u = local_displacement(linear, w.x, i);
    twist = std::max(twist, std::abs(w.x[6 * i + 3]));
    along = std::max(along, std::abs(u[0]));
    across = std::max({across, std::abs(u[1]), std::abs(u[2])});
  }
  return twist > std::max(along, across) ? ModeKind::torsional
         : along > across                ? ModeKind::axial
                                         : ModeKind::lateral;
}

/// Scale: largest displacement (or twist) real and 1.
void normalise_shape(const system::System& s, WhirlMode& w) {
  constexpr double first_of_equals = 1.0 + 1e-9;
  Complex largest = 0;
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).scalar) continue;
    const auto x = w.x.segment<6>(6 * i);
    if (w.kind == ModeKind::torsional) {
      if (std::abs(x[3]) > first_of_equals * std::abs(largest)) largest = x[3];
    } else {
      for (int c = 0; c < 3; ++c)
        if (std::abs(x[c]) > first_of_equals * std::abs(largest)) largest = x[c];
    }
  }
  if (std::abs(largest) > 1e-12) w.x /= largest;
}

/// Direction of the whirl, from the orbits of displacements; of directors (d = e + gamma x e) where
/// the mode hardly moves sideways.
void find_direction(const Linearizer& linear, WhirlMode& w) {
  const system::System& s = linear.system();
  double top[2] = {0, 0};
  std::vector<std::array<Vec2, 2>> radius(
      at(s.nodes()), {Vec2::Zero(), Vec2::Zero()});  // (forward, backward) seen along the spin
  for (Index i = 0; i < s.nodes(); ++i) {
    if (s.node(i).scalar) continue;
    const Eigen::Vector3cd u = local_displacement(linear, w.x, i);
    const double sense = linear.sense(i);
    const Orbit o[2] = {orbit_of(u[1], u[2], sense),
                        orbit_of(w.x[6 * i + 5], -w.x[6 * i + 4], sense)};
    for (int k = 0; k < 2; ++k) {
      radius[at(i)][k] = Vec2(o[k].forward, o[k].backward);
      top[k] = std::max(top[k], o[k].major);
    }
  }
  double length = 0;
  for (Index i = 0; i < s.nodes(); ++i)
    length = std::max(length, (s.node(i).position - s.node(0).position).norm());
  const int k = top[0] < 1e-3 * top[1] * (length > 0 ? length : 1.0) ? 1 : 0;
  double area = 0, sum = 0, most = 0, least = 0;
  for (const auto& r : radius) {
    const double f = r[k][0] * r[k][0], b = r[k][1] * r[k][1];
    area += f - b;
    sum += f + b;
    // The direction of orbits below 3 % of the largest decides nothing.
    if (std::sqrt(f) + std::sqrt(b) > 0.03 * top[k]) {
      most = std::max(most, (f - b) / (f + b));
      least = std::min(least, (f - b) / (f + b));
    }
  }
  w.forwardness = sum > 0 ? area / sum : 0.0;
  const double flat =
      1e-6;  // far above the rounding of eigenvectors, far below any orbit one could see
  w.direction = most <= flat && least >= -flat ? Direction::planar
                : most > flat && least < -flat ? Direction::mixed
                : most > flat                  ? Direction::forward
                                               : Direction::backward;
}

}  // namespace

WhirlMode describe_mode(const la::Mode& mode, const la::MCK& m, const Linearizer& linear) {
  WHIRL_EXPECTS(mode.x.size() == linear.system().size());
  WhirlMode w;
  w.lambda = w.continued = mode.lambda;
  w.x = mode.x;
  linear.system().complete(linear.equilibrium().state, w.x);
  w.residual = mode.residual;
  w.from = mode.from;
  w.rounding = std::max(rounding_of(mode), la::unnoticed_growth * std::abs(mode.lambda));
  w.frequency = std::abs(mode.lambda.imag());
  const double size = std::abs(mode.lambda);
  w.damping_ratio = size > 0 ? -mode.lambda.real() / size : 0.0;
  w.log_decrement = w.frequency > 0          ? -two_pi * mode.lambda.real() / w.frequency
                    : mode.lambda.real() < 0 ? infinity
                    : mode.lambda.real() > 0 ? -infinity
                                             : 0.0;
  const double total = find_energy_shares(m, linear, w);
  if (total == 0.0 || w.lambda == 0.0) w.kind = kind_by_size(linear, w);
  if (total == 0.0)  // in the coordinates of joints alone
    (w.kind == ModeKind::lateral     ? w.lateral
     : w.kind == ModeKind::torsional ? w.torsional
                                     : w.axial) = 1.0;
  normalise_shape(linear.system(), w);
  if (w.kind == ModeKind::lateral && w.frequency != 0.0) find_direction(linear, w);
  return w;
}

namespace {

/// Lateral displacement of a node, or where a mode tilts it alone that of its axis.
Eigen::Vector2cd motion_across(const Linearizer& linear, const WhirlMode& w, Index node,
                               bool tilts) {
  if (tilts) return {w.x[6 * node + 5], -w.x[6 * node + 4]};
  return local_displacement(linear, w.x, node).tail<2>();
}

}  // namespace

void separate_pair(const Linearizer& linear, bool turning, WhirlMode& first, WhirlMode& second) {
  const system::System& s = linear.system();
  Index top = -1;
  bool tilts = false;
  for (const bool by_tilt : {false, true}) {
    double largest = 0.0;
    for (Index i = 0; i < s.nodes() && (!by_tilt || top < 0); ++i) {
      if (s.node(i).scalar) continue;
      const double size = motion_across(linear, first, i, by_tilt).squaredNorm() +
                          motion_across(linear, second, i, by_tilt).squaredNorm();
      constexpr double first_of_equals = 1.0 + 1e-9;
      if (!(size > first_of_equals * largest)) continue;
      largest = size;
      top = i;
    }
    tilts = by_tilt;
    if (top >= 0) break;
  }
  if (top < 0) return;
  Eigen::Matrix2cd u;
  u.col(0) = motion_across(linear, first, top, tilts);
  u.col(1) = motion_across(linear, second, top, tilts);
  const Complex det = u(0, 0) * u(1, 1) - u(0, 1) * u(1, 0);
  if (!(std::abs(det) > 1e-3 * u.col(0).norm() * u.col(1).norm())) return;
  const VecXc y = (u(1, 1) * first.x - u(1, 0) * second.x) / det;
  const VecXc z = (u(0, 0) * second.x - u(0, 1) * first.x) / det;
  const Complex ahead(0.0, -linear.sense(top));  // z against y of forward whirl
  first.x = turning ? VecXc(y - ahead * z) : y;
  second.x = turning ? VecXc(y + ahead * z) : z;
  for (WhirlMode* w : {&first, &second}) {
    normalise_shape(s, *w);
    find_direction(linear, *w);
  }
}

}  // namespace whirl::analysis
