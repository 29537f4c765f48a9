// The command line. CLI11 is known here alone.
#include <CLI/CLI.hpp>

#include <app/commands.hpp>
#include <deck/text/document.hpp>
#include <run/diagnose.hpp>
#include <run/terminal.hpp>
#include <core/version.hpp>
#include <study/study.hpp>
#include <sweep/sweep.hpp>
#include <core/interrupt.hpp>
#include <core/isa.hpp>
#include <core/types.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <string>
#include <unistd.h>

namespace {

using namespace whirl;
using namespace whirl::app;

void add_deck(CLI::App* c, std::filesystem::path& deck, deck::ReadOptions& read) {
  c->add_option("deck", deck, "deck file (TOML); - is standard input")->required();
  c->add_option("--set", read.set,
                "override a key: --set step.run_up.duration='5 s' (may be repeated)")
      ->type_name("PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

/// "8GB" as bytes, 1000 of each to the next, or 1024 ("8GiB"); "none": any number.
double bytes_of(const std::string& text) {
  static constexpr std::string_view letters = "kmgtp";
  if (text == "none") return infinity;
  double bytes = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), bytes);
  std::string unit(static_cast<const char*>(read.ptr), text.data() + text.size());
  std::erase(unit, ' ');
  for (char& c : unit)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t place = unit.empty() ? letters.npos : letters.find(unit.front());
  const bool scaled = place != letters.npos;
  const std::string rest = scaled ? unit.substr(1) : unit;
  const bool of_1024 = scaled && rest == "ib";
  const bool known = rest.empty() || rest == "b" || of_1024;
  if (read.ec != std::errc{} || !known || !(bytes > 0) || !std::isfinite(bytes))
    throw CLI::ValidationError(
        fmt::format("'{}' is not a size: write 8GB, 500MB, 16GiB or none", text));
  return scaled ? bytes * std::pow(of_1024 ? 1024.0 : 1000.0, static_cast<double>(place + 1))
                : bytes;
}

void add_limits(CLI::App* c, double& memory, double& disk) {
  c->add_option_function<std::string>(
       "--max-memory", [&memory](const std::string& text) { memory = bytes_of(text); },
       "refuse what would take more memory, by the estimate before it (default: what is available)")
      ->type_name("SIZE");
  c->add_option_function<std::string>(
       "--max-disk", [&disk](const std::string& text) { disk = bytes_of(text); },
       "refuse what would write more (default: what is free)")
      ->type_name("SIZE");
}

void add_run(CLI::App* c, run::RunOptions& run, bool& reproducible) {
  c->add_flag("-q,--quiet", run.quiet, "no progress and no summary");
  c->add_flag("--savings", run.savings,
              "measure what an evaluation costs with and without the parts that were left out");
  c->add_flag("--json", run.json, "summary as JSON on standard output");
  c->add_option("-j,--jobs", run.jobs, "threads for what can go in parallel (0: all processors)")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  c->add_flag("--reproducible", reproducible,
              "the same digits on every x86-64 processor, by instructions that all of them have");
  c->add_option("-o,--output", run.output, "results folder instead of the deck's")
      ->type_name("FOLDER");
  add_limits(c, run.max_memory, run.max_disk);
}

std::vector<CommandInfo> commands_of(const CLI::App& app) {
  std::vector<CommandInfo> r;
  for (const auto* c : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandInfo info{c->get_name(), {}, false};
    for (const auto* o : c->get_options()) {
      for (const auto& n : o->get_lnames())
        info.options.push_back("--" + n);
      info.takes_deck = info.takes_deck || o->get_name() == "deck";
    }
    r.push_back(std::move(info));
  }
  return r;
}

void check_environment() {
  const char* isa = std::getenv("WHIRL_ISA");
  if (!isa || known_isa(isa)) return;
  throw Error(Exit::usage,
              Diagnostic{Diagnostic::Severity::error, "E98",
                         fmt::format("WHIRL_ISA = '{}' is no instruction set", isa),
                         "it is baseline, avx2 or avx512; leave it out for the best one", Where{}});
}

/// What the subcommands are given.
struct Given {
  CheckOptions check;
  RunCommand run;
  bool keep_everything = false;
  bool reproducible = false;
  study::StudyOptions study;
  bool stability = false;
  sweep::SweepOptions sweep;
  bool reference = false, unit_list = false;
  std::filesystem::path pages;
  std::vector<std::string> codes;
  NewOptions fresh;
  ConvertOptions convert;
  ViewOptions view;
  std::string shell;
};

void add_check(CLI::App& app, Given& g) {
  auto* c = app.add_subcommand("check",
                               "read a deck; print stations, masses and everything that is wrong");
  add_deck(c, g.check.deck, g.check.read);
  c->add_option(
       "--mesh", g.check.mesh,
       "write nodes, elements and stations (CSV) and a drawing of the rotor (SVG) into this folder")
      ->type_name("FOLDER");
  c->add_flag("--json", g.check.json, "result as JSON on standard output");
  c->add_flag("-q,--quiet", g.check.quiet, "errors only");
  c->add_flag("--resolved", g.check.resolved,
              "print the resolved deck: parameters put in, defaults explicit");
  add_limits(c, g.check.max_memory, g.check.max_disk);
}

void add_run_command(CLI::App& app, Given& g) {
  auto* c = app.add_subcommand("run", "run the steps of a deck");
  add_deck(c, g.run.deck, g.run.read);
  add_run(c, g.run.run, g.reproducible);
  c->add_flag("--resume", g.run.run.resume, "continue from the last checkpoint");
  c->add_flag("--keep-everything", g.keep_everything,
              "build the general model instead of leaving out what the deck does not need");
}

void add_study(CLI::App& app, Given& g) {
  auto* c = app.add_subcommand(
      "study", "error against run time of a deck over tolerances, steps, integrators and meshes");
  add_deck(c, g.study.deck, g.study.read);
  add_run(c, g.study.run, g.reproducible);
  c->add_option("--exact", g.study.exact,
                "exact displacements of probes to measure against as well: CSV, or HDF5 (*.h5), "
                "with columns \"t [s]\", \"PROBE.y [m]\", ..")
      ->type_name("FILE");
  c->add_flag("--stability", g.stability,
              "instead: spectral radius, numerical damping and energy over 1e5 steps of every "
              "integrator on this rotor");
}

void add_sweep(CLI::App& app, Given& g) {
  auto* c = app.add_subcommand("sweep", "many runs of a deck with some of its keys varied");
  add_deck(c, g.sweep.deck, g.sweep.read);
  c->add_option(
       "--vary", g.sweep.vary,
       "a key and its values: first:last:count (:log), a list, or uniform(low, high), "
       "loguniform, triangular(low, mode, high), normal(mean, deviation), lognormal(median, "
       "deviation), each also as 'LAW drawn LAW' for weighted samples; several keys are combined; "
       "@FILE: a CSV of runs")
      ->type_name("PATH=VALUES")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--response", g.sweep.responses,
                "a number or word of a table of the run, PICK a row from 1, last, min, max, absmax "
                "or mean; of the summary: summary:KEY.KEY")
      ->type_name("[NAME=]TABLE:COLUMN[:PICK]")
      ->take_all()
      ->allow_extra_args(false);
  c->add_flag("--list", g.sweep.list, "run the deck as it is and list what can be a response");
  c->add_option("--samples", g.sweep.samples, "samples of the distributions")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000000}))
      ->type_name("N");
  c->add_option(
       "--sampling", g.sweep.sampling,
       "random, lhs (Latin hypercube, default) or sobol; for sensitivity saltelli (Sobol's "
       "indices), morris or one_at_a_time (tornado)")
      ->type_name("WORD");
  c->add_option("--correlation", g.sweep.correlations,
                "of two distributions' normal scores, -1 .. 1")
      ->type_name("PATH,PATH=NUMBER")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--exceed", g.sweep.exceed,
                "how probable it is that a response lies beyond a value (or NAME<VALUE)")
      ->type_name("NAME>VALUE")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--worst", g.sweep.worst,
                "run the worst ones by this response again with their reports (default largest:10)")
      ->type_name("NAME[:least][:COUNT]")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--seed", g.sweep.seed, "of the samples: the same gives the same runs (default 1)")
      ->type_name("N");
  c->add_option("--shard", g.sweep.shard,
                "every n-th run from the i-th, for several machines on one folder; auto: as the "
                "queue or mpirun says")
      ->type_name("I/N");
  c->add_option("--limit", g.sweep.limit, "seconds of wall time a run may take")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  c->add_flag("--hdf5", g.sweep.hdf5, "write the table of runs to sweep.h5 as well");
  c->add_flag("--keep", g.sweep.keep, "keep the results folder of every run");
  c->add_flag("--resume", g.sweep.run.resume, "do the runs that are not done yet");
  add_run(c, g.sweep.run, g.reproducible);
}

void add_texts(CLI::App& app, Given& g) {
  auto* c = app.add_subcommand("schema", "JSON schema of decks, for editors");
  auto* r = c->add_flag("--reference", g.reference, "all tables and keys as Markdown");
  auto* u = c->add_flag("--units", g.unit_list, "all units as Markdown")->excludes(r);
  c->add_option("--pages", g.pages, "the reference as pages (Markdown) in this folder")
      ->type_name("FOLDER")
      ->excludes(r)
      ->excludes(u);

  c = app.add_subcommand("explain", "what an error code means; without a code: the list");
  c->add_option("codes", g.codes, "error codes")->type_name("CODE");

  c = app.add_subcommand("new",
                         "write a commented deck to start from, an example or a starter for a kind "
                         "of machine; without either: the list");
  auto* example =
      c->add_option("--example", g.fresh.example, "a validated example")->type_name("NAME");
  auto* machine = c->add_option("--machine", g.fresh.machine, "a starter for a kind of machine")
                      ->type_name("KIND")
                      ->excludes(example);
  c->add_option("--answer", g.fresh.answers,
                "answer to one of its questions: --answer speed='2980 rpm' (may be repeated)")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false)
      ->needs(machine);
  c->add_flag("--questions", g.fresh.questions, "the questions of the starter instead of a deck")
      ->needs(machine);
  c->add_option("file", g.fresh.file, "file to write (standard output when left out)");
  c->add_flag("--force", g.fresh.force, "replace an existing file");

  c = app.add_subcommand("convert",
                         "a model of another program as a deck: a rotor saved by ROSS "
                         "(.toml, .json), a table of stations or coefficients (.csv, .xlsx)");
  c->add_option("input", g.convert.input, "file to convert")->required();
  c->add_option("output", g.convert.output, "file to write (standard output when left out)");
  c->add_option("--sheet", g.convert.sheet, "sheet of a workbook (the first with cells)");
  c->add_flag("--force", g.convert.force, "replace an existing file");

  c = app.add_subcommand("view", "arrange the frames of a results folder in ParaView");
  c->add_option("results", g.view.results, "results folder of a run")->required();
  c->add_option("set", g.view.set, "step or shape to show (that of most frames when left out)");
  c->add_option("--script", g.view.script, "state script to write (RESULTS/view.py)")
      ->type_name("FILE");
  c->add_flag("--open", g.view.open, "start ParaView with it");

  c = app.add_subcommand("completion", "completion script for a shell");
  c->add_option("shell", g.shell, "bash or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "fish"}));

  app.add_subcommand("version", "version, compiler, plug-ins");
}

/// Instructions beyond those of every x86-64 round differently where they fuse a product and a sum.
/// Whirl's own kernels are chosen by WHIRL_ISA; the C library chooses its sines when a program starts,
/// so that this one starts again.
void take_common_instructions(char** argv) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  static constexpr const char* hidden = "glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-AVX512F,-AVX512VL";
  const std::string tunables = variable("GLIBC_TUNABLES");
  if (variable("WHIRL_ISA") == "baseline" && tunables.find(hidden) != std::string::npos) return;
  setenv("WHIRL_ISA", "baseline", 1);
  setenv("GLIBC_TUNABLES", (tunables.empty() ? hidden : tunables + ":" + hidden).c_str(), 1);
  std::fflush(nullptr);
  execv("/proc/self/exe", argv);
  Diagnostic d;
  d.message =
      fmt::format("--reproducible cannot start the program again: {}", std::strerror(errno));
  d.hint = "WHIRL_ISA=baseline chooses the same kernels, but leaves the C library its own choice";
  throw Error(Exit::io, std::move(d));
}

int execute(const CLI::App& app, Given& g) {
  const auto is = [&](const char* name) { return app.got_subcommand(name); };
  if (is("check")) return check_deck(g.check);
  if (is("run")) {
    g.run.run.terminal = run::is_terminal(2);
    if (g.keep_everything) g.run.read.set.emplace_back("model.keep_everything=true");
    return run_command(g.run);
  }
  if (is("study")) {
    g.study.run.terminal = run::is_terminal(2);
    return g.stability ? study::study_stability(g.study) : study::study_deck(g.study);
  }
  if (is("sweep")) {
    g.sweep.run.terminal = run::is_terminal(2);
    return sweep::run_sweep(g.sweep);
  }
  if (is("schema") && !g.pages.empty()) return write_reference(g.pages);
  if (is("schema"))
    return print_schema(g.reference   ? SchemaForm::reference
                        : g.unit_list ? SchemaForm::units
                                      : SchemaForm::json);
  if (is("explain")) return explain(g.codes);
  if (is("new")) return new_deck(g.fresh);
  if (is("convert")) return convert_model(g.convert);
  if (is("view")) return view_results(g.view);
  if (is("completion")) {
    std::fputs(completion_script(g.shell, commands_of(app)).c_str(), stdout);
    return static_cast<int>(Exit::ok);
  }
  std::fputs(version_text().c_str(), stdout);
  return static_cast<int>(Exit::ok);
}

/// Says why the arguments cannot be taken, with the nearest word that could.
[[noreturn]] void bad_usage(std::string message, std::string hint) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  throw Error(Exit::usage, std::move(d));
}

/// A first word that is no command.
void check_command(const CLI::App& app, const std::string& word) {
  if (word.empty() || word.front() == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(c->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const auto near = deck::nearest(word, names);
  std::error_code ec;
  bad_usage(fmt::format("there is no command '{}'", word),
            std::filesystem::is_regular_file(word, ec) ? fmt::format("whirl run '{}'", word)
            : near.empty() ? fmt::format("the commands: {}", fmt::join(names, ", "))
                           : fmt::format("did you mean '{}'?", near.front()));
}

/// Null without it.
const CLI::App* command_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; }))
    if (c->get_name() == name) return c;
  return nullptr;
}

/// Long names with their dashes, short ones too.
std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* o : command.get_options()) {
    for (const std::string& n : o->get_lnames())
      names.push_back("--" + n);
    for (const std::string& n : o->get_snames())
      names.push_back("-" + n);
  }
  return names;
}

std::string hint_for(const std::string& option, const std::vector<std::string>& names,
                     const std::string& command) {
  const bool one_dash = option.size() > 2 && option[1] != '-';
  if (one_dash && std::find(names.begin(), names.end(), "-" + option) != names.end())
    return fmt::format("did you mean '-{}'?", option);
  const auto near = option.size() > 2 ? deck::nearest(option, names) : std::vector<std::string>();
  return near.empty() ? fmt::format("`{} --help` lists them", command)
                      : fmt::format("did you mean '{}'?", near.front());
}

/// Whether a word is an option, and one that there is; short ones may have their value behind them.
bool is_unknown_option(const std::string& option, const std::vector<std::string>& names) {
  if (option.size() < 2 || option[0] != '-' || option == "--") return false;
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (option[1] == '-') return !has(option);
  if (std::isdigit(static_cast<unsigned char>(option[1]))) return false;  // a number
  return !has(option.substr(0, 2)) || has("-" + option);
}

/// Options that the command does not have, or that stand before it.
void check_options(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* command = &app;
  std::string called = "whirl";
  for (const std::string& a : arguments) {
    if (command == &app)
      if (const CLI::App* chosen = command_named(app, a)) {
        command = chosen;
        called += " " + a;
        continue;
      }
    const std::string option = a.substr(0, a.find('='));
    const std::vector<std::string> names = options_of(*command);
    if (is_unknown_option(option, names))
      bad_usage(fmt::format("`{}` has no option '{}'", called, option),
                command != &app || !deck::nearest(option, names).empty()
                    ? hint_for(option, names, called)
                    : "options stand behind the command: whirl run deck.toml --jobs 2");
  }
}

int command_line(int argc, char** argv) {
  check_environment();
  CLI::App app{"Whirl: dynamics of rotor-shaft systems, exact in large rotation", "whirl"};
  app.require_subcommand(1);
  app.set_version_flag("--version", [] { return "whirl " + version(); });
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "Exit codes: 0 done, 1 internal error, 2 usage, 3 deck, 4 no convergence, 5 input or output, "
      "130 interrupted.\nExamples:\n"
      "  whirl new --example run_up deck.toml    a commented deck to start from\n  whirl check "
      "deck.toml                   what is in it, what is wrong with it\n"
      "  whirl run deck.toml                     run it\n  whirl explain E07                       "
      "what an error code means");

  Given given;
  add_check(app, given);
  add_run_command(app, given);
  add_study(app, given);
  add_sweep(app, given);
  add_texts(app, given);
  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return static_cast<int>(Exit::usage);
  }
  check_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) check_options(app, {argv + 1, argv + argc});
    const int code = app.exit(e);  // prints help, version or the message
    return code == 0 ? static_cast<int>(Exit::ok) : static_cast<int>(Exit::usage);
  }
  if (given.reproducible) take_common_instructions(argv);
  return execute(app, given);
}

/// Matrices of some hundred nodes come and go by the thousand. The heap keeps their memory: giving it
/// back to the system and having it cleared anew takes a ninth of the unbalance response of 400
/// elements.
void keep_memory() {
#ifdef __GLIBC__
  constexpr int megabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * megabyte);
  mallopt(M_TRIM_THRESHOLD, 256 * megabyte);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
  try {
    const int code = command_line(argc, argv);
    // a full disk or a closed pipe shows only here
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
      std::fputs("error: cannot write to standard output\n", stderr);
      return code == 0 ? static_cast<int>(whirl::Exit::io) : code;
    }
    return code;
  } catch (const whirl::Error& e) {
    run::print_diagnostics(e.diagnostics());
    return static_cast<int>(e.exit());
  } catch (const whirl::Interrupted&) {
    return static_cast<int>(whirl::Exit::interrupted);
  } catch (const std::bad_alloc&) {
    std::fputs("internal error: out of memory\n", stderr);
  } catch (const std::exception& e) {
    std::fputs(fmt::format("internal error: {}\n", e.what()).c_str(), stderr);
  }
  return static_cast<int>(whirl::Exit::internal);
}
