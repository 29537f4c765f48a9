// `whirl study DECK`: error against run time of the deck's first transient step.
#include <analysis/study.hpp>
#include <app/job.hpp>
#include <app/results_folder.hpp>
#include <app/run.hpp>
#include <deck/deck.hpp>
#include <io/plots.hpp>
#include <io/svg.hpp>
#include <system/momentum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace whirl::app {

namespace {

/// Displacements of the watched points, forces of the supports, spin and stored energy at equal intervals.
class Sampler final : public analysis::Observer {
 public:
  Sampler(const Job& job, const std::vector<std::pair<std::string, analysis::Point>>& points, double t0, double t1, int n)
      : job_(job), points_(points), ticker_(t0, (t1 - t0) / n), displacement_(points.size()), force_(job.built.support_forces.size()) { ticker_.advance(); }
  void step(analysis::StepAccess& s) override {
    for (; ticker_.next() <= s.t1() * (1.0 + 1e-13); ticker_.advance()) {
      const analysis::Snapshot& x = s.at(std::min(ticker_.next(), s.t1()));
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec3 u = analysis::displacement(x, points_[i].second);
        displacement_[i].push_back(u.y()), displacement_[i].push_back(u.z());
      }
      spin_.push_back(x.node(job_.reference()).spin());
      const system::Energy& e = x.energy();
      energy_.push_back(e.kinetic + e.elastic + e.gravity);
      for (std::size_t i = 0; i < force_.size(); ++i) {
        const Vec3 f = job_.built.support_forces[i].force([&x](Index n) -> const system::NodeState& { return x.node(n); }, x.t(), [&x](Index k) { return x.reactions()[k]; });
        force_[i].push_back(f.y()), force_[i].push_back(f.z());
      }
    }
  }
  const std::vector<double>& displacement(std::size_t i) const { return displacement_[i]; }
  const std::vector<std::vector<double>>& forces() const { return force_; }
  const std::vector<double>& spin() const { return spin_; }
  const std::vector<double>& energy() const { return energy_; }

 private:
  const Job& job_;
  const std::vector<std::pair<std::string, analysis::Point>>& points_;
  analysis::Ticker ticker_;
  std::vector<std::vector<double>> displacement_, force_;
  std::vector<double> spin_, energy_;
};

/// The model with every flexible section split into `factor` times as many elements.
model::Model refined(const model::Model& m, const meshes::Mesh& mesh, int factor) {
  model::Model r = m;
  for (std::size_t l = 0; l < r.shafts.size(); ++l)
    for (std::size_t s = 0; s < r.shafts[l].sections.size(); ++s) {
      int count = 0;
      for (const meshes::Element& e : mesh.elements) count += e.line == static_cast<Index>(l) && e.section == s;
      if (count > 0) r.shafts[l].sections[s].min_elements = count * factor;
    }
  return r;
}

/// Everything one mesh needs, made once.
struct Bench {
  model::Model model;
  Job job;
  const model::Step& step;
  const model::TransientStep& law;
  StepState start;
  Bench(model::Model m, const RunOptions& options, const std::filesystem::path& root, std::size_t which)
      : model(std::move(m)), job(model, options, root), step(model.steps[which]),
        law(std::get<model::TransientStep>(model.steps[which].law)) {
    job.build_for(step);
    start = transient_start(job, step, law);
  }
  analysis::StudySample run(const analysis::StudyCase& c) {
    const std::unique_ptr<system::SystemProblem> equations = transient_problem(job, law, start);
    system::SystemProblem& problem = *equations;
    analysis::TransientOptions o = transient_options(job, law, start.state.t);
    o.method = c.method;
    o.integrator.tolerance = c.tolerance > 0 ? c.tolerance : 1e-8;   // fixed steps: Newton well below the step's error
    o.integrator.dt_fixed = c.dt;
    const auto points = watched_points(job);
    Sampler sampler(job, points, start.state.t, o.integrator.t_end, 200);
    analysis::PeakTracker peaks(points, job.reference());
    analysis::StudySample s;
    s.setting = c;
    try {
      const analysis::TransientResult r = analysis::run_transient(problem, start.state, o, {&sampler, &peaks});
      s.ok = r.reason == analysis::StopReason::end_time;
      if (!s.ok) s.note = fmt::format("{} {}", to_string(r.reason), r.detail);
      s.seconds = r.seconds, s.steps = r.statistics.accepted, s.newton = r.statistics.newton_iterations;
      s.factorizations = r.statistics.factorizations_real + r.statistics.factorizations_complex;
      for (std::size_t i = 0; i < points.size(); ++i) {
        s.quantities.push_back({points[i].first + ": displacement", "m", sampler.displacement(i), 0.0});
        s.quantities.push_back({points[i].first + ": peak", "m", {peaks.peaks()[i].amplitude}, 0.0});
        s.quantities.push_back({points[i].first + ": speed at peak", "rad/s", {peaks.peaks()[i].speed}, 0.0, false});
      }
      for (std::size_t i = 0; i < sampler.forces().size(); ++i)
        s.quantities.push_back({"bearing " + job.built.support_forces[i].name + ": force", "N", sampler.forces()[i], 0.0});
      s.quantities.push_back({"spin", "rad/s", sampler.spin(), 0.0});
      s.quantities.push_back({"stored energy", "J", sampler.energy(), 0.0});
      const Index n = job.reference();
      problem.frames = r.end.frames;
      analysis::Snapshot end(problem);
      end.set(r.end.t, r.end.q, r.end.v, r.end.a);
      s.quantities.push_back({"end angle", "rad", {end.total_phi(n)}, 0.0});
    } catch (const Error& e) {
      s.ok = false, s.note = e.what();
    }
    return s;
  }
};

}  // namespace

int study_deck(const StudyOptions& options) {
  const model::Model model = deck::load_model(options.deck, options.read);
  std::size_t which = 0;
  while (which < model.steps.size() && !std::holds_alternative<model::TransientStep>(model.steps[which].law)) ++which;
  if (which == model.steps.size() || !model.steps[which].from.empty())
    throw Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E95", "the deck has no transient step that starts by itself",
                                       "a study compares integrators on the first transient step", Where{options.deck.string(), 0, 0, 0, ""}});
  RunOptions run = options.run;
  run.quiet = true;
  const auto root = prepare_results(model, run);

  std::map<int, std::unique_ptr<Bench>> benches;
  benches[1] = std::make_unique<Bench>(model, run, root, which);
  auto bench = [&](int factor) -> Bench& {
    auto& b = benches[factor];
    if (!b) b = std::make_unique<Bench>(refined(model, benches[1]->job.mesh, factor), run, root, which);
    return *b;
  };
  const bool flexible = !benches[1]->job.mesh.elements.empty();
  const bool rigid_bodies = system::MomentumProblem::obstacle(benches[1]->job.system()).empty();

  analysis::StudyOptions o;
  const int finest = flexible ? 4 : 1;
  o.reference = {"gauss6", 1e-10, 0.0, finest};
  o.cross_check = rigid_bodies ? analysis::StudyCase{"momentum_rk", 1e-11, 0.0, 1} : analysis::StudyCase{"radau5", 1e-9, 0.0, finest};
  for (double tol : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) o.ladder.push_back({"radau5", tol, 0.0, 1});
  for (const char* m : {"gauss4", "gauss6"})
    for (double tol : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) o.ladder.push_back({m, tol, 0.0, 1});
  for (double tol : {1e-2, 1e-3, 1e-4, 1e-5}) o.ladder.push_back({"generalized_alpha", tol, 0.0, 1});
  for (double tol : {1e-2, 1e-3, 1e-4, 1e-5}) o.ladder.push_back({"ida", tol, 0.0, 1});
  if (rigid_bodies)
    for (double tol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) o.ladder.push_back({"momentum_rk", tol, 0.0, 1});
  // equal steps around the one the default accuracy takes, on the reference's mesh: observed orders
  const analysis::StudySample probe = bench(1).run({"radau5", 1e-4, 0.0, 1});
  const double T = std::get<model::TransientStep>(model.steps[which].law).duration;
  const double h = T / static_cast<double>(std::max(probe.steps, 10L));
  for (const char* m : {"radau5", "gauss4", "gauss6", "generalized_alpha"})
    for (double f : {2.0, 1.0, 0.5, 0.25}) o.ladder.push_back({m, 0.0, f * h, finest});
  if (flexible)
    for (int factor : {2, finest})
      for (double tol : {1e-2, 1e-3, 1e-4, 1e-5}) o.ladder.push_back({"radau5", tol, 0.0, factor});

  const bool talk = !options.run.quiet;
  constexpr double patience = 4.0;   // s: a finer setting than one that took this long would take longer
  std::map<std::string, double> spent;
  int runs = 0;                      // the first two are the reference and its check
  if (talk) std::printf("%-34s %10s %9s %9s  %10s\n", "setting", "CPU s", "steps", "Newton", "worst error");
  o.progress = [&](const analysis::StudySample& s) {
    if (!talk) return;
    if (s.ok) std::printf("%-34s %10.4f %9ld %9ld  %10.2e\n", s.setting.label().c_str(), s.seconds, s.steps, s.newton, s.worst());
    else std::printf("%-34s %s\n", s.setting.label().c_str(), s.note.c_str());
    std::fflush(stdout);
  };
  const analysis::StudyResult r = analysis::run_study(
      [&](const analysis::StudyCase& c) {
        const std::string key = c.method + (c.tolerance > 0 ? "" : " fixed") + (c.mesh_factor > 1 ? " finer" : "");
        const bool ladder = runs++ >= 2;
        if (ladder && spent[key] > patience) {
          analysis::StudySample s;
          s.setting = c, s.ok = false, s.note = "left out: the setting before it took long";
          return s;
        }
        analysis::StudySample s = bench(c.mesh_factor).run(c);
        if (ladder) spent[key] = std::max(spent[key], s.seconds);
        return s;
      },
      o);

  // results
  io::ResultsFolder folder(root);
  io::Table table;
  table.title = "Error against run time";
  table.columns = {{"method", "-", ""}, {"tolerance", "-", ""}, {"dt", "s", ""}, {"mesh factor", "-", ""}, {"CPU", "s", ""},
                   {"steps", "-", ""}, {"Newton", "-", ""}, {"factorisations", "-", ""}, {"Pareto", "-", "1: no other setting is both faster and more accurate"},
                   {"largest error", "-", "of the quantities that count"}};
  for (const std::string& q : r.quantities) table.columns.push_back({"error of " + q, "-", "relative to its largest value"});
  io::Value json = io::Value::object();
  std::map<std::string, io::StudyCurve> curves;
  for (std::size_t k = 0; k < r.samples.size(); ++k) {
    const analysis::StudySample& s = r.samples[k];
    if (!s.ok) continue;
    const double front = std::find(r.pareto.begin(), r.pareto.end(), k) != r.pareto.end() ? 1.0 : 0.0;
    std::vector<io::Table::Cell> row{s.setting.method, s.setting.tolerance, s.setting.dt, s.setting.mesh_factor, s.seconds,
                                     static_cast<double>(s.steps), static_cast<double>(s.newton), static_cast<double>(s.factorizations), front, s.worst()};
    for (double e : s.errors) row.emplace_back(e);
    io::Value sample;
    sample["setting"] = s.setting.label(), sample["CPU [s]"] = s.seconds, sample["Pareto"] = front > 0.0, sample["largest error"] = s.worst();
    for (std::size_t i = 0; i < r.quantities.size(); ++i) sample["errors"][r.quantities[i]] = s.errors[i];
    json["settings"].push(sample);
    table.add(std::move(row));
    const std::string key = s.setting.method + (s.setting.tolerance > 0 ? "" : ", equal steps") + (s.setting.mesh_factor > 1 ? ", finer mesh" : "");
    curves[key].label = key;
    if (s.worst() < 10.0) curves[key].points.push_back({s.seconds, std::max(s.worst(), 1e-16), s.setting.label()});
  }
  folder.write_table("study.csv", table);
  io::Value& u = json["uncertainty of the reference"];
  for (std::size_t i = 0; i < r.quantities.size(); ++i) u[r.quantities[i]] = r.uncertainty[i];
  for (const auto& order : r.orders)
    if (order.order > 0) json["observed order, equal steps"][order.method] = order.order;
  std::string advice_text;
  for (const auto& a : r.advice) {
    const std::string target = fmt::format("{:g}", a.target);
    const std::string text = a.found ? fmt::format("{}: {:.3g} s", r.samples[a.sample].setting.label(), r.samples[a.sample].seconds)
                                     : std::string("none of the settings");
    json["advice"][target] = text;
    advice_text += fmt::format("for an error of {} of the largest value use {}\n", target, text);
  }
  folder.write_json("study.json", json);
  std::vector<io::StudyCurve> list;
  for (auto& [name, c] : curves)
    if (!c.points.empty()) {
      std::sort(c.points.begin(), c.points.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
      list.push_back(std::move(c));
    }
  const io::Figure figure = io::plot_study("study", model.title + ": error against run time", list, "largest relative error of all quantities", "-",
                                           bench(1).law.integrator.tolerance);
  io::write_svg(folder.path("plots/study.svg"), figure);
  io::Report report;
  report.title = "Study: " + (model.title.empty() ? model.deck_name : model.title);
  io::ReportSection section;
  section.title = "Error against run time";
  section.text = advice_text;
  section.figures.push_back(figure);
  section.tables.push_back(table);
  report.sections.push_back(std::move(section));
  report.deck = model.resolved;
  report.summary = json;
  io::write_report(folder.path("study.html"), report);
  if (talk) {
    std::printf("\nreference: %s, checked by %s; they differ by\n", o.reference.label().c_str(), o.cross_check.label().c_str());
    for (std::size_t i = 0; i < r.quantities.size(); ++i)
      std::printf("  %-28s %.1e%s\n", r.quantities[i].c_str(), r.uncertainty[i],
                  r.uncertainty[i] > analysis::resolved ? "   not resolved by the model itself: listed, not counted" : "");
    for (const auto& order : r.orders) {
      if (order.order > 0) std::printf("observed order, equal steps: %s %.2f\n", order.method.c_str(), order.order);
      else std::printf("observed order, equal steps: %s none, its error is not that of the step\n", order.method.c_str());
    }
    std::printf("%sresults: %s\n", advice_text.c_str(), root.string().c_str());
  }
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
