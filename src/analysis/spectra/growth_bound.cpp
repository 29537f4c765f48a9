#include <analysis/spectra/growth_bound.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// out = (a + sign a^T)/2.
void take_part(const la::BlockMatrix<6>& a, double sign, la::BlockMatrix<6>& out) {
  const la::BlockPattern& p = a.pattern();
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[at(i)]; s < p.row_start()[at(i) + 1]; ++s) {
      const Index transposed = p.slot(p.cols()[at(s)], i);
      out.block(s) = 0.5 * (a.block(s) + sign * a.block(transposed).transpose());
    }
}

}  // namespace

GrowthBound::GrowthBound(const la::BlockPattern& pattern, std::span<const unsigned char> active)
    : real_(pattern, active),
      complex_(pattern, active),
      parts_(pattern),
      work_(pattern) {}

void GrowthBound::split(const la::MCK& m) {
  take_part(m.M, -1.0, work_.M);
  double skew = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < m.M.value_count(); ++k) {
    skew = std::max(skew, std::abs(work_.M.data()[k]));
    size = std::max(size, std::abs(m.M.data()[k]));
  }
  symmetric_mass_ = skew <= 1e-12 * size;
  take_part(m.M, 1.0, parts_.M);
  take_part(m.C, 1.0, parts_.C);
  take_part(m.K, 1.0, parts_.K);
  // What stays in work_ is K_a.
  take_part(m.K, -1.0, work_.K);
}

bool GrowthBound::positive_stiffness(double w) {
  return real_.factor(parts_, w * w, 0.0, 1.0) == la::Status::ok &&
         real_.negative_eigenvalues() == 0;
}

std::optional<Index> GrowthBound::modes_below(double w) {
  if (real_.factor(parts_, -w * w, 0.0, 1.0) != la::Status::ok) return std::nullopt;
  return real_.negative_eigenvalues();
}

bool GrowthBound::positive_damping(double w, double eta) {
  return real_.factor(parts_, eta * w, 1.0, eta / w) == la::Status::ok &&
         real_.negative_eigenvalues() == 0;
}

bool GrowthBound::damping_beats_circulation(double w, double eta) {
  for (std::size_t k = 0; k < parts_.M.value_count(); ++k)
    work_.M.data()[k] =
        w * parts_.C.data()[k] + eta * (w * w * parts_.M.data()[k] + parts_.K.data()[k]);
  const la::Status status =
      complex_.factor(work_, Complex(1.0, 0.0), Complex(0.0, 0.0), Complex(0.0, -1.0));
  return status == la::Status::ok && complex_.negative_eigenvalues() == 0;
}

std::optional<GrowthBound::Quiet> GrowthBound::first(const la::MCK& m, double w, double w_max) {
  if (!(w > 0.0)) return std::nullopt;  // nowhere to begin: nothing oscillates
  split(m);
  if (!symmetric_mass_) return std::nullopt;
  for (; w <= w_max && std::isfinite(w); w *= 2.0) {
    if (!positive_stiffness(w) || !positive_stiffness(1e3 * w)) continue;
    for (const double eta : {1e-9, 1e-7, 1e-5})
      if (positive_damping(w, eta) && damping_beats_circulation(w, eta)) return Quiet{w, eta};
  }
  return std::nullopt;
}

}  // namespace whirl::analysis
