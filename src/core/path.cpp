#include <core/path.hpp>

#include <core/rotation.hpp>

#include <algorithm>
#include <cmath>

namespace whirl {
namespace {

/// Points closer than this part of their size are one point: written lengths have fewer digits.
constexpr double same_point = 1e-9;

/// minimal_rotation, and half a turn about z (or y) where a = -b has none.
Mat3 least_turn(const Vec3& a, const Vec3& b) {
  if (1.0 + a.dot(b) > 1e-12) return rotation::minimal_rotation(a, b);
  Vec3 axis = Vec3::UnitZ() - a.z() * a;
  if (axis.squaredNorm() < 0.5) axis = Vec3::UnitY() - a.y() * a;
  return rotation::L(pi * axis.normalized());
}

}  // namespace

bool Path::append(const Vec3& tangent, double length, const Vec3& turn, const Vec3& centre) {
  Piece p;
  p.s0 = this->length();
  p.s1 = p.s0 + length;
  p.r = end_;
  p.turn = turn;
  p.centre = centre;
  const Mat3 last =
      pieces_.empty() ? Mat3::Identity() : on(pieces_.back(), pieces_.back().s1).triad;
  p.triad = least_turn(last.col(0), tangent) * last;
  p.triad.col(0) = tangent;
  pieces_.push_back(p);
  end_ = on(p, p.s1).r;
  return true;
}

bool Path::add_line(const Vec3& to) {
  const Vec3 step = to - end_;
  const double l = step.norm();
  if (!(l > same_point * std::max(to.norm(), end_.norm()))) return false;
  append(step / l, l, Vec3::Zero(), Vec3::Zero());
  end_ = to;
  return true;
}

bool Path::add_arc_through(const Vec3& middle, const Vec3& to) {
  // circle through end_, middle, to
  const Vec3 a = middle - end_, b = to - end_, n = a.cross(b);
  const double n2 = n.squaredNorm();
  if (!(std::sqrt(n2) > same_point * a.norm() * b.norm()) ||
      !((to - middle).norm() > same_point * b.norm()))
    return false;
  const Vec3 centre =
      end_ + (a.squaredNorm() * b.cross(n) + b.squaredNorm() * n.cross(a)) / (2.0 * n2);
  const Vec3 axis = n / std::sqrt(n2), x = end_ - centre, y = axis.cross(x);
  double angle = std::atan2((to - centre).dot(y), (to - centre).dot(x));
  if (angle <= 0) angle += two_pi;
  if (!add_arc_about(centre, axis, angle)) return false;
  end_ = to;
  return true;
}

bool Path::add_arc_about(const Vec3& centre, const Vec3& axis, double angle) {
  const double size = axis.norm();
  if (!(size > 0) || angle == 0 || !(std::abs(angle) <= 2 * two_pi)) return false;
  const Vec3 n = axis / size, arm = end_ - centre, across = arm - n.dot(arm) * n;
  const double R = across.norm();
  if (!(R > same_point * std::max({arm.norm(), end_.norm(), centre.norm()}))) return false;
  const double sign = angle > 0 ? 1.0 : -1.0;
  return append(sign / R * n.cross(across), R * std::abs(angle), sign / R * n, end_ - across);
}

Path::Point Path::on(const Piece& p, double s) {
  Point x;
  const double d = s - p.s0;
  if (p.turn.isZero(0.0)) {
    x.r = p.r + d * p.triad.col(0);
    x.triad = p.triad;
    return x;
  }
  const Mat3 R = rotation::L(d * p.turn);
  x.r = p.centre + R * (p.r - p.centre);
  x.triad = R * p.triad;
  return x;
}

Path::Point Path::at(double s, bool before) const {
  if (pieces_.empty()) return {start_ + Vec3(s, 0, 0), Mat3::Identity()};
  std::size_t k = 0;
  const double slack = same_point * length();
  while (k + 1 < pieces_.size() &&
         (before ? s > pieces_[k].s1 + slack : s >= pieces_[k].s1 - slack))
    ++k;
  Point x = on(pieces_[k], std::min(std::max(s, pieces_[k].s0), pieces_[k].s1));
  const double beyond = s < 0 ? s : std::max(s - length(), 0.0);
  x.r += beyond * x.triad.col(0);
  return x;
}

std::vector<double> Path::joints() const {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < pieces_.size(); ++k)
    out.push_back(pieces_[k].s1);
  return out;
}

}  // namespace whirl
