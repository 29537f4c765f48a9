// Error against run time: one deck over a ladder of integrators, accuracies, steps and meshes,
// against its own converged solution.
#pragma once
#include <core/types.hpp>
#include <functional>
#include <string>
#include <vector>

namespace whirl::analysis {

/// One setting of the ladder. tolerance > 0: adaptive; else fixed step dt.
struct StudyCase {
  std::string
      method;  ///< empty: no integrator, meshes alone are compared (StudySample::steps: elements)
  double tolerance = 0, dt = 0;
  int mesh_factor = 1;  ///< elements of the deck's mesh split into this many
  std::string label() const;
  bool operator==(const StudyCase&) const = default;
};

/// A quantity of a run: one number or a sampled history. Errors are max |x - reference| / scale.
struct Quantity {
  std::string name, unit;
  std::vector<double> values;
  double scale = 0;    ///< 0: the largest |value| of the reference
  bool counts = true;  ///< in worst(); false: listed only (the instant of a flat peak is known to
                       ///< the root of its height)
};

/// A quantity whose reference and cross-check differ by more than this is not a number of the model
/// (undamped ringing sampled at an instant): its errors are listed but do not count in worst().
inline constexpr double resolved = 1e-4;

struct StudySample {
  StudyCase setting;
  bool ok = true;
  std::string note;    ///< why not ok
  double seconds = 0;  ///< CPU
  long steps = 0, newton = 0, factorizations = 0;
  std::vector<Quantity> quantities;
  std::vector<double> errors;  ///< one a quantity; filled by run_study
  std::vector<bool> counted;   ///< quantities that count
  double worst() const;
};

/// Runs one setting. May report failure in `ok`; must not throw for non-convergence. Settings of
/// different series, and the reference and its check, are run side by side.
using StudyRunner = std::function<StudySample(const StudyCase&)>;

struct StudyOptions {
  std::vector<StudyCase> ladder;
  StudyCase reference;    ///< a much tighter run
  StudyCase cross_check;  ///< the same accuracy by another scheme: their difference is the
                          ///< reference's uncertainty
  std::vector<double> targets{1e-2, 1e-3, 1e-4};
  int repeats = 3;  ///< runs faster than 0.2 s are repeated; the fastest counts
  /// Settings of one series are run one after the other, in their order. Empty: all are of one.
  std::function<std::string(const StudyCase&)> series;
  int threads = 1;                                   ///< for the series; 0: all processors
  std::function<void(const StudySample&)> progress;  ///< of every setting, in their order
};

struct StudyResult {
  std::vector<std::string> quantities;
  std::vector<double> uncertainty;  ///< of the reference, relative, one a quantity
  StudySample reference;
  std::vector<StudySample> samples;
  /// Slope of the worst error against the step, equal steps on one mesh; 0: none seen, the error
  /// does not fall with the step.
  struct Order {
    std::string method;
    double order;
  };
  std::vector<Order> orders;
  std::vector<std::size_t> pareto;  ///< indices of samples no other beats in both error and time
  struct Advice {
    double target;
    std::size_t sample;
    bool found;
  };
  std::vector<Advice> advice;  ///< cheapest setting at or below each target (worst quantity)
};

/// exact: quantities of a closed form replace the reference run when given.
/// @throws Error (R20) when the reference run fails.
StudyResult run_study(const StudyRunner& run, const StudyOptions& options,
                      const std::vector<Quantity>* exact = nullptr);

}  // namespace whirl::analysis
