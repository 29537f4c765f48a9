// The frequency that is asked about. Coefficients that were measured or computed by shaking (tables
// of bearings and seals) may depend on the frequency w of the motion beside the spin. A motion in
// time has no one frequency; small motions a exp(i w t) have. An analysis of such motions opens a
// scope around its evaluations:
//
//   const system::FrequencyScope ask(w);
//   running.tangent(...);          // K(Omega, w), C(Omega, w), M(Omega, w)
//
// Outside any scope nothing is asked, and such elements answer for the frequency of the shaft's own
// spin (synchronous reduction). A property of the question, not of the state, and of one thread.
#pragma once

namespace whirl::system {

/// rad/s, not negative; NaN outside every scope.
double asked_frequency() noexcept;

class FrequencyScope {
 public:
  explicit FrequencyScope(double w) noexcept;
  ~FrequencyScope();
  FrequencyScope(const FrequencyScope&) = delete;
  FrequencyScope& operator=(const FrequencyScope&) = delete;

 private:
  double before_;
};

}  // namespace whirl::system
