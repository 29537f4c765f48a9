#include <system/joint_start.hpp>

#include <core/rotation.hpp>
#include <la/dense.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace whirl::system {

namespace {

/// Place, attitude and rates of the nodes that follow, six numbers each.
struct Poses {
  std::vector<Vec3> r;
  std::vector<Mat3> R;
  VecX rates;
};

class Fit {
 public:
  Fit(const System& s, State& x) : s_(s), x_(x), w_(s.make_workspace()) {
    const Followers& all = s.followers();
    for (std::size_t k = 0; k < all.count(); ++k) {
      if (!all[k].between) real_.push_back(k);
      for (const Index n : {all[k].angle, all[k].slide})
        if (n >= 0) scalars_.push_back(n);
    }
    for (Index i = 0; i < s.nodes(); ++i)
      size_ = std::max(size_, (s.node(i).position - s.node(0).position).norm());
    if (!(size_ > 0)) size_ = 1.0;
  }

  std::string run() {
    const Poses wanted = poses();
    s_.followers().keep_turns(x_.frames, x_.q);
    VecX left;
    for (int round = 0; round < 50; ++round) {
      s_.follow(x_);
      left = difference(wanted, poses());
      const VecX step = la::pseudo_inverse(motions()) * left;
      for (std::size_t k = 0; k < scalars_.size(); ++k)
        x_.q[6 * scalars_[k]] += step[static_cast<Index>(k)];
      if (!(step.norm() > 1e-14)) break;
    }
    s_.follow(x_);
    left = difference(wanted, poses());
    if (const std::string wrong = worst(left, 1e-6); !wrong.empty()) return wrong;
    for (const Index n : scalars_)
      x_.v[6 * n] = 0.0;
    s_.follow(x_);
    const VecX missing = wanted.rates - poses().rates;
    const VecX rates = la::pseudo_inverse(motions()) * missing;
    for (std::size_t k = 0; k < scalars_.size(); ++k)
      x_.v[6 * scalars_[k]] = rates[static_cast<Index>(k)];
    s_.follow(x_);
    return worst(VecX(wanted.rates - poses().rates),
                 1e-6 * std::max(1e-6, wanted.rates.cwiseAbs().maxCoeff()));
  }

 private:
  Poses poses() {
    Poses out;
    out.rates.resize(6 * static_cast<Index>(real_.size()));
    Index row = 0;
    for (const std::size_t k : real_) {
      const Index i = s_.followers()[k].node;
      const Mat3& E = x_.frames.axes(i);
      const Vec2 g = x_.q.segment<2>(6 * i + gamma2);
      out.r.push_back(x_.q.segment<3>(6 * i));
      out.R.push_back(E * rotation::L(Vec3(0, g[0], g[1])) *
                      rotation::L(Vec3(x_.q[6 * i + spin_phi], 0, 0)));
      out.rates.segment<3>(row) = x_.v.segment<3>(6 * i) / size_;
      out.rates.segment<3>(row + 3) =
          E * rotation::omega_of_rates(g, x_.v[6 * i + spin_phi], x_.v.segment<2>(6 * i + gamma2));
      row += 6;
    }
    return out;
  }
  VecX difference(const Poses& to, const Poses& from) const {
    VecX out(6 * static_cast<Index>(real_.size()));
    for (std::size_t k = 0; k < real_.size(); ++k) {
      const Index row = 6 * static_cast<Index>(k);
      out.segment<3>(row) = (to.r[k] - from.r[k]) / size_;
      const Eigen::AngleAxisd turn(Mat3(to.R[k] * from.R[k].transpose()));
      out.segment<3>(row + 3) = turn.angle() * turn.axis();
    }
    return out;
  }
  /// How those poses change with each coordinate of a joint.
  MatX motions() {
    MatX out =
        MatX::Zero(6 * static_cast<Index>(real_.size()), static_cast<Index>(scalars_.size()));
    s_.evaluate_nodes(w_, x_.frames, x_.t, x_.q, x_.v, x_.a);
    for (std::size_t c = 0; c < scalars_.size(); ++c) {
      VecX e = VecX::Zero(s_.size());
      e[6 * scalars_[c]] = 1.0;
      s_.followers().complete(w_, x_.frames, e);
      for (std::size_t k = 0; k < real_.size(); ++k) {
        const Index i = s_.followers()[real_[k]].node, row = 6 * static_cast<Index>(k);
        const Vec2 g = x_.q.segment<2>(6 * i + gamma2);
        out.block<3, 1>(row, static_cast<Index>(c)) = e.segment<3>(6 * i) / size_;
        out.block<3, 1>(row + 3, static_cast<Index>(c)) =
            x_.frames.axes(i) *
            rotation::omega_of_rates(g, e[6 * i + spin_phi], e.segment<2>(6 * i + gamma2));
      }
    }
    return out;
  }
  std::string worst(const VecX& left, double limit) const {
    Index at_row = 0;
    if (left.size() == 0 || !(left.cwiseAbs().maxCoeff(&at_row) > limit)) return {};
    return s_.followers()[real_[static_cast<std::size_t>(at_row / 6)]].joint;
  }

  const System& s_;
  State& x_;
  Workspace w_;
  std::vector<std::size_t> real_;
  std::vector<Index> scalars_;
  double size_ = 0;
};

}  // namespace

std::string fit_joints(const System& system, State& x) {
  return system.followers().empty() ? std::string() : Fit(system, x).run();
}

}  // namespace whirl::system
