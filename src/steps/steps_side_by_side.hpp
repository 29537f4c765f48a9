// Steps of a deck that need nothing of one another, side by side. What they say, write into summary
// and report, and which failure is reported is as if they had run one after the other.
#pragma once
#include <run/job.hpp>
#include <core/messages.hpp>
#include <run/watch_progress.hpp>

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace whirl::steps {

/// Runs one step of a job.
/// @throws Error, Interrupted
using StepBody = std::function<void(run::Job&, const model::Step&)>;

/// For every step the numbers of earlier ones that must have run before it: whose state or damage it
/// begins with, whose results it reads from the folder, or whose files could be its own.
std::vector<std::vector<std::size_t>> needs_of_steps(const model::Model& model,
                                                     const std::filesystem::path& results);

/// The number of the step that writes a file, by its name in the results folder: of the longest name of
/// a step that a part of the path begins with; of none the number of steps.
std::size_t place_in_deck(const model::Model& model, const std::filesystem::path& file);

class StepsSideBySide {
 public:
  /// Nothing runs yet.
  StepsSideBySide(run::Job& job, StepBody body);
  /// Several steps, several threads, and memory for as many steps.
  bool possible() const;
  /// Runs all steps, each on a job of its own, and hands over what they leave in the order of the
  /// deck. An interrupted step ends the run as soon as all have heard of it; steps that were complete
  /// by then stay.
  /// @throws what the first step of the deck that failed threw; of steps after it nothing stays, but
  /// of a resumed run the files.
  void run();

 private:
  enum class Outcome { not_begun, complete, interrupted, failed };
  struct Part {
    const model::Step* step = nullptr;
    std::vector<std::size_t> needs, needed_by;
    std::size_t waits_for = 0;  ///< needs that have not ended
    bool ended = false;
    Outcome outcome = Outcome::not_begun;
    std::unique_ptr<run::Job> job;
    std::exception_ptr failure;
    Messages messages;
  };

  void run_all(const std::vector<std::size_t>& ready);
  void execute(Part& part);
  void begin(Part& part);
  bool may_begin(const Part& part);
  std::vector<std::size_t> end(std::size_t k);
  void let_next_be_heard();
  void hand_over();
  void drop_after(std::size_t failed);
  void arrange_manifest(std::size_t last) const;

  run::Job& job_;
  StepBody body_;
  std::vector<Part> parts_;
  std::size_t listed_before_ = 0;  ///< lines of the manifest
  std::mutex mutex_;               ///< of what follows, and of waits_for and ended
  std::size_t heard_ = 0;          ///< the step whose turn it is to speak
  bool stopped_ = false;           ///< a step has failed, and all before it have ended
  std::mutex watching_;            ///< one step at a time tells how far it is
  run::ProgressWatcher watcher_;
};

}  // namespace whirl::steps
