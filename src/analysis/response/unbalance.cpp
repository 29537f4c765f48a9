#include <analysis/response/unbalance.hpp>
#include <core/contract.hpp>

#include <analysis/search.hpp>
#include <core/error.hpp>
#include <core/parallel.hpp>
#include <core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

double ResponsePeak::amplification() const {
  const double size = std::abs(speed);  // a rotor may turn the other way
  if (!std::isnan(low) && !std::isnan(high)) return size / (high - low);
  if (!std::isnan(high)) return size / (2.0 * (high - speed));
  if (!std::isnan(low)) return size / (2.0 * (speed - low));
  return nan;
}

UnbalanceSolver::UnbalanceSolver(Linearizer& linear, const UnbalanceOptions& options)
    : linear_(linear),
      options_(options),
      solver_(linear) {
  if (options_.multiples > 0)
    periodic_ = std::make_unique<PeriodicResponse>(linear, std::max(6, options_.multiples + 1));
  else if (options_.turns_with_rotor && !options_.speeds.empty())
    axes_ = std::make_unique<RotatingAxes>(linear, options_.speeds.back());
  if (!options_.outputs.empty()) meter_ = std::make_unique<VariationMeter>(linear);
}

void UnbalanceSolver::put_multiple(const VecXc& a, SteadyPoint& p) const {
  p.multiple.emplace_back();
  for (const ResponseProbe& probe : options_.probes)
    p.multiple.back().push_back(amplitude_at(linear_, a, probe.point));
}

void UnbalanceSolver::stand_still(SteadyPoint& p) const {
  put_multiple(linear_.equilibrium().state.q.cast<Complex>(), p);
  for (int h = 1; h <= options_.multiples; ++h)
    put_multiple(VecXc::Zero(linear_.system().size()), p);
}

VecXc UnbalanceSolver::breathe(double Omega, SteadyPoint& p) {
  const PeriodicMotion motion = periodic_->solve(Omega);
  if (!motion.converged)
    throw run_error("E76",
                    fmt::format("no periodic motion found at {:.6g} rpm: the crack's opening and "
                                "closing did not settle in {} rounds",
                                to_rpm(Omega), motion.rounds),
                    "near a band of instability there may be none; a transient step follows the "
                    "motion itself");
  const VecXc mean = linear_.equilibrium().state.q.cast<Complex>() + motion.amplitude[0];
  put_multiple(mean, p);
  for (int h = 1; h <= options_.multiples; ++h)
    put_multiple(motion.amplitude[static_cast<std::size_t>(h)], p);
  p.left_out = motion.last_share;
  return motion.amplitude[1];
}

VecXc UnbalanceSolver::force_of(std::size_t order, double Omega) {
  // forcing is given as Re(f exp(i order theta)) with theta = Omega t: backward rotation runs the
  // phase backward
  const VecXc& f = linear_.forcing()[order];
  return Omega < 0 ? VecXc(-f.conjugate()) : VecXc(-f);
}

SteadyPoint UnbalanceSolver::at(double Omega, bool with_outputs) {
  SteadyPoint p;
  p.Omega = Omega;
  const auto orders = linear_.running().orders();
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const double w = orders[k] * std::abs(Omega);
    VecXc a;
    if (w == 0.0) {
      a = VecXc::Zero(linear_.system().size());  // nothing turns
      linear_.at(Omega);
      if (periodic_) stand_still(p);
    } else if (periodic_) {
      a = breathe(Omega, p);
    } else if (axes_) {
      linear_.move_to(Omega);
      a = axes_->response(Omega, -linear_.forcing()[k]);
      if (Omega < 0) a = a.conjugate().eval();
      linear_.system().complete(linear_.equilibrium().state, a);
    } else if (solver_.prepare(Omega, w)) {
      a = force_of(k, Omega);
      solver_.solve(a);
    } else {
      a = VecXc::Constant(linear_.system().size(), Complex(nan, nan));
    }
    p.probe.emplace_back();
    for (const ResponseProbe& probe : options_.probes)
      p.probe.back().push_back(amplitude_at(linear_, a, probe.point));
    if (meter_ && with_outputs) {
      p.output.emplace_back();
      meter_->measure(a, force_of(k, Omega), w, options_.outputs, p.output.back());
    }
    if (options_.shapes) p.shape.push_back(std::move(a));
  }
  return p;
}

void UnbalanceSolver::find_half_power(const std::vector<SteadyPoint>& coarse, std::size_t i,
                                      ResponsePeak& peak) {
  const auto size = [&](const SteadyPoint& p) {
    return p.probe[peak.order][peak.probe].orbit().major;
  };
  const double half = peak.amplitude / std::sqrt(2.0);
  const auto excess = [&](double Omega) { return size(at(Omega, false)) - half; };
  double inner = peak.speed, f_inner = peak.amplitude - half;
  // Whether the search ends at a sample beyond the peak: the crossing, or the flank of a higher one.
  const auto ends_at = [&](const SteadyPoint& p, double& crossing) {
    const double f = size(p) - half;
    if (f <= 0) {
      crossing = find_crossing(inner, f_inner, p.Omega, f, 1e-9, excess);
      return true;
    }
    if (size(p) > peak.amplitude) return true;
    inner = p.Omega;
    f_inner = f;
    return false;
  };
  for (std::size_t j = i + 1; j-- > 0;)
    if (coarse[j].Omega < peak.speed && ends_at(coarse[j], peak.low)) break;
  inner = peak.speed;
  f_inner = peak.amplitude - half;
  for (std::size_t j = i; j < coarse.size(); ++j)
    if (coarse[j].Omega > peak.speed && ends_at(coarse[j], peak.high)) break;
}

void UnbalanceSolver::add_points(const ResponsePeak& peak, double low, double high, double reach,
                                 std::vector<SteadyPoint>& extra) {
  const double factor = peak.amplification();
  const double width = std::isnan(factor) ? 0.0 : std::abs(peak.speed) / factor;
  for (double x : {0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.5, 4.0})
    for (double sign : {-1.0, 1.0}) {
      const double Omega = peak.speed + sign * x * width;
      if (width > 0 && Omega > low && Omega < high && x * width < reach) extra.push_back(at(Omega));
    }
}

void UnbalanceSolver::find_peaks(std::size_t order, std::size_t probe,
                                 const std::vector<SteadyPoint>& coarse,
                                 std::vector<SteadyPoint>& extra) {
  WHIRL_EXPECTS(probe < options_.probes.size());
  const auto size = [&](const SteadyPoint& p) { return p.probe[order][probe].orbit().major; };
  const auto evaluate = [&](double Omega) { return size(at(Omega, false)); };
  double top = 0;
  for (const SteadyPoint& p : coarse)
    top = std::max(top, size(p));
  for (std::size_t i = 1; i + 1 < coarse.size(); ++i) {
    const double f0 = size(coarse[i - 1]), f1 = size(coarse[i]), f2 = size(coarse[i + 1]);
    // a peak of rounding on a plateau is none
    if (!(f1 > f0 && f1 >= f2) || f1 - std::min(f0, f2) < 1e-7 * top) continue;
    ResponsePeak peak;
    peak.order = order;
    peak.probe = probe;
    peak.speed =
        find_maximum(coarse[i - 1].Omega, coarse[i].Omega, f1, coarse[i + 1].Omega, 3e-9, evaluate);
    const SteadyPoint top_point = at(peak.speed);
    peak.amplitude = size(top_point);
    peak.phase_lag = -std::arg(top_point.probe[order][probe].forward());
    find_half_power(coarse, i, peak);
    peaks_.push_back(peak);
    if (!options_.refine_peaks) continue;
    extra.push_back(top_point);
    add_points(peak, coarse.front().Omega, coarse.back().Omega,
               coarse[i + 1].Omega - coarse[i - 1].Omega, extra);
  }
}

std::vector<SteadyPoint> UnbalanceSolver::points_at(const std::vector<double>& speeds) {
  constexpr std::size_t batch = 64;       // equilibria kept at a time
  constexpr std::size_t run_length = 16;  // speeds of one solver
  std::vector<SteadyPoint> points(speeds.size());
  for (std::size_t from = 0; from < speeds.size(); from += batch) {
    const std::size_t count = std::min(batch, speeds.size() - from);
    std::vector<Equilibrium> equilibria;
    for (std::size_t k = 0; k < count; ++k) {
      linear_.move_to(speeds[from + k]);
      equilibria.push_back(linear_.equilibrium());
    }
    run_side_by_side((count + run_length - 1) / run_length, options_.threads, [&](std::size_t r) {
      Linearizer linear(linear_);
      UnbalanceSolver solver(linear, options_);
      for (std::size_t k = r * run_length; k < std::min((r + 1) * run_length, count); ++k) {
        linear.set_equilibrium(equilibria[k]);
        points[from + k] = solver.at(speeds[from + k]);
      }
    });
  }
  return points;
}

UnbalanceResponse UnbalanceSolver::run() {
  UnbalanceResponse out;
  const auto orders = linear_.running().orders();
  out.orders.assign(orders.begin(), orders.end());
  peaks_.clear();
  out.points = points_at(options_.speeds);
  const std::size_t probes = options_.probes.size();
  std::vector<std::vector<SteadyPoint>> extra(orders.size() * probes);
  std::vector<std::vector<ResponsePeak>> peaks(extra.size());
  run_side_by_side(extra.size(), options_.threads, [&](std::size_t k) {
    Linearizer linear(linear_);
    UnbalanceSolver solver(linear, options_);
    solver.find_peaks(k / probes, k % probes, out.points, extra[k]);
    peaks[k] = std::move(solver.peaks_);
  });
  for (std::size_t k = 0; k < extra.size(); ++k) {
    std::move(peaks[k].begin(), peaks[k].end(), std::back_inserter(peaks_));
    std::move(extra[k].begin(), extra[k].end(), std::back_inserter(out.points));
  }
  std::sort(out.points.begin(), out.points.end(),
            [](const SteadyPoint& a, const SteadyPoint& b) { return a.Omega < b.Omega; });
  // the same peak seen by two probes: keep speeds apart by 1e-7
  out.points.erase(std::unique(out.points.begin(), out.points.end(),
                               [](const SteadyPoint& a, const SteadyPoint& b) {
                                 return b.Omega - a.Omega < 1e-7 * std::abs(b.Omega);
                               }),
                   out.points.end());
  return out;
}

}  // namespace whirl::analysis
