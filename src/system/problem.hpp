// The System as the time schemes and Newton see it.
#pragma once
#include <la/direct.hpp>
#include <la/multiply.hpp>
#include <system/system.hpp>
#include <time/problem.hpp>
#include <memory>
#include <span>

namespace whirl::system {

struct ProblemOptions {
  la::SolverKind solver = la::SolverKind::automatic;
  bool chart_change = true;  ///< nodes whose tilt passes chart_limit move to other axes
  double chart_limit = rotation::chart_switch;  ///< rad
};

/// Owns frames, workspace, matrices and factorisations; borrows the System.
class SystemProblem : public time::Problem {
 public:
  SystemProblem(const System& system, ProblemOptions options = {});

  Index size() const override { return system_.size(); }
  std::span<const time::Kind> kinds() const override { return kinds_; }
  bool is_linear() const override { return system_.linear(); }
  bool has_corners() const override { return system_.cornered(); }
  void impose(double t, time::Ref q, time::Ref v, time::Ref a) const override {
    system_.impose(frames, t, q, v, a);
  }
  bool residual(double t, time::CRef q, time::CRef v, time::CRef a, time::Ref r) override;
  void linearize(double t, time::CRef q, time::CRef v, time::CRef a) override;
  void add_M(double s, time::CRef x, time::Ref y) const override {
    la::add_multiply(matrices_.M, s, x, y);
  }
  void add_C(double s, time::CRef x, time::Ref y) const override {
    la::add_multiply(matrices_.C, s, x, y);
  }
  void add_K(double s, time::CRef x, time::Ref y) const override {
    la::add_multiply(matrices_.K, s, x, y);
  }
  bool factor(double cm, double cc, double ck) override;
  bool factor(Complex cm, Complex cc, Complex ck) override;
  void solve(time::Ref b) const override { real_->solve(b); }
  void solve(time::RefC b) const override { complex_->solve(b); }
  Power power(double t, time::CRef q, time::CRef v, time::CRef a, time::CRef reactions) override;
  bool accept(double t, time::Ref q, time::Ref v, time::Ref a) override;

  /// The same for the state the nodes were last evaluated at (System::evaluate_nodes or residual).
  virtual Power power_here(time::CRef v, time::CRef reactions);
  /// Only `supplied` and `dissipated` of it.
  virtual Power exchange_here(time::CRef v, time::CRef reactions);
  /// The residual has a part in the power: an unknown follows a law of time, whose reaction
  /// supplies power. Otherwise `reactions` is not read above.
  virtual bool power_needs_reactions() const { return driven_by_law_; }

  const System& system() const { return system_; }
  const la::MCK& matrices() const { return matrices_; }
  Workspace& workspace() { return workspace_; }
  /// Energies split by kind at the last power() call.
  const Energy& energy() const { return energy_; }
  /// Node that left its chart in the last failed residual, or -1.
  Index outside() const { return workspace_.outside; }
  /// After factor() returned false: "y of node ...", or empty.
  std::string singular_unknown() const;

  Frames frames;  ///< current charts and turns; copy into State to checkpoint

 protected:
  /// For problems that keep matrices of their own making.
  la::MCK& kept_matrices() { return matrices_; }

 private:
  bool accept_nodes(time::Ref q, time::Ref v, time::Ref a);
  bool rechart(Index line, time::Ref q, time::Ref v, time::Ref a);
  void move(std::span<const Index> nodes, const Vec3& axis, time::Ref q, time::Ref v, time::Ref a);
  void list_normals(time::CRef q);

  const System& system_;
  ProblemOptions options_;
  std::vector<time::Kind> kinds_;
  std::vector<std::vector<Index>> line_nodes_;
  std::vector<std::vector<Index>> movable_;  ///< nodes whose axes may change, per line
  std::vector<Vec3> normals_;
  std::vector<Index> lead_;  ///< node whose phi decides about whole turns, per line
  Workspace workspace_;
  la::MCK matrices_;
  std::unique_ptr<la::DirectSolver<double>> real_;
  std::unique_ptr<la::DirectSolver<Complex>> complex_;
  Energy energy_;
  bool driven_by_law_ = false;
};

}  // namespace whirl::system
