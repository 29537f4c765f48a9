// The Python module `whirl`: decks, runs, results, small motions. What it does is in the other
// files of this folder; here stand names, arguments and documentation.
#include <core/units.hpp>
#include <core/version.hpp>
#include <algorithm>
#include <csignal>
#include <exception>
#include <fmt/format.h>
#include <io/file.hpp>
#include <io/results.hpp>
#include <io/table_file.hpp>
#include <map>
#include <mutex>
#include <pybind11/complex.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <python/arrays.hpp>
#include <python/deck_run.hpp>
#include <python/linear_rotor.hpp>
#include <python/toml_text.hpp>
#include <run/borrowed_signals.hpp>
#include <utility>

namespace py = pybind11;

namespace whirl::python {

namespace {

// ---- errors

/// whirl.Error with what it knows of its first diagnostic as attributes, and all of them in a list.
PyObject* error_type = nullptr;

[[noreturn]] void raise(const Error& e, const std::string& shown) {
  const std::vector<Diagnostic>& all = e.diagnostics();
  Diagnostic first = all.empty() ? Diagnostic{} : all.front();
  for (const Diagnostic& d : all)
    if (d.severity == Diagnostic::Severity::error) {
      first = d;
      break;
    }
  const py::object error = py::reinterpret_borrow<py::object>(error_type)(shown);
  error.attr("code") = first.code;
  error.attr("message") = first.message;
  error.attr("hint") = first.hint;
  error.attr("file") = first.where.file;
  error.attr("line") = first.where.line;
  error.attr("column") = first.where.column;
  error.attr("entity") = first.where.entity;
  error.attr("exit_code") = static_cast<int>(e.exit());
  error.attr("diagnostics") = py::cast(all);
  PyErr_SetObject(error_type, error.ptr());
  throw py::error_already_set();
}

std::string shown_without_source(const Error& e) {
  std::string out;
  for (const Diagnostic& d : e.diagnostics())
    out += format(d);
  return out;
}

// ---- work without the interpreter

/// What computes: one thing at a time in a process, since what asks a run to stop is one flag.
std::mutex computing;

/// Does `work` with other Python threads running and Ctrl-C asking it to stop. What Python itself
/// would have done on the signal, it does afterwards.
template <class Work>
auto compute(const DeckSource* source, Work work) {
  int signal = 0;
  std::exception_ptr failed;
  decltype(work()) result;
  {
    const py::gil_scoped_release others;
    const std::lock_guard one(computing);
    const run::BorrowedSignals borrowed;
    try {
      result = work();
    } catch (...) {
      failed = std::current_exception();
    }
    signal = borrowed.asked_by();
  }
  if (signal != 0) {
    std::raise(signal);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  if (!failed) return result;
  try {
    std::rethrow_exception(failed);
  } catch (const Error& e) {
    raise(e, source ? source->shown(e.diagnostics()) : shown_without_source(e));
  }
}

/// rad/s: of a number as it is, of text by its unit.
double angular(const py::object& given, const char* what) {
  if (!py::isinstance<py::str>(given)) return given.cast<double>();
  const std::string text = given.cast<std::string>();
  const units::Parsed parsed = units::parse(text);
  const units::Quantity rad_s = units::unit("rad/s"), hz = units::unit("Hz");
  if (parsed.problem)
    throw py::value_error(fmt::format("{} '{}': {}", what, text, parsed.problem->message));
  if (parsed.quantity.dimension == hz.dimension) return two_pi * parsed.quantity.value();
  if (parsed.quantity.dimension == rad_s.dimension) return parsed.quantity.value();
  throw py::value_error(fmt::format(
      "{} '{}': not an angular speed; \"3000 rpm\", \"50 Hz\" or a number in rad/s", what, text));
}

// ---- results

/// A table of a results folder.
class ResultTable {
 public:
  explicit ResultTable(std::vector<std::string> names, std::vector<std::string> units,
                       std::vector<py::object> values)
      : names_(std::move(names)),
        units_(std::move(units)),
        values_(std::move(values)) {}

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& units() const { return units_; }
  std::string title(std::size_t k) const {
    return units_[k].empty() ? names_[k] : names_[k] + " [" + units_[k] + "]";
  }
  std::vector<std::string> titles() const {
    std::vector<std::string> out;
    for (std::size_t k = 0; k < names_.size(); ++k)
      out.push_back(title(k));
    return out;
  }
  /// By title "frequency [Hz]", or by name where one column alone has it.
  py::object column(const std::string& asked) const {
    std::vector<std::size_t> named;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (title(k) == asked) return values_[k];
      if (names_[k] == asked) named.push_back(k);
    }
    if (named.size() == 1) return values_[named.front()];
    throw py::key_error(
        fmt::format("{} '{}'; the columns are: {}", named.empty() ? "no column" : "several columns",
                    asked, py::str(", ").attr("join")(py::cast(titles())).cast<std::string>()));
  }
  py::ssize_t rows() const {
    return values_.empty() ? 0 : static_cast<py::ssize_t>(py::len(values_.front()));
  }

 private:
  std::vector<std::string> names_, units_;
  std::vector<py::object> values_;  ///< arrays of numbers; lists of text
};

ResultTable table_from_csv(const std::filesystem::path& file) {
  io::TableFile t;
  {
    const py::gil_scoped_release others;
    t = io::read_table(file);
  }
  std::vector<std::string> names, units;
  std::vector<py::object> values;
  for (io::TableFile::Column& c : t.columns) {
    names.push_back(std::move(c.name));
    units.push_back(std::move(c.unit));
    if (c.texts.empty())
      values.push_back(array_of(std::move(c.numbers)));
    else
      values.push_back(py::cast(c.texts));
  }
  return ResultTable(std::move(names), std::move(units), std::move(values));
}

ResultTable table_from_hdf5(const std::filesystem::path& file) {
  io::Columns c = io::read_hdf5(file);
  std::vector<py::object> values;
  for (std::vector<double>& v : c.values)
    values.push_back(array_of(std::move(v)));
  return ResultTable(std::move(c.names), std::move(c.units), std::move(values));
}

/// A results folder: of a run just made, or of an earlier one.
class Results {
 public:
  Results(std::filesystem::path folder, int exit_code, bool cancelled)
      : folder_(std::move(folder)),
        exit_code_(exit_code),
        cancelled_(cancelled) {}
  static Results open(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "run.json"))
      throw Error(
          Exit::io,
          Diagnostic{
              Diagnostic::Severity::error, "E91",
              fmt::format("'{}' is no results folder: there is no run.json in it", folder.string()),
              "`whirl run DECK` makes one, at the deck's output.directory", Where{}});
    return Results(folder, 0, false);
  }
  const std::filesystem::path& folder() const { return folder_; }
  int exit_code() const { return exit_code_; }
  bool cancelled() const { return cancelled_; }
  py::object summary() const {
    const std::string text = io::read_text(folder_ / "summary.json");
    return py::module_::import("json").attr("loads")(text);
  }
  /// Of the tables: file names without their ending.
  std::vector<std::string> tables() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().extension() == ".csv" || entry.path().extension() == ".h5")
        out.push_back(entry.path().stem().string());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  py::object table(const std::string& name) {
    const auto known = read_.find(name);
    if (known != read_.end()) return known->second;
    const std::filesystem::path csv = folder_ / (name + ".csv"), h5 = folder_ / (name + ".h5");
    py::object made;
    if (std::filesystem::exists(csv))
      made = py::cast(table_from_csv(csv));
    else if (std::filesystem::exists(h5))
      made = py::cast(table_from_hdf5(h5));
    else
      throw py::key_error(
          fmt::format("no table '{}' in {}; there are: {}", name, folder_.string(),
                      py::str(", ").attr("join")(py::cast(tables())).cast<std::string>()));
    read_.emplace(name, made);
    return made;
  }

 private:
  std::filesystem::path folder_;
  int exit_code_;
  bool cancelled_;
  std::map<std::string, py::object> read_;  ///< a table is read once
};

// ---- decks

void set_keys(DeckSource& deck, const py::dict& set) {
  for (const auto& [path, value] : set) {
    const std::string key = py::str(path).cast<std::string>();
    deck.set(key, toml_of_value(value, key));
  }
}

DeckSource make_deck(const py::object& source, const std::filesystem::path& folder,
                     const std::string& name, const py::dict& set) {
  std::string text;
  if (py::isinstance<py::dict>(source))
    text = toml_of_deck(source.cast<py::dict>());
  else if (py::isinstance<py::str>(source))
    text = source.cast<std::string>();
  else
    throw py::type_error("a deck is made from TOML text or from a dict; whirl.load() reads a file");
  DeckSource deck(std::move(text), name, folder);
  set_keys(deck, set);
  return deck;
}

DeckSource load_deck(const std::filesystem::path& file, const py::dict& set) {
  try {
    DeckSource deck = DeckSource::from_file(file);
    set_keys(deck, set);
    return deck;
  } catch (const Error& e) {
    raise(e, shown_without_source(e));
  }
}

std::shared_ptr<const deck::Deck> read(const DeckSource& deck) {
  try {
    return deck.read();
  } catch (const Error& e) {
    raise(e, deck.shown(e.diagnostics()));
  }
}

Results run_deck(const DeckSource& deck, const std::filesystem::path& output,
                 const py::object& progress, int jobs, bool resume, bool quiet) {
  const DeckSource fixed = deck;  // other threads may go on setting keys
  RunChoices choices{output, jobs, resume, quiet, {}};
  std::exception_ptr raised;  // by the callback: passed on when the run has come to its end
  if (!progress.is_none())
    choices.progress = [&](const std::string& step, double fraction, const std::string& text) {
      const py::gil_scoped_acquire interpreter;
      try {
        const py::object answer = progress(step, fraction, text);
        return answer.is_none() || answer.cast<bool>();
      } catch (...) {
        raised = std::current_exception();
        return false;
      }
    };
  const RunOutcome done = compute(&fixed, [&] { return run(fixed, choices); });
  if (raised) std::rethrow_exception(raised);
  return Results(done.folder, done.exit_code, done.cancelled);
}

// ---- small motions

/// M, C, G, K of a rotor as SciPy matrices.
struct Linear {
  py::object M, C, G, K;
  double speed;
};

py::object csr(SparseRows&& m, std::size_t size) {
  const py::object type = py::module_::import("scipy.sparse").attr("csr_matrix");
  const py::tuple parts = py::make_tuple(
      array_of(std::move(m.values)), array_of(std::move(m.columns)), array_of(std::move(m.starts)));
  return type(parts, py::arg("shape") = py::make_tuple(size, size), py::arg("copy") = false);
}

/// The modes of a rotor at one speed.
struct Modes {
  py::array_t<Complex> eigenvalues, shapes;
  py::array_t<double> frequency, log_decrement, damping_ratio;
  std::vector<std::string> kind, direction;
  std::string certificate;
  bool complete = false;
};

/// A rotor and the deck it is of, for messages.
struct Rotor {
  DeckSource source;
  std::unique_ptr<LinearRotor> rotor;
};

Rotor make_rotor(const DeckSource& deck, const std::string& step, const std::string& about) {
  if (about != "equilibrium" && about != "undeformed")
    throw py::value_error(fmt::format("about = '{}': \"equilibrium\" or \"undeformed\"", about));
  const auto parsed = read(deck);
  Rotor out{deck, nullptr};
  out.rotor = compute(
      &deck, [&] { return std::make_unique<LinearRotor>(parsed, step, about == "undeformed"); });
  return out;
}

Linear linearise(Rotor& r, const py::object& speed, const py::object& frequency) {
  const double Omega = angular(speed, "speed");
  std::optional<double> w;
  if (!frequency.is_none()) w = angular(frequency, "frequency");
  Matrices m = compute(&r.source, [&] { return r.rotor->matrices(Omega, w); });
  const std::size_t n = r.rotor->size();
  return {csr(std::move(m.M), n), csr(std::move(m.C), n), csr(std::move(m.G), n),
          csr(std::move(m.K), n), Omega};
}

analysis::Motion motion_named(const std::string& name) {
  const std::pair<const char*, analysis::Motion> all[] = {
      {"all", analysis::Motion::all},
      {"lateral", analysis::Motion::lateral},
      {"torsional", analysis::Motion::torsional},
      {"axial", analysis::Motion::axial}};
  for (const auto& [word, motion] : all)
    if (name == word) return motion;
  throw py::value_error(
      fmt::format("motion = '{}': \"all\", \"lateral\", \"torsional\" or \"axial\"", name));
}

Modes modes_of(Rotor& r, const py::object& speed, int count, const std::string& motion,
               bool damped) {
  analysis::ModesOptions options;
  options.count = count;
  options.motion = motion_named(motion);
  options.damped = damped;
  const double Omega = angular(speed, "speed");
  analysis::SpectrumCertificate certificate;
  const std::vector<analysis::WhirlMode> found =
      compute(&r.source, [&] { return r.rotor->modes(Omega, options, certificate); });
  std::vector<Complex> lambda, shapes;
  std::vector<double> hertz, decrement, ratio;
  Modes out;
  for (const analysis::WhirlMode& m : found) {
    lambda.push_back(m.lambda);
    hertz.push_back(to_hz(m.frequency));
    decrement.push_back(m.log_decrement);
    ratio.push_back(m.damping_ratio);
    out.kind.emplace_back(to_string(m.kind));
    out.direction.emplace_back(to_string(m.direction));
    const VecXc x = r.rotor->free_part(m.x);
    shapes.insert(shapes.end(), x.begin(), x.end());
  }
  const auto rows = static_cast<py::ssize_t>(found.size());
  const auto width = static_cast<py::ssize_t>(r.rotor->size());
  out.shapes = array_of(std::move(shapes), {rows, width});
  out.eigenvalues = array_of(std::move(lambda));
  out.frequency = array_of(std::move(hertz));
  out.log_decrement = array_of(std::move(decrement));
  out.damping_ratio = array_of(std::move(ratio));
  out.certificate = certificate.text();
  out.complete = certificate.complete();
  return out;
}

// ---- names and documentation

void bind_errors(py::module_& m) {
  py::class_<Diagnostic>(m, "Diagnostic", "What is wrong, or to be known, and where.")
      .def_property_readonly("severity", [](const Diagnostic& d) { return name_of(d.severity); })
      .def_readonly("code", &Diagnostic::code, "\"E07\"; `whirl explain E07` tells more")
      .def_readonly("message", &Diagnostic::message)
      .def_readonly("hint", &Diagnostic::hint)
      .def_property_readonly("file", [](const Diagnostic& d) { return d.where.file; })
      .def_property_readonly("line", [](const Diagnostic& d) { return d.where.line; })
      .def_property_readonly("column", [](const Diagnostic& d) { return d.where.column; })
      .def_property_readonly("entity", [](const Diagnostic& d) { return d.where.entity; })
      .def("__repr__", [](const Diagnostic& d) { return format(d); });
  error_type = PyErr_NewExceptionWithDoc(
      "whirl.Error",
      "What a deck, a file or the numbers do not allow. Attributes: code (\"E07\"), message, hint, "
      "file, line, column, entity of the first error; exit_code of the program; diagnostics, all "
      "of "
      "them. As text: what the program prints, with source line and caret.",
      PyExc_RuntimeError, nullptr);
  m.attr("Error") = py::handle(error_type);
  // NOLINTNEXTLINE(performance-unnecessary-value-param): what pybind11 calls
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const Error& e) {
      try {
        raise(e, shown_without_source(e));
      } catch (py::error_already_set& python) {
        python.restore();
      }
    }
  });
}

void bind_results(py::module_& m) {
  py::class_<ResultTable>(
      m, "Table",
      "A table: columns with names and units. t[\"frequency [Hz]\"] is a NumPy "
      "array (text columns: a list); the name alone does where it is the only one.")
      .def_property_readonly("names", &ResultTable::names)
      .def_property_readonly("units", &ResultTable::units, "\"-\": dimensionless")
      .def_property_readonly("columns", &ResultTable::titles, "\"name [unit]\"")
      .def("__getitem__", &ResultTable::column, py::arg("column"))
      .def("__len__", &ResultTable::rows, "rows")
      .def("__repr__", [](const ResultTable& t) {
        return fmt::format("<whirl.Table: {} rows, {} columns>", t.rows(), t.names().size());
      });
  py::class_<Results>(m, "Results",
                      "A results folder. r.tables lists the tables, r[\"modes_modes\"] reads one "
                      "(once); r.summary is summary.json.")
      .def_property_readonly("folder", &Results::folder)
      .def_property_readonly("exit_code", &Results::exit_code,
                             "as of the program: 0, or 4 when something could not be certified")
      .def_property_readonly("cancelled", &Results::cancelled)
      .def_property_readonly("summary", &Results::summary)
      .def_property_readonly("tables", &Results::tables)
      .def("__getitem__", &Results::table, py::arg("table"))
      .def("__repr__", [](const Results& r) {
        return fmt::format("<whirl.Results in '{}'>", r.folder().string());
      });
}

void bind_deck(py::module_& m) {
  py::class_<DeckSource>(
      m, "Deck",
      "A deck: from TOML text or a dict (values as in a deck: \"75 um\", numbers, lists, dicts). "
      "Relative paths in it start at folder; name stands in messages; set: keys set otherwise.")
      .def(py::init(&make_deck), py::arg("source"), py::arg("folder") = std::filesystem::path(),
           py::arg("name") = "deck.toml", py::arg("set") = py::dict())
      .def_property_readonly("text", &DeckSource::text,
                             "the TOML text that lines of errors count in")
      .def_property_readonly("settings", &DeckSource::settings)
      .def(
          "set",
          [](DeckSource& d, const std::string& path, const py::object& value) -> DeckSource& {
            d.set(path, toml_of_value(value, path));
            return d;
          },
          py::arg("path"), py::arg("value"), py::return_value_policy::reference_internal,
          "Sets a key as --set of the program does: deck.set(\"step.run.duration\", \"5 s\"), "
          "deck.set(\"parameters.clearance\", \"75 um\"). Returns the deck.")
      .def("__setitem__", [](DeckSource& d, const std::string& path,
                             const py::object& value) { d.set(path, toml_of_value(value, path)); })
      .def(
          "check", [](const DeckSource& d) { return read(d)->diagnostics; },
          "Reads the deck; returns its warnings. Raises Error with everything that is wrong.")
      .def_property_readonly(
          "resolved", [](const DeckSource& d) { return read(d)->model.resolved; },
          "the deck with parameters put in and defaults explicit, TOML (tomllib.loads)")
      .def("run", &run_deck, py::arg("output") = std::filesystem::path(),
           py::arg("progress") = py::none(), py::kw_only(), py::arg("jobs") = 0,
           py::arg("resume") = false, py::arg("quiet") = true,
           "Runs the steps into the results folder (output, or as the deck says) and returns it. "
           "progress(step, fraction, text) is called at most ten times a second; returning False "
           "ends the run, which writes what is finished (resume=True goes on with a transient). "
           "Other threads of Python run meanwhile; one run at a time in a process.")
      .def("rotor", &make_rotor, py::arg("step") = "", py::arg("about") = "equilibrium",
           "The machine for small motions: matrices and modes. step: whose drives act. about: "
           "\"equilibrium\", the static one at the speed, or \"undeformed\".");
}

void bind_rotor(py::module_& m) {
  py::class_<Linear>(m, "Linear",
                     "M x'' + (C + G) x' + K x = f at one speed, SI, SciPy csr_matrix: C the "
                     "symmetric part of what multiplies x', G the skew-symmetric (gyroscopic) one.")
      .def_readonly("M", &Linear::M)
      .def_readonly("C", &Linear::C)
      .def_readonly("G", &Linear::G)
      .def_readonly("K", &Linear::K)
      .def_readonly("speed", &Linear::speed, "rad/s");
  py::class_<Modes>(m, "Modes", "Modes at one speed by frequency: x exp(lambda t).")
      .def_readonly("eigenvalues", &Modes::eigenvalues, "lambda, 1/s, Im >= 0")
      .def_readonly("shapes", &Modes::shapes, "one row a mode, on the unknowns of the rotor")
      .def_readonly("frequency", &Modes::frequency, "Hz, damped")
      .def_readonly("log_decrement", &Modes::log_decrement)
      .def_readonly("damping_ratio", &Modes::damping_ratio)
      .def_readonly("kind", &Modes::kind)
      .def_readonly("direction", &Modes::direction)
      .def_readonly("certificate", &Modes::certificate, "what is known of the list")
      .def_readonly("complete", &Modes::complete, "counted by a second method: none is missing");
  py::class_<Rotor>(
      m, "Rotor",
      "The machine of a deck for small motions about its steady state. Unknowns: "
      "displacements (m) in fixed axes x (along the shaft), y, z (up), spin angle and "
      "tilts (rad) of every node, those that are free.")
      .def_property_readonly("unknowns", [](const Rotor& r) { return r.rotor->names(); })
      .def_property_readonly(
          "stations", [](const Rotor& r) { return array_of(r.rotor->stations()); },
          "m from the left end of its line, one an unknown; nan off the lines")
      .def_property_readonly(
          "components", [](const Rotor& r) { return array_of(r.rotor->components()); },
          "0 to 5, one an unknown: x, y, z, spin, tilt gamma2, tilt gamma3")
      .def_property_readonly(
          "equilibrium", [](const Rotor& r) { return array_of(r.rotor->equilibrium()); },
          "the state at the last speed, m and rad, one an unknown")
      .def_property_readonly(
          "notes", [](const Rotor& r) { return r.rotor->notes(); },
          "what one must know of the matrices: held motions, means")
      .def(
          "linearise", &linearise, py::arg("speed"), py::arg("frequency") = py::none(),
          "Matrices at a speed of the reference line (rad/s, or text: \"3000 rpm\"). frequency: of "
          "the motion, for supports tabulated against it.")
      .def("modes", &modes_of, py::arg("speed"), py::arg("count") = 12, py::arg("motion") = "all",
           py::arg("damped") = true, "Modes of least frequency at a speed.")
      .def(
          "__len__", [](const Rotor& r) { return r.rotor->size(); }, "unknowns");
}

}  // namespace

}  // namespace whirl::python

PYBIND11_MODULE(whirl, m) {
  using namespace whirl::python;
  m.doc() =
      "Whirl: rotor-shaft dynamics. whirl.load(file) or whirl.Deck(dict) gives a deck; "
      "deck.run() its results; deck.rotor() matrices and modes.";
  m.attr("__version__") = whirl::version();
  bind_errors(m);
  bind_results(m);
  bind_deck(m);
  bind_rotor(m);
  m.def("load", &load_deck, py::arg("file"), py::arg("set") = py::dict(), "The deck in a file.");
  m.def("results", &Results::open, py::arg("folder"), "The results of an earlier run.");
}
