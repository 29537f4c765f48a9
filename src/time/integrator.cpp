#include <time/integrator.hpp>

#include <core/error.hpp>
#include <core/plugin.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <time/collocation.hpp>
#include <time/generalized_alpha.hpp>
#include <time/sundials/entry.hpp>

#include <cmath>
#include <stdexcept>

namespace whirl::time {

std::string_view message(StepStatus status) {
  switch (status) {
    case StepStatus::ok: return "ok";
    case StepStatus::error_test: return "the error test fails at the smallest step";
    case StepStatus::newton: return "Newton's iteration does not converge at the smallest step";
    case StepStatus::domain: return "the motion leaves the range of the model";
    case StepStatus::singular: return "the iteration matrix is singular";
    case StepStatus::finished: return "the end time is reached";
  }
  return "";
}

std::vector<double> IntegratorState::serialize() const {
  std::vector<double> out{1.0, static_cast<double>(q.size()), static_cast<double>(history.size()),
                          t};
  for (const VecX* x : {&q, &v, &a})
    out.insert(out.end(), x->data(), x->data() + x->size());
  out.insert(out.end(), history.begin(), history.end());
  return out;
}

IntegratorState IntegratorState::deserialize(const std::vector<double>& data) {
  auto bad = [] { return std::invalid_argument("not a saved integrator state"); };
  if (data.size() < 4 || data[0] != 1.0) throw bad();
  if (!(data[1] >= 0.0 && data[1] < 1e12 && data[2] >= 0.0 && data[2] < 1e12)) throw bad();
  const auto n = static_cast<std::size_t>(data[1]), m = static_cast<std::size_t>(data[2]);
  if (data.size() != 4 + 3 * n + m) throw bad();
  IntegratorState s;
  s.t = data[3];
  const double* in = data.data() + 4;
  for (VecX* x : {&s.q, &s.v, &s.a}) {
    *x = Eigen::Map<const VecX>(in, static_cast<Index>(n));
    in += n;
  }
  s.history.assign(in, in + m);
  return s;
}

std::vector<std::string_view> integrator_names() {
  return {"radau5", "gauss4", "gauss6", "generalized_alpha", "ida"};
}

namespace {

[[noreturn]] void refuse(std::string text, std::string hint) {
  throw Error(Exit::usage,
              Diagnostic{Diagnostic::Severity::error, "N10", std::move(text), std::move(hint), {}});
}

void check(const Options& o) {
  auto positive = [](double x) { return x > 0.0; };  // false for NaN
  if (!(o.tolerance >= 1e-13 && o.tolerance <= 0.1))
    refuse(fmt::format("integrator tolerance {} is out of range", o.tolerance),
           "choose 1e-13 ... 0.1; the default is 1e-4");
  if (!(o.rho_inf >= 0.0 && o.rho_inf <= 1.0))
    refuse(fmt::format("rho_inf = {} is out of range", o.rho_inf),
           "0 damps unresolved modes at once, 1 not at all");
  if (!(o.dt_fixed >= 0.0) || !(o.dt_first >= 0.0) || !(o.dt_min >= 0.0) || !positive(o.dt_max) ||
      o.dt_min > o.dt_max)
    refuse("a step length of the integrator is negative, or dt_min exceeds dt_max",
           "leave them out to have them chosen");
  if (!std::isfinite(o.dt_fixed) || std::isnan(o.t_end))
    refuse("a time given to the integrator is not a number", {});
  if (o.max_newton < 1 || o.max_attempts < 1)
    refuse("max_newton and max_attempts must be at least 1", {});
  if (o.max_order < 1 || o.max_order > 5)
    refuse(fmt::format("max_order = {} is out of range", o.max_order), "1 ... 5");
  const Scales& s = o.scales;
  if (!positive(s.spin_angle) || !positive(s.length) || !positive(s.floor_displacement) ||
      !positive(s.floor_tilt) || !positive(s.floor_internal) || !(s.displacement >= 0.0) ||
      !(s.tilt >= 0.0) || !(s.internal >= 0.0) || !(s.cross_floor >= 0.0))
    refuse("an error scale of the integrator is not positive", {});
}

}  // namespace

std::unique_ptr<Integrator> make_integrator(std::string_view name, Problem& problem,
                                            const Options& options) {
  check(options);
  if (name == "radau5") return std::make_unique<Collocation>("radau5", radau5(), problem, options);
  if (name == "gauss4") return std::make_unique<Collocation>("gauss4", gauss4(), problem, options);
  if (name == "gauss6") return std::make_unique<Collocation>("gauss6", gauss6(), problem, options);
  if (name == "generalized_alpha") return std::make_unique<GeneralizedAlpha>(problem, options);
  if (name == "ida")
    return std::unique_ptr<Integrator>(Plugin::load("sundials")
                                           .function<decltype(whirl_sundials_make_ida)>(
                                               "whirl_sundials_make_ida")(problem, options));
  refuse(fmt::format("there is no integrator '{}'", name),
         fmt::format("known: {}", fmt::join(integrator_names(), ", ")));
}

std::unique_ptr<ExplicitIntegrator> make_explicit_integrator(FirstOrderProblem& problem,
                                                             const Options& options, int order) {
  check(options);
  if (order < 2 || order > 8)
    refuse(fmt::format("there is no explicit Runge-Kutta method of order {}", order), "2 ... 8");
  return std::unique_ptr<ExplicitIntegrator>(
      Plugin::load("sundials")
          .function<decltype(whirl_sundials_make_erk)>("whirl_sundials_make_erk")(problem, options,
                                                                                  order));
}

}  // namespace whirl::time
