// `whirl study DECK --stability`: what the integrators do to the modes of this rotor, at which
// steps.
#include <analysis/study/scheme_stability.hpp>
#include <results/frequency.hpp>
#include <run/job.hpp>
#include <run/memory_limit.hpp>
#include <run/results_folder.hpp>
#include <run/options.hpp>
#include <study/study.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <plot/plot.hpp>
#include <io/file.hpp>
#include <plot/svg.hpp>
#include <time/stability.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace whirl::study {

namespace {

constexpr const char* schemes[] = {"radau5", "gauss4", "gauss6", "generalized_alpha", "ida"};
constexpr long many_steps = 100000;
constexpr double per_period =
    20.0;  ///< steps in a period of the fastest mode kept, for the run of many steps

struct Scheme {
  std::string name;
  plot::Series radius;  ///< against h times the frequency of the first mode
  double largest_radius = 0, limit = 0, first_unstable = infinity;  ///< s
  double energy = nan;
  std::vector<time::ModeResponse> response;
};

/// Steps a period of a mode at which its damping and frequency error are stated.
constexpr double resolutions[] = {100, 50, 20, 10, 5};

std::string label_of(const std::string& name, double rho) {
  return name == "generalized_alpha" ? fmt::format("{} ({:g})", name, rho)
         : name == "ida"             ? "ida (BDF2)"
                                     : name;
}

Scheme examine(const analysis::ReducedRotor& rotor, const char* name, double rho, double slow,
               double fast) {
  Scheme s;
  s.name = name;
  s.radius.label = label_of(name, rho);
  constexpr int per_decade = 12;
  const double first = two_pi / fast / 200.0, last = 1e3 * two_pi / slow;
  const int points = static_cast<int>(std::ceil(per_decade * std::log10(last / first)));
  for (int k = 0; k <= points; ++k) {
    const double h = first * std::pow(last / first, static_cast<double>(k) / points);
    const double r = analysis::spectral_radius(rotor, name, h, rho);
    s.radius.x.push_back(to_hz(h * slow));
    s.radius.y.push_back(r);
    s.largest_radius = std::max(s.largest_radius, r);
    s.limit = r;
    // double roots are found to the square root of rounding
    if (r > 1.0 + 1e-6) s.first_unstable = std::min(s.first_unstable, h);
  }
  for (double n : resolutions)
    s.response.push_back(time::mode_response(name, 1.0, 0.0, two_pi / n, rho));
  if (s.name != "ida")
    s.energy = analysis::energy_ratio(rotor, name, two_pi / fast / per_period, many_steps,
                                      rho);  // ida has no equal steps
  return s;
}

/// Where the deck's motion takes place: the speed its first transient step begins with, else the
/// first speed a step names.
double speed_of(run::Job& job) {
  for (const model::Step& step : job.model.steps) {
    job.build_for(step);
    if (const auto* t = std::get_if<model::TransientStep>(&step.law))
      return step.from.empty() ? job.start_of(step, t->own_speed()).speed : t->speed0;
    if (const auto* m = std::get_if<model::ModalStep>(&step.law)) return m->speed;
    if (const auto* m = std::get_if<model::StaticStep>(&step.law))
      return m->speeds ? results::speeds_of(*m->speeds).back()
                       : job.start_of(step, m->own_speed()).speed;
    if (const auto* m = std::get_if<model::UnbalanceStep>(&step.law))
      return m->speed.values.empty() ? m->speed.stop : m->speed.values.back();
    if (const auto* m = std::get_if<model::CampbellStep>(&step.law))
      return m->speed.values.empty() ? m->speed.stop : m->speed.values.back();
    if (const auto* m = std::get_if<model::StabilityStep>(&step.law))
      return m->speed.values.empty() ? m->speed.stop : m->speed.values.back();
  }
  return 0.0;
}

/// Error E95: what the study needs and the deck has not.
Error unfit(const StudyOptions& options, const char* what, const char* hint) {
  return Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E95", what, hint,
                                      Where{options.deck.string(), 0, 0, 0, ""}});
}

/// The undamped rotor on its lowest modes, and what the schemes do to it.
struct Findings {
  double Omega = 0, rho = 0.9;         ///< rad/s; of generalized_alpha
  double slow = infinity, fast = 0.0;  ///< rad/s, of the modes kept
  long unknowns = 0;                   ///< kept
  std::vector<Scheme> schemes;
};

Findings examine_schemes(run::Job& job, const StudyOptions& options) {
  Findings f;
  f.Omega = speed_of(job);
  for (const model::Step& step : job.model.steps)
    if (const auto* t = std::get_if<model::TransientStep>(&step.law)) f.rho = t->integrator.rho_inf;
  const run::StepState standing =
      job.start_of(job.model.steps.front(), f.Omega != 0.0 ? std::optional(f.Omega) : std::nullopt);
  analysis::EquilibriumOptions equilibrium;
  equilibrium.chart_change = job.model.chart_change;
  analysis::Linearizer linear(job.system(), job.steady_rotation_of(standing), equilibrium);
  const analysis::ReducedRotor rotor = analysis::reduce_rotor(linear, f.Omega).conservative();
  for (const Complex& l : rotor.lambda)
    if (l.imag() > 0.0) {
      f.slow = std::min(f.slow, l.imag());
      f.fast = std::max(f.fast, l.imag());
    }
  if (!(f.fast > 0.0))
    throw unfit(options, "the rotor has no mode that oscillates",
                "a stability study needs elastic supports or shafts");
  f.unknowns = static_cast<long>(rotor.M.rows());
  for (const char* name : schemes)
    f.schemes.push_back(examine(rotor, name, f.rho, f.slow, f.fast));
  return f;
}

io::Table scheme_table(const Findings& f) {
  io::Table table;
  table.title = "Schemes on the undamped rotor";
  table.columns = {{"method", "-", ""},
                   {"largest spectral radius", "-", "over all steps looked at"},
                   {"spectral radius of the longest step", "-", ""},
                   {"unstable from step", "s", "none: stable at every step"},
                   {fmt::format("energy after {} steps / at start", many_steps), "-",
                    fmt::format("{:g} steps a period of the fastest mode kept", per_period)}};
  for (double n : resolutions) {
    table.columns.push_back({fmt::format("damping ratio added, {:g} steps a period", n), "-", ""});
    table.columns.push_back({fmt::format("frequency error, {:g} steps a period", n), "-", ""});
  }
  for (const Scheme& s : f.schemes) {
    std::vector<io::Table::Cell> row{
        label_of(s.name, f.rho), s.largest_radius, s.limit,
        std::isfinite(s.first_unstable) ? io::Table::Cell(s.first_unstable)
                                        : io::Table::Cell(std::string("none")),
        std::isnan(s.energy) ? io::Table::Cell(std::string("-")) : io::Table::Cell(s.energy)};
    for (const time::ModeResponse& r : s.response) {
      row.emplace_back(r.damping);
      row.emplace_back(r.frequency_error);
    }
    table.add(std::move(row));
  }
  return table;
}

io::Table curve_table(const Findings& f) {
  io::Table curves;
  curves.columns = {{"method", "-", ""},
                    {"step", "s", ""},
                    {"step / period of the first mode", "-", ""},
                    {"spectral radius", "-", ""}};
  for (const Scheme& s : f.schemes)
    for (std::size_t k = 0; k < s.radius.x.size(); ++k)
      curves.add({s.name, s.radius.x[k] * two_pi / f.slow, s.radius.x[k], s.radius.y[k]});
  return curves;
}

io::Value json_of(const Findings& f) {
  io::Value json = io::Value::object();
  json["speed [rpm]"] = to_rpm(f.Omega);
  json["unknowns kept"] = static_cast<double>(f.unknowns);
  json["frequencies kept, lowest [Hz]"] = to_hz(f.slow);
  json["frequencies kept, highest [Hz]"] = to_hz(f.fast);
  for (const Scheme& s : f.schemes) {
    io::Value& v = json["schemes"][s.name];
    v["largest spectral radius"] = s.largest_radius;
    v["spectral radius of the longest step"] = s.limit;
    v["stable at every step"] = !std::isfinite(s.first_unstable);
    if (std::isfinite(s.first_unstable)) v["unstable from step [s]"] = s.first_unstable;
    if (!std::isnan(s.energy)) v["energy ratio after many steps"] = s.energy;
    for (std::size_t i = 0; i < s.response.size(); ++i) {
      io::Value& at = v["steps a period"][fmt::format("{:g}", resolutions[i])];
      at["damping ratio added"] = s.response[i].damping;
      at["frequency error"] = s.response[i].frequency_error;
    }
  }
  return json;
}

plot::Series damping_curve(const Scheme& s, double rho, int color) {
  plot::Series damping;
  damping.label = s.radius.label;
  damping.style.color = color;
  for (double n = 400.0; n >= 4.0; n /= 1.1) {
    const double d = time::mode_response(s.name, 1.0, 0.0, two_pi / n, rho).damping;
    if (d > 1e-12) {
      damping.x.push_back(n);
      damping.y.push_back(d);
    }
  }
  return damping;
}

plot::Figure draw(const Findings& f, const std::string& title) {
  plot::Axes above, below;
  above.x = plot::Axis("step / period of the first mode", "-", true);
  above.y = plot::Axis("spectral radius", "-");
  above.rules.push_back({false, 1.0, "energy is kept"});
  below.x = plot::Axis("steps a period of the mode", "-", true);
  below.y = plot::Axis("damping ratio added by the scheme", "-", true);
  above.y.min = 0.0;
  above.y.max = 1.1;
  int color = 0;
  for (const Scheme& s : f.schemes) {
    plot::Series damping = damping_curve(s, f.rho, color);
    if (!damping.x.empty()) below.series.push_back(std::move(damping));
    above.series.push_back(s.radius);
    above.series.back().style.color = color++;
    if (s.largest_radius > 1.05) above.y.max = std::min(3.0, 1.05 * s.largest_radius);
  }
  plot::Figure figure;
  figure.name = "stability";
  figure.title = title + ": stability of the integrators";
  figure.height = 820;
  figure.caption = fmt::format(
      "Above: one step on the undamped rotor at {:.0f} rpm. Below: what a step adds to the damping "
      "ratio of a mode.",
      to_rpm(f.Omega));
  figure.axes = {std::move(above), std::move(below)};
  return figure;
}

void write_findings(const run::Job& job, const Findings& f) {
  const io::Table table = scheme_table(f);
  const io::Value json = json_of(f);
  const plot::Figure figure = draw(f, job.model.title);
  job.folder.write_table("stability.csv", table);
  job.folder.write_table("stability_curves.csv", curve_table(f));
  job.folder.write_json("stability.json", json);
  io::write_atomic(job.folder.path("plots/stability.svg"), plot::render_svg(figure));
  io::ReportSection section;
  section.title = "Stability";
  section.text = fmt::format(
      "The rotor at {:.0f} rpm, linearised, without damping, on its lowest modes from {:.4g} to "
      "{:.4g} Hz. Energy is constant in truth: a spectral radius above 1 "
      "makes energy, one below 1 takes it. Damping ratios added and frequency errors hold for any "
      "undamped mode.",
      to_rpm(f.Omega), to_hz(f.slow), to_hz(f.fast));
  section.figures.push_back(figure);
  section.tables.push_back(table);
  io::Report report;
  report.title = "Stability of the integrators: " +
                 (job.model.title.empty() ? job.model.deck_name : job.model.title);
  report.sections.push_back(std::move(section));
  report.deck = job.model.resolved;
  report.summary = json;
  io::write_report(job.folder.path("stability.html"), report);
}

void print(const Findings& f) {
  std::printf("%.0f rpm, %ld unknowns, modes from %.4g to %.4g Hz, undamped\n\n", to_rpm(f.Omega),
              f.unknowns, to_hz(f.slow), to_hz(f.fast));
  std::printf("%-26s %14s %14s %16s %16s %14s %14s\n", "", "largest radius", "long steps",
              "unstable from", "energy, 1e5", "damping added", "frequency err");
  std::printf("%-26s %14s %14s %16s %16s %14s %14s\n", "", "", "", "s", "steps", "20 a period",
              "20 a period");
  for (const Scheme& s : f.schemes)
    std::printf(
        "%-26s %14.8f %14.3g %16s %16s %14.2e %14.2e\n", label_of(s.name, f.rho).c_str(),
        s.largest_radius, s.limit,
        std::isfinite(s.first_unstable) ? fmt::format("{:.3g}", s.first_unstable).c_str() : "none",
        std::isnan(s.energy) ? "-" : fmt::format("{:.6g}", s.energy).c_str(), s.response[2].damping,
        s.response[2].frequency_error);
}

}  // namespace

int study_stability(const StudyOptions& options) {
  const model::Model model = deck::load_model(options.deck, options.read);
  if (model.steps.empty())
    throw unfit(options, "the deck has no step",
                "a stability study takes the speed from the first step");
  run::RunOptions run = options.run;
  run.quiet = true;
  run::check_memory(model, run);
  run::Job job(model, run, run::prepare_results(model, run));
  const Findings findings = examine_schemes(job, options);
  write_findings(job, findings);
  if (!options.run.quiet) {
    print(findings);
    std::printf("\nresults: %s\n", job.folder.root().string().c_str());
  }
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::study
