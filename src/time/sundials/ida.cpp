// IDA (SUNDIALS) on the first-order form: y = (q, v),
//     F1 = q' - v,      F2 = R(t, q, v, v'),
// and for held entries F1 = q - q(t), F2 = v - v(t). Variable-order BDF, held at order <= 2 by
// default: BDF of order 3 to 5 has negative numerical damping on lightly damped modes.
//
// Linear algebra: IDA's matrix and linear solver are shells around the Problem. With b = (b1, b2)
// and c = cj,
//     [c 1   -1; K   C + c M] (dq, dv) = (b1, b2)   <=>   (c^2 M + c C + K) dq = b2 + (C + c M) b1,
//         dv = c dq - b1.
//
// Whole turns that accept() takes out of phi stay in IDA's own vector (its history would otherwise
// have to start anew each revolution): y = q + offset. Spin angles have absolute tolerances, so the
// turns do not loosen them.
//
// Tolerance: BDF2 has global order 2, so the local weights follow tolerance^(3/2); ten periods of
// an undamped oscillator end with an error of the tolerance, as with generalized-alpha. The norm is
// the Euclidean one of the scaled errors (IDA's mean square would let one bad node hide among
// many).
#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <time/hermite.hpp>
#include <time/initial.hpp>
#include <time/response_scale.hpp>
#include <time/sundials/context.hpp>

#include <fmt/format.h>
#include <stdexcept>

namespace whirl::time::sundials {
namespace {

constexpr double allowance_factor = 0.015;
constexpr double weight_of_held = 1e-30;  // positive, as IDA demands; held entries are exact

class Ida final : public Integrator {
 public:
  Ida(Problem& problem, const Options& options);
  ~Ida() override;
  std::string_view name() const override { return "ida"; }
  int order() const override { return options_.max_order; }
  void start(double t, CRef q, CRef v) override;
  void restart(CRef q, CRef v, bool corner = false) override;
  StepReport advance() override;
  StepReport shorten_to(double t) override;
  double time() const override { return t_; }
  const VecX& q() const override { return q_; }
  const VecX& v() const override { return v_; }
  const VecX& a() const override { return a_; }
  double proposed_step() const override { return h_next_; }
  void interpolate(double t, Ref q, Ref v, Ref a) const override;
  void refresh() override { matrices_lost_ = true; }
  void set_end(double t_end) override { stops_.set_end(t_end); }
  void set_breakpoints(std::vector<double> times) override { stops_.set_breaks(std::move(times)); }
  const Statistics& statistics() const override { return statistics_; }
  Statistics judged_statistics() const override {
    Statistics s = statistics_;
    s.twist = scale_.twist();
    return s;
  }
  IntegratorState save() override;
  void restore(const IntegratorState& state) override;

 private:
  void check(int flag, const char* call) const {
    if (flag < 0) throw run_error("N31", fmt::format("IDA: {} returned {}", call, flag));
  }
  void initial_acceleration();
  void reinitialize();
  void begin_step();
  StepReport step_to(double stop, bool is_break);
  /// What IDA has counted since the last step.
  void count_failures(StepReport& report);
  /// Estimated error of the last step, of length h, in units of the allowance; uses yp_.
  double local_error(double h);
  void split(double t, N_Vector y, N_Vector yp);
  int residual(double t, N_Vector y, N_Vector yp, N_Vector r);
  int linearize(double t, double cj, N_Vector y, N_Vector yp);
  int factor();
  int solve(N_Vector x, N_Vector b);
  int weights(N_Vector w);

  Problem& problem_;
  Options options_;
  Index n_;
  std::vector<Index> held_;
  Context context_;
  void* ida_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SerialVector y_, yp_;
  bool initialized_ = false, reinitialize_ = true;
  Stops stops_;
  InitialSolver initial_;
  ResponseScale scale_;
  Statistics statistics_;
  double allowance_;

  double t0_ = 0.0, t_ = 0.0, t_stop_eval_ = infinity, h_next_ = 0.0, h_init_ = 0.0;
  bool accept_pending_ = false, at_break_ = false, have_step_ = false;
  VecX q0_, v0_, a0_, q_, v_, a_, offset_;
  VecX qs_, vs_, as_, r_, w_, increments_;
  // last linearisation, to make again when somebody else used the problem's matrices
  double t_lin_ = 0.0, cj_ = 0.0;
  VecX q_lin_, v_lin_, a_lin_;
  bool have_matrices_ = false, matrices_lost_ = false;
  long errors_before_ = 0, failures_before_ = 0, iterations_before_ = 0;
};

// ---------------------------------------------------------------------------------------------------------------------
// Callbacks

void Ida::split(double t, N_Vector y, N_Vector yp) {
  const auto yy = view(y), dy = view(yp);
  qs_ = yy.head(n_) - offset_;
  vs_ = yy.tail(n_);
  as_ = dy.tail(n_);
  problem_.impose(t, qs_, vs_, as_);
}

int Ida::residual(double t, N_Vector y, N_Vector yp, N_Vector r) {
  const double te = std::min(t, t_stop_eval_);
  split(te, y, yp);
  ++statistics_.residuals;
  if (!problem_.residual(te, qs_, vs_, as_, r_)) return 1;
  auto out = view(r);
  out.head(n_) = view(yp).head(n_) - view(y).tail(n_);
  out.tail(n_) = r_;
  for (Index i : held_) {
    out[i] = view(y)[i] - offset_[i] - qs_[i];
    out[n_ + i] = view(y)[n_ + i] - vs_[i];
  }
  return out.allFinite() ? 0 : 1;
}

int Ida::linearize(double t, double cj, N_Vector y, N_Vector yp) {
  t_lin_ = std::min(t, t_stop_eval_);
  cj_ = cj;
  split(t_lin_, y, yp);
  q_lin_ = qs_;
  v_lin_ = vs_;
  a_lin_ = as_;
  ++statistics_.linearizations;
  problem_.linearize(t_lin_, q_lin_, v_lin_, a_lin_);
  have_matrices_ = true;
  return 0;
}

int Ida::factor() {
  ++statistics_.factorizations_real;
  return problem_.factor(cj_ * cj_, cj_, 1.0) ? 0 : 1;
}

int Ida::solve(N_Vector x, N_Vector b) {
  const auto rhs = view(b);
  w_ = rhs.head(n_);
  for (Index i : held_)
    w_[i] = 0.0;
  r_ = rhs.tail(n_);
  problem_.add_C(1.0, w_, r_);
  problem_.add_M(cj_, w_, r_);
  for (Index i : held_)
    r_[i] = 0.0;
  problem_.solve(Ref(r_));
  ++statistics_.solves_real;
  auto out = view(x);
  out.tail(n_) = cj_ * r_ - w_;
  out.head(n_) = r_;
  for (Index i : held_) {
    const double b1 = rhs[i], b2 = rhs[n_ + i];
    out[i] = b1;
    out[n_ + i] = b2;
  }
  return out.allFinite() ? 0 : 1;
}

int Ida::weights(N_Vector w) {
  // After IDAReInit IDA still reports the step of its life before, which a run that was continued
  // does not know.
  double h = h_init_;
  long steps = 0;
  IDAGetNumSteps(ida_, &steps);
  if (steps > 0) IDAGetCurrentStep(ida_, &h);
  increments_ = h * v_ + (0.5 * h * h) * a_;
  scale_.begin_step(increments_);
  auto out = view(w);
  const double factor = std::sqrt(2.0 * static_cast<double>(n_)) / allowance_;
  out.head(n_) = factor * scale_.weights();
  out.tail(n_) = (h * factor) * scale_.weights().cwiseProduct(initial_.dynamic());
  // IDA refuses weights finer than the rounding of y
  const auto y = y_.map();
  for (Index i = 0; i < 2 * n_; ++i) {
    const double rounding =
        0.1 / (std::numeric_limits<double>::epsilon() * std::abs(y[i]) + 1e-300);
    out[i] = std::max(std::min(out[i], rounding), weight_of_held);
  }
  return 0;
}

// ---------------------------------------------------------------------------------------------------------------------
// Set-up

Ida::Ida(Problem& problem, const Options& options)
    : problem_(problem),
      options_(options),
      n_(problem.size()),
      y_(2 * n_, context_.handle),
      yp_(2 * n_, context_.handle) {
  if (options.dt_fixed > 0.0)
    throw Error(Exit::usage,
                Diagnostic{Diagnostic::Severity::error,
                           "N11",
                           "IDA chooses its own steps: a fixed step is not possible",
                           "use radau5, gauss4, gauss6 or generalized_alpha for equal steps",
                           {}});
  const auto kinds = problem.kinds();
  for (Index i = 0; i < n_; ++i)
    if (kinds[static_cast<std::size_t>(i)] == Kind::held) held_.push_back(i);
  for (VecX* x : {&q0_, &v0_, &a0_, &q_, &v_, &a_, &offset_, &qs_, &vs_, &as_, &r_, &w_,
                  &increments_, &q_lin_, &v_lin_, &a_lin_})
    *x = VecX::Zero(n_);
  stops_.set_end(options.t_end);
  stops_.set_breaks(options.breakpoints);
  initial_.resize(problem);
  scale_.resize(kinds, options.scales);
  scale_.weigh_spin_by_twist();
  allowance_ = allowance_factor * std::pow(options.tolerance, 1.5);

  ida_ = IDACreate(context_.handle);
  if (!ida_) throw run_error("N30", "IDA cannot be created");
  solver_ = SUNLinSolNewEmpty(context_.handle);
  matrix_ = SUNMatNewEmpty(context_.handle);
  if (!solver_ || !matrix_) throw run_error("N30", "IDA's linear solver cannot be created");
  solver_->content = this;
  solver_->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
  solver_->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
  solver_->ops->setup = [](SUNLinearSolver s, SUNMatrix) {
    return static_cast<Ida*>(s->content)->factor();
  };
  solver_->ops->solve = [](SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) {
    return static_cast<Ida*>(s->content)->solve(x, b);
  };
  matrix_->ops->getid = [](SUNMatrix) { return SUNMATRIX_CUSTOM; };
  matrix_->ops->zero = [](SUNMatrix) { return 0; };
}

Ida::~Ida() {
  if (ida_) IDAFree(&ida_);
  if (solver_) SUNLinSolFreeEmpty(solver_);
  if (matrix_) SUNMatFreeEmpty(matrix_);
}

void Ida::initial_acceleration() {
  const StepStatus status = initial_.solve(problem_, t_, q_, v_, a_, statistics_);
  if (status != StepStatus::ok)
    throw run_error(
        "N20",
        fmt::format("no acceleration satisfies the equations at t = {} s: {}", t_, message(status)),
        "a part without mass that nothing holds, or a state outside the model's range");
  reinitialize_ = true;
}

void Ida::start(double t, CRef q, CRef v) {
  statistics_ = {};
  t_ = t0_ = t;
  q_ = q;
  v_ = v;
  a_.setZero();
  accept_pending_ = at_break_ = have_step_ = false;
  problem_.impose(t, q_, v_, a_);
  initial_acceleration();
  scale_.reset(q_);
  bool is_break;
  const double stop = stops_.next(t_, is_break), span = std::isfinite(stop) ? stop - t_ : 1.0;
  h_next_ = options_.dt_first > 0.0 ? options_.dt_first : 1e-6 * span;
  q0_ = q_;
  v0_ = v_;
  a0_ = a_;
}

void Ida::restart(CRef q, CRef v, bool) {
  q_ = q;
  v_ = v;
  accept_pending_ = at_break_ = have_step_ = false;
  problem_.impose(t_, q_, v_, a_);
  initial_acceleration();
  for (Index i = 0; i < n_; ++i)
    if (q_[i] != q0_[i]) scale_.rebase(i, q_[i]);
  q0_ = q_;
  v0_ = v_;
  a0_ = a_;
  t0_ = t_;
}

void Ida::reinitialize() {
  offset_.setZero();
  auto y = y_.map(), yp = yp_.map();
  y << q_, v_;
  yp << v_, a_;
  // order 1 takes shorter steps than the order 2 that proposed this one
  h_init_ = std::max(std::min(0.1 * h_next_, options_.dt_max), options_.dt_min);
  if (!initialized_) {
    check(IDAInit(
              ida_,
              [](realtype t, N_Vector yy, N_Vector yd, N_Vector r, void* self) {
                return static_cast<Ida*>(self)->residual(t, yy, yd, r);
              },
              t_, y_.handle(), yp_.handle()),
          "IDAInit");
    check(IDASetUserData(ida_, this), "IDASetUserData");
    check(IDASetErrHandlerFn(ida_, silent, nullptr), "IDASetErrHandlerFn");
    check(IDAWFtolerances(ida_, [](N_Vector, N_Vector w,
                                   void* self) { return static_cast<Ida*>(self)->weights(w); }),
          "IDAWFtolerances");
    check(IDASetMaxOrd(ida_, options_.max_order), "IDASetMaxOrd");
    check(IDASetLinearSolver(ida_, solver_, matrix_), "IDASetLinearSolver");
    check(IDASetJacFn(ida_,
                      [](realtype t, realtype cj, N_Vector yy, N_Vector yd, N_Vector, SUNMatrix,
                         void* self, N_Vector, N_Vector,
                         N_Vector) { return static_cast<Ida*>(self)->linearize(t, cj, yy, yd); }),
          "IDASetJacFn");
    check(IDASetMaxNonlinIters(ida_, std::max(4, options_.max_newton)), "IDASetMaxNonlinIters");
    check(IDASetMaxErrTestFails(ida_, options_.max_attempts), "IDASetMaxErrTestFails");
    check(IDASetMaxConvFails(ida_, options_.max_attempts), "IDASetMaxConvFails");
    // the iteration error is to be small against the local error: it adds up coherently in a free
    // spin
    check(IDASetNonlinConvCoef(ida_, 0.01), "IDASetNonlinConvCoef");
    if (std::isfinite(options_.dt_max))
      check(IDASetMaxStep(ida_, options_.dt_max), "IDASetMaxStep");
    initialized_ = true;
  } else {
    check(IDAReInit(ida_, t_, y_.handle(), yp_.handle()), "IDAReInit");
  }
  check(IDASetInitStep(ida_, h_init_), "IDASetInitStep");
  errors_before_ = failures_before_ = iterations_before_ = 0;
  reinitialize_ = matrices_lost_ = have_matrices_ = false;
}

// ---------------------------------------------------------------------------------------------------------------------
// Steps

void Ida::begin_step() {
  if (accept_pending_) {
    accept_pending_ = false;
    q0_ = q_;
    v0_ = v_;
    a0_ = a_;
    if (problem_.accept(t_, q_, v_, a_)) {
      for (Index i = 0; i < n_; ++i) {
        if (v_[i] != v0_[i] || a_[i] != a0_[i]) reinitialize_ = true;
        if (q_[i] != q0_[i]) scale_.rebase(i, q_[i]);
      }
      if (!reinitialize_) offset_ += q0_ - q_;
    }
  }
  if (at_break_) {
    at_break_ = false;
    problem_.impose(t_, q_, v_, a_);
    initial_acceleration();
  }
  q0_ = q_;
  v0_ = v_;
  a0_ = a_;
  t0_ = t_;
  if (reinitialize_) reinitialize();
  if (matrices_lost_ && have_matrices_) {
    problem_.linearize(t_lin_, q_lin_, v_lin_, a_lin_);
    factor();
  }
  matrices_lost_ = false;
}

StepReport Ida::advance() {
  StepReport report;
  report.t0 = report.t1 = t_;
  if (t_ >= stops_.end()) {
    report.status = StepStatus::finished;
    return report;
  }
  bool is_break;
  const double stop = stops_.next(t_, is_break);
  begin_step();
  return step_to(stop, is_break);
}

void Ida::count_failures(StepReport& report) {
  long errors = 0, failures = 0, iterations = 0;
  IDAGetNumErrTestFails(ida_, &errors);
  IDAGetNonlinSolvStats(ida_, &iterations, &failures);
  report.rejected_error = static_cast<int>(errors - errors_before_);
  report.rejected_newton = static_cast<int>(failures - failures_before_);
  report.newton_iterations = static_cast<int>(iterations - iterations_before_);
  errors_before_ = errors;
  failures_before_ = failures;
  iterations_before_ = iterations;
  statistics_.rejected_error += report.rejected_error;
  statistics_.rejected_newton += report.rejected_newton;
  statistics_.newton_iterations += report.newton_iterations;
}

double Ida::local_error(double h) {
  SerialVector& error = yp_;  // its values were read by split(), IDA writes it anew
  if (IDAGetEstLocalErrors(ida_, error.handle()) != IDA_SUCCESS) return StepReport().error;
  const double factor = 1.0 / allowance_;
  increments_ = error.map().head(n_).cwiseProduct(scale_.weights());
  const double eq = increments_.squaredNorm();
  increments_ =
      h * error.map().tail(n_).cwiseProduct(scale_.weights()).cwiseProduct(initial_.dynamic());
  return factor * std::sqrt(eq + increments_.squaredNorm());
}

StepReport Ida::step_to(double stop, bool is_break) {
  StepReport report;
  report.t0 = report.t1 = t0_;
  t_stop_eval_ = is_break ? std::nextafter(stop, t0_) : infinity;
  if (std::isfinite(stop)) check(IDASetStopTime(ida_, stop), "IDASetStopTime");
  // without a least step IDA creeps towards an impassable state for ever
  const double least =
      options_.dt_min > 0.0 ? options_.dt_min : std::max(1e-14 * std::abs(t0_), 1e-300);
  check(IDASetMinStep(ida_, std::min(least, options_.dt_max)), "IDASetMinStep");
  if (!options_.paces.empty()) {
    const double longest = std::min(options_.dt_max, longest_step(options_.paces, t0_));
    check(IDASetMaxStep(ida_, std::isfinite(longest) ? longest : 0.0), "IDASetMaxStep");
  }
  realtype reached = t0_;
  const double far = std::isfinite(stop) ? stop : t0_ + 1e3 * std::max(1.0, std::abs(t0_));
  const int flag = IDASolve(ida_, far, &reached, y_.handle(), yp_.handle(), IDA_ONE_STEP);
  count_failures(report);
  if (flag < 0) {
    report.status = flag == IDA_ERR_FAIL                                 ? StepStatus::error_test
                    : flag == IDA_LSETUP_FAIL || flag == IDA_LSOLVE_FAIL ? StepStatus::singular
                    : flag == IDA_REP_RES_ERR || flag == IDA_RES_FAIL || flag == IDA_FIRST_RES_FAIL
                        ? StepStatus::domain
                        : StepStatus::newton;
    reinitialize_ = true;  // the state stays at t0
    return report;
  }
  const bool landed = flag == IDA_TSTOP_RETURN;
  t_ = landed ? stop : reached;
  split(std::min(t_, t_stop_eval_), y_.handle(), yp_.handle());
  q_ = qs_;
  v_ = vs_;
  a_ = as_;
  report.t1 = t_;
  report.at_breakpoint = at_break_ = landed && is_break;
  have_step_ = accept_pending_ = true;
  scale_.observe(q_);
  scale_.observe_twist(q0_, q_, false);
  IDAGetCurrentStep(ida_, &h_next_);
  const double h = t_ - t0_;
  report.error = local_error(h);
  ++statistics_.accepted;
  statistics_.step_min = std::min(statistics_.step_min, h);
  statistics_.step_max = std::max(statistics_.step_max, h);
  statistics_.step_sum += h;
  statistics_.error_max = std::max(statistics_.error_max, report.error);
  statistics_.error_sum += report.error;
  return report;
}

StepReport Ida::shorten_to(double t) {
  if (!have_step_ || !(t > t0_ && t < t_))
    throw std::invalid_argument("shorten_to: t outside the last step");
  // IDA cannot step back: its solution at t is that of its interpolant, from which it starts anew.
  const double h_before = t_ - t0_, wanted = h_next_;
  t_stop_eval_ = infinity;
  // not into what it is computed from
  interpolate(t, qs_, vs_, as_);
  q_ = qs_;
  v_ = vs_;
  a_ = as_;
  t_ = t;
  initial_acceleration();
  scale_.observe(q_);
  accept_pending_ = true;
  at_break_ = false;
  h_next_ = wanted;
  statistics_.step_sum += (t - t0_) - h_before;
  StepReport report;
  report.t0 = t0_;
  report.t1 = t_;
  return report;
}

void Ida::interpolate(double t, Ref q, Ref v, Ref a) const {
  if (take_end(have_step_ ? t : t_, {t_, q_, v_, a_}, q, v, a)) return;
  if (take_end(t, {t0_, q0_, v0_, a0_}, q, v, a)) return;
  const double h = t_ - t0_;
  hermite((t - t0_) / h, h, q0_, v0_, q_, v_, q, v, a);
  problem_.impose(t, q, v, a);
}

// ---------------------------------------------------------------------------------------------------------------------
// IDA's history cannot be written back: both the saving and the restored integrator start anew from
// the same state, and nothing of IDA's memory from before that may reach what comes after
// (weights()).

IntegratorState Ida::save() {
  reinitialize_ = true;
  IntegratorState s;
  s.t = t_;
  s.q = q_;
  s.v = v_;
  s.a = a_;
  auto& out = s.history;
  const Statistics& k = statistics_;
  for (long c : {k.accepted, k.rejected_error, k.rejected_newton, k.newton_iterations,
                 k.linearizations, k.factorizations_real, k.factorizations_complex, k.residuals,
                 k.solves_real, k.solves_complex})
    out.push_back(static_cast<double>(c));
  out.insert(out.end(), {k.step_min, k.step_max, k.step_sum, k.error_max, k.error_sum, h_next_,
                         accept_pending_ ? 1.0 : 0.0, at_break_ ? 1.0 : 0.0});
  scale_.save(out);
  initial_.save(out);
  return s;
}

void Ida::restore(const IntegratorState& s) {
  if (s.q.size() != n_ || s.v.size() != n_ || s.a.size() != n_ ||
      s.history.size() != save().history.size())
    throw std::invalid_argument("integrator state of another problem or scheme");
  const double* in = s.history.data();
  Statistics& k = statistics_;
  for (long* c : {&k.accepted, &k.rejected_error, &k.rejected_newton, &k.newton_iterations,
                  &k.linearizations, &k.factorizations_real, &k.factorizations_complex,
                  &k.residuals, &k.solves_real, &k.solves_complex})
    *c = static_cast<long>(*in++);
  for (double* c : {&k.step_min, &k.step_max, &k.step_sum, &k.error_max, &k.error_sum, &h_next_})
    *c = *in++;
  accept_pending_ = *in++ != 0.0;
  at_break_ = *in++ != 0.0;
  in = scale_.restore(in);
  initial_.restore(in);
  t_ = t0_ = s.t;
  q_ = q0_ = s.q;
  v_ = v0_ = s.v;
  a_ = a0_ = s.a;
  have_step_ = false;
  reinitialize_ = true;
}

}  // namespace

std::unique_ptr<Integrator> make_ida(Problem& problem, const Options& options) {
  return std::make_unique<Ida>(problem, options);
}

}  // namespace whirl::time::sundials
