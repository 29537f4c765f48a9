// What all one-step schemes share: the loop around one step. Stops, step control, rejection, dense
// output frame, chart changes, save and restore. A scheme adds attempt(), dense() and its history.
#pragma once
#include <time/initial.hpp>
#include <time/integrator.hpp>
#include <time/response_scale.hpp>
#include <time/step_control.hpp>

namespace whirl::time {

class Stepper : public Integrator {
 public:
  Stepper(Problem& problem, const Options& options);

  void start(double t, CRef q, CRef v) final;
  void restart(CRef q, CRef v, bool corner = false) final;
  StepReport advance() final;
  StepReport shorten_to(double t) final;
  double time() const final { return t_; }
  const VecX& q() const final { return q_; }
  const VecX& v() const final { return v_; }
  const VecX& a() const final { return a_; }
  double proposed_step() const final { return h_next_; }
  void interpolate(double t, Ref q, Ref v, Ref a) const final;
  bool interpolate_entries(double t, std::span<const Index> entries, Ref q) const final;
  bool interpolate_some(double t, std::span<const Index> entries, Ref q, Ref v, Ref a) const final;
  void refresh() final {
    linearize_ = true;
    h_factored_ = 0.0;
  }
  void set_end(double t_end) final;
  void set_breakpoints(std::vector<double> times) final;
  const Statistics& statistics() const final { return statistics_; }
  Statistics judged_statistics() const final;
  IntegratorState save() final;
  void restore(const IntegratorState& state) final;

 protected:
  struct Attempt {
    StepStatus status = StepStatus::ok;
    double error = 0.0;  ///< relative to the allowance
    int iterations = 0;
  };
  /// One step of length h from (t0_, q0_, v0_, a0_) with the matrices at hand. On success q_, v_,
  /// a_, q_low_, v_low_ hold its end (held entries too).
  virtual Attempt attempt(double h) = 0;
  /// Factors the iteration matrices for step h.
  virtual bool factor(double h) = 0;
  /// Errors of the step of length h just made, in the unit of each unknown; error: their size
  /// relative to allowance(), as the step was judged.
  virtual const VecX& step_error(double h, double error) = 0;
  /// What the error of a step may be, relative to the scales.
  virtual double allowance() const = 0;
  /// The step of length h is accepted: it becomes history.
  virtual void commit(double h) = 0;
  /// The last step is to be made again, shorter, from its start.
  virtual void rewind() = 0;
  /// What the scheme extrapolates from no longer continues smoothly (or stands in another chart).
  virtual void drop_history() = 0;
  /// Entries of the state were written in another way after a step (whole turns, another chart).
  virtual void recharted() {}
  /// (q, v, a) at theta = (t - t0)/h of the last step; held entries are overwritten afterwards.
  virtual void dense(double theta, Ref q, Ref v, Ref a) const = 0;
  /// Some entries of q alone; false where dense() is as cheap.
  virtual bool dense_entries(double theta, std::span<const Index> entries, Ref q) const {
    (void)theta;
    (void)entries;
    (void)q;
    return false;
  }
  /// Of some entries; false where dense() is as cheap.
  virtual bool dense_some(double theta, std::span<const Index> entries, Ref q, Ref v, Ref a) const {
    (void)theta;
    (void)entries;
    (void)q;
    (void)v;
    (void)a;
    return false;
  }
  virtual void save_history(std::vector<double>& out) const = 0;
  virtual const double* restore_history(const double* in) = 0;

  // Services to schemes.
  double stage_time(double c, double h) const {
    return c == 1.0 ? t1_eval_ : t0_ + (c * h + t0_low_);
  }
  bool residual(double t, const VecX& q, const VecX& v, const VecX& a, Ref r) {
    ++statistics_.residuals;
    return problem_.residual(t, q, v, a, r);
  }
  /// Matrices may be taken inside the step, where Newton's iteration converges best.
  bool smooth() const {
    return options_.linearize_inside && !first_ && !problem_.has_corners() && !problem_.is_linear();
  }
  bool factor_real(double cm, double cc, double ck) {
    ++statistics_.factorizations_real;
    return problem_.factor(cm, cc, ck);
  }
  bool factor_complex(Complex cm, Complex cc, Complex ck) {
    ++statistics_.factorizations_complex;
    return problem_.factor(cm, cc, ck);
  }
  /// sum = x + dx with the rounding error carried in low.
  static void add_compensated(const VecX& x, const VecX& x_low, const VecX& dx, VecX& sum,
                              VecX& low);

  Problem& problem_;
  Options options_;
  Index n_;
  std::vector<Index> held_;
  ResponseScale scale_;
  StepControl control_;
  Statistics statistics_;
  InitialSolver initial_;

  double t0_ = 0.0, t0_low_ = 0.0, t_ = 0.0, t_low_ = 0.0;
  double h_ = 0.0;  ///< length of the last accepted step
  double t1_eval_ =
      0.0;  ///< time at which the end of the step is evaluated: a breakpoint's left side
  VecX q0_, v0_, a0_, q_, v_, a_;
  VecX q0_low_, v0_low_, q_low_, v_low_;
  bool first_ =
      true;  ///< no step since start, restart or a breakpoint: a0_ solves the equations at t0_
  double rate_span_ = 0.0;  ///< errors of rates count as displacements after this time at least, s
  bool retrying_ = false;   ///< the previous attempt of this step failed the error test

 private:
  struct Target {
    double h, t1;
    bool landing, clipped;
  };
  void linearize(double h, bool inside);
  Attempt attempt_with_recovery(double h);
  void begin_step();
  /// The state was written in another way; q0_, v0_, a0_ are what it was.
  void take_recharted();
  /// Sets the time of the step's end; whether that is a breakpoint.
  bool aim_at(const Target& target);
  /// Counts a failed attempt of length h, and names what failed; the length to try next.
  double shorter_after(Attempt& failed, double h, StepReport& report);
  /// The step of length h is accepted.
  void take_step(double h, const StepReport& report);
  /// The state of the step's start is the present one again.
  void return_to_start();
  void after_discontinuity(bool impulse);
  void choose_first_step();
  void next_stop(double& t, bool& is_break) const;
  Target plan(double h);
  void plan_segment();

  std::vector<double> breaks_;
  bool have_step_ = false, accept_pending_ = false, at_break_ = false;
  double h_next_ = 0.0;
  double longest_ = 0.0;     ///< step since the last corner
  double rate_steps_ = 0.0;  ///< steps made with rate_span_
  bool fresh_ = false;       ///< matrices are of the present step's start
  // fixed step: the segment between two stops in equal parts; a failed part is halved until its end
  // is reached
  double segment_start_ = 0.0, segment_end_ = 0.0, segment_count_ = 0.0, segment_step_ = 0.0,
         segment_k_ = 0.0;
  bool segment_valid_ = false, inside_part_ = false;

 protected:
  bool linearize_ = true;    ///< matrices are to be computed anew before the next attempt
  double h_factored_ = 0.0;  ///< step length of the factors at hand; 0: none
};

}  // namespace whirl::time
