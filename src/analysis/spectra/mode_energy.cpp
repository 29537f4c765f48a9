#include <analysis/spectra/mode_energy.hpp>
#include <core/contract.hpp>

#include <la/multiply.hpp>

#include <algorithm>

namespace whirl::analysis {

namespace {

/// Rigid motion of node j from that of node i, in (u, phi, gamma) of lines with triads E.
Matrix<6> carry(const Vec3& arm, const Mat3& E_i, const Mat3& E_j) {
  Matrix<6> G = Matrix<6>::Identity();
  for (int c = 0; c < 3; ++c)
    G.block<3, 1>(0, 3 + c) = Vec3(E_i.col(c)).cross(arm);
  G.block<3, 3>(3, 3) = E_j.transpose() * E_i;
  return G;
}

void normalise(std::vector<EnergyPart>& parts) {
  double sum = 0;
  for (const EnergyPart& p : parts)
    sum += p.share;
  if (!(sum > 0)) {
    parts.clear();
    return;
  }
  for (EnergyPart& p : parts)
    p.share /= sum;
  std::erase_if(parts, [](const EnergyPart& p) { return std::abs(p.share) < 1e-6; });
}

/// What stiffness stores between nodes and at them, for the stiffness of one batch of terms.
class Stretched {
 public:
  Stretched(const system::System& s, const system::State& state, const la::MCK& part,
            const VecXc& x)
      : system_(s),
        state_(state),
        pattern_(s.pattern()),
        part_(part),
        x_(x) {}

  /// Of what is between two nodes.
  void add_pairs(const EnergyPart& named, std::vector<EnergyPart>& out) const {
    for (Index i = 0; i < system_.nodes(); ++i)
      each_other(i, [&](Index j, const Matrix<6>& K) {
        if (j < i) return;
        const Part e = stretch(i, j);
        const Part force = K.transpose() * (carry_to(j, i) * e);
        out.push_back({named.family, named.kind, i, j, -e.dot(force).real()});
      });
  }

  /// The same, and what is left of the forces at a node: of springs to the ground. States of supports
  /// (scalar nodes) move no body: all that is at them is theirs.
  void add_all(const EnergyPart& named, std::vector<EnergyPart>& out) const {
    VecXc forces;
    la::multiply(part_.K, x_, forces);
    for (Index i = 0; i < system_.nodes(); ++i) {
      if (system_.node(i).signal || system_.node(i).rate) continue;
      Part left = forces.segment<6>(6 * i);
      if (is_body(i))
        each_other(i, [&](Index j, const Matrix<6>& K) {
          if (!is_body(j)) return;
          left -= K * stretch(i, j);
          if (j < i) return;
          const Part e = stretch(i, j);
          const Part force = K.transpose() * (carry_to(j, i) * e);
          if (const double energy = -e.dot(force).real(); energy != 0.0)
            out.push_back({named.family, named.kind, i, j, energy});
        });
      if (const double energy = x_.segment<6>(6 * i).dot(left).real(); energy != 0.0)
        out.push_back({named.family, named.kind, i, -1, energy});
    }
  }

 private:
  using Part = Eigen::Matrix<Complex, 6, 1>;

  template <class Visit>
  void each_other(Index i, const Visit& visit) const {
    const auto row = static_cast<std::size_t>(i);
    for (Index b = pattern_.row_start()[row]; b < pattern_.row_start()[row + 1]; ++b) {
      const Index j = pattern_.cols()[static_cast<std::size_t>(b)];
      const Matrix<6> K = part_.K.block(b);
      if (j != i && !K.isZero(0.0)) visit(j, K);
    }
  }
  bool is_body(Index i) const { return !system_.node(i).scalar; }
  /// Rigid motion of node j from that of node i.
  Matrix<6> carry_to(Index i, Index j) const {
    const Vec3 arm = system_.node(j).position + state_.q.segment<3>(6 * j) -
                     system_.node(i).position - state_.q.segment<3>(6 * i);
    return carry(arm, state_.frames.axes(i), state_.frames.axes(j));
  }
  /// Motion of node j but for the rigid one with node i.
  Part stretch(Index i, Index j) const {
    return x_.segment<6>(6 * j) - carry_to(i, j) * x_.segment<6>(6 * i);
  }

  const system::System& system_;
  const system::State& state_;
  const la::BlockPattern& pattern_;
  const la::MCK& part_;
  const VecXc& x_;
};

}  // namespace

ModeEnergy energy_distribution(Linearizer& linear, const VecXc& x) {
  WHIRL_EXPECTS(x.size() == linear.system().size());
  const system::System& s = linear.system();
  const system::State& state = linear.equilibrium().state;
  system::Workspace workspace = s.make_workspace();
  la::MCK part = s.make_matrices();
  const VecX zero = VecX::Zero(s.size());
  ModeEnergy out;
  VecXc y;
  for (std::size_t k = 0; k < s.terms().size(); ++k) {
    const std::string kind(s.terms()[k]->kind());
    const system::Family family = s.terms()[k]->family();
    const std::vector<std::size_t> only{k};
    if (!s.tangent(workspace, state.frames, state.t, state.q, zero, zero, part, &only)) continue;
    la::multiply(part.M, x, y);
    for (Index i = 0; i < s.nodes(); ++i)
      if (const double e = x.segment<6>(6 * i).dot(y.segment<6>(6 * i)).real(); e != 0)
        out.kinetic.push_back({family, kind, i, -1, e});
    const Stretched stretched{s, state, part, x};
    if (family == system::Family::shaft)
      stretched.add_pairs({family, kind}, out.strain);
    else
      stretched.add_all({family, kind}, out.strain);
  }
  normalise(out.strain);
  normalise(out.kinetic);
  return out;
}

}  // namespace whirl::analysis
