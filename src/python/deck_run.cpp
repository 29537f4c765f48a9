#include <python/deck_run.hpp>
#include <core/error.hpp>
#include <run/borrowed_signals.hpp>
#include <run/watch_progress.hpp>
#include <steps/run_deck.hpp>

namespace whirl::python {

namespace {

[[noreturn]] void refuse_to_run_nothing(const model::Model& model) {
  Diagnostic d;
  d.code = "E35";
  d.message = "the deck has no step: there is nothing to run";
  d.hint = "add a [[step]]; Deck.rotor() gives matrices and modes without one";
  d.where.file = model.deck_path;
  throw Error(Exit::deck, std::move(d));
}

}  // namespace

RunOutcome run(const DeckSource& source, const RunChoices& choices) {
  const std::shared_ptr<const deck::Deck> deck = source.read();
  const model::Model& model = deck->model;
  if (model.steps.empty()) refuse_to_run_nothing(model);
  run::RunOptions options;
  options.quiet = choices.quiet;
  options.jobs = choices.jobs;
  options.resume = choices.resume;
  options.output = choices.output;
  options.variant = [&source](const std::string& setting) { return source.model_with({setting}); };
  options.build = [&source](const std::vector<std::string>& settings) {
    return source.model_with(settings);
  };
  bool cancelled = false;
  const auto look = [&](const std::string& step, double fraction, const std::string& text) {
    if (cancelled || !choices.progress || choices.progress(step, fraction, text)) return;
    cancelled = true;
    run::ask_to_stop();
  };
  const run::WatchProgress watch(look);
  RunOutcome out;
  out.folder =
      choices.output.empty() ? std::filesystem::path(model.output.directory) : choices.output;
  out.exit_code = steps::run_deck(model, options);
  out.cancelled = out.exit_code == static_cast<int>(Exit::interrupted);
  return out;
}

}  // namespace whirl::python
