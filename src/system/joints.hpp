// Joints without penalty: a node whose motion is that of another one and of the joint's own
// coordinates. Nothing is added to the equations; unknowns go.
//
// A follower b has X_b = X_b(X_a, angle, slide) (joint_map.hpp), a its parent, angle and slide
// scalars of nodes of their own, unbounded. A pinned follower keeps its own rotation, and only u_b
// follows. Elements see b as any other node. What they leave there is carried to what b follows,
//   f_a += J^T f_b,   M J,   C J + 2 M J',   K J + C J' + M J'' + f_b . d2X_b/dxi2
// as node.hpp has it for charts, before these. So M and K stay symmetric where they were, the
// system stays an ordinary differential equation, and whatever counts its eigenvalues holds on.
//
// The entries of q, v, a of a follower that are no unknowns hold its place all the same, u, phi,
// gamma in its own axes, written by System::follow. No force depends on them; results read them.
// The entries of a residual there hold the load of the joint: force and moment on b, global axes.
//
// phi_b is known from R_b but for whole turns. They are those nearest to phi_a e_a.e_b + angle
// n.e_b (signs only), which follows spin of any speed, plus Frames::joint, kept after every step.
#pragma once
#include <la/block.hpp>
#include <system/batch.hpp>
#include <system/joint_map.hpp>
#include <string>
#include <vector>

namespace whirl::system {

struct State;

/// What a builder is told.
struct FollowerDef {
  Index node = -1;               ///< b; all of it that follows stops being unknown
  Index parent = -1;             ///< a: may follow another node itself
  bool pinned = false;           ///< only the place follows
  Index angle = -1, slide = -1;  ///< scalar nodes, rad and m; -1: none
  Vec3 axis = Vec3::UnitX();     ///< unit vector in the reference, of angle and slide
  std::string joint;             ///< for messages: "joint 'elbow'"
  bool between = false;          ///< b only stands between others: it has no place of its own
};

/// All followers of a system, parents before those that follow them.
class Followers {
 public:
  bool empty() const { return list_.empty(); }
  std::size_t count() const { return list_.size(); }
  const FollowerDef& operator[](std::size_t k) const { return list_[k].def; }
  /// The follower at a node, or null.
  const FollowerDef* find(Index node) const {
    const int k = empty() ? -1 : of_node_[static_cast<std::size_t>(node)];
    return k < 0 ? nullptr : &list_[static_cast<std::size_t>(k)].def;
  }

  /// The follower whose angle or slide a scalar node is, or null.
  const FollowerDef* find_coordinate(Index node) const;

  /// axes: what Frames::axes says of every line in the reference. Appends to `couplings` what the
  /// pattern must hold beside what elements couple.
  /// @throws std::invalid_argument: a node follows twice, or itself.
  void arrange(std::vector<FollowerDef> defs, const std::vector<Vec3>& positions,
               const std::vector<Mat3>& axes_of_node,
               std::vector<std::pair<Index, Index>>& couplings);
  void bind(const la::BlockPattern& p);

  /// Writes the places of followers into q, their rates into v and a. False when one cannot be
  /// written in its axes (a tilt of pi).
  bool follow(const Frames& f, Eigen::Ref<VecX> q, Eigen::Ref<VecX> v, Eigen::Ref<VecX> a) const;
  /// Frames::joint of a state whose followers stand where follow() puts them.
  void keep_turns(Frames& f, Eigen::Ref<const VecX> q) const;
  /// Carries w.force to what is followed; r: residual, whose entries at followers get their loads.
  void carry_force(Workspace& w, const Frames& f, Eigen::Ref<VecX> loads) const;
  /// Carries w.force and w.M, w.C, w.K.
  void carry_tangent(Workspace& w, const Frames& f) const;
  /// x, small motions of the unknowns about the state last evaluated, gets those of followers.
  template <class Scalar>
  void complete(const Workspace& w, const Frames& f, Eigen::Matrix<Scalar, -1, 1>& x) const;
  /// The transposed: generalised forces on the coordinates of followers go to the unknowns.
  template <class Scalar>
  void reduce(const Workspace& w, const Frames& f, Eigen::Matrix<Scalar, -1, 1>& x) const;

 private:
  struct Follower {
    FollowerDef def;
    Vec3 arm, normal;     ///< in the reference: from a to b, m; axis of b
    Mat3 start, start_b;  ///< axes of a and b in the reference
    /// Of every node j that b's block row holds: slots (b, j), (j, b), and for a, angle, slide
    /// those of (input, j), (j, input); -1: not there.
    struct Slots {
      Index node, row, column;
      std::array<Index, 3> input_row, input_column;
    };
    std::vector<Slots> slots;
    std::array<std::array<Index, 3>, 3> among{};  ///< slots of pairs of inputs
  };
  struct Jacobians;
  static std::array<Index, 3> inputs_of(const FollowerDef& d) {
    return {d.parent, d.angle, d.slide};
  }
  joints::Axes axes(const Follower& b, const Frames& f) const;
  static double expected(const joints::Axes& k, double phi, double angle);
  void jacobians(const Follower& b, const Workspace& w, const Frames& f, Jacobians& out) const;
  Matrix<joints::inputs> curvature(const Follower& b, const Workspace& w, const Frames& f,
                                   const Vector<7>& force) const;

  std::vector<Follower> list_;
  std::vector<int> of_node_;
};

}  // namespace whirl::system
