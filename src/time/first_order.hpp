// First-order systems y' = F(t, y) and their explicit integrator: an independent route for models
// written in momenta.
#pragma once
#include <time/integrator.hpp>

namespace whirl::time {

class FirstOrderProblem {
 public:
  virtual ~FirstOrderProblem() = default;
  virtual Index size() const = 0;
  /// dy = F(t, y); false when y is outside the domain of F (the step is shortened).
  virtual bool rate(double t, CRef y, Ref dy) = 0;
  /// Absolute tolerance of entry i for relative tolerance `relative`: its scale times that. An
  /// unbounded angle has scale about 1 rad and is_unbounded true: its error is then never relative
  /// to the angle itself.
  virtual double scale(Index i) const = 0;
  virtual bool is_unbounded(Index i) const {
    (void)i;
    return false;
  }
};

class ExplicitIntegrator {
 public:
  virtual ~ExplicitIntegrator() = default;
  virtual std::string_view name() const = 0;
  virtual int order() const = 0;
  virtual void start(double t, CRef y) = 0;
  virtual StepReport advance() = 0;
  virtual double time() const = 0;
  virtual const VecX& y() const = 0;
  /// y at t inside the last step.
  virtual void interpolate(double t, Ref y) const = 0;
  virtual void set_end(double t_end) = 0;
  virtual const Statistics& statistics() const = 0;
};

/// Explicit Runge-Kutta with automatic step, ARKODE ERKStep (SUNDIALS plug-in). order 2..8. options
/// used: tolerance (relative local tolerance), t_end, dt_first, dt_min, dt_max, dt_fixed,
/// breakpoints.
/// @throws Error when the plug-in is missing.
std::unique_ptr<ExplicitIntegrator> make_explicit_integrator(FirstOrderProblem& problem,
                                                             const Options& options, int order = 5);

}  // namespace whirl::time
