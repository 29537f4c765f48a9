#include <analysis/spectra/mode_energy.hpp>
#include <core/contract.hpp>

#include <la/multiply.hpp>

#include <algorithm>

namespace whirl::analysis {

namespace {

/// Rigid motion of node j from that of node i, in (u, phi, gamma) of a line with triad E.
Matrix<6> carry(const Vec3& arm, const Mat3& E) {
  Matrix<6> G = Matrix<6>::Identity();
  for (int c = 0; c < 3; ++c)
    G.block<3, 1>(0, 3 + c) = Vec3(E.col(c)).cross(arm);
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

}  // namespace

ModeEnergy energy_distribution(Linearizer& linear, const VecXc& x) {
  WHIRL_EXPECTS(x.size() == linear.system().size());
  const system::System& s = linear.system();
  const system::State& state = linear.equilibrium().state;
  system::Workspace workspace = s.make_workspace();
  la::MCK part = s.make_matrices();
  const VecX zero = VecX::Zero(s.size());
  const la::BlockPattern& pattern = s.pattern();
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
    if (family != system::Family::shaft) {
      la::multiply(part.K, x, y);
      for (Index i = 0; i < s.nodes(); ++i)
        if (const double e = x.segment<6>(6 * i).dot(y.segment<6>(6 * i)).real();
            e != 0 && !s.node(i).signal && !s.node(i).rate)
          out.strain.push_back({family, kind, i, -1, e});
      continue;
    }
    for (Index i = 0; i < s.nodes(); ++i)
      for (Index b = pattern.row_start()[static_cast<std::size_t>(i)];
           b < pattern.row_start()[static_cast<std::size_t>(i) + 1]; ++b) {
        const Index j = pattern.cols()[static_cast<std::size_t>(b)];
        if (j <= i || part.K.block(b).isZero(0.0)) continue;
        const Mat3& E = state.frames.axes(i);
        const Vec3 arm = s.node(j).position + state.q.segment<3>(6 * j) - s.node(i).position -
                         state.q.segment<3>(6 * i);
        const Eigen::Matrix<Complex, 6, 1> e =
            x.segment<6>(6 * j) - carry(arm, E) * x.segment<6>(6 * i);
        const Matrix<6> D = -part.K.block(b).transpose() * carry(-arm, E);
        out.strain.push_back({family, kind, i, j, e.dot(D * e).real()});
      }
  }
  normalise(out.strain);
  normalise(out.kinetic);
  return out;
}

}  // namespace whirl::analysis
