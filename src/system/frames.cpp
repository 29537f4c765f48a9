#include <system/frames.hpp>

#include <core/contract.hpp>
#include <system/system.hpp>

#include <algorithm>

namespace whirl::system {

namespace {

/// The value of `angle` plus whole periods that is nearest to `to`.
double nearest(double angle, double period, double to) {
  return angle + period * std::round((to - angle) / period);
}

double solid_angle(const Vec3& e, const Vec3& d, const Vec3& f) {
  return AngleTransport(e, f).angle(d);
}

/// Angle about f, in (-pi, pi], from axes f to axes e brought along the shortest way.
double angle_between(const Mat3& e, const Mat3& f) {
  const Vec3 brought = rotation::minimal_rotation(e.col(0), f.col(0)) * e.col(1);
  return std::atan2(brought.dot(f.col(2)), brought.dot(f.col(1)));
}

}  // namespace

AngleTransport::At AngleTransport::at(const Vec3& d, const Vec3& dd, const Vec3& ddd) const {
  const Complex z(constant + real.dot(d), imaginary.dot(d));
  const Complex first = 1.0 / z, second = -first * first, third = -2.0 * first * second;
  const Complex along(real.dot(dd), imaginary.dot(dd)), onward(real.dot(ddd), imaginary.dot(ddd));
  // Im(zeta c), and of zeta zeta' c
  const auto vector = [&](Complex c) {
    return Vec3(2.0 * (c.imag() * real + c.real() * imaginary));
  };
  At out;
  out.angle = 2.0 * std::arg(z);
  out.slope = vector(first);
  out.curvature =
      vector(second) * real.transpose() + vector(second * Complex(0, 1)) * imaginary.transpose();
  out.slope_rate = vector(second * along);
  out.slope_accel = vector(second * onward + third * along * along);
  return out;
}

double Frames::own_angle(Index node, Index line, const Vec3& d) const {
  WHIRL_EXPECTS(at(node) < of_node.size() && at(line) < turns.size());
  if (shift.empty()) return 0.0;
  const Vec3 own = chart[at(line)].col(0);
  const double raw = shift[at(node)] + solid_angle(axes(node).col(0), d, own);
  return nearest(raw, 2.0 * two_pi, lead[at(node)]);
}

void Frames::move(const System& system, std::span<const Index> nodes, const Vec3& e,
                  std::span<const Vec3> normals, std::span<rotation::Angles> x) {
  WHIRL_EXPECTS(!nodes.empty() && x.size() == nodes.size());
  WHIRL_EXPECTS(normals.size() == of_node.size());
  WHIRL_EXPECTS(std::abs(e.norm() - 1.0) < 1e-9);
  if (shift.empty()) {
    shift.assign(of_node.size(), 0.0);
    lead = shift;
    link.assign(system.links().size(), 0.0);
  }
  const Mat3 old = axes(nodes.front());
  const rotation::ChartChange change(old, e);
  chart.push_back(change.new_triad());
  const int moved_to = static_cast<int>(chart.size()) - 1;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Index i = nodes[k];
    const double before = own_angle(i, system.node(i).line, normals[at(i)]);
    const rotation::Angles now = change.apply(x[k]);
    const double phi_change = now.phi - x[k].phi;
    x[k] = now;
    of_node[at(i)] = moved_to;
    const Vec3 own = chart[at(system.node(i).line)].col(0);
    lead[at(i)] = before - phi_change;
    shift[at(i)] = lead[at(i)] - solid_angle(e, normals[at(i)], own);
    update_links(system, i, old.col(0), phi_change, normals);
  }
  drop_unused();
}

void Frames::update_links(const System& system, Index node, const Vec3& old_e, double phi_change,
                          std::span<const Vec3> normals) {
  const Vec3 e = axes(node).col(0);
  for (std::size_t k = 0; k < link.size(); ++k) {
    const auto [a, b] = system.links()[k];
    if (a != node && b != node) continue;
    const Vec3& d = normals[at(b)];
    if (b == node) {
      const Vec3 first = axes(a).col(0);
      link[k] += solid_angle(old_e, d, first) - phi_change - solid_angle(e, d, first);
    } else {
      const Vec3 second = axes(b).col(0);
      link[k] +=
          solid_angle(second, d, old_e) + solid_angle(old_e, d, e) - solid_angle(second, d, e);
    }
    // the triads know it to the last digit, but for whole turns
    link[k] = nearest(angle_between(axes(b), axes(a)), two_pi, link[k]);
  }
}

void Frames::follow(const System& system, std::span<const Vec3> normals) {
  WHIRL_EXPECTS(normals.size() == of_node.size());
  for (std::size_t i = 0; i < shift.size(); ++i) {
    const Index node = static_cast<Index>(i);
    lead[i] = own_angle(node, system.node(node).line, normals[i]);
  }
}

void Frames::drop_unused() {
  const std::size_t lines = turns.size();
  std::vector<int> number(chart.size(), -1);
  std::vector<Mat3> stay(chart.begin(), chart.begin() + static_cast<std::ptrdiff_t>(lines));
  for (std::size_t l = 0; l < lines; ++l)
    number[l] = static_cast<int>(l);
  for (int& c : of_node) {
    int& n = number[static_cast<std::size_t>(c)];
    if (n < 0) {
      n = static_cast<int>(stay.size());
      stay.push_back(chart[static_cast<std::size_t>(c)]);
    }
    c = n;
  }
  chart = std::move(stay);
}

}  // namespace whirl::system
