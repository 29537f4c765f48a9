// Runs the steps of a deck and writes summary and report, complete or not: a failed step keeps what
// comes before it in the deck.
#include <core/messages.hpp>
#include <run/interrupt.hpp>
#include <run/job.hpp>
#include <steps/savings.hpp>
#include <steps/steps.hpp>
#include <steps/steps_side_by_side.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
#include <core/interrupt.hpp>
#include <core/parallel.hpp>
#include <io/nonfinite.hpp>
#include <plot/rotor_drawing.hpp>
#include <plot/svg.hpp>
#include <results/compliance.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <type_traits>

namespace whirl::steps {

namespace {

void describe_model(run::Job& job) {
  io::Value& v = job.summary["model"];
  v["nodes"] = job.mesh.nodes.size();
  v["elements"] = job.mesh.elements.size();
  long unknowns = 0;
  for (unsigned char a : job.system().active())
    unknowns += a;
  v["unknowns"] = unknowns;
  io::Value parts = io::Value::object();
  for (const auto& term : job.system().terms())
    parts[term->kind()] = term->count();
  v["batches"] = parts;
  io::Value left = io::Value::array();
  for (const std::string& s : job.built.left_out)
    left.push(s);
  for (const std::string& s : job.built.simpler)
    left.push(s);
  v["left out"] = left;
  if (job.built.notes.empty()) return;
  io::Value notes = io::Value::array();
  for (const std::string& s : job.built.notes)
    notes.push(s);
  v["notes"] = notes;
}

/// Numbers that are none and that nothing accounts for: the results are not to be trusted there,
/// and that is said.
void report_nonfinite(run::Job& job) {
  std::vector<io::NonFinite> all = io::take_nonfinite();
  std::stable_sort(all.begin(), all.end(), [&](const io::NonFinite& a, const io::NonFinite& b) {
    return place_in_deck(job.model, a.file) < place_in_deck(job.model, b.file);
  });
  for (const io::NonFinite& n : all) {
    const std::string text = fmt::format(
        "{} in {} are not finite (first in the column '{}'): what should stand there was not found",
        n.count == 1 ? "1 number" : fmt::format("{} numbers", n.count), n.file, n.column);
    job.summary["warnings"].push(text);
    job.report.warnings.push_back(text);
    if (!job.options.quiet) say(fmt::format("warning: {}\n", text));
  }
}

/// What leaving out saved, where that is asked for: it takes building the general model.
void describe_savings(run::Job& job) {
  if (!job.options.savings || job.model.keep_everything || job.built_for.empty()) return;
  if (run::interrupted()) return;
  const Savings s = measure_savings(job);
  if (!(s.everything > 0.0)) return;
  io::Value& v = job.summary["model"]["cost of one evaluation of forces and tangents"];
  v["of this model [us]"] = 1e6 * s.pruned;
  v["of the general model [us]"] = 1e6 * s.everything;
  v["saved"] = std::max(0.0, 1.0 - s.pruned / s.everything);
  if (!job.options.quiet)
    say(fmt::format(
        "left out: {} parts of the general model this deck does not need "
        "(summary.json); an evaluation takes {:.0f} us CPU instead of {:.0f} us\n",
        job.built.left_out.size() + job.built.simpler.size(), 1e6 * s.pruned, 1e6 * s.everything));
}

void take_times(run::Job& job, const Stopwatch& watch) {
  for (const auto& [name, time] : job.phases) {
    job.summary["run time by phase, CPU [s]"][name] = time.cpu;
    job.summary["run time by phase, wall [s]"][name] = time.wall;
  }
  run::put_run_time(job.summary, watch.elapsed());
}

/// Every figure of the report as a file of its own.
void write_plots(const run::Job& job) {
  std::vector<std::pair<std::string, const plot::Figure*>> plots;
  std::map<std::string, int> figures;  // of one name: the second is NAME-2
  for (const io::ReportSection& s : job.report.sections)
    for (const plot::Figure& f : s.figures) {
      const int n = ++figures[f.name];
      const std::string number = n > 1 ? fmt::format("-{}", n) : std::string();
      plots.emplace_back(fmt::format("plots/{}{}.svg", f.name, number), &f);
    }
  std::vector<std::string> drawn(plots.size());
  run_side_by_side(plots.size(), job.options.jobs,
                   [&](std::size_t k) { drawn[k] = plot::render_svg(*plots[k].second); });
  for (std::size_t k = 0; k < plots.size(); ++k)  // in order, as their names are listed
    job.folder.write_text(plots[k].first, drawn[k]);
}

void write_report(run::Job& job, const RunTime& time) {
  job.report.summary = job.summary;
  job.report.facts.emplace_back("run time, CPU", fmt::format("{:.3f} s", time.cpu));
  job.report.facts.emplace_back("run time, wall", fmt::format("{:.3f} s", time.wall));
  io::ReportSection rotor;
  rotor.title = "Rotor";
  rotor.tables = {results::station_table(job), results::mass_table(job.model)};
  rotor.figures = plot::draw_model(job.model, job.mesh, job.scene);
  job.report.sections.insert(job.report.sections.begin(), std::move(rotor));
  io::write_report(job.folder.path("report.html"), job.report, job.options.jobs);
  write_plots(job);
}

/// Summary and report of what has run.
void finish(run::Job& job, const Stopwatch& watch) {
  job.folder.set_owner({});
  report_nonfinite(job);
  take_times(job, watch);
  if (job.model.output.report) {
    const run::PhaseTimer timer(job, "report");
    write_report(job, watch.elapsed());
  }
  take_times(job, watch);
  job.folder.write_json("summary.json", job.summary);
}

/// Some kinds of motion alone: a line at an angle to another one would bend where that one twists.
bool leaves_motion_out(const model::StepLaw& law) {
  if (std::holds_alternative<model::TorsionalStep>(law) ||
      std::holds_alternative<model::ApiTorsionalStep>(law))
    return true;
  const auto kind = [](const auto& x) -> model::MotionKind {
    if constexpr (requires { x.motion; }) return x.motion;
    return model::MotionKind::all;
  };
  return std::visit(kind, law) != model::MotionKind::all;
}

/// The first joint of a line that is not parallel to the first one; empty: none.
std::string crooked_joint(const system::System& system) {
  const system::State start = system.make_state();
  for (std::size_t k = 0; k < system.followers().count(); ++k) {
    const system::FollowerDef& f = system.followers()[k];
    for (const Index node : {f.node, f.parent}) {
      const Vec3 axis = start.frames.axes(node).col(0);
      if (axis.cross(Vec3::UnitX()).norm() > 1e-9) return f.joint;
    }
  }
  return {};
}

/// What a step supposes that joints break.
void refuse_joints(const run::Job& job, const model::Step& step) {
  if (job.model.joints.empty()) return;
  const auto refuse = [&](const std::string& what, const std::string& joint, const char* hint) {
    Diagnostic d{Diagnostic::Severity::error, "E41",
                 fmt::format("step '{}': {} and {} do not go together", step.name, what, joint),
                 hint, step.where};
    throw Error(Exit::deck, {std::move(d)});
  };
  if (const std::string joint = crooked_joint(job.system());
      leaves_motion_out(step.law) && !joint.empty())
    refuse("one kind of motion alone", joint + ", of a line at an angle to the x axis,",
           "motion = \"all\": bending of one line is twist of another");
}

void run_step(run::Job& job, const model::Step& step) {
  job.build_for(step);
  refuse_joints(job, step);
  if (!job.summary.is_object() || job.summary.at("model").is_null()) describe_model(job);
  std::visit(
      [&](const auto& law) {
        using T = std::decay_t<decltype(law)>;
        if constexpr (std::is_same_v<T, model::TransientStep>)
          run_transient_step(job, step, law);
        else if constexpr (std::is_same_v<T, model::StaticStep>)
          run_static_step(job, step, law);
        else
          run_frequency_step(job, step);
      },
      step.law);
}

/// Keys of a step that say which frequencies it asks tables about.
std::string keys_of_frequency(const model::StepLaw& law) {
  return std::visit(
      [](const auto& x) -> std::string {
        if constexpr (requires {
                        x.max_frequency;
                        x.modes;
                      })
          return "max_frequency, modes";
        else if constexpr (requires {
                             x.min_speed;
                             x.max_speed;
                           })
          return "min_speed, max_speed";
        else if constexpr (requires {
                             x.frequency;
                             x.speeds;
                           })
          return "frequency, speed";
        else if constexpr (requires { x.speed.points; })
          return "speed";
        else if constexpr (requires { x.max_speed; })
          return "max_speed";
        else
          return {};
      },
      law);
}

/// The bearings at a node, by its name.
std::string bearings_at(const run::Job& job, const std::string& node) {
  std::string out;
  for (const model::Bearing& b : job.model.bearings) {
    const Index n = job.mesh.place(b.at).node;
    if (n >= 0 && n < job.system().nodes() && job.system().node(n).name == node)
      out += fmt::format("{}'{}'", out.empty() ? "" : ", ", b.name);
  }
  return out;
}

/// Speeds at which films may carry too little to hold the rotor.
void add_hint_of_films(const run::Job& job, Diagnostic& d) {
  if (d.code != "E75" && d.code != "E76") return;
  const auto film =
      std::find_if(job.model.bearings.begin(), job.model.bearings.end(),
                   [](const model::Bearing& b) { return *model::traits_of(b.law).film; });
  if (film == job.model.bearings.end() || d.hint.find("film") != std::string::npos) return;
  if (d.where.line == 0) d.where = film->where;
  d.hint =
      "a film carries nothing at rest and little at low speed: begin the speeds where it "
      "carries the rotor; else " +
      d.hint;
}

/// Pads that have no equation of motion while their films are dry.
void add_hint_of_pivots(const run::Job& job, Diagnostic& d) {
  if (d.code != "N20" && d.code != "R10") return;
  for (const assembly::TiltingPads& pads : job.built.tilting_pads)
    if (std::find(pads.follows.begin(), pads.follows.end(), true) != pads.follows.end()) {
      d.hint = fmt::format(
          "pads of bearing '{}' have elastic pivots without mass, and follow nothing while their "
          "films are dry: give them mass, or pivot_damping; else {}",
          job.model.bearings[pads.bearing].name, d.hint);
      return;
    }
}

/// What failed while a step ran, with the step it failed in.
Error in_step(const run::Job& job, const std::string& name, const Error& e) {
  const auto step = std::find_if(job.model.steps.begin(), job.model.steps.end(),
                                 [&](const model::Step& s) { return s.name == name; });
  std::vector<Diagnostic> all = e.diagnostics();
  for (Diagnostic& d : all) {
    if (d.message.find("step '") == std::string::npos)
      d.message = fmt::format("step '{}': {}", name, d.message);
    add_hint_of_films(job, d);
    add_hint_of_pivots(job, d);
    if (step == job.model.steps.end() || d.code != "E81") continue;
    const std::string bearings = bearings_at(job, d.where.entity);
    if (!bearings.empty()) d.message += ", at bearing " + bearings;
    if (const std::string keys = keys_of_frequency(step->law); !keys.empty())
      d.hint = fmt::format(
          "extend its frequencies, narrow the step ({}), or write extrapolate = \"hold\"", keys);
  }
  return Error(e.exit(), std::move(all));
}

/// @throws Interrupted, with the step marked as such; Error with the name of the step.
void run_named_step(run::Job& job, const model::Step& step) {
  job.folder.set_owner(step.name);
  try {
    run_step(job, step);
  } catch (const Interrupted&) {
    job.summary["steps"][step.name]["outcome"] = "interrupted";
    if (!job.options.quiet) say(fmt::format("{}: interrupted\n", step.name));
    throw;
  } catch (const Error& unnamed) {
    throw in_step(job, step.name, unnamed);
  }
}

void run_one_by_one(run::Job& job, const StepBody& body) {
  for (const model::Step& step : job.model.steps) {
    if (run::interrupted()) return;
    body(job, step);
  }
}

/// The title block of the deck, what is given of it.
void put_title_block(run::Job& job) {
  if (!job.model.title_block) return;
  const model::TitleBlock& b = *job.model.title_block;
  for (const auto& [name, text] : {std::pair{"Project", &b.project},
                                   {"Machine", &b.machine},
                                   {"Company", &b.company},
                                   {"Author", &b.author},
                                   {"Checked", &b.checked},
                                   {"Document", &b.document},
                                   {"Revision", &b.revision},
                                   {"Date", &b.date},
                                   {"Notes", &b.notes}}) {
    if (text->empty()) continue;
    job.report.title_block.emplace_back(name, *text);
    job.summary["title block"][name] = *text;
  }
}

}  // namespace

void run_steps(run::Job& job) {
  const Stopwatch watch;
  put_title_block(job);
  job.report.title = job.model.title.empty() ? job.model.deck_name : job.model.title;
  job.report.deck = job.model.resolved;
  for (const Diagnostic& w : job.model.warnings)
    job.report.warnings.push_back(w.message);
  const StepBody body = [](run::Job& of_step, const model::Step& step) {
    run_named_step(of_step, step);
  };
  StepsSideBySide several(job, body);  // what of them the report still looks at lives as long
  try {
    if (several.possible())
      several.run();
    else
      run_one_by_one(job, body);
  } catch (const Interrupted&) {
    // steps before it are complete; of this one nothing is, and it has said so
  } catch (const Error& e) {
    io::Value& v = job.summary["error"];
    for (const Diagnostic& d : e.diagnostics())
      v.push(d.code + ": " + d.message);
    finish(job, watch);
    throw;
  }
  describe_savings(job);
  finish(job, watch);
}

}  // namespace whirl::steps
