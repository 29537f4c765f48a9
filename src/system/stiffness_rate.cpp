#include <system/stiffness_rate.hpp>

#include <core/rotation.hpp>

#include <map>

namespace whirl::system {
namespace {

std::map<std::type_index, AddStiffnessRates>& known() {
  static std::map<std::type_index, AddStiffnessRates> table;
  return table;
}

/// dX/dq of a node from dd/dgamma.
Eigen::Matrix<double, 7, 6> jacobian(const Mat32& D) {
  Eigen::Matrix<double, 7, 6> J = Eigen::Matrix<double, 7, 6>::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J(6, spin_phi) = 1.0;
  J.block<3, 2>(3, 4) = D;
  return J;
}

/// How it changes as the director moves at d', for one and the same small rotation of the node, w =
/// W (dphi, dgamma): dd = w x d, dphi = (e + d).w/(1 + e.d).
Eigen::Matrix<double, 7, 6> jacobian_rate(const Mat3& chart, const Vec2& gamma, const Vec3& t,
                                          const Vec3& d_rate) {
  Mat3 W;
  W.col(0) = chart * rotation::omega_of_rates(gamma, 1.0, Vec2::Zero());
  W.col(1) = chart * rotation::omega_of_rates(gamma, 0.0, Vec2::UnitX());
  W.col(2) = chart * rotation::omega_of_rates(gamma, 0.0, Vec2::UnitY());
  const Vec3 e = chart.col(0);
  const double D = 2.0 + e.dot(t);
  const Vec3 axis_rate = d_rate / D - (e.dot(d_rate) / (D * D)) * (2.0 * e + t);
  Eigen::Matrix<double, 7, 6> J = Eigen::Matrix<double, 7, 6>::Zero();
  for (int c = 0; c < 3; ++c)
    J.block<3, 1>(3, 3 + c) = W.col(c).cross(d_rate);
  J.block<1, 3>(6, 3) = axis_rate.transpose() * W;
  return J;
}

}  // namespace

RelativeMotion::RelativeMotion(const StiffnessMotion& m, const std::array<Index, 2>& nodes) {
  std::array<Vec3, 2> place, velocity, omega;
  std::array<double, 2> phi_rate;
  for (std::size_t a = 0; a < 2; ++a) {
    const Index k = 6 * nodes[a];
    const NodeDef& node = m.system.node(nodes[a]);
    chart[a] = m.frames.axes(nodes[a]);
    gamma[a] = m.q.segment<2>(k + 4);
    gamma_rate[a] = m.direction.segment<2>(k + 4);
    phi_rate[a] = m.direction[k + spin_phi];
    place[a] = node.position + m.q.segment<3>(k);
    velocity[a] = m.direction.segment<3>(k);
    omega[a] = chart[a] * rotation::omega_of_rates(gamma[a], phi_rate[a], gamma_rate[a]);
  }
  const Vec3 chord = place[1] - place[0];
  const Vec3 mean = 0.5 * (omega[0] + omega[1]);
  Vec3 turn = mean;
  if (chord.squaredNorm() > 0.0)
    turn = (chord.cross(velocity[1] - velocity[0]) + chord.dot(mean) * chord) / chord.squaredNorm();
  const Vec3 middle = 0.5 * (place[0] + place[1]);
  const Vec3 move = 0.5 * (velocity[0] + velocity[1]);
  for (std::size_t a = 0; a < 2; ++a) {
    const rotation::ChartRates whole =
        rotation::rates_of_omega(gamma[a], chart[a].transpose() * turn);
    gamma_rate[a] -= whole.gamma;
    rotation::Director d;
    rotation::director(gamma[a], gamma_rate[a], Vec2::Zero(), d);
    J[a] = jacobian(chart[a] * d.D);
    J_rate[a] = jacobian_rate(chart[a], gamma[a], chart[a] * d.t, chart[a] * d.rate);
    rate[a].u = velocity[a] - move - turn.cross(place[a] - middle);
    rate[a].t = chart[a] * d.rate;
    rate[a].phi = phi_rate[a] - whole.phi;
  }
}

Mat2 curvature_rate(const RelativeMotion& m, std::size_t node, const Vec3& f, const Vec3& df) {
  rotation::Director d;
  rotation::director(m.gamma[node], d);
  const Mat2 change = d.curvature(m.chart[node].transpose() * df);
  const double size = m.gamma_rate[node].norm();
  if (size == 0.0 || f.isZero(0.0)) return change;
  // how the curvature turns under the force that is there at rest: a smooth function of two angles,
  // fourth-order difference, 0.01 rad
  const Vec3 at_rest = m.chart[node].transpose() * f;
  const double h = 0.01 / size;
  const auto shifted = [&](double step) {
    rotation::director(m.gamma[node] + step * m.gamma_rate[node], d);
    return d.curvature(at_rest);
  };
  const Mat2 near = shifted(h) - shifted(-h);
  const Mat2 far = shifted(2.0 * h) - shifted(-2.0 * h);
  return change + (8.0 * near - far) / (12.0 * h);
}

void know_stiffness_rate(std::type_index batch, AddStiffnessRates add) {
  known().emplace(batch, add);
}

AddStiffnessRates find_stiffness_rate(const Term& batch) {
  const auto it = known().find(std::type_index(typeid(batch)));
  return it == known().end() ? nullptr : it->second;
}

void add_stiffness_rate(const StiffnessMotion& motion, double weight, la::BlockMatrix<6>& out) {
  for (const auto& term : motion.system.terms())
    if (const AddStiffnessRates add = find_stiffness_rate(*term)) add(*term, motion, weight, out);
}

}  // namespace whirl::system
