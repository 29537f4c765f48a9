// SUNDIALS objects with owners, and the stops both integrators land on.
#pragma once
#include <core/error.hpp>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <time/first_order.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace whirl::time::sundials {

struct Context {
  Context() {
    if (SUNContext_Create(nullptr, &handle) != 0)
      throw run_error("N30", "SUNDIALS cannot be started");
  }
  ~Context() { SUNContext_Free(&handle); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  SUNContext handle = nullptr;
};

/// A serial N_Vector seen as an Eigen vector.
class SerialVector {
 public:
  SerialVector(Index n, SUNContext context) : handle_(N_VNew_Serial(n, context)), n_(n) {
    if (!handle_) throw run_error("N30", "SUNDIALS cannot allocate a vector");
    N_VConst(0.0, handle_);
  }
  ~SerialVector() { N_VDestroy(handle_); }
  SerialVector(const SerialVector&) = delete;
  SerialVector& operator=(const SerialVector&) = delete;
  N_Vector handle() { return handle_; }
  Eigen::Map<VecX> map() { return {N_VGetArrayPointer(handle_), n_}; }
  Eigen::Map<const VecX> map() const { return {N_VGetArrayPointer(handle_), n_}; }

 private:
  N_Vector handle_;
  Index n_;
};

inline Eigen::Map<VecX> view(N_Vector x) {
  return {N_VGetArrayPointer(x), static_cast<Index>(N_VGetLength(x))};
}

/// Breakpoints and end time.
class Stops {
 public:
  void set_end(double t) { end_ = t; }
  void set_breaks(std::vector<double> times) {
    std::erase_if(times, [](double t) { return !std::isfinite(t); });
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    breaks_ = std::move(times);
  }
  double end() const { return end_; }
  double next(double t, bool& is_break) const {
    const auto it = std::upper_bound(breaks_.begin(), breaks_.end(), t);
    is_break = it != breaks_.end() && *it <= end_;
    return is_break ? *it : end_;
  }

 private:
  double end_ = infinity;
  std::vector<double> breaks_;
};

/// SUNDIALS prints nothing: its flags are turned into StepStatus.
inline void silent(int, const char*, const char*, char*, void*) {}

std::unique_ptr<Integrator> make_ida(Problem& problem, const Options& options);
std::unique_ptr<ExplicitIntegrator> make_erk(FirstOrderProblem& problem, const Options& options,
                                             int order);

}  // namespace whirl::time::sundials
