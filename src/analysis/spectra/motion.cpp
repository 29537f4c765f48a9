#include <analysis/spectra/motion.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Of the stiffness an unknown has by itself, the part left when all others give way: below this it
/// is rounding. The pivot of a chain that nothing holds ends at 1e-16 to 1e-13 of it.
constexpr double unresisted = 1e-11;
/// Of a spin: what resists it so little (a cracked or flat rotor at rest that would roll under its weight)
/// is slow beside bending, and its inertia, which is left out, holds it.
constexpr double slow_spin = 1e-5;

void copy_without(const la::BlockMatrix<6>& in, std::span<const unsigned char> out_of,
                  la::BlockMatrix<6>& out) {
  const la::BlockPattern& p = in.pattern();
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[at(i)]; s < p.row_start()[at(i) + 1]; ++s) {
      const Index j = p.cols()[at(s)];
      auto block = out.block(s);
      block = in.block(s);
      for (Index c = 0; c < 6; ++c) {
        if (out_of[at(6 * i + c)]) block.row(c).setZero();
        if (out_of[at(6 * j + c)]) block.col(c).setZero();
      }
    }
}

/// K, and of the flagged rows and columns those of another matrix.
void copy_with(const la::BlockMatrix<6>& K, const la::BlockMatrix<6>& other,
               std::span<const unsigned char> of_other, la::BlockMatrix<6>& out) {
  std::copy_n(K.data(), K.value_count(), out.data());
  if (&K == &other) return;
  const la::BlockPattern& p = K.pattern();
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[at(i)]; s < p.row_start()[at(i) + 1]; ++s) {
      const Index j = p.cols()[at(s)];
      for (Index r = 0; r < 6; ++r)
        for (Index c = 0; c < 6; ++c)
          if (of_other[at(6 * i + r)] || of_other[at(6 * j + c)])
            out.block(s)(r, c) = other.block(s)(r, c);
    }
}

}  // namespace

Motion kind_of_unknown(const system::System& system, Index unknown) {
  WHIRL_EXPECTS(unknown >= 0 && unknown < system.size());
  if (system.node(unknown / 6).scalar) {
    const system::FollowerDef* joint = system.followers().find_coordinate(unknown / 6);
    if (!joint || std::abs(joint->axis.x()) < 0.5) return Motion::lateral;
    return joint->angle == unknown / 6 ? Motion::torsional : Motion::axial;
  }
  const Index c = unknown % 6;
  return c == system::spin_phi ? Motion::torsional
         : c == system::ux     ? Motion::axial
                               : Motion::lateral;
}

MotionReduction::MotionReduction(const system::System& system, Motion motion, Twist twist)
    : system_(system),
      motion_(motion),
      active_(system.active().begin(), system.active().end()),
      follows_(active_.size(), 0) {
  if (motion == Motion::all) return;
  for (Index k = 0; k < system.size(); ++k) {
    const Motion kind = kind_of_unknown(system, k);
    if (!active_[at(k)] || kind == motion) continue;
    if (motion == Motion::lateral && (kind == Motion::axial || twist == Twist::follows))
      follows_[at(k)] = 1;
    else
      active_[at(k)] = 0;
  }
  any_ = std::find(follows_.begin(), follows_.end(), 1) != follows_.end();
  if (!any_) return;
  reduced_ = system.make_matrices();
  scratch_.resize(system.size());
  // in natural order a step of the elimination is a node
  followers_ =
      std::make_unique<la::BlockLu<double>>(system.pattern(), follows_, la::lu::Ordering::natural);
}

const la::MCK& MotionReduction::reduce(const la::MCK& m, const la::BlockMatrix<6>& following) {
  WHIRL_EXPECTS(m.K.pattern().size() == system_.nodes());
  WHIRL_EXPECTS(following.pattern().size() == system_.nodes());
  if (!any_) return m;
  copy_without(m.M, follows_, reduced_.M);
  copy_without(m.C, follows_, reduced_.C);
  copy_with(m.K, following, follows_, reduced_.K);
  find_restraints();
  return reduced_;
}

double& MotionReduction::own_stiffness(Index unknown) {
  const Index slot = reduced_.K.pattern().diagonal(unknown / 6);
  return reduced_.K.data()[36 * slot + 7 * (unknown % 6)];
}

void MotionReduction::restrain(Index unknown) {
  WHIRL_EXPECTS(unknown >= 0 && unknown < system_.size());
  double& stiffness = own_stiffness(unknown);
  const double spring = stiffness != 0.0 ? std::abs(stiffness)
                                         : 1.0;  // what nothing resists at all: any spring will do
  stiffness += spring;
  restraints_.push_back(unknown);
  springs_.push_back(spring);
}

double MotionReduction::resisted(Index unknown) const {
  return kind_of_unknown(system_, unknown) == Motion::torsional ? slow_spin : unresisted;
}

/// The unknown that others hold least, or -1 when all are held. After a factorisation.
Index MotionReduction::softest_unknown() const {
  Index softest = -1;
  double most = 1.0;
  for (Index i = 0; i < system_.nodes(); ++i) {
    const auto flags = std::span(follows_).subspan(at(6 * i), 6);
    if (std::find(flags.begin(), flags.end(), 1) == flags.end()) continue;
    const Matrix<6> flexibility = followers_->inverse_pivot_block(i);
    const auto stiffness = reduced_.K.block(reduced_.K.pattern().diagonal(i));
    for (Index c = 0; c < 6; ++c) {
      if (!flags[at(c)]) continue;
      const double ratio = std::abs(flexibility(c, c) * stiffness(c, c)) * resisted(6 * i + c);
      if (ratio > most) {
        most = ratio;
        softest = 6 * i + c;
      }
    }
  }
  return softest;
}

/// The springs of the last time: each must still give way to a load on it as it would alone.
bool MotionReduction::restraints_still_free() {
  for (std::size_t i = 0; i < restraints_.size(); ++i) {
    scratch_.setZero();
    scratch_[restraints_[i]] = springs_[i];
    followers_->solve(scratch_);
    constexpr double rounding = 1e-9;
    const double weak = 2.0 * resisted(restraints_[i]);
    if (std::abs(scratch_[restraints_[i]] - 1.0) > std::max(rounding, weak)) return false;
  }
  return true;
}

void MotionReduction::find_restraints() {
  const auto factor = [&] { return followers_->factor(reduced_, 0.0, 0.0, 1.0) == la::Status::ok; };
  std::vector<Index> last;
  last.swap(restraints_);
  springs_.clear();
  for (const Index k : last)
    restrain(k);
  bool regular = factor();
  if (!last.empty() && (!regular || !restraints_still_free())) {
    for (std::size_t i = 0; i < restraints_.size(); ++i)
      own_stiffness(restraints_[i]) -= springs_[i];
    restraints_.clear();
    springs_.clear();
    regular = factor();
  }
  while (true) {
    const Index k = regular ? softest_unknown() : followers_->singular_unknown();
    if (k < 0 || static_cast<Index>(restraints_.size()) >= system_.size()) return;
    restrain(k);
    regular = factor();
  }
}

}  // namespace whirl::analysis
