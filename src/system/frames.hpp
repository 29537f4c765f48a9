// The axes that (phi, gamma) of every node refer to: part of the state, changed between steps only.
//
// A node starts in the axes of its shaft line (e, e2, e3), its own axes. Where it tilts far from
// them it goes on in axes near its present normal, so that |gamma| stays well below pi: the motion
// goes on, its coordinates change. What the change may not touch:
//   - what acts on the axial angle (drives, springs, gears, counts of turns) means the angle about
//     the line's own axes. That is phi + shift + Omega(e, d, e0), Omega the solid angle of the
//     triangle, continuous in time (`lead` is its last value);
//   - two nodes of a shaft element compare their angles in the axes of the first. The second's is
//     phi + link + Omega(e_b, d, e_a), with link an angle between the two triads and as many whole
//     turns as the element is wound up by.
// While no node has moved all of this is absent.
#pragma once
#include <core/contract.hpp>
#include <core/rotation.hpp>
#include <core/types.hpp>
#include <cmath>
#include <span>
#include <vector>

namespace whirl::system {

class System;

struct Frames {
  std::vector<Mat3> chart;    ///< columns e, e2, e3: first each line's own, then those moved to
  std::vector<double> turns;  ///< whole turns taken out of phi, per line
  std::vector<int> of_node;   ///< number of the chart that a node stands in
  /// Per node, empty while none has moved: the line's own angle less phi, rad, at the last change,
  /// and at the last accepted state.
  std::vector<double> shift, lead;
  std::vector<double> link;  ///< per pair in System::links(), rad; empty while no node has moved
  /// Per follower of a joint, rad: its phi less what is expected of it (joints.hpp), which tells
  /// whole turns.
  std::vector<double> joint;
  /// What elements keep from one equilibrium to the next: temperatures of films, and what follows from
  /// them (Builder::keep). Empty where nothing does.
  std::vector<double> kept;
  /// 1/s: a motion in time changes it so from the time kept_from, s, on. Empty: it leaves it as it is.
  std::vector<double> kept_rate;
  double kept_from = 0;
  double kept_at(std::size_t i, double t) const {
    return kept_rate.empty() ? kept[i] : kept[i] + kept_rate[i] * (t - kept_from);
  }
  /// From the time t on it stays as it is then.
  void hold_kept(double t) {
    for (std::size_t i = 0; i < kept.size(); ++i)
      kept[i] = kept_at(i, t);
    kept_rate.clear();
  }

  bool moved() const { return chart.size() > turns.size(); }
  /// The axes that a node's phi and gamma refer to.
  const Mat3& axes(Index node) const {
    WHIRL_EXPECTS(node >= 0 && at(node) < of_node.size());
    return chart[at(of_node[at(node)])];
  }
  /// Nodes stand in the same axes.
  bool same_axes(Index a, Index b) const { return of_node[at(a)] == of_node[at(b)]; }
  /// The angle about its line's own axes less phi, of a node with the normal d, rad.
  /// @pre a node and a line of the system.
  double own_angle(Index node, Index line, const Vec3& d) const;

  /// Moves nodes to axes along e (P(e <- e_old) applied to those they stand in) and re-expresses
  /// their angles x, which come in the order of `nodes`. normals: of all nodes, global axes.
  /// @pre e is a unit vector, nodes not empty.
  void move(const System& system, std::span<const Index> nodes, const Vec3& e,
            std::span<const Vec3> normals, std::span<rotation::Angles> x);
  /// After an accepted state: what the continuous angles have become.
  void follow(const System& system, std::span<const Vec3> normals);

 private:
  void update_links(const System& system, Index node, const Vec3& old_e, double phi_change,
                    std::span<const Vec3> normals);
  void drop_unused();
};

/// How the angle of a node in axes with direction e is seen in other axes with direction f:
/// phi^ = phi + constant + Omega(e, d, f), 2 arg z(d), z = c + zeta.d. Linear z makes every
/// derivative a power of zeta/z.
struct AngleTransport {
  AngleTransport(const Vec3& e, const Vec3& f)
      : real(e + f),
        imaginary(f.cross(e)),
        constant(1.0 + e.dot(f)) {}
  Vec3 real, imaginary;
  double constant;

  struct At {
    double angle;  ///< Omega, rad, in (-2 pi, 2 pi)
    Vec3 slope;    ///< dOmega/dd
    Mat3 curvature;
    Vec3 slope_rate;   ///< curvature d'
    Vec3 slope_accel;  ///< curvature d'' + third derivative d' d'
  };
  At at(const Vec3& d, const Vec3& dd, const Vec3& ddd) const;
  double angle(const Vec3& d) const {
    return 2.0 * std::atan2(imaginary.dot(d), constant + real.dot(d));
  }
};

}  // namespace whirl::system
