#include <system/joints.hpp>

#include <core/rotation.hpp>
#include <system/system.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace whirl::system {

namespace {

using joints::First;
using joints::Rate;
using Jacobian = Eigen::Matrix<double, 7, 7>;
using Column = Eigen::Matrix<double, 7, 1>;

double sign_of(double cosine) { return std::abs(cosine) < 0.1 ? 0.0 : cosine > 0.0 ? 1.0 : -1.0; }

/// u, d, phi of a function's outputs: phi = 2 arg z.
template <class S>
std::array<S, 7> entries(const joints::Outputs<S>& o) {
  using std::atan2;
  return {o.u.x, o.u.y, o.u.z, o.t.x, o.t.y, o.t.z, 2.0 * atan2(o.imaginary, o.real)};
}

Rate<double> rate_of(double v, double d, double dd) { return {v, d, dd}; }
Rate<First> rate_of(double v, double d, double dd, int k) {
  return {First::variable(v, k), First(d), First(dd)};
}

/// The state of node i of q, v, a (gravity left out).
NodeState state_of(const Frames& f, Index i, const Eigen::Ref<const VecX>& q,
                   const Eigen::Ref<const VecX>& v, const Eigen::Ref<const VecX>& a) {
  const Mat3& E = f.axes(i);
  rotation::Director o;
  rotation::director(q.segment<2>(6 * i + gamma2), v.segment<2>(6 * i + gamma2),
                     a.segment<2>(6 * i + gamma2), o);
  NodeState n;
  n.u = q.segment<3>(6 * i);
  n.du = v.segment<3>(6 * i);
  n.ddu = a.segment<3>(6 * i);
  n.t = E * o.t;
  n.dd = E * o.rate;
  n.ddd = E * o.accel;
  n.phi = q[6 * i + spin_phi];
  n.dphi = v[6 * i + spin_phi];
  n.ddphi = a[6 * i + spin_phi];
  n.chart = &E;
  return n;
}

}  // namespace

struct Followers::Jacobians {
  Jacobian a, a_rate, a_accel;               ///< dX_b/dX_a, dX_b'/dX_a, dX_b''/dX_a
  std::array<Column, 2> c, c_rate, c_accel;  ///< of angle and slide
};

void Followers::arrange(std::vector<FollowerDef> defs, const std::vector<Vec3>& positions,
                        const std::vector<Mat3>& axes_of_node,
                        std::vector<std::pair<Index, Index>>& couplings) {
  if (defs.empty()) return;
  of_node_.assign(positions.size(), -1);
  std::vector<unsigned char> follows(positions.size(), 0);
  for (const FollowerDef& d : defs) {
    if (follows[at(d.node)]) throw std::invalid_argument(d.joint + ": its node follows twice");
    follows[at(d.node)] = 1;
  }
  while (!defs.empty()) {  // parents first
    const auto next = std::find_if(defs.begin(), defs.end(), [&](const FollowerDef& d) {
      return !follows[at(d.parent)] || of_node_[at(d.parent)] >= 0;
    });
    if (next == defs.end())
      throw std::invalid_argument(defs[0].joint + ": nodes follow each other");
    Follower b;
    b.def = *next;
    b.def.axis.normalize();
    b.arm = positions[at(b.def.node)] - positions[at(b.def.parent)];
    b.start = axes_of_node[at(b.def.parent)];
    b.start_b = axes_of_node[at(b.def.node)];
    b.normal = b.start_b.col(0);
    of_node_[at(b.def.node)] = static_cast<int>(list_.size());
    list_.push_back(std::move(b));
    defs.erase(next);
  }
  // What b couples with couples with what b follows, from the last follower on.
  std::vector<std::set<Index>> row(positions.size());
  for (const auto& [i, j] : couplings) {
    row[at(i)].insert(j);
    row[at(j)].insert(i);
  }
  for (std::size_t k = list_.size(); k-- > 0;) {
    const FollowerDef& d = list_[k].def;
    std::set<Index> met = row[at(d.node)];
    met.insert(d.node);
    for (const Index p : inputs_of(d))
      if (p >= 0) met.insert(p);
    for (const Index p : inputs_of(d))
      for (const Index j : met)
        if (p >= 0 && p != j) {
          row[at(p)].insert(j);
          row[at(j)].insert(p);
          couplings.emplace_back(p, j);
        }
  }
}

const FollowerDef* Followers::find_coordinate(Index node) const {
  for (const Follower& b : list_)
    if (b.def.angle == node || b.def.slide == node) return &b.def;
  return nullptr;
}

void Followers::bind(const la::BlockPattern& p) {
  const auto slot = [&p](Index i, Index j) { return i < 0 || j < 0 ? -1 : p.slot(i, j); };
  for (Follower& b : list_) {
    const auto in = inputs_of(b.def);
    const Index node = b.def.node;
    for (Index s = p.row_start()[at(node)]; s < p.row_start()[at(node) + 1]; ++s) {
      const Index j = p.cols()[at(s)];
      Follower::Slots x{j, s, p.slot(j, node), {}, {}};
      for (std::size_t k = 0; k < 3; ++k) {
        x.input_row[k] = slot(in[k], j);
        x.input_column[k] = slot(j, in[k]);
      }
      b.slots.push_back(x);
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        b.among[k][l] = slot(in[k], in[l]);
  }
}

joints::Axes Followers::axes(const Follower& b, const Frames& f) const {
  const Mat3 &E = f.axes(b.def.parent), &E_b = f.axes(b.def.node);
  joints::Axes k;
  k.e = E.col(0);
  k.e_b = E_b.col(0);
  k.arm0 = b.arm;
  if (f.moved()) {
    const Mat3 C = E * b.start.transpose(), C_b = E_b * b.start_b.transpose();
    const Eigen::Quaterniond q(Mat3(C * C_b.transpose()));
    k.normal = C * b.normal;
    k.axis = C * b.def.axis;
    k.arm = C * b.arm;
    k.k0 = q.w();
    k.k = q.vec();
  } else {
    k.normal = b.normal;
    k.axis = b.def.axis;
    k.arm = b.arm;
    k.k0 = 1.0;
    k.k.setZero();
  }
  return k;
}

double Followers::expected(const joints::Axes& k, double phi, double angle) {
  // the axis as b's own axes have it
  const Vec3 axis = k.axis + 2.0 * k.k.cross(k.k.cross(k.axis)) - 2.0 * k.k0 * k.k.cross(k.axis);
  return sign_of(k.e.dot(k.e_b)) * phi + sign_of(axis.dot(k.e_b)) * angle;
}

bool Followers::follow(const Frames& f, Eigen::Ref<VecX> q, Eigen::Ref<VecX> v,
                       Eigen::Ref<VecX> a) const {
  for (std::size_t n = 0; n < list_.size(); ++n) {
    const Follower& b = list_[n];
    const FollowerDef& d = b.def;
    const Index i = 6 * d.node, p = 6 * d.parent;
    if (d.pinned) {
      for (auto* x : {&q, &v, &a})
        x->segment<3>(i) = x->segment<3>(p);
      continue;
    }
    if (!(q.segment<2>(p + gamma2).norm() < pi)) return false;
    const NodeState s = state_of(f, d.parent, q, v, a);
    const joints::Axes k = axes(b, f);
    using S = Rate<double>;
    joints::Inputs<S> in;
    in.t = {rate_of(s.t.x(), s.dd.x(), s.ddd.x()), rate_of(s.t.y(), s.dd.y(), s.ddd.y()),
            rate_of(s.t.z(), s.dd.z(), s.ddd.z())};
    in.phi = rate_of(s.phi, s.dphi, s.ddphi);
    const auto scalar = [&](Index node) {
      return node < 0 ? S(0.0) : rate_of(q[6 * node], v[6 * node], a[6 * node]);
    };
    in.angle = scalar(d.angle);
    in.slide = scalar(d.slide);
    const std::array<S, 7> x = entries(joints::place(k, in));
    const Mat3 E = f.axes(d.node).transpose();
    const Vec3 t = E * Vec3(x[3].v, x[4].v, x[5].v);
    if (!(t.x() > -2.0 + 1e-12)) return false;
    const Vec3 rate = E * Vec3(x[3].d, x[4].d, x[5].d), accel = E * Vec3(x[3].dd, x[4].dd, x[5].dd);
    for (Index c = 0; c < 3; ++c) {
      const S& u = x[at(c)];
      q[i + c] = s.u[c] + u.v;
      v[i + c] = s.du[c] + u.d;
      a[i + c] = s.ddu[c] + u.dd;
    }
    const double wanted = expected(k, in.phi.v, in.angle.v) + (f.joint.empty() ? 0.0 : f.joint[n]);
    q[i + spin_phi] = x[6].v + two_pi * std::round((wanted - x[6].v) / two_pi);
    v[i + spin_phi] = x[6].d;
    a[i + spin_phi] = x[6].dd;
    const Vec2 gamma = rotation::gamma_of_director(t);
    rotation::Director o;
    rotation::director(gamma, o);
    const Eigen::Matrix<double, 2, 3> back =
        Mat2(o.D.transpose() * o.D).inverse() * o.D.transpose();
    const Vec2 gamma_rate = back * rate;
    rotation::director(gamma, gamma_rate, Vec2::Zero(), o);
    q.segment<2>(i + gamma2) = gamma;
    v.segment<2>(i + gamma2) = gamma_rate;
    a.segment<2>(i + gamma2) = back * (accel - o.accel);
  }
  return true;
}

void Followers::keep_turns(Frames& f, Eigen::Ref<const VecX> q) const {
  for (std::size_t n = 0; n < list_.size(); ++n) {
    const Follower& b = list_[n];
    const FollowerDef& d = b.def;
    if (d.pinned) continue;
    const double angle = d.angle < 0 ? 0.0 : q[6 * d.angle];
    f.joint[n] = q[6 * d.node + spin_phi] - expected(axes(b, f), q[6 * d.parent + spin_phi], angle);
  }
}

void Followers::jacobians(const Follower& b, const Workspace& w, const Frames& f,
                          Jacobians& out) const {
  const NodeState& s = w.nodes[at(b.def.parent)];
  const joints::Axes k = axes(b, f);
  using S = Rate<First>;
  joints::Inputs<S> in;
  in.t = {rate_of(s.t.x(), s.dd.x(), s.ddd.x(), 0), rate_of(s.t.y(), s.dd.y(), s.ddd.y(), 1),
          rate_of(s.t.z(), s.dd.z(), s.ddd.z(), 2)};
  in.phi = rate_of(s.phi, s.dphi, s.ddphi, 3);
  const auto scalar = [&](Index node, int number) {
    if (node < 0) return S(0.0);
    const NodeState& x = w.nodes[at(node)];
    return rate_of(x.u[0], x.du[0], x.ddu[0], number);
  };
  in.angle = scalar(b.def.angle, 4);
  in.slide = scalar(b.def.slide, 5);
  const std::array<S, 7> x = entries(joints::place(k, in));
  out.a.setZero();
  out.a_rate.setZero();
  out.a_accel.setZero();
  out.a.topLeftCorner<3, 3>().setIdentity();
  for (int r = 0; r < 7; ++r) {
    const S& y = x[static_cast<std::size_t>(r)];
    out.a.block<1, 4>(r, 3) = y.v.g.head<4>().transpose();
    out.a_rate.block<1, 4>(r, 3) = y.d.g.head<4>().transpose();
    out.a_accel.block<1, 4>(r, 3) = y.dd.g.head<4>().transpose();
    for (std::size_t c = 0; c < 2; ++c) {
      out.c[c][r] = y.v.g[4 + static_cast<Index>(c)];
      out.c_rate[c][r] = y.d.g[4 + static_cast<Index>(c)];
      out.c_accel[c][r] = y.dd.g[4 + static_cast<Index>(c)];
    }
  }
}

Matrix<joints::inputs> Followers::curvature(const Follower& b, const Workspace& w, const Frames& f,
                                            const Vector<7>& force) const {
  using S = joints::Second;
  const NodeState& s = w.nodes[at(b.def.parent)];
  joints::Inputs<S> in;
  in.t = {S::variable(s.t.x(), 0), S::variable(s.t.y(), 1), S::variable(s.t.z(), 2)};
  in.phi = S::variable(s.phi, 3);
  const auto scalar = [&](Index node, int number) {
    return node < 0 ? S(0.0) : S::variable(w.nodes[at(node)].u[0], number);
  };
  in.angle = scalar(b.def.angle, 4);
  in.slide = scalar(b.def.slide, 5);
  const std::array<S, 7> x = entries(joints::place(axes(b, f), in));
  Matrix<joints::inputs> out = Matrix<joints::inputs>::Zero();
  for (std::size_t r = 0; r < 7; ++r)
    out += force[static_cast<Index>(r)] * x[r].h;
  return out;
}

void Followers::carry_force(Workspace& w, const Frames& f, Eigen::Ref<VecX> loads) const {
  Jacobians J;
  for (std::size_t n = list_.size(); n-- > 0;) {
    const Follower& b = list_[n];
    const FollowerDef& d = b.def;
    Vector<7>& on_b = w.force[at(d.node)];
    loads.segment<3>(6 * d.node) = on_b.head<3>();
    if (d.pinned) {
      w.force[at(d.parent)].head<3>() += on_b.head<3>();
      on_b.head<3>().setZero();
      continue;
    }
    const NodeState& s = w.nodes[at(d.node)];
    const Vec3 about = (s.e() + s.d()) / (2.0 + s.e().dot(s.t));
    loads.segment<3>(6 * d.node + 3) = s.d().cross(Vec3(on_b.segment<3>(3))) + on_b[6] * about;
    jacobians(b, w, f, J);
    w.force[at(d.parent)] += J.a.transpose() * on_b;
    if (d.angle >= 0) w.force[at(d.angle)][0] += J.c[0].dot(on_b);
    if (d.slide >= 0) w.force[at(d.slide)][0] += J.c[1].dot(on_b);
    on_b.setZero();
  }
}

namespace {

using BlocksX = la::BlockMatrix<7>;

/// Column of blocks (j, b) to (j, input), J of W columns: M J, C J + 2 M J', K J + C J' + M J''.
template <class J>
void carry_column(Workspace& w, Index from, Index to, const J& j, const J& rate, const J& accel) {
  constexpr int W = J::ColsAtCompileTime;
  const Jacobian M = w.M.block(from), C = w.C.block(from), K = w.K.block(from);
  w.M.block(to).leftCols<W>() += M * j;
  w.C.block(to).leftCols<W>() += C * j + 2.0 * (M * rate);
  w.K.block(to).leftCols<W>() += K * j + C * rate + M * accel;
}

/// Row of blocks (b, j) to (input, j): J^T.
template <class J>
void carry_row(Workspace& w, Index from, Index to, const J& j) {
  constexpr int W = J::ColsAtCompileTime;
  for (BlocksX* m : {&w.M, &w.C, &w.K}) {
    const Jacobian x = m->block(from);
    m->block(to).topRows<W>() += j.transpose() * x;
  }
}

void clear(Workspace& w, Index slot) {
  for (BlocksX* m : {&w.M, &w.C, &w.K})
    m->block(slot).setZero();
}

/// Only u: columns of (j, b) to (j, a), then rows of (b, j) to (a, j).
void carry_place(Workspace& w, Index from, Index to, bool rows) {
  for (BlocksX* m : {&w.M, &w.C, &w.K}) {
    auto x = m->block(from), y = m->block(to);
    if (rows) {
      y.topRows<3>() += x.topRows<3>();
      x.topRows<3>().setZero();
    } else {
      y.leftCols<3>() += x.leftCols<3>();
      x.leftCols<3>().setZero();
    }
  }
}

}  // namespace

void Followers::carry_tangent(Workspace& w, const Frames& f) const {
  Jacobians J;
  for (std::size_t n = list_.size(); n-- > 0;) {
    const Follower& b = list_[n];
    const FollowerDef& d = b.def;
    const Vector<7> on_b = w.force[at(d.node)];
    if (d.pinned) {
      w.force[at(d.parent)].head<3>() += on_b.head<3>();
      w.force[at(d.node)].head<3>().setZero();
      for (const auto& s : b.slots) {
        if (s.input_column[0] >= 0)
          carry_place(w, s.column, s.input_column[0], false);
        else
          for (BlocksX* m : {&w.M, &w.C, &w.K})
            m->block(s.column).leftCols<3>().setZero();
      }
      for (const auto& s : b.slots) {
        if (s.input_row[0] >= 0)
          carry_place(w, s.row, s.input_row[0], true);
        else
          for (BlocksX* m : {&w.M, &w.C, &w.K})
            m->block(s.row).topRows<3>().setZero();
      }
      continue;
    }
    jacobians(b, w, f, J);
    for (const auto& s : b.slots) {
      if (s.input_column[0] >= 0)
        carry_column(w, s.column, s.input_column[0], J.a, J.a_rate, J.a_accel);
      for (std::size_t c = 0; c < 2; ++c)
        if (s.input_column[c + 1] >= 0)
          carry_column(w, s.column, s.input_column[c + 1], J.c[c], J.c_rate[c], J.c_accel[c]);
      clear(w, s.column);
    }
    for (const auto& s : b.slots) {
      if (s.input_row[0] >= 0) carry_row(w, s.row, s.input_row[0], J.a);
      for (std::size_t c = 0; c < 2; ++c)
        if (s.input_row[c + 1] >= 0) carry_row(w, s.row, s.input_row[c + 1], J.c[c]);
      clear(w, s.row);
    }
    const Matrix<joints::inputs> H = curvature(b, w, f, on_b);
    const std::array<Index, 3> place{3, 0, 0}, from{0, 4, 5}, width{4, 1, 1};
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t r = 0; r < 3; ++r)
        if (b.among[p][r] >= 0)
          w.K.block(b.among[p][r]).block(place[p], place[r], width[p], width[r]) +=
              H.block(from[p], from[r], width[p], width[r]);
    w.force[at(d.parent)] += J.a.transpose() * on_b;
    if (d.angle >= 0) w.force[at(d.angle)][0] += J.c[0].dot(on_b);
    if (d.slide >= 0) w.force[at(d.slide)][0] += J.c[1].dot(on_b);
    w.force[at(d.node)].setZero();
  }
}

template <class Scalar>
void Followers::complete(const Workspace& w, const Frames& f,
                         Eigen::Matrix<Scalar, -1, 1>& x) const {
  Jacobians J;
  for (const Follower& b : list_) {
    const FollowerDef& d = b.def;
    const Index i = 6 * d.node, p = 6 * d.parent;
    if (d.pinned) {
      x.template segment<3>(i) = x.template segment<3>(p);
      continue;
    }
    jacobians(b, w, f, J);
    Eigen::Matrix<Scalar, 7, 1> in;
    in << x.template segment<3>(p), w.D[at(d.parent)] * x.template segment<2>(p + gamma2),
        x[p + spin_phi];
    Eigen::Matrix<Scalar, 7, 1> out = J.a * in;
    if (d.angle >= 0) out += J.c[0] * x[6 * d.angle];
    if (d.slide >= 0) out += J.c[1] * x[6 * d.slide];
    const Mat32& D = w.D[at(d.node)];
    x.template segment<3>(i) = out.template head<3>();
    x[i + spin_phi] = out[6];
    x.template segment<2>(i + gamma2) =
        (D.transpose() * D).inverse() * (D.transpose() * out.template segment<3>(3));
  }
}

template <class Scalar>
void Followers::reduce(const Workspace& w, const Frames& f, Eigen::Matrix<Scalar, -1, 1>& x) const {
  Jacobians J;
  for (std::size_t n = list_.size(); n-- > 0;) {
    const Follower& b = list_[n];
    const FollowerDef& d = b.def;
    const Index i = 6 * d.node, p = 6 * d.parent;
    if (d.pinned) {
      x.template segment<3>(p) += x.template segment<3>(i);
      x.template segment<3>(i).setZero();
      continue;
    }
    jacobians(b, w, f, J);
    const Mat32& D = w.D[at(d.node)];
    Eigen::Matrix<Scalar, 7, 1> on;
    on << x.template segment<3>(i),
        D * ((D.transpose() * D).inverse() * x.template segment<2>(i + gamma2)), x[i + spin_phi];
    const Eigen::Matrix<Scalar, 7, 1> to = J.a.transpose() * on;
    x.template segment<3>(p) += to.template head<3>();
    x.template segment<2>(p + gamma2) += w.D[at(d.parent)].transpose() * to.template segment<3>(3);
    x[p + spin_phi] += to[6];
    if (d.angle >= 0) x[6 * d.angle] += J.c[0].template cast<Scalar>().cwiseProduct(on).sum();
    if (d.slide >= 0) x[6 * d.slide] += J.c[1].template cast<Scalar>().cwiseProduct(on).sum();
    x.template segment<6>(i).setZero();
  }
}

template void Followers::complete(const Workspace&, const Frames&, VecX&) const;
template void Followers::complete(const Workspace&, const Frames&, VecXc&) const;
template void Followers::reduce(const Workspace&, const Frames&, VecX&) const;
template void Followers::reduce(const Workspace&, const Frames&, VecXc&) const;

}  // namespace whirl::system
