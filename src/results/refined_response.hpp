// What the finite length of the elements does to a response: the same response on a mesh twice as
// fine.
#pragma once
#include <assembly/build_system.hpp>
#include <meshes/halved.hpp>
#include <results/frequency.hpp>

#include <functional>
#include <string>

namespace whirl::results {

/// The step's model on the mesh twice as fine, and its linearisation.
class RefinedModel {
 public:
  explicit RefinedModel(const FrequencyStep& s);
  analysis::Linearizer& linear() { return linear_; }
  /// The same place, the same unknown there.
  analysis::Point point(analysis::Point p) const;
  Index unknown(Index k) const;

 private:
  meshes::Halved fine_;
  assembly::Built built_;
  analysis::Linearizer linear_;
};

/// Relative errors; NaN: not judged.
struct PeakError {
  double amplitude = nan, amplification = nan;
};

/// The error that the elements leave of a peak: 4/3 of its change on the mesh twice as fine, which is
/// right where it falls with the square of their length, and too large where it falls faster. Both
/// peaks are those of a parabola through 1/size^2 at three places about the one found, which is exact
/// for a single resonance: a peak that moves is compared with itself. A peak that nothing damps is not
/// judged. at: where it was found, rad/s; amplification: of it (NaN: not known).
PeakError peak_error(double at, double amplification, const std::function<double(double)>& own,
                     const std::function<double(double)>& refined);

/// A response (m, or rad) that is nothing but the rounding of the displacements: there is none to be
/// off by anything.
bool is_rounding(const run::Job& job, double amplitude);

/// Errors of the amplitudes of a step on their way into its summary, headers and warning.
class AmplitudeAccuracy {
 public:
  /// what: they are, "amplitudes of the peaks".
  AmplitudeAccuracy(FrequencyStep& s, std::string what) : step_(s), what_(std::move(what)) {}
  /// name: "the peak of probe 'P' at 4100 rpm".
  void add(double error, const std::string& name);
  /// Into the summary ("mesh"), the headers of the tables still to come, and W10 where it is above
  /// Model::mesh_accuracy.
  void report();

 private:
  FrequencyStep& step_;
  std::string what_;
  double largest_ = 0;
  std::string worst_;
  bool looked_ = false;
  int not_judged_ = 0;
};

}  // namespace whirl::results
