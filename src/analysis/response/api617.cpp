#include <analysis/response/api617.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

double api_unbalance(double factor, double constant, double W, double N) {
  constexpr double kg_m = 1e-6;  // of 1 g mm
  return factor * constant * kg_m * W / to_rpm(N);
}

double vibration_limit(double cap, double of_speed, double N) {
  return std::min(cap, cap * std::sqrt(of_speed / N));
}

double scale_factor(double limit, double amplitude, double most) {
  return amplitude > 0 ? std::min(most, limit / amplitude) : most;
}

double MarginRule::required(double amplification, bool above_the_range) const {
  if (!(amplification >= damped)) return 0.0;
  if (!std::isnan(fixed)) return fixed;
  const double margin = factor * (1.0 - 1.0 / (amplification - offset));
  return above_the_range ? above + margin : margin;
}

double CrossCoupledStage::anticipated(double radial_factor, double axial_factor,
                                      double constant) const {
  const double torque = constant * power / to_rpm(speed);
  const double stage = torque / (diameter * width);
  return axial ? axial_factor * stage : radial_factor * stage * discharge / suction;
}

double RatioBoundary::at(double rho) const {
  WHIRL_EXPECTS(!density.empty() && density.size() == ratio.size());
  if (rho <= density.front()) return ratio.front();
  for (std::size_t k = 1; k < density.size(); ++k)
    if (rho <= density[k])
      return ratio[k - 1] +
             (ratio[k] - ratio[k - 1]) * (rho - density[k - 1]) / (density[k] - density[k - 1]);
  return 0.0;
}

std::string describe(ModeForm form) {
  switch (form) {
    case ModeForm::one_lobe: return "one lobe between the journals";
    case ModeForm::conical: return "two lobes: unbalance at 180 degrees";
    case ModeForm::several_lobes: return "several lobes, in turn at 0 and 180 degrees";
    case ModeForm::overhung: return "overhung";
  }
  return {};
}

namespace {

struct Extreme {
  double s = 0, u = 0;
};

/// Largest |u| at places that `take` takes.
template <class Take>
Extreme largest(const std::vector<double>& s, const std::vector<double>& u, const Take& take) {
  Extreme e;
  for (std::size_t k = 0; k < s.size(); ++k)
    if (take(s[k]) && std::abs(u[k]) > std::abs(e.u)) e = {s[k], u[k]};
  return e;
}

/// The extreme of each stretch of one sign. Less than a tenth of the largest is no lobe: a
/// journal that hardly gives way.
std::vector<Extreme> lobes_between(const std::vector<double>& s, const std::vector<double>& u,
                                   double from, double to) {
  constexpr double least = 0.1;
  const double most = std::abs(largest(s, u, [&](double x) { return x >= from && x <= to; }).u);
  std::vector<Extreme> lobes;
  for (std::size_t k = 0; k < s.size(); ++k) {
    if (s[k] < from || s[k] > to || std::abs(u[k]) < least * most || u[k] == 0) continue;
    if (lobes.empty() || lobes.back().u * u[k] < 0)
      lobes.push_back({s[k], u[k]});
    else if (std::abs(u[k]) > std::abs(lobes.back().u))
      lobes.back() = {s[k], u[k]};
  }
  return lobes;
}

double nearest_weight(const JournalWeights& j, double s) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < j.s.size(); ++k)
    if (std::abs(j.s[k] - s) < std::abs(j.s[best] - s)) best = k;
  return j.weight[best];
}

}  // namespace

ModePlanes place_unbalance(const std::vector<double>& s, const std::vector<double>& u,
                           const JournalWeights& journals) {
  WHIRL_EXPECTS(!s.empty() && s.size() == u.size() && !journals.s.empty());
  const double first = journals.s.front(), last = journals.s.back();
  const Extreme span = largest(s, u, [&](double x) { return x >= first && x <= last; });
  const Extreme left = largest(s, u, [&](double x) { return x < first; });
  const Extreme right = largest(s, u, [&](double x) { return x > last; });
  const bool overhung = journals.motion_left + journals.motion_right > 0.5;
  ModePlanes out;
  if (overhung) {
    const bool on_left = journals.motion_left >= 0.25, on_right = journals.motion_right >= 0.25;
    out.form = ModeForm::overhung;
    if (on_left) out.planes.push_back({left.s, journals.overhang_left, false});
    if (on_right)
      out.planes.push_back({right.s, journals.overhang_right, on_left && left.u * right.u < 0});
    return out;
  }
  const std::vector<Extreme> lobes = lobes_between(s, u, first, last);
  if (lobes.size() <= 1) {
    double all = 0;
    for (const double w : journals.weight)
      all += w;
    out.planes.push_back({span.s, all, false});
    return out;
  }
  out.form = lobes.size() == 2 ? ModeForm::conical : ModeForm::several_lobes;
  for (std::size_t k = 0; k < lobes.size(); ++k)
    out.planes.push_back({lobes[k].s, nearest_weight(journals, lobes[k].s), k % 2 == 1});
  return out;
}

}  // namespace whirl::analysis
