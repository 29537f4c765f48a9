#include <analysis/transient/momentum_route.hpp>

#include <time/first_order.hpp>

#include <algorithm>

namespace whirl::analysis {

namespace {

class MomentumIntegrator final : public time::Integrator {
 public:
  MomentumIntegrator(system::SystemProblem& problem, const time::Options& options, int order)
      : problem_(problem),
        options_(options),
        order_(order),
        momentum_(problem.system()),
        explicit_(time::make_explicit_integrator(momentum_, options, order)),
        y0_(momentum_.size()),
        y_(momentum_.size()),
        now_(problem.system().make_state()),
        between_(now_) {}

  std::string_view name() const override { return "momentum_rk"; }
  int order() const override { return order_; }

  void start(double t, time::CRef q, time::CRef v) override {
    total_ = {};
    begin(t, q, v);
  }
  void restart(time::CRef q, time::CRef v, bool) override { begin(now_.t, q, v); }

  time::StepReport advance() override {
    if (momentum_.accept(y_)) {
      problem_.frames = momentum_.frames;
      add_statistics();
      explicit_->start(now_.t, y_);
    } else if (fresh_) {
      add_statistics();
      explicit_->start(now_.t, y_);
    }
    fresh_ = false;
    t0_ = now_.t;
    y0_ = y_;
    const time::StepReport report = explicit_->advance();
    if (report.ok()) take();
    return report;
  }
  time::StepReport shorten_to(double t) override {
    add_statistics();
    explicit_->start(t0_, y0_);
    explicit_->set_end(t);
    time::StepReport report;
    do
      report = explicit_->advance();
    while (report.ok() && explicit_->time() < t);
    explicit_->set_end(options_.t_end);
    report.t0 = t0_;
    report.t1 = explicit_->time();
    if (report.ok()) take();
    fresh_ = true;
    return report;
  }

  double time() const override { return now_.t; }
  const VecX& q() const override { return now_.q; }
  const VecX& v() const override { return now_.v; }
  const VecX& a() const override { return now_.a; }
  double proposed_step() const override { return statistics().step_mean(); }
  void interpolate(double t, time::Ref q, time::Ref v, time::Ref a) const override {
    VecX& y = scratch_;
    y.resize(momentum_.size());
    explicit_->interpolate(t, y);
    auto& form = const_cast<system::MomentumProblem&>(momentum_);  // evaluation scratch only
    form.get_state(t, y, between_);
    q = between_.q;
    v = between_.v;
    a = between_.a;
  }
  void refresh() override {}  // keeps no factorisation
  void set_end(double t_end) override {
    options_.t_end = t_end;
    explicit_->set_end(t_end);
  }
  void set_breakpoints(std::vector<double> times) override {
    options_.breakpoints = std::move(times);
    explicit_ = time::make_explicit_integrator(momentum_, options_, order_);
    explicit_->start(now_.t, y_);
  }
  const time::Statistics& statistics() const override {
    shown_ = total_;
    const time::Statistics& s = explicit_->statistics();
    shown_.accepted += s.accepted;
    shown_.rejected_error += s.rejected_error;
    shown_.residuals += s.residuals;
    shown_.step_sum += s.step_sum;
    shown_.step_min = std::min(shown_.step_min, s.step_min);
    shown_.step_max = std::max(shown_.step_max, s.step_max);
    return shown_;
  }

  time::IntegratorState save() override {
    fresh_ = true;  // both the saved and the running one start anew here
    return {now_.t, now_.q, now_.v, now_.a, {}};
  }
  void restore(const time::IntegratorState& s) override { begin(s.t, s.q, s.v); }

 private:
  void begin(double t, time::CRef q, time::CRef v) {
    now_.t = t;
    now_.q = q;
    now_.v = v;
    now_.frames = problem_.frames;
    momentum_.set_state(now_, y_);
    explicit_->start(t, y_);
    momentum_.get_state(t, y_, now_);
    fresh_ = false;
  }
  void take() {
    y_ = explicit_->y();
    now_.t = explicit_->time();
    momentum_.get_state(now_.t, y_, now_);
  }
  void add_statistics() { total_ = statistics(); }

  system::SystemProblem& problem_;
  time::Options options_;
  int order_;
  system::MomentumProblem momentum_;
  std::unique_ptr<time::ExplicitIntegrator> explicit_;
  VecX y0_, y_;
  double t0_ = 0;
  bool fresh_ = false;
  system::State now_;
  mutable system::State between_;
  mutable VecX scratch_;
  time::Statistics total_;
  mutable time::Statistics shown_;
};

}  // namespace

std::unique_ptr<time::Integrator> make_momentum_integrator(system::SystemProblem& problem,
                                                           const time::Options& options,
                                                           int order) {
  return std::make_unique<MomentumIntegrator>(problem, options, order);
}

}  // namespace whirl::analysis
