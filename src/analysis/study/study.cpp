#include <analysis/study/study.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <core/parallel.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace whirl::analysis {

std::string StudyCase::label() const {
  if (method.empty())
    return mesh_factor == 1 ? "the deck's mesh" : fmt::format("{} times the elements", mesh_factor);
  std::string s = tolerance > 0 ? fmt::format("{} tol {:.0e}", method, tolerance)
                                : fmt::format("{} dt {:.3g} s", method, dt);
  if (mesh_factor != 1) s += fmt::format(" mesh x{}", mesh_factor);
  return s;
}

double StudySample::worst() const {
  double w = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (i >= counted.size() || counted[i])
      w = std::isfinite(errors[i]) ? std::max(w, errors[i]) : infinity;
  return errors.empty() ? infinity : w;
}

namespace {

std::vector<double> errors_of(const std::vector<Quantity>& x, const std::vector<Quantity>& ref) {
  std::vector<double> out;
  for (std::size_t i = 0; i < ref.size(); ++i) {
    if (i >= x.size() || x[i].values.size() != ref[i].values.size()) {
      out.push_back(infinity);  // the run ended early
      continue;
    }
    double scale = ref[i].scale, error = 0.0;
    if (scale <= 0.0)
      for (double v : ref[i].values)
        scale = std::max(scale, std::abs(v));
    for (std::size_t k = 0; k < ref[i].values.size(); ++k) {
      const double d = std::abs(x[i].values[k] - ref[i].values[k]);
      error = std::isfinite(d) ? std::max(error, d) : infinity;
    }
    out.push_back(scale > 0.0 ? error / scale : error);
  }
  return out;
}

StudySample timed(const StudyRunner& run, const StudyCase& c, int repeats) {
  StudySample best = run(c);
  best.setting = c;
  // short runs: the fastest of a few, since the first pays for caches and page faults
  for (int k = 1; k < repeats && best.ok && best.seconds < 0.2; ++k)
    if (StudySample again = run(c); again.ok && again.seconds < best.seconds)
      best.seconds = again.seconds;
  return best;
}

/// The solution that all are measured against, and how well a second scheme confirms it.
void find_reference(const StudyRunner& run, const StudyOptions& options,
                    const std::vector<Quantity>* exact, StudyResult& result) {
  if (exact) {
    result.reference.quantities = *exact;
    result.uncertainty.assign(exact->size(), 0.0);
  } else {
    StudySample check;
    run_side_by_side(2, options.threads, [&](std::size_t k) {
      (k == 0 ? result.reference : check) =
          timed(run, k == 0 ? options.reference : options.cross_check, 1);
    });
    if (!result.reference.ok)
      throw run_error("R20", "the reference run of the study failed: " + result.reference.note,
                      "the deck does not run at " + options.reference.label());
    result.uncertainty = check.ok
                             ? errors_of(check.quantities, result.reference.quantities)
                             : std::vector<double>(result.reference.quantities.size(), infinity);
  }
  for (const Quantity& q : result.reference.quantities)
    result.quantities.push_back(q.name);
}

using LogPoint = std::pair<double, double>;  ///< -log(steps), log(error)

/// Slope of log(worst error) against log(step) by least squares over equal steps from the coarsest
/// on, as long as the slope holds: finer ones stand on another error (the mesh, motion too fast
/// for any of these steps, the reference itself). 0: there is none.
double fit_order(std::vector<LogPoint> p) {
  std::sort(p.rbegin(), p.rend());
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, steepest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i > 0) {
      const double slope = (p[i - 1].second - p[i].second) / (p[i - 1].first - p[i].first);
      if (slope > 8.0) {  // no scheme has it: the coarser step was too long to be anything
        n = x = y = xx = xy = steepest = 0;
      } else {
        if (!(slope > std::max(1.0, 0.6 * steepest))) break;
        steepest = std::max(steepest, slope);
      }
    }
    n += 1;
    x += p[i].first;
    y += p[i].second;
    xx += p[i].first * p[i].first;
    xy += p[i].first * p[i].second;
  }
  const double d = n * xx - x * x;
  return n >= 2 && d > 1e-12 ? (n * xy - x * y) / d : 0.0;
}

void find_orders(StudyResult& result) {
  double floor = 1e-13;
  for (std::size_t i = 0; i < result.uncertainty.size(); ++i)
    if (const double u = result.uncertainty[i];
        u <= resolved && result.reference.quantities[i].counts)
      floor = std::max(floor, 3.0 * u);
  std::map<std::string, std::vector<LogPoint>> points;
  for (const StudySample& s : result.samples) {
    if (s.setting.tolerance > 0) continue;  // the steps of adaptive runs are not proportional
    if (!s.ok || !(s.worst() > floor) || !(s.worst() < 0.3) || s.steps <= 0) continue;
    points[s.setting.method].emplace_back(-std::log(static_cast<double>(s.steps)),
                                          std::log(s.worst()));
  }
  for (const auto& [name, p] : points)
    result.orders.push_back({name, fit_order(p)});
}

/// Samples that no other beats in both error and time, and the cheapest of them for each target.
void find_best(const StudyOptions& options, StudyResult& result) {
  for (std::size_t i = 0; i < result.samples.size(); ++i) {
    const StudySample& a = result.samples[i];
    if (!a.ok) continue;
    const bool beaten =
        std::any_of(result.samples.begin(), result.samples.end(), [&](const StudySample& b) {
          return b.ok && &a != &b && b.worst() <= a.worst() && b.seconds <= a.seconds &&
                 (b.worst() < a.worst() || b.seconds < a.seconds);
        });
    if (!beaten) result.pareto.push_back(i);
  }
  std::sort(result.pareto.begin(), result.pareto.end(), [&](std::size_t a, std::size_t b) {
    return result.samples[a].seconds < result.samples[b].seconds;
  });
  for (double target : options.targets) {
    StudyResult::Advice advice{target, 0, false};
    for (std::size_t i : result.pareto)
      if (result.samples[i].worst() <= target) {
        advice.sample = i;
        advice.found = true;
        break;  // pareto is sorted by time
      }
    result.advice.push_back(advice);
  }
}

/// The samples of the ladder, told of in their order as they are there.
class Ladder {
 public:
  Ladder(const StudyRunner& run, const StudyOptions& options, StudyResult& result)
      : run_(run),
        options_(options),
        result_(result),
        done_(options.ladder.size(), 0) {
    result_.samples.resize(options.ladder.size());
  }

  void climb() {
    std::map<std::string, std::vector<std::size_t>> series;
    for (std::size_t k = 0; k < options_.ladder.size(); ++k)
      series[options_.series ? options_.series(options_.ladder[k]) : std::string()].push_back(k);
    std::vector<std::vector<std::size_t>> tasks;
    tasks.reserve(series.size());
    for (auto& [name, numbers] : series)
      tasks.push_back(std::move(numbers));
    std::sort(tasks.begin(), tasks.end());
    run_side_by_side(tasks.size(), options_.threads, [&](std::size_t k) {
      for (const std::size_t number : tasks[k])
        take(number);
    });
  }

 private:
  void take(std::size_t number) {
    StudySample s = timed(run_, options_.ladder[number], options_.repeats);
    if (s.ok) s.errors = errors_of(s.quantities, result_.reference.quantities);
    for (std::size_t i = 0; i < result_.uncertainty.size(); ++i)
      s.counted.push_back(result_.uncertainty[i] <= resolved &&
                          result_.reference.quantities[i].counts);
    const std::lock_guard lock(mutex_);
    result_.samples[number] = std::move(s);
    done_[number] = 1;
    for (; told_ < done_.size() && done_[told_]; ++told_)
      if (options_.progress) options_.progress(result_.samples[told_]);
  }

  const StudyRunner& run_;
  const StudyOptions& options_;
  StudyResult& result_;
  std::mutex mutex_;
  std::vector<unsigned char> done_;
  std::size_t told_ = 0;
};

}  // namespace

StudyResult run_study(const StudyRunner& run, const StudyOptions& options,
                      const std::vector<Quantity>* exact) {
  WHIRL_EXPECTS(options.repeats > 0);
  StudyResult result;
  find_reference(run, options, exact, result);
  Ladder(run, options, result).climb();
  find_orders(result);
  find_best(options, result);
  return result;
}

}  // namespace whirl::analysis
