// The generalized-alpha scheme, adaptive or with equal steps. See generalized_alpha.cpp.
#pragma once
#include <time/newton.hpp>
#include <time/stepper.hpp>

namespace whirl::time {

class GeneralizedAlpha final : public Stepper {
 public:
  GeneralizedAlpha(Problem& problem, const Options& options);
  std::string_view name() const override { return "generalized_alpha"; }
  int order() const override { return 2; }

 private:
  Attempt attempt(double h) override;
  bool factor(double h) override;
  void predict(double h);
  void correct(double B, double G, Attempt& out);
  const VecX& step_error(double h, double error) override;
  double allowance() const override { return allowance_; }
  void commit(double h) override;
  void rewind() override;
  void drop_history() override;
  void dense(double theta, Ref q, Ref v, Ref a) const override;
  void save_history(std::vector<double>& out) const override;
  const double* restore_history(const double* in) override;

  double alpha_m_, alpha_f_, beta_, gamma_;
  double error_constant_, allowance_;
  NewtonMonitor newton_;
  VecX algorithmic0_, algorithmic_;  ///< the scheme's own acceleration at the step's start and end
  VecX difference_;                  ///< last step's change of acceleration / its length
  VecX difference_before_, algorithmic_before_;
  VecX r_, dq_, dv_, e_;
  double h_last_ = 0.0, h_before_ = 0.0;  ///< 0: no history
};

}  // namespace whirl::time
