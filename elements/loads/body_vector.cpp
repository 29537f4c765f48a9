#include <elements/loads/body_vector.hpp>
#include <cmath>

namespace whirl::elements {

BodyFrame::BodyFrame(const system::NodeState& s)
    : e(s.chart->col(0)),
      e2(s.chart->col(1)),
      e3(s.chart->col(2)),
      p(2.0 * e + s.t),
      n(s),
      D(2.0 + e.dot(s.t)),
      D1(e.dot(s.dd)),
      D2(e.dot(s.ddd)),
      cosine(std::cos(s.phi)),
      sine(std::sin(s.phi)) {}

BodyVector::BodyVector(const BodyFrame& f, double cos_beta, double sin_beta) {
  const double c = f.cosine * cos_beta - f.sine * sin_beta,
               s = f.sine * cos_beta + f.cosine * sin_beta;
  c_ = c * f.e2 + s * f.e3;
  c1_ = c * f.e3 - s * f.e2;
  alpha_ = f.n.t.dot(c_) / f.D;  // d.c = t.c: c is perpendicular to e
  alpha_d_ = (c_ - alpha_ * f.e) / f.D;
  alpha_phi_ = f.n.t.dot(c1_) / f.D;
  b = c_ - alpha_ * f.p;
  B.leftCols<3>() = -f.p * alpha_d_.transpose();
  B.diagonal().array() -= alpha_;
  B.col(3) = c1_ - alpha_phi_ * f.p;
}

void BodyVector::add_rates(const BodyFrame& f) {
  const auto& n = f.n;
  const double w = n.dphi, ww = w * w;
  const double n1 = n.dd.dot(c_) + w * n.t.dot(c1_);
  const double n2 =
      n.ddd.dot(c_) + 2.0 * w * n.dd.dot(c1_) + n.ddphi * n.t.dot(c1_) - ww * n.t.dot(c_);
  alpha1_ = (n1 - alpha_ * f.D1) / f.D;
  alpha2_ = (n2 - 2.0 * alpha1_ * f.D1 - alpha_ * f.D2) / f.D;
  rate = w * c1_ - alpha1_ * f.p - alpha_ * n.dd;
  accel = n.ddphi * c1_ - ww * c_ - alpha2_ * f.p - 2.0 * alpha1_ * n.dd - alpha_ * n.ddd;
}

void BodyVector::gradient_rates(const BodyFrame& f, Mat34& B_rate, Mat34& B_accel) const {
  const auto& n = f.n;
  const double w = n.dphi, ww = w * w;
  const Vec3 c_rate = w * c1_, c_accel = n.ddphi * c1_ - ww * c_;     // c' and c''
  const Vec3 c1_rate = -w * c_, c1_accel = -n.ddphi * c_ - ww * c1_;  // (dc/dphi)' and ''
  const Vec3 d1 = (c_rate - alpha1_ * f.e - f.D1 * alpha_d_) / f.D;
  const Vec3 d2 = (c_accel - alpha2_ * f.e - 2.0 * f.D1 * d1 - f.D2 * alpha_d_) / f.D;
  const double p1 = (n.dd.dot(c1_) + n.t.dot(c1_rate) - f.D1 * alpha_phi_) / f.D;
  const double p2 = (n.ddd.dot(c1_) + 2.0 * n.dd.dot(c1_rate) + n.t.dot(c1_accel) -
                     2.0 * f.D1 * p1 - f.D2 * alpha_phi_) /
                    f.D;
  B_rate.leftCols<3>() = -n.dd * alpha_d_.transpose() - f.p * d1.transpose();
  B_rate.diagonal().array() -= alpha1_;
  B_rate.col(3) = c1_rate - p1 * f.p - alpha_phi_ * n.dd;
  B_accel.leftCols<3>() =
      -n.ddd * alpha_d_.transpose() - 2.0 * n.dd * d1.transpose() - f.p * d2.transpose();
  B_accel.diagonal().array() -= alpha2_;
  B_accel.col(3) = c1_accel - p2 * f.p - 2.0 * p1 * n.dd - alpha_phi_ * n.ddd;
}

Mat4 BodyVector::hessian(const BodyFrame& f, const Vec3& A) const {
  // d2 alpha/dd2 = -(alpha_d e^T + e alpha_d^T)/D
  const double Ap = A.dot(f.p) / f.D;
  const Mat3 half = Ap * alpha_d_ * f.e.transpose() - A * alpha_d_.transpose();
  Mat4 h;
  h.topLeftCorner<3, 3>() = half + half.transpose();
  // dB_phi/dd is the gradient of the same function of dc/dphi
  const Vec3 alpha1_d = (c1_ - alpha_phi_ * f.e) / f.D;
  h.topRightCorner<3, 1>() = -A.dot(f.p) * alpha1_d - alpha_phi_ * A;
  h.bottomLeftCorner<1, 3>() = h.topRightCorner<3, 1>().transpose();
  h(3, 3) = -A.dot(b);
  return h;
}

}  // namespace whirl::elements
