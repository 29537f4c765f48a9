// `whirl study DECK`: error against run time.
#include <run/job.hpp>
#include <run/memory_limit.hpp>
#include <run/results_folder.hpp>
#include <run/options.hpp>
#include <study/study_parts.hpp>
#include <study/study.hpp>
#include <deck/deck.hpp>
#include <plot/plots.hpp>
#include <io/file.hpp>
#include <plot/svg.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace whirl::study {

model::Model refined(const model::Model& m, const meshes::Mesh& mesh, int factor) {
  model::Model r = m;
  for (std::size_t l = 0; l < r.shafts.size(); ++l)
    for (std::size_t s = 0; s < r.shafts[l].sections.size(); ++s) {
      int count = 0;
      for (const meshes::Element& e : mesh.elements)
        count += e.line == static_cast<Index>(l) && e.section == s;
      if (count > 0) r.shafts[l].sections[s].min_elements = count * factor;
    }
  return r;
}

void print_study_head() {
  std::printf("%-34s %10s %9s %9s  %10s\n", "setting", "CPU s", "steps", "Newton", "worst error");
}

void print_study_sample(const analysis::StudySample& s) {
  if (s.ok)
    std::printf("%-34s %10.4f %9ld %9ld  %10.2e\n", s.setting.label().c_str(), s.seconds, s.steps,
                s.newton, s.worst());
  else
    std::printf("%-34s %s\n", s.setting.label().c_str(), s.note.c_str());
  std::fflush(stdout);
}

namespace {

io::Table empty_table(const std::string& title, const std::vector<std::string>& quantities) {
  io::Table table;
  table.title = title;
  table.columns = {{"method", "-", ""},
                   {"tolerance", "-", ""},
                   {"dt", "s", ""},
                   {"mesh factor", "-", ""},
                   {"CPU", "s", ""},
                   {"steps", "-", ""},
                   {"Newton", "-", ""},
                   {"factorisations", "-", ""},
                   {"Pareto", "-", "1: no other setting is both faster and more accurate"},
                   {"largest error", "-", "of the quantities that count"}};
  for (const std::string& q : quantities)
    table.columns.push_back({"error of " + q, "-", "relative to its largest value"});
  return table;
}

bool is_on_front(const analysis::StudyResult& r, std::size_t sample) {
  return std::find(r.pareto.begin(), r.pareto.end(), sample) != r.pareto.end();
}

void add_row(io::Table& table, const analysis::StudySample& s, bool front) {
  std::vector<io::Table::Cell> row{s.setting.method,
                                   s.setting.tolerance,
                                   s.setting.dt,
                                   s.setting.mesh_factor,
                                   s.seconds,
                                   static_cast<double>(s.steps),
                                   static_cast<double>(s.newton),
                                   static_cast<double>(s.factorizations),
                                   front ? 1.0 : 0.0,
                                   s.worst()};
  for (double e : s.errors)
    row.emplace_back(e);
  table.add(std::move(row));
}

io::Value json_of(const analysis::StudySample& s, const std::vector<std::string>& quantities,
                  bool front) {
  io::Value sample;
  sample["setting"] = s.setting.label();
  sample["CPU [s]"] = s.seconds;
  sample["Pareto"] = front;
  sample["largest error"] = s.worst();
  for (std::size_t i = 0; i < quantities.size(); ++i)
    sample["errors"][quantities[i]] = s.errors[i];
  return sample;
}

/// The curve of the figure that a setting belongs to.
std::string curve_name(const analysis::StudyCase& c) {
  if (c.method.empty()) return "meshes";
  return c.method + (c.tolerance > 0 ? "" : ", equal steps") +
         (c.mesh_factor > 1 ? ", finer mesh" : "");
}

plot::Figure draw_study(const analysis::StudyResult& r, const StudyText& text) {
  std::map<std::string, plot::StudyCurve> curves;
  for (const analysis::StudySample& s : r.samples) {
    if (!s.ok) continue;
    plot::StudyCurve& curve = curves[curve_name(s.setting)];
    curve.label = curve_name(s.setting);
    if (s.worst() < 10.0)
      curve.points.push_back({s.seconds, std::max(s.worst(), 1e-16), s.setting.label()});
  }
  std::vector<plot::StudyCurve> list;
  for (auto& [name, c] : curves) {
    if (c.points.empty()) continue;
    std::sort(c.points.begin(), c.points.end(),
              [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    list.push_back(std::move(c));
  }
  return plot::plot_study(text.stem, text.title, list, "largest relative error of all quantities",
                          "-", text.target);
}

/// Uncertainty of the reference and observed orders.
void add_orders(io::Value& json, const analysis::StudyResult& r) {
  io::Value& u = json["uncertainty of the reference"];
  for (std::size_t i = 0; i < r.quantities.size(); ++i)
    u[r.quantities[i]] = r.uncertainty[i];
  for (const auto& order : r.orders) {
    if (!(order.order > 0)) continue;
    const bool meshes = order.method.empty();
    json[meshes ? "observed order" : "observed order, equal steps"]
        [meshes ? "meshes" : order.method] = order.order;
  }
}

/// The advice as text; and into the JSON.
std::string add_advice(io::Value& json, const analysis::StudyResult& r) {
  std::string text;
  for (const auto& a : r.advice) {
    const std::string target = fmt::format("{:g}", a.target);
    std::string best = "none of the settings";
    if (a.found) {
      const analysis::StudySample& s = r.samples[a.sample];
      best = fmt::format("{}: {:.3g} s", s.setting.label(), s.seconds);
    }
    json["advice"][target] = best;
    text += fmt::format("for an error of {} of the largest value use {}\n", target, best);
  }
  return text;
}

void print_orders(const analysis::StudyResult& r, const StudyText& text) {
  std::printf("\nreference: %s; they differ by\n", text.reference.c_str());
  for (std::size_t i = 0; i < r.quantities.size(); ++i)
    if (r.uncertainty[i] > 0.0)
      std::printf("  %-28s %.1e%s\n", r.quantities[i].c_str(), r.uncertainty[i],
                  r.uncertainty[i] > analysis::resolved
                      ? "   not resolved by the model itself: listed, not counted"
                      : "");
  for (const auto& order : r.orders) {
    const std::string of = order.method.empty() ? "meshes" : "equal steps: " + order.method;
    if (order.order > 0)
      std::printf("observed order, %s: %.2f\n", of.c_str(), order.order);
    else
      std::printf("observed order, %s: none, its error is not that of the step\n", of.c_str());
  }
}

}  // namespace

StudyPart write_study(const std::filesystem::path& root, const analysis::StudyResult& r,
                      const StudyText& text, bool talk) {
  io::ResultsFolder folder(root);
  StudyPart part;
  io::Table table = empty_table(text.heading, r.quantities);
  part.json = io::Value::object();
  for (std::size_t k = 0; k < r.samples.size(); ++k) {
    if (!r.samples[k].ok) continue;
    const bool front = is_on_front(r, k);
    add_row(table, r.samples[k], front);
    part.json["settings"].push(json_of(r.samples[k], r.quantities, front));
  }
  add_orders(part.json, r);
  part.section.text = add_advice(part.json, r);
  folder.write_table(text.stem + ".csv", table);
  folder.write_json(text.stem + ".json", part.json);
  const plot::Figure figure = draw_study(r, text);
  io::write_atomic(folder.path("plots/" + text.stem + ".svg"), plot::render_svg(figure));
  part.section.title = text.heading;
  part.section.figures.push_back(figure);
  part.section.tables.push_back(std::move(table));
  if (talk) {
    print_orders(r, text);
    std::fputs(part.section.text.c_str(), stdout);
  }
  return part;
}

int study_deck(const StudyOptions& options) {
  const model::Model model = deck::load_model(options.deck, options.read);
  std::size_t which = 0;
  while (which < model.steps.size() &&
         !(std::holds_alternative<model::TransientStep>(model.steps[which].law) &&
           model.steps[which].from.empty()))
    ++which;
  run::check_memory(model, options.run);
  const bool transient = which < model.steps.size(), meshes = has_mesh_study(model);
  if (!transient && !meshes)
    throw Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E95",
                                       "the deck has neither a transient step that starts by "
                                       "itself nor other steps on a shaft of elements",
                                       "a study compares integrators on the first transient step, "
                                       "and meshes on the steps that are none",
                                       Where{options.deck.string(), 0, 0, 0, ""}});
  if (!transient && !options.exact.empty())
    throw Error(Exit::usage,
                Diagnostic{Diagnostic::Severity::error, "E96",
                           "an exact solution is one of a transient step, and the deck has none "
                           "that starts by itself",
                           "leave out --exact", Where{options.deck.string(), 0, 0, 0, ""}});
  run::RunOptions run = options.run;
  run.quiet = true;
  const auto root = run::prepare_results(model, run);
  io::Report report;
  report.title = "Study: " + (model.title.empty() ? model.deck_name : model.title);
  report.summary = io::Value::object();
  if (transient) {
    StudyPart part = study_transient(model, which, options, run, root);
    report.summary["transient"] = std::move(part.json);
    report.sections.push_back(std::move(part.section));
  }
  if (meshes) {
    StudyPart part = study_meshes(model, options, root);
    report.summary["meshes"] = std::move(part.json);
    report.sections.push_back(std::move(part.section));
  }
  report.deck = model.resolved;
  io::write_report(io::ResultsFolder(root).path("study.html"), report);
  if (!options.run.quiet) std::printf("results: %s\n", root.string().c_str());
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::study
