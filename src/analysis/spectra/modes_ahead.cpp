#include <analysis/spectra/modes_ahead.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/interrupt.hpp>
#include <core/parallel.hpp>

#include <algorithm>

namespace whirl::analysis {

ModesAhead::ModesAhead(Linearizer& linear, const ModesOptions& options, std::vector<double> speeds,
                       std::size_t at_once, int threads)
    : linear_(linear),
      options_(options),
      speeds_(std::move(speeds)),
      at_once_(at_once > 0 ? at_once : speeds_.size()),
      threads_(threads) {
  WHIRL_EXPECTS(threads >= 0);
}

const ModesAtSpeed* ModesAhead::at(double Omega) {
  if (ready_.empty() && next_ < speeds_.size() && speeds_[next_] == Omega) solve_more();
  if (ready_.empty() || ready_.front().Omega != Omega) return nullptr;
  current_ = std::move(ready_.front());
  ready_.pop_front();
  if (current_.failure) std::rethrow_exception(current_.failure);
  return &current_;
}

void ModesAhead::continue_equilibria(std::vector<ModesAtSpeed>& batch) {
  int matrices = 0;
  for (ModesAtSpeed& m : batch) {
    try {
      // Two speeds make the polynomials that all copies of the linearisation then share.
      if (++matrices <= 2)
        linear_.at(m.Omega);
      else
        linear_.move_to(m.Omega);
      m.equilibrium = linear_.equilibrium();
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      m.failure = std::current_exception();
      return;
    }
  }
}

void ModesAhead::solve_run(std::span<ModesAtSpeed> run, const WhirlSolver* seed) const {
  Linearizer linear(linear_);
  WhirlSolver solver(linear, options_);
  if (seed) solver.start_from(*seed);
  for (ModesAtSpeed& m : run) {
    try {
      linear.set_equilibrium(m.equilibrium);
      m.modes = solver.solve(m.Omega);
      m.certificate = solver.certificate();
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      m.failure = std::current_exception();
      return;
    }
  }
}

void ModesAhead::solve_more() {
  std::vector<ModesAtSpeed> batch(std::min(at_once_, speeds_.size() - next_));
  for (ModesAtSpeed& m : batch)
    m.Omega = speeds_[next_++];
  continue_equilibria(batch);
  const auto failed = std::find_if(batch.begin(), batch.end(),
                                   [](const ModesAtSpeed& m) { return m.failure != nullptr; });
  const auto good = static_cast<std::size_t>(failed - batch.begin());
  std::size_t first = 0;
  if (!seed_ && good > 0) {
    seed_linear_.emplace(linear_);
    seed_linear_->set_equilibrium(batch[0].equilibrium);
    seed_.emplace(*seed_linear_, options_);
    try {
      batch[0].modes = seed_->solve(batch[0].Omega);
      batch[0].certificate = seed_->certificate();
    } catch (const Error&) {
      batch[0].failure = std::current_exception();
      seed_.reset();
    }
    first = 1;
  }
  const std::size_t runs = good > first ? (good - first + run_length - 1) / run_length : 0;
  run_side_by_side(runs, threads_, [&](std::size_t k) {
    const std::size_t from = first + k * run_length;
    const std::size_t count = std::min(run_length, good - from);
    solve_run(std::span(batch).subspan(from, count), seed_ ? &*seed_ : nullptr);
  });
  // What comes after a failure is not there: the failure ends the search.
  for (ModesAtSpeed& m : batch) {
    ready_.push_back(std::move(m));
    if (ready_.back().failure) break;
  }
}

}  // namespace whirl::analysis
