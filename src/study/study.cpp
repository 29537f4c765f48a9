// `whirl study DECK`: error against run time.
#include <run/job.hpp>
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

StudyPart write_study(const std::filesystem::path& root, const analysis::StudyResult& r,
                      const StudyText& text, bool talk) {
  io::ResultsFolder folder(root);
  io::Table table;
  table.title = text.heading;
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
  for (const std::string& q : r.quantities)
    table.columns.push_back({"error of " + q, "-", "relative to its largest value"});
  io::Value json = io::Value::object();
  std::map<std::string, plot::StudyCurve> curves;
  for (std::size_t k = 0; k < r.samples.size(); ++k) {
    const analysis::StudySample& s = r.samples[k];
    if (!s.ok) continue;
    const double front =
        std::find(r.pareto.begin(), r.pareto.end(), k) != r.pareto.end() ? 1.0 : 0.0;
    std::vector<io::Table::Cell> row{s.setting.method,
                                     s.setting.tolerance,
                                     s.setting.dt,
                                     s.setting.mesh_factor,
                                     s.seconds,
                                     static_cast<double>(s.steps),
                                     static_cast<double>(s.newton),
                                     static_cast<double>(s.factorizations),
                                     front,
                                     s.worst()};
    for (double e : s.errors)
      row.emplace_back(e);
    io::Value sample;
    sample["setting"] = s.setting.label();
    sample["CPU [s]"] = s.seconds;
    sample["Pareto"] = front > 0.0;
    sample["largest error"] = s.worst();
    for (std::size_t i = 0; i < r.quantities.size(); ++i)
      sample["errors"][r.quantities[i]] = s.errors[i];
    json["settings"].push(sample);
    table.add(std::move(row));
    const std::string key = s.setting.method.empty()
                                ? "meshes"
                                : s.setting.method +
                                      (s.setting.tolerance > 0 ? "" : ", equal steps") +
                                      (s.setting.mesh_factor > 1 ? ", finer mesh" : "");
    curves[key].label = key;
    if (s.worst() < 10.0)
      curves[key].points.push_back({s.seconds, std::max(s.worst(), 1e-16), s.setting.label()});
  }
  folder.write_table(text.stem + ".csv", table);
  io::Value& u = json["uncertainty of the reference"];
  for (std::size_t i = 0; i < r.quantities.size(); ++i)
    u[r.quantities[i]] = r.uncertainty[i];
  for (const auto& order : r.orders)
    if (order.order > 0)
      json[order.method.empty() ? "observed order" : "observed order, equal steps"]
          [order.method.empty() ? "meshes" : order.method] = order.order;
  std::string advice_text;
  for (const auto& a : r.advice) {
    const std::string target = fmt::format("{:g}", a.target);
    const std::string best = a.found
                                 ? fmt::format("{}: {:.3g} s", r.samples[a.sample].setting.label(),
                                               r.samples[a.sample].seconds)
                                 : std::string("none of the settings");
    json["advice"][target] = best;
    advice_text += fmt::format("for an error of {} of the largest value use {}\n", target, best);
  }
  folder.write_json(text.stem + ".json", json);
  std::vector<plot::StudyCurve> list;
  for (auto& [name, c] : curves)
    if (!c.points.empty()) {
      std::sort(c.points.begin(), c.points.end(),
                [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
      list.push_back(std::move(c));
    }
  const plot::Figure figure = plot::plot_study(
      text.stem, text.title, list, "largest relative error of all quantities", "-", text.target);
  io::write_atomic(folder.path("plots/" + text.stem + ".svg"), plot::render_svg(figure));
  StudyPart part;
  part.section.title = text.heading;
  part.section.text = advice_text;
  part.section.figures.push_back(figure);
  part.section.tables.push_back(table);
  part.json = json;
  if (talk) {
    std::printf("\nreference: %s; they differ by\n", text.reference.c_str());
    for (std::size_t i = 0; i < r.quantities.size(); ++i)
      if (r.uncertainty[i] > 0.0)
        std::printf("  %-28s %.1e%s\n", r.quantities[i].c_str(), r.uncertainty[i],
                    r.uncertainty[i] > analysis::resolved
                        ? "   not resolved by the model itself: listed, not counted"
                        : "");
    for (const auto& order : r.orders) {
      if (order.order > 0)
        std::printf("observed order, %s: %.2f\n",
                    order.method.empty() ? "meshes" : ("equal steps: " + order.method).c_str(),
                    order.order);
      else
        std::printf("observed order, %s: none, its error is not that of the step\n",
                    order.method.empty() ? "meshes" : ("equal steps: " + order.method).c_str());
    }
    std::fputs(advice_text.c_str(), stdout);
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
