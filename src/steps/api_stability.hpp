// Level 1 of an API stability analysis: log decrement against cross-coupled stiffness, and what
// follows from it.
#pragma once
#include <analysis/spectra/whirl_modes.hpp>
#include <results/compliance.hpp>
#include <results/frequency.hpp>
#include <steps/api_models.hpp>

#include <memory>
#include <optional>

namespace whirl::steps {

struct WhirlingMode {
  double log_decrement = nan, frequency = nan;  ///< -, rad/s
  bool driven = false;                          ///< forward, and slower than the rotor; or it grows
  bool grows = false;
};
/// The lateral mode of the machine's rotor that grows fastest a turn, whatever way it whirls and however
/// fast; where none grows, of those that are not backward (forwardness below -0.5) and slower than the rotor at
/// a speed of the reference the one of least log decrement; where there is none, the slowest of them, and
/// without these the slowest lateral one.
WhirlingMode least_stable(const std::vector<analysis::WhirlMode>& modes, const meshes::Mesh& mesh,
                          const system::System& system, const ApiMachine& machine, double speed);

/// Level 2: the machine as given, with its seals, against the limit of the log decrement; a machine without
/// seals only must not grow.
results::Check check_as_given(const model::ApiLateralStep& law, const ApiMachine& machine,
                              const WhirlingMode& mode, const std::string& figure);

/// The analysis of one set of bearings, without its seals.
class Level1 {
 public:
  Level1(run::Job& parent, const model::Step& step, const model::ApiLateralStep& law,
         const ApiMachine& machine, const std::string& name);
  /// Runs it. with_seals: the mode of level 2, when there are seals.
  std::vector<results::Check> judge(const std::optional<WhirlingMode>& with_seals,
                                    const std::string& seals_figure);
  run::Job& job() { return *sub_; }
  /// Lateral modes slower than the rotor at a speed of the reference: their number, and of them and of all
  /// that grows, swinging or not, the least stable.
  struct Below {
    int count = 0;
    WhirlingMode least;
  };
  static Below modes_below(const run::Job& parent, const model::Model& m, const model::Step& step,
                           const ApiMachine& machine, double speed);

 private:
  /// The cross-coupled stiffness at which the mode no longer decays; nan: more than ten times the
  /// anticipated one.
  struct Curve {
    std::vector<double> q, log_decrement, frequency;  ///< N/m, -, rad/s
    double onset = nan;
  };
  /// whatever_grows: also faster than the rotor.
  WhirlingMode at(double q, bool whatever_grows = false);
  Curve find_curve();
  double find_critical_ratio() const;
  void add_couplings();
  void add_tables(const Curve& curve);
  void add_curve_figure(const Curve& curve);
  void add_ratio_figure(double ratio);
  std::string source(std::initializer_list<const char*> keys) const {
    return results::source_of(law_.standard, law_.limits.given, law_.limits.source, keys);
  }

  const model::ApiLateralStep& law_;
  const ApiMachine& machine_;
  model::Step step_;
  model::Model model_;                                  ///< with the couplings
  std::vector<std::pair<std::size_t, double>> shares_;  ///< bearings of it, share of the whole
  double anticipated_ = 0, density_ = nan;              ///< QA, N/m; mean of the gas, kg/m3
  std::unique_ptr<run::Job> sub_;
  std::unique_ptr<results::FrequencyStep> s_;
};

}  // namespace whirl::steps
