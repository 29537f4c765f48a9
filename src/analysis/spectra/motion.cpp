#include <analysis/spectra/motion.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Of the stiffness an unknown has by itself, the part left when all others give way: below this it
/// is rounding. The pivot of a chain that nothing holds ends at 1e-16 to 1e-13 of it.
constexpr double unresisted = 1e-11;
/// How evenly a line turns whose spin is resisted less than its own twist resists, with a twentieth of it.
constexpr double as_one = 0.05;
/// Softness from which it may do so.
constexpr double soft_spin = 1e2;
/// The same of what moves with a spin that is held already: teeth and couplings are stiffer.
constexpr double loose_spin = 1e5;

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

MotionReduction::MotionReduction(const system::System& system, Motion motion,
                                 std::span<const unsigned char> spinning, Twist twist)
    : system_(system),
      motion_(motion),
      active_(system.active().begin(), system.active().end()),
      follows_(active_.size(), 0),
      spinning_(spinning.begin(), spinning.end()) {
  WHIRL_EXPECTS(spinning.empty() || static_cast<Index>(spinning.size()) == system.nodes());
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

void MotionReduction::restrain(Index unknown, bool rolls) {
  WHIRL_EXPECTS(unknown >= 0 && unknown < system_.size());
  constexpr double firmly = 1e3;  // beside what else resists
  double& stiffness = own_stiffness(unknown);
  const double own = stiffness != 0.0 ? std::abs(stiffness)
                                      : 1.0;  // what nothing resists at all: any spring will do
  const double spring = rolls ? firmly * own : own;
  stiffness += spring;
  springs_.push_back({unknown, rolls, spring});
}

double MotionReduction::softness(Index unknown) const {
  const Index i = unknown / 6, c = unknown % 6;
  const double flexibility = followers_->inverse_pivot_block(i)(c, c);
  return std::abs(flexibility * reduced_.K.block(reduced_.K.pattern().diagonal(i))(c, c));
}

/// The unknown that others hold least, or -1 when all are held. After a factorisation.
Index MotionReduction::softest_unknown() const {
  Index softest = -1;
  double most = 1.0 / unresisted;
  for (Index k = 0; k < system_.size(); ++k) {
    if (!follows_[at(k)]) continue;
    const double ratio = softness(k);
    if (ratio > most) {
      most = ratio;
      softest = k;
    }
  }
  return softest;
}

bool MotionReduction::spins(Index unknown) const {
  return unknown % 6 == system::spin_phi && follows_[at(unknown)] && !spinning_.empty() &&
         spinning_[at(unknown / 6)];
}

void MotionReduction::push(const Restraint& r) {
  scratch_.setZero();
  scratch_[r.unknown] = r.spring;
  followers_->solve(scratch_);
}

bool MotionReduction::turns_as_one(Index unknown) const {
  const Index line = system_.node(unknown / 6).line;
  const double turn = scratch_[unknown];
  for (Index i = 0; i < system_.nodes(); ++i) {
    const Index k = 6 * i + system::spin_phi;
    if (system_.node(i).line == line && spins(k) &&
        !(std::abs(scratch_[k] - turn) <= as_one * std::abs(turn)))
      return false;
  }
  return true;
}

Index MotionReduction::rolling_spin() {
  std::vector<Index> softest(at(system_.lines()), -1);
  std::vector<double> most(at(system_.lines()), soft_spin);
  for (Index i = 0; i < system_.nodes(); ++i) {
    const Index k = 6 * i + system::spin_phi;
    if (!spins(k)) continue;
    const Index line = system_.node(i).line;
    const double ratio = softness(k);
    if (ratio <= most[at(line)]) continue;
    most[at(line)] = ratio;
    softest[at(line)] = k;
  }
  for (const Restraint& r : springs_) {
    push(r);
    constexpr double little = 1e-3;
    for (Index i = 0; i < system_.nodes(); ++i) {
      Index& k = softest[at(system_.node(i).line)];
      const bool moves = std::abs(scratch_[6 * i + system::spin_phi]) > little;
      if (spins(6 * i + system::spin_phi) && moves && most[at(system_.node(i).line)] < loose_spin)
        k = -1;
    }
  }
  for (const Index k : softest) {
    if (k < 0) continue;
    push({k, true, 1.0});
    if (turns_as_one(k)) return k;
  }
  return -1;
}

/// The springs of the last time: each must still give way to a load on it as it would alone.
bool MotionReduction::restraints_still_free() {
  constexpr double rounding = 1e-9;
  for (const Restraint& r : springs_) {
    push(r);
    if (!(r.rolls ? turns_as_one(r.unknown) : std::abs(scratch_[r.unknown] - 1.0) <= rounding))
      return false;
  }
  return true;
}

void MotionReduction::find_restraints() {
  const auto factor = [&] { return followers_->factor(reduced_, 0.0, 0.0, 1.0) == la::Status::ok; };
  std::vector<Restraint> last;
  last.swap(springs_);
  for (const Restraint& r : last)
    restrain(r.unknown, r.rolls);
  bool regular = factor();
  if (!last.empty() && (!regular || !restraints_still_free())) {
    for (const Restraint& r : springs_)
      own_stiffness(r.unknown) -= r.spring;
    springs_.clear();
    regular = factor();
  }
  while (static_cast<Index>(springs_.size()) < system_.size()) {
    Index k = regular ? softest_unknown() : followers_->singular_unknown();
    const bool rolls = k < 0 && regular;
    if (rolls) k = rolling_spin();
    if (k < 0) break;
    restrain(k, rolls);
    regular = factor();
  }
  restraints_.clear();
  for (const Restraint& r : springs_)
    restraints_.push_back(r.unknown);
}

}  // namespace whirl::analysis
