#include <elements/rigid/turning_base.hpp>
#include <core/contract.hpp>

#include <core/rotation.hpp>

namespace whirl::elements {

AbsoluteNode::AbsoluteNode(const system::NodeState& n, const TurningBase::Motion& b, double load,
                           const Vec3& arm)
    : state(n) {
  WHIRL_EXPECTS(n.chart != nullptr && arm.allFinite());
  const Vec3 r = arm + n.u, d = n.d(), e = n.e();
  const Vec3 wr = b.omega.cross(r), wd = b.omega.cross(d);
  state.du += wr;
  state.ddu += load * b.gravity_change + b.omega.cross(2.0 * n.du + wr) + b.alpha.cross(r);
  state.dd += wd;
  state.ddd += b.omega.cross(2.0 * n.dd + wd) + b.alpha.cross(d);
  const double D = 2.0 + e.dot(n.t);
  const Vec3 w = n.spin_form();
  state.dphi += b.omega.dot(e + d) / D;
  state.ddphi += w.dot(state.ddd - n.ddd) -
                 (w.dot(state.dd) * e.dot(state.dd) - w.dot(n.dd) * e.dot(n.dd)) / D +
                 b.alpha.dot(d) + b.omega.dot(n.dd);
}

void AbsoluteNode::derive(const system::NodeState& n, const TurningBase::Motion& b) {
  const Vec3 d = n.d(), e = n.e(), w = n.spin_form();
  const double D = 2.0 + e.dot(n.t);
  const Mat3 O = skew(b.omega), S = O * O + skew(b.alpha), W = (skew(e) - w * e.transpose()) / D;
  rate_position.setZero();
  accel_rate.setZero();
  accel_position.setZero();
  for (int k : {0, 3}) {
    rate_position.block<3, 3>(k, k) = O;
    accel_rate.block<3, 3>(k, k) = 2.0 * O;
    accel_position.block<3, 3>(k, k) = S;
  }
  rate_position.block<1, 3>(6, 3) = (b.omega / D - b.omega.dot(e + d) / (D * D) * e).transpose();
  const Vec3 dd = state.dd;  // absolute
  const double wa = w.dot(dd), ea = e.dot(dd), wr = w.dot(n.dd), er = e.dot(n.dd);
  accel_rate.block<1, 3>(6, 3) =
      (2.0 * O.transpose() * w - (w * (ea - er) + e * (wa - wr)) / D + b.omega).transpose();
  const Vec3 d_wa = W.transpose() * dd + O.transpose() * w, d_ea = O.transpose() * e,
             d_wr = W.transpose() * n.dd;
  accel_position.block<1, 3>(6, 3) =
      (W.transpose() * (state.ddd - n.ddd) + S.transpose() * w -
       (d_wa * ea + wa * d_ea - d_wr * er) / D + (wa * ea - wr * er) / (D * D) * e + b.alpha)
          .transpose();
}

}  // namespace whirl::elements
