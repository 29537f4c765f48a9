#include <steps/steps_side_by_side.hpp>
#include <core/interrupt.hpp>
#include <core/parallel.hpp>
#include <io/file.hpp>
#include <run/checkpoint.hpp>
#include <run/interrupt.hpp>
#include <run/memory_limit.hpp>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>

namespace whirl::steps {

namespace {

/// A step that goes on from the results folder of this very run.
bool reads_results(const model::Step& step, const std::filesystem::path& results) {
  const auto* law = std::get_if<model::TransientStep>(&step.law);
  if (law == nullptr || law->previous.empty()) return false;
  return run::is_results_folder(law->previous, results);
}

/// Fatigue is counted in the transients that a report on torsion names.
bool counts_damage_of(const model::Step& step, const std::string& other) {
  const auto* law = std::get_if<model::ApiTorsionalStep>(&step.law);
  return law != nullptr &&
         std::any_of(law->events.begin(), law->events.end(),
                     [&other](const model::ApiEvent& e) { return e.step == other; });
}

/// Files are named after their step: "run" and "run_up" could write the same one, which is an error of
/// the later step (E16).
bool may_share_files(const std::string& a, const std::string& b) {
  return a.starts_with(b) || b.starts_with(a);
}

/// Members in the order in which steps that ran one after the other would have set them.
void add_summary(io::Value& to, const io::Value& from) {
  if (!from.is_object()) return;
  for (const auto& [name, value] : from.members()) {
    if (name == "steps")
      for (const auto& [step, of_step] : value.members())
        to[name][step] = of_step;
    else if (value.is_array())
      for (const io::Value& item : value.items())
        to[name].push(item);
    else if (to.at(name).is_null())
      to[name] = value;
  }
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

void add_phases(run::Job& to, const run::Job& from) {
  for (const auto& [phase, time] : from.phases) {
    const auto same = std::find_if(to.phases.begin(), to.phases.end(),
                                   [&name = phase](const auto& x) { return x.first == name; });
    if (same != to.phases.end())
      same->second += time;
    else
      to.phases.emplace_back(phase, time);
  }
}

/// None where there is no list.
std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

}  // namespace

std::size_t place_in_deck(const model::Model& model, const std::filesystem::path& file) {
  std::size_t place = model.steps.size(), length = 0;
  for (const std::filesystem::path& part : file)
    for (std::size_t k = 0; k < model.steps.size(); ++k) {
      const std::string& name = model.steps[k].name;
      if (!part.string().starts_with(name) || name.size() <= length) continue;
      place = k;
      length = name.size();
    }
  return place;
}

std::vector<std::vector<std::size_t>> needs_of_steps(const model::Model& model,
                                                     const std::filesystem::path& results) {
  const std::vector<model::Step>& steps = model.steps;
  std::vector<std::vector<std::size_t>> needs(steps.size());
  for (std::size_t k = 1; k < steps.size(); ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const std::string& earlier = steps[j].name;
      // what reads checkpoints of this folder stands between those before and those after it
      if (steps[k].from == earlier || counts_damage_of(steps[k], earlier) ||
          may_share_files(steps[k].name, earlier) || reads_results(steps[k], results) ||
          reads_results(steps[j], results))
        needs[k].push_back(j);
    }
  return needs;
}

StepsSideBySide::StepsSideBySide(run::Job& job, StepBody body)
    : job_(job),
      body_(std::move(body)),
      parts_(job.model.steps.size()),
      watcher_(run::progress_watcher()) {
  const auto needs = needs_of_steps(job.model, job.folder.root());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Part& part = parts_[k];
    part.step = &job.model.steps[k];
    part.needs = needs[k];
    part.waits_for = needs[k].size();
    for (const std::size_t earlier : needs[k])
      parts_[earlier].needed_by.push_back(k);
  }
}

bool StepsSideBySide::possible() const {
  const int threads = job_.options.jobs > 0 ? job_.options.jobs : processors();
  if (threads < 2 || parts_.size() < 2) return false;
  return run::steps_fit_side_by_side(job_.model, job_.options);
}

void StepsSideBySide::run() {
  listed_before_ = lines_of(job_.folder.root() / io::Manifest::file_name).size();
  std::vector<std::size_t> ready;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (parts_[k].waits_for == 0) ready.push_back(k);
  parts_.front().messages.let_be_heard();
  run_all(ready);
  if (stopped_) run::take_back_stop();
  hand_over();
}

/// Who ends a step goes on with those that waited for it alone; nobody waits.
void StepsSideBySide::run_all(const std::vector<std::size_t>& ready) {
  run_side_by_side(ready.size(), job_.options.jobs, [&](std::size_t n) {
    execute(parts_[ready[n]]);
    run_all(end(ready[n]));
  });
}

bool StepsSideBySide::may_begin(const Part& part) {
  const std::lock_guard lock(mutex_);
  if (run::interrupted()) return false;
  for (const Part& earlier : parts_) {
    if (&earlier == &part) return true;
    if (earlier.ended && earlier.outcome == Outcome::failed) return false;
  }
  return true;
}

/// A job of its own, with what the step needs of those before it.
void StepsSideBySide::begin(Part& part) {
  part.job = std::make_unique<run::Job>(job_.model, job_);
  for (const std::size_t k : part.needs) {
    const std::string& name = parts_[k].step->name;
    const run::Job& earlier = *parts_[k].job;
    if (const auto state = earlier.states.find(name); state != earlier.states.end())
      part.job->states.insert(*state);
    if (const auto damage = earlier.shaft_damage.find(name); damage != earlier.shaft_damage.end())
      part.job->shaft_damage.insert(*damage);
  }
}

void StepsSideBySide::execute(Part& part) {
  if (!may_begin(part)) return;
  const SpeakThrough own_messages(part.messages);
  const run::WatchProgress watch(
      [this](const std::string& step, double done, const std::string& s) {
        if (!watcher_) return;
        const std::lock_guard lock(watching_);
        watcher_(step, done, s);
      });
  Outcome outcome = Outcome::complete;
  try {
    begin(part);
    body_(*part.job, *part.step);
  } catch (const Interrupted&) {
    outcome = Outcome::interrupted;
  } catch (...) {
    outcome = Outcome::failed;
    part.failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  part.outcome = outcome;
}

/// The steps that waited for this one alone.
std::vector<std::size_t> StepsSideBySide::end(std::size_t k) {
  const std::lock_guard lock(mutex_);
  parts_[k].ended = true;
  let_next_be_heard();
  std::vector<std::size_t> ready;
  for (const std::size_t later : parts_[k].needed_by)
    if (--parts_[later].waits_for == 0) ready.push_back(later);
  return ready;
}

/// A failed step is the last that is heard: those after it end as soon as they can.
void StepsSideBySide::let_next_be_heard() {
  while (heard_ < parts_.size() && parts_[heard_].ended && !stopped_) {
    if (parts_[heard_].outcome == Outcome::failed) {
      stopped_ = true;
      run::stop_what_runs();
      return;
    }
    if (++heard_ < parts_.size()) parts_[heard_].messages.let_be_heard();
  }
}

void StepsSideBySide::hand_over() {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Part& part = parts_[k];
    if (!part.job) continue;
    run::Job& own = *part.job;
    add_summary(job_.summary, own.summary);
    append(job_.report.sections, own.report.sections);
    append(job_.report.warnings, own.report.warnings);
    append(job_.uncertified, own.uncertified);
    add_phases(job_, own);
    job_.built = std::move(own.built);
    job_.built_for = own.built_for;
    if (part.outcome != Outcome::failed) continue;
    drop_after(k);
    arrange_manifest(k);
    std::rethrow_exception(part.failure);
  }
  arrange_manifest(parts_.size());
}

/// One after the other they would not have begun. A resumed run goes on from what was there before it.
void StepsSideBySide::drop_after(std::size_t failed) {
  if (job_.options.resume) return;
  for (std::size_t k = failed + 1; k < parts_.size(); ++k)
    if (parts_[k].job) job_.folder.remove_of(parts_[k].step->name);
}

/// What the steps up to the last have added stands in the order of the deck. What others have added is
/// gone again.
void StepsSideBySide::arrange_manifest(std::size_t last) const {
  const std::filesystem::path list = job_.folder.root() / io::Manifest::file_name;
  std::vector<std::string> lines = lines_of(list);
  if (lines.size() <= listed_before_) return;
  const auto added = lines.begin() + static_cast<std::ptrdiff_t>(listed_before_);
  std::stable_sort(added, lines.end(), [this](const std::string& a, const std::string& b) {
    return place_in_deck(job_.model, a) < place_in_deck(job_.model, b);
  });
  const auto gone = [&](const std::string& file) {
    const std::size_t place = place_in_deck(job_.model, file);
    return !job_.options.resume && place > last && place < parts_.size();
  };
  lines.erase(std::remove_if(added, lines.end(), gone), lines.end());
  std::string text;
  for (const std::string& line : lines)
    text += line + "\n";
  io::write_atomic(list, text);
}

}  // namespace whirl::steps
