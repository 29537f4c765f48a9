// Collocation (Radau IIA 5, Gauss 4, Gauss 6) for second-order implicit systems R(t, q, v, a) = 0.
// See collocation.cpp.
#pragma once
#include <time/affine.hpp>
#include <time/linear_stages.hpp>
#include <time/newton.hpp>
#include <time/residual_work.hpp>
#include <time/stepper.hpp>
#include <time/tableau.hpp>

namespace whirl::time {

class Collocation final : public Stepper {
 public:
  Collocation(std::string_view name, const Tableau& tableau, Problem& problem,
              const Options& options);
  std::string_view name() const override { return name_; }
  int order() const override { return tab_.order; }
  std::optional<double> residual_work() override;

 private:
  Attempt attempt(double h) override;
  bool factor(double h) override;
  const VecX& step_error(double h, double error) override;
  double allowance() const override { return allowance_; }
  void commit(double h) override;
  void rewind() override;
  void drop_history() override;
  void recharted() override { have_bound_ = false; }
  /// Of count entries, the k-th is entry(k).
  template <int S, class Entry>
  void dense_of(double theta, Index count, const Entry& entry, Ref q, Ref v, Ref a) const;
  template <class Entry>
  void dense_at(double theta, Index count, const Entry& entry, Ref q, Ref v, Ref a) const;
  bool dense_some(double theta, std::span<const Index> entries, Ref q, Ref v, Ref a) const override;
  template <int S>
  void dense_entries_of(double theta, std::span<const Index> entries, Ref q) const;
  bool dense_entries(double theta, std::span<const Index> entries, Ref q) const override;
  void dense(double theta, Ref q, Ref v, Ref a) const override;
  void save_history(std::vector<double>& out) const override;
  const double* restore_history(const double* in) override;

  void predict(double h, bool extrapolate);
  /// State of stage i at the present increments into qs_, vs_, as_; its time.
  double set_stage(int i, double h);
  /// Matrices at the middle stage of the present iterate: where those of the start do not lead to
  /// the solution. false: singular.
  bool linearize_inside(double h);
  /// The whole attempt of a linear problem that knows its bound along the step, in few passes over
  /// the vectors; false: by residuals, like any other.
  bool attempt_linear(double h, Attempt& out);
  /// Whether it does; the changing entries at the start and at the stages are then known.
  bool bound_along(double h);
  /// Residuals of all stages at the present increments into r_; false: outside the model's domain.
  bool evaluate_stages(double h);
  /// The same of a linear problem, whose increments are still zero; false: one by one.
  bool evaluate_free_stages(double h);
  /// Newton on the stages; iterations and status into `out`.
  void newton(double h, Attempt& out);
  /// r_ := corrections of the stages from their residuals, Y -= r_; false when not finite.
  bool correct();
  void finish(double h);
  double estimate(double h);
  double estimate_linear(double h, bool consistent);
  /// Filters the defect rho_q_, rho_v_ with the residual r where it was taken (null: zero); its size
  /// relative to the allowance. e_, u_ := e_q, h e_v.
  double filtered(double h, const VecX* r);
  /// The size of e_ and of h e_v, which follows from it.
  double size_of_defect(double h, const VecX& rho_q);
  /// An estimate above its allowance once more, at the filtered point, where that may help.
  double taken_again(double h, double error);

  std::string_view name_;
  const Tableau& tab_;
  AffineProblem* affine_;             ///< the problem, where it is linear and says so; else null
  std::optional<ResidualWork> work_;  ///< of such a problem
  bool free_stages_ = false;          ///< held entries move freely in the last step
  // of an affine problem that tells its bound (attempt_linear)
  std::optional<LinearStages> linear_;
  bool linear_step_ = false;  ///< the last attempt was one of it
  bool have_bound_ = false;   ///< bound_ is that of the step's start
  Bound bound_, bound_end_;
  StepProducts products_;
  VecX start_forces_;    ///< residual of the interpolant at the step's start
  MatX changing_;        ///< changing entries at the stages, a column each
  VecX changing_start_;  ///< and at the step's start
  int s_;
  double allowance_;
  NewtonMonitor newton_;
  // stage quantities, one column a stage
  MatX y_, a_stage_, r_;
  VecX qs_, vs_, as_, dq_;
  VecX u_, e_, rho_q_, rho_v_;
  VecXc uc_;
  // Gauss: residual at the start of the step, at its end, and at the start of the step before (for
  // a repeated step)
  VecX start_residual_, end_residual_, start_before_;
  bool have_start_residual_ = false, had_start_residual_ = false;
  // history: stage accelerations of the last step and its length
  MatX a_last_;
  double h_last_ = 0.0, theta_start_ = 1.0;
  bool have_history_ = false;
  int hard_ = 0;  ///< attempts to come without extrapolated massless unknowns, as Newton was slow
};

}  // namespace whirl::time
