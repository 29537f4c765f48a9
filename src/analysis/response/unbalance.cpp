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

double ResponsePeak::amplification_bound() const {
  const double factor = amplification();
  return std::isnan(factor) ? std::abs(speed) / (high_seen - low_seen) : factor;
}

UnbalanceSolver::UnbalanceSolver(Linearizer& linear, const UnbalanceOptions& options)
    : linear_(linear),
      options_(options),
      solver_(linear) {
  if (options_.breathes)
    periodic_ = std::make_unique<PeriodicResponse>(linear, std::max(6, options_.multiples + 1));
  else if (options_.turns_with_rotor && !options_.speeds.empty())
    make_axes();
  if (!options_.outputs.empty()) meter_ = std::make_unique<VariationMeter>(linear);
}

void UnbalanceSolver::make_axes() {
  if (options_.harmonics < 0) options_.harmonics = enough_harmonics(linear_, options_.speeds);
  const Index H = std::max<Index>(options_.harmonics, 1);
  axes_ = std::make_unique<RotatingAxes>(linear_, fastest_of(options_.speeds), Harmonics{H, H});
}

void UnbalanceSolver::put_multiple(const VecXc& a, SteadyPoint& p) const {
  p.multiple.emplace_back();
  for (const ResponseProbe& probe : options_.probes)
    p.multiple.back().push_back(amplitude_at(linear_, a, probe.point));
}

void UnbalanceSolver::put_multiples(std::vector<VecXc> amplitudes, SteadyPoint& p) const {
  const VecXc still = linear_.equilibrium().state.q.cast<Complex>();
  for (int h = 0; h <= options_.multiples; ++h) {
    VecXc& a = amplitudes[static_cast<std::size_t>(h)];
    put_multiple(h == 0 ? VecXc(still + a) : a, p);
    if (options_.shapes && h != 1) p.shape_of_multiples.push_back(std::move(a));
  }
}

void UnbalanceSolver::stand_still(SteadyPoint& p) const {
  put_multiple(linear_.equilibrium().state.q.cast<Complex>(), p);
  for (int h = 1; h <= options_.multiples; ++h)
    put_multiple(VecXc::Zero(linear_.system().size()), p);
}

VecXc UnbalanceSolver::breathe(double Omega, SteadyPoint& p) {
  const PeriodicMotion motion = periodic_->solve(Omega);
  if (!motion.converged) {
    p.found = false;
    const VecXc none = VecXc::Constant(linear_.system().size(), Complex(nan, nan));
    for (int h = 0; h <= options_.multiples; ++h)
      put_multiple(none, p);
    return none;
  }
  put_multiples(motion.amplitude, p);
  p.left_out = motion.last_share;
  return motion.amplitude[1];
}

VecXc UnbalanceSolver::turn(double Omega, const VecXc& forcing, bool with_multiples,
                            SteadyPoint& p) {
  constexpr double beside = 1e-9;  // of an undamped resonance that is met exactly
  if (with_multiples) {
    std::vector<VecXc> all = axes_->multiples(Omega, -forcing, options_.multiples);
    if (!all[1].allFinite())
      all = axes_->multiples((1.0 + beside) * Omega, -forcing, options_.multiples);
    for (VecXc& a : all)
      linear_.system().complete(linear_.equilibrium().state, a);
    p.left_out = axes_->last_share();
    VecXc once = all[1];
    put_multiples(std::move(all), p);
    return once;
  }
  VecXc a = axes_->response(Omega, -forcing);
  if (!a.allFinite()) a = axes_->response((1.0 + beside) * Omega, -forcing);
  if (Omega < 0) a = a.conjugate().eval();
  linear_.system().complete(linear_.equilibrium().state, a);
  p.left_out = axes_->last_share();
  return a;
}

namespace {

/// What is seen of a steady motion: once a revolution, and the mean to three times.
struct Seen {
  Seen(RotatingAxes& axes, Linearizer& linear, double Omega) {
    linear.move_to(Omega);  // others were made meanwhile
    multiples = axes.multiples(Omega, -linear.forcing().front(), 3);
    once = multiples[1];
    multiples[1].setZero();
  }
  VecXc once;
  std::vector<VecXc> multiples;
};

/// Largest difference of the displacements, over the largest of these; of the multiples likewise.
double change(const system::System& s, const Seen& a, const Seen& b) {
  const double once = largest_displacement(s, b.once);
  double size = 1e-6 * once, off = 0.0;  // less is rounding, of a rotor without weight
  for (std::size_t h = 0; h < a.multiples.size(); ++h) {
    size = std::max(size, largest_displacement(s, b.multiples[h]));
    off = std::max(off, largest_displacement(s, VecXc(a.multiples[h] - b.multiples[h])));
  }
  const double of_once = largest_displacement(s, VecXc(a.once - b.once));
  return std::max(once > 0 ? of_once / once : 0.0, size > 0 ? off / size : 0.0);
}

}  // namespace

double fastest_of(const std::vector<double>& speeds) {
  WHIRL_EXPECTS(!speeds.empty());
  return std::abs(speeds.front()) > std::abs(speeds.back()) ? speeds.front() : speeds.back();
}

Index enough_harmonics(Linearizer& linear, const std::vector<double>& speeds, Index most) {
  constexpr int looks = 8;
  constexpr double nothing = 1e-4;
  constexpr Index more = 2;
  const auto with = [&](Index H) {
    return std::make_unique<RotatingAxes>(linear, fastest_of(speeds), Harmonics{H, H});
  };
  auto axes = std::make_unique<RotatingAxes>(linear, fastest_of(speeds));
  if (axes->constant()) return 0;
  auto finer = with(axes->harmonics() + more);
  // by value, not by number: speeds put in at peaks change nothing
  const double first = speeds.front(), last = speeds.back();
  for (int k = 0; k < (first < last ? looks : 1); ++k) {
    const double Omega = first + (last - first) * k / (looks - 1);
    if (std::abs(Omega) < 1e-3 * std::max(std::abs(first), std::abs(last))) continue;
    linear.move_to(Omega);
    if (linear.forcing().empty()) break;
    while (finer->harmonics() <= most) {
      const Seen now(*axes, linear, Omega), then(*finer, linear, Omega);
      if (!(change(linear.system(), now, then) > nothing)) break;
      axes = std::move(finer);
      finer = with(axes->harmonics() + more);
    }
  }
  return axes->harmonics();
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
  double largest = 0;
  const auto orders = linear_.running().orders();
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const double w = orders[k] * std::abs(Omega);
    VecXc a;
    linear_.move_to(Omega);
    // at rest what turns with the rotor is the slow roll of a bow or of a load on it
    const bool still = w == 0.0 && linear_.forcing()[k].isZero(0.0);
    if (still || (w == 0.0 && periodic_)) {
      a = VecXc::Zero(linear_.system().size());
      if (options_.multiples > 0) stand_still(p);
    } else if (periodic_) {
      a = breathe(Omega, p);
    } else if (axes_) {
      a = turn(Omega, linear_.forcing()[k], with_outputs && options_.multiples > 0, p);
    } else {
      a = solver_.response(Omega, w, [&] { return force_of(k, Omega); });
      if (w == 0.0 && solver_.bounded().size() > 0) a = solver_.bounded();
    }
    largest = std::max(largest, largest_displacement(linear_.system(), a));
    p.probe.emplace_back();
    for (const ResponseProbe& probe : options_.probes)
      p.probe.back().push_back(amplitude_at(linear_, a, probe.point));
    if (meter_ && with_outputs) {
      p.output.emplace_back();
      meter_->measure(a, force_of(k, Omega), w, options_.outputs, p.output.back());
    }
    if (options_.shapes) p.shape.push_back(std::move(a));
  }
  for (std::vector<PointAmplitude>& order : p.probe)
    drop_rounding(largest, order);
  return p;
}

namespace {

/// The same peak seen by two probes: speeds stay apart by 1e-7.
void sort_apart(std::vector<SteadyPoint>& points) {
  constexpr double apart = 1e-7;
  std::sort(points.begin(), points.end(),
            [](const SteadyPoint& a, const SteadyPoint& b) { return a.Omega < b.Omega; });
  points.erase(std::unique(points.begin(), points.end(),
                           [](const SteadyPoint& a, const SteadyPoint& b) {
                             return b.Omega - a.Omega < apart * std::abs(b.Omega);
                           }),
               points.end());
}

}  // namespace

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
  peak.low_seen = std::isnan(peak.low) ? inner : peak.low;
  inner = peak.speed;
  f_inner = peak.amplitude - half;
  for (std::size_t j = i; j < coarse.size(); ++j)
    if (coarse[j].Omega > peak.speed && ends_at(coarse[j], peak.high)) break;
  peak.high_seen = std::isnan(peak.high) ? inner : peak.high;
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

std::vector<double> UnbalanceSolver::sizes_of(const std::vector<SteadyPoint>& points,
                                              std::size_t order, std::size_t probe) {
  std::vector<double> sizes;
  sizes.reserve(points.size());
  for (const SteadyPoint& p : points)
    sizes.push_back(p.probe[order][probe].orbit().major);
  return sizes;
}

void UnbalanceSolver::find_peaks(std::size_t order, std::size_t probe,
                                 const std::vector<SteadyPoint>& coarse,
                                 std::vector<SteadyPoint>& extra) {
  WHIRL_EXPECTS(probe < options_.probes.size());
  const auto size = [&](const SteadyPoint& p) { return p.probe[order][probe].orbit().major; };
  bool all_found = true;
  const auto evaluate = [&](double Omega) {
    const SteadyPoint p = at(Omega, false);
    all_found = all_found && p.found;
    return size(p);
  };
  for (const std::size_t i : maxima_of(sizes_of(coarse, order, probe))) {
    all_found = true;
    const double f1 = size(coarse[i]);
    ResponsePeak peak;
    peak.order = order;
    peak.probe = probe;
    peak.speed =
        find_maximum(coarse[i - 1].Omega, coarse[i].Omega, f1, coarse[i + 1].Omega, 3e-9, evaluate);
    const SteadyPoint top_point = at(peak.speed);
    peak.amplitude = size(top_point);
    peak.phase_lag = -std::arg(top_point.probe[order][probe].forward());
    peak.bounded = all_found && is_bounded(peak);
    if (!peak.bounded) {
      peak.amplitude = infinity;
      peak.low = peak.high = peak.low_seen = peak.high_seen = peak.speed;
      peaks_.push_back(peak);
      continue;
    }
    find_half_power(coarse, i, peak);
    peaks_.push_back(peak);
    if (!options_.refine_peaks) continue;
    extra.push_back(top_point);
    add_points(peak, coarse.front().Omega, coarse.back().Omega,
               coarse[i + 1].Omega - coarse[i - 1].Omega, extra);
  }
  if (options_.refine_peaks) add_edges_of_no_motion(order, probe, coarse);
}

void UnbalanceSolver::add_edges_of_no_motion(std::size_t order, std::size_t probe,
                                             const std::vector<SteadyPoint>& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    // one alone is none of a band: its iteration failed
    if (points[i].found || points[i - 1].found == points[i + 1].found) continue;
    ResponsePeak edge;
    edge.order = order;
    edge.probe = probe;
    edge.amplitude = infinity;
    edge.bounded = false;
    edge.speed = edge.low = edge.high = edge.low_seen = edge.high_seen = points[i].Omega;
    peaks_.push_back(edge);
  }
  std::stable_sort(peaks_.begin(), peaks_.end(),
                   [](const ResponsePeak& a, const ResponsePeak& b) { return a.speed < b.speed; });
}

void UnbalanceSolver::add_unbounded_ends(const std::vector<SteadyPoint>& points) {
  for (std::size_t order = 0; order < points.front().probe.size(); ++order)
    for (std::size_t probe = 0; probe < options_.probes.size(); ++probe)
      for (const std::size_t end : ends_that_stand_out(sizes_of(points, order, probe))) {
        ResponsePeak peak;
        peak.order = order;
        peak.probe = probe;
        peak.speed = peak.low = peak.high = peak.low_seen = peak.high_seen = points[end].Omega;
        peak.amplitude = infinity;
        if (peak.speed == 0.0 || !points[end].found) continue;
        peak.bounded = is_bounded(peak);
        if (!peak.bounded) peaks_.push_back(peak);
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

bool UnbalanceSolver::shows_another(const std::vector<SteadyPoint>& points, std::size_t order,
                                    std::size_t probe) const {
  for (const std::size_t i : maxima_of(sizes_of(points, order, probe))) {
    const bool known = std::any_of(peaks_.begin(), peaks_.end(), [&](const ResponsePeak& p) {
      return p.order == order && p.probe == probe && p.speed >= points[i - 1].Omega &&
             p.speed <= points[i + 1].Omega;
    });
    if (!known) return true;
  }
  return false;
}

bool UnbalanceSolver::is_straight(const SteadyPoint& a, const SteadyPoint& middle,
                                  const SteadyPoint& b) const {
  constexpr double enough = 0.1;
  for (std::size_t k = 0; k < middle.probe.size(); ++k)
    for (std::size_t p = 0; p < middle.probe[k].size(); ++p) {
      const PointAmplitude &low = a.probe[k][p], &here = middle.probe[k][p], &high = b.probe[k][p];
      const double off = std::abs(0.5 * (low.forward() + high.forward()) - here.forward()) +
                         std::abs(0.5 * (low.backward() + high.backward()) - here.backward());
      if (off > enough * here.orbit().major) return false;
    }
  return true;
}

void UnbalanceSolver::resolve(std::vector<SteadyPoint>& points) {
  constexpr int rounds = 10;
  std::vector<bool> open(points.size(), true);  // the stretch from a point to the next one
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> middles;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      if (open[i]) middles.push_back(0.5 * (points[i].Omega + points[i + 1].Omega));
    if (middles.empty()) return;
    std::vector<SteadyPoint> found = points_at(middles), merged;
    std::vector<bool> still;
    std::size_t next = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool divided = open[i] && i + 1 < points.size();
      const bool again = divided && !is_straight(points[i], found[next], points[i + 1]);
      merged.push_back(std::move(points[i]));
      still.push_back(again);
      if (!divided) continue;
      merged.push_back(std::move(found[next++]));
      still.push_back(again);
    }
    points = std::move(merged);
    open = std::move(still);
  }
}

bool UnbalanceSolver::is_bounded(const ResponsePeak& peak) {
  const auto amplitude = [&](double side) {
    return at(peak.speed * (1 + side * beside_resonance), false).probe[peak.order][peak.probe];
  };
  return !turns_about(amplitude(-1.0), amplitude(1.0));
}

void UnbalanceSolver::drop_unbounded(std::vector<SteadyPoint>& points) const {
  constexpr double near = 1e-6;
  const auto drop = [&](const auto& peaks) {
    std::erase_if(points, [&](const SteadyPoint& x) {
      return std::any_of(peaks.begin(), peaks.end(), [&](const auto& p) {
        return x.found && !p.bounded && std::abs(x.Omega - p.speed) < near * std::abs(p.speed);
      });
    });
  };
  drop(peaks_);
  drop(peaks_of_multiples_);
}

UnbalanceResponse UnbalanceSolver::run() {
  constexpr int rounds = 4;
  UnbalanceResponse out;
  const auto orders = linear_.running().orders();
  out.orders.assign(orders.begin(), orders.end());
  peaks_.clear();
  peaks_of_multiples_.clear();
  out.points = points_at(options_.speeds);
  if (std::none_of(out.points.begin(), out.points.end(),
                   [](const SteadyPoint& p) { return p.found; }))
    throw run_error(
        "E76",
        "no periodic motion found at any of the speeds: the crack's opening and closing "
        "did not settle",
        "near a band of instability there may be none; a transient step follows the "
        "motion itself");
  if (options_.resolve) resolve(out.points);
  const std::size_t probes = options_.probes.size();
  std::vector<std::size_t> open(orders.size() * probes);
  for (std::size_t k = 0; k < open.size(); ++k)
    open[k] = k;
  for (int round = 0; round < rounds && !open.empty(); ++round) {
    find_peaks_of(open, out.points);
    std::erase_if(
        open, [&](std::size_t k) { return !shows_another(out.points, k / probes, k % probes); });
  }
  add_unbounded_ends(out.points);
  drop_unbounded(out.points);
  if (options_.refine_peaks) find_peaks_of_multiples(out.points);
  drop_unbounded(out.points);
  return out;
}

PointAmplitude UnbalanceSolver::multiple_at(double Omega, std::size_t h, std::size_t probe) {
  if (!axes_) return at(Omega, false).multiple[h][probe];
  linear_.move_to(Omega);
  // what turns makes odd ones alone
  const VecXc forces = h % 2 == 1 ? VecXc(-linear_.forcing().front()) : VecXc();
  VecXc a = axes_->multiples(Omega, forces, options_.multiples)[h];
  linear_.system().complete(linear_.equilibrium().state, a);
  return amplitude_at(linear_, a, options_.probes[probe].point);
}

void UnbalanceSolver::find_peaks_of_multiple(std::size_t h, std::size_t probe,
                                             const std::vector<SteadyPoint>& points) {
  constexpr double close_enough = 1e-8;  // of the speed
  constexpr double seen = 1e-3;          // of the largest at all speeds
  constexpr double rounding = 1e-9;      // of the speed itself
  const auto size = [&](const SteadyPoint& p, std::size_t k) {
    return p.multiple[k][probe].orbit().major;
  };
  std::vector<double> sizes;
  sizes.reserve(points.size());
  for (const SteadyPoint& p : points)
    sizes.push_back(size(p, h));
  double largest = 0;
  for (const double x : sizes)
    largest = std::max(largest, x);  // not of what was not found
  for (const std::size_t i : maxima_of(sizes)) {
    if (!(sizes[i] > std::max(seen * largest, rounding * size(points[i], 1)))) continue;
    const auto at_speed = [&](double Omega) { return multiple_at(Omega, h, probe); };
    MultiplePeak peak{h, probe};
    peak.speed =
        find_maximum(points[i - 1].Omega, points[i].Omega, sizes[i], points[i + 1].Omega,
                     close_enough, [&](double Omega) { return at_speed(Omega).orbit().major; });
    peak.bounded = !turns_about(at_speed(peak.speed * (1 - beside_resonance)),
                                at_speed(peak.speed * (1 + beside_resonance)));
    peak.amplitude = peak.bounded ? at_speed(peak.speed).orbit().major : infinity;
    peaks_of_multiples_.push_back(peak);
  }
}

void UnbalanceSolver::find_peaks_of_multiples(std::vector<SteadyPoint>& points) {
  for (std::size_t h = 2; h < points.front().multiple.size(); ++h)
    for (std::size_t probe = 0; probe < options_.probes.size(); ++probe)
      find_peaks_of_multiple(h, probe, points);
  for (const MultiplePeak& peak : peaks_of_multiples_)
    if (peak.bounded) points.push_back(at(peak.speed));
  sort_apart(points);
}

void UnbalanceSolver::find_peaks_of(const std::vector<std::size_t>& numbers,
                                    std::vector<SteadyPoint>& points) {
  const std::size_t probes = options_.probes.size();
  std::vector<std::vector<SteadyPoint>> extra(numbers.size());
  std::vector<std::vector<ResponsePeak>> peaks(numbers.size());
  run_side_by_side(numbers.size(), options_.threads, [&](std::size_t j) {
    Linearizer linear(linear_);
    UnbalanceSolver solver(linear, options_);
    solver.find_peaks(numbers[j] / probes, numbers[j] % probes, points, extra[j]);
    peaks[j] = std::move(solver.peaks_);
  });
  for (std::size_t j = 0; j < numbers.size(); ++j) {
    std::erase_if(peaks_,
                  [&](const ResponsePeak& p) { return p.order * probes + p.probe == numbers[j]; });
    std::move(peaks[j].begin(), peaks[j].end(), std::back_inserter(peaks_));
    std::move(extra[j].begin(), extra[j].end(), std::back_inserter(points));
  }
  std::stable_sort(peaks_.begin(), peaks_.end(),
                   [probes](const ResponsePeak& a, const ResponsePeak& b) {
                     return a.order * probes + a.probe < b.order * probes + b.probe;
                   });
  sort_apart(points);
}

}  // namespace whirl::analysis
