// A line in space made of straight pieces and circular arcs, with section axes carried along it
// without twist.
//
// Triad of a place: columns (tangent, y, z). At the start it is the least rotation of the global
// axes that brings x to the tangent; along an arc and across a corner it turns by the least
// rotation again (Bishop's frame). A corner has two triads, one before and one after it.
#pragma once
#include <core/types.hpp>
#include <vector>

namespace whirl {

class Path {
 public:
  Path() = default;
  explicit Path(const Vec3& start) : start_(start), end_(start) {}

  bool empty() const { return pieces_.empty(); }
  double length() const { return pieces_.empty() ? 0.0 : pieces_.back().s1; }
  const Vec3& start() const { return start_; }
  const Vec3& end() const { return end_; }

  /// Each appends a piece at the end and returns false, leaving the path as it was, where there is
  /// no such piece: no length; three points in a line or two that are one; an end on the axis of
  /// the arc, or no angle.
  bool add_line(const Vec3& to);
  bool add_arc_through(const Vec3& middle, const Vec3& to);
  /// About an axis through `centre`, by `angle`, rad; at most two whole turns.
  bool add_arc_about(const Vec3& centre, const Vec3& axis, double angle);

  struct Point {
    Vec3 r = Vec3::Zero();          ///< m
    Mat3 triad = Mat3::Identity();  ///< tangent, y, z
  };
  /// At distance s from the start, m; straight on beyond both ends. At a joint of two pieces: the
  /// end of the one before, or the start of the next.
  Point before(double s) const { return at(s, true); }
  Point after(double s) const { return at(s, false); }
  /// Where pieces join, from the start, m (without both ends).
  std::vector<double> joints() const;

 private:
  struct Piece {
    double s0, s1;  ///< m
    Vec3 r;         ///< start
    Mat3 triad;     ///< at the start
    Vec3 turn;      ///< rotation vector per length, rad/m; zero: straight
    Vec3 centre;    ///< of the arc
  };
  Point at(double s, bool before) const;
  static Point on(const Piece& p, double s);
  bool append(const Vec3& tangent, double length, const Vec3& turn, const Vec3& centre);

  Vec3 start_ = Vec3::Zero(), end_ = Vec3::Zero();
  std::vector<Piece> pieces_;
};

}  // namespace whirl
