// Explicit Runge-Kutta with automatic step for y' = F(t, y): ERKStep of ARKODE (SUNDIALS). Error
// weights: relative to the larger of the entry and its scale; entries that grow without bound
// (angles) relative to their scale alone.
#include <arkode/arkode_erkstep.h>
#include <time/sundials/context.hpp>

#include <fmt/format.h>

namespace whirl::time::sundials {
namespace {

class Erk final : public ExplicitIntegrator {
 public:
  Erk(FirstOrderProblem& problem, const Options& options, int order)
      : problem_(problem),
        options_(options),
        order_(order),
        n_(problem.size()),
        work_(n_, context_.handle),
        y_(VecX::Zero(n_)),
        y0_(VecX::Zero(n_)) {
    stops_.set_end(options.t_end);
    stops_.set_breaks(options.breakpoints);
  }
  ~Erk() override {
    if (ark_) ERKStepFree(&ark_);
  }
  std::string_view name() const override { return "erk"; }
  int order() const override { return order_; }
  void start(double t, CRef y) override;
  StepReport advance() override;
  double time() const override { return t_; }
  const VecX& y() const override { return y_; }
  void interpolate(double t, Ref y) const override;
  void set_end(double t_end) override { stops_.set_end(t_end); }
  const Statistics& statistics() const override { return statistics_; }

 private:
  void check(int flag, const char* call) const {
    if (flag < 0) throw run_error("N32", fmt::format("ARKODE: {} returned {}", call, flag));
  }
  int rate(double t, N_Vector y, N_Vector dy) {
    ++statistics_.residuals;
    auto out = view(dy);
    return problem_.rate(std::min(t, t_stop_eval_), view(y), out) && out.allFinite() ? 0 : 1;
  }
  int weights(N_Vector y, N_Vector w) const {
    const auto x = view(y);
    auto out = view(w);
    for (Index i = 0; i < n_; ++i) {
      const double size = problem_.is_unbounded(i) ? problem_.scale(i)
                                                   : std::max(problem_.scale(i), std::abs(x[i]));
      out[i] = 1.0 / (options_.tolerance * size);
    }
    return 0;
  }

  FirstOrderProblem& problem_;
  Options options_;
  int order_;
  Index n_;
  Context context_;
  SerialVector work_;
  void* ark_ = nullptr;
  Stops stops_;
  Statistics statistics_;
  double t0_ = 0.0, t_ = 0.0, t_stop_eval_ = infinity;
  long errors_before_ = 0;
  bool at_break_ = false, have_step_ = false;
  VecX y_, y0_;
};

void Erk::start(double t, CRef y) {
  statistics_ = {};
  t_ = t0_ = t;
  y_ = y0_ = y;
  at_break_ = have_step_ = false;
  errors_before_ = 0;
  t_stop_eval_ = infinity;
  work_.map() = y;
  if (ark_) ERKStepFree(&ark_);
  ark_ = ERKStepCreate([](realtype time, N_Vector x, N_Vector dx,
                          void* self) { return static_cast<Erk*>(self)->rate(time, x, dx); },
                       t, work_.handle(), context_.handle);
  if (!ark_) throw run_error("N30", "ERKStep cannot be created");
  check(ERKStepSetUserData(ark_, this), "ERKStepSetUserData");
  check(ERKStepSetErrHandlerFn(ark_, silent, nullptr), "ERKStepSetErrHandlerFn");
  check(ERKStepSetOrder(ark_, order_), "ERKStepSetOrder");
  check(ERKStepWFtolerances(ark_,
                            [](N_Vector x, N_Vector w, void* self) {
                              return static_cast<const Erk*>(self)->weights(x, w);
                            }),
        "ERKStepWFtolerances");
  check(ERKStepSetMaxErrTestFails(ark_, options_.max_attempts), "ERKStepSetMaxErrTestFails");
  if (options_.dt_fixed > 0.0) {
    check(ERKStepSetFixedStep(ark_, options_.dt_fixed), "ERKStepSetFixedStep");
  } else {
    if (options_.dt_first > 0.0)
      check(ERKStepSetInitStep(ark_, options_.dt_first), "ERKStepSetInitStep");
    if (std::isfinite(options_.dt_max))
      check(ERKStepSetMaxStep(ark_, options_.dt_max), "ERKStepSetMaxStep");
    if (options_.dt_min > 0.0) check(ERKStepSetMinStep(ark_, options_.dt_min), "ERKStepSetMinStep");
  }
}

StepReport Erk::advance() {
  StepReport report;
  report.t0 = report.t1 = t_;
  if (t_ >= stops_.end()) {
    report.status = StepStatus::finished;
    return report;
  }
  if (at_break_) {  // the rate kept from the last step is that of the left side
    at_break_ = false;
    work_.map() = y_;
    check(ERKStepReset(ark_, t_, work_.handle()), "ERKStepReset");
  }
  bool is_break;
  const double stop = stops_.next(t_, is_break);
  t_stop_eval_ = is_break ? std::nextafter(stop, t_) : infinity;
  if (std::isfinite(stop)) check(ERKStepSetStopTime(ark_, stop), "ERKStepSetStopTime");
  const double far = std::isfinite(stop) ? stop : t_ + 1e3 * std::max(1.0, std::abs(t_));
  realtype reached = t_;
  const int flag = ERKStepEvolve(ark_, far, work_.handle(), &reached, ARK_ONE_STEP);
  long errors = 0;
  ERKStepGetNumErrTestFails(ark_, &errors);
  report.rejected_error = static_cast<int>(errors - errors_before_);
  errors_before_ = errors;
  statistics_.rejected_error += report.rejected_error;
  if (flag < 0) {
    report.status = flag == ARK_ERR_FAILURE ? StepStatus::error_test : StepStatus::domain;
    return report;
  }
  t0_ = t_;
  y0_ = y_;
  const bool landed = flag == ARK_TSTOP_RETURN;
  t_ = landed ? stop : reached;
  y_ = work_.map();
  have_step_ = true;
  report.t1 = t_;
  report.at_breakpoint = at_break_ = landed && is_break;
  const double h = t_ - t0_;
  ++statistics_.accepted;
  statistics_.step_min = std::min(statistics_.step_min, h);
  statistics_.step_max = std::max(statistics_.step_max, h);
  statistics_.step_sum += h;
  return report;
}

void Erk::interpolate(double t, Ref y) const {
  if (!have_step_ || t == t_) {
    y = y_;
    return;
  }
  if (t == t0_) {
    y = y0_;
    return;
  }
  auto& scratch = const_cast<SerialVector&>(work_);
  check(ERKStepGetDky(ark_, t, 0, scratch.handle()), "ERKStepGetDky");
  y = scratch.map();
}

}  // namespace

std::unique_ptr<ExplicitIntegrator> make_erk(FirstOrderProblem& problem, const Options& options,
                                             int order) {
  return std::make_unique<Erk>(problem, options, order);
}

}  // namespace whirl::time::sundials
