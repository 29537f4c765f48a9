// The transient of a study: one ladder of integrators, accuracies, steps and meshes.
#include <analysis/transient/kept_in_time.hpp>
#include <run/job.hpp>
#include <run/results_folder.hpp>
#include <study/study_parts.hpp>
#include <results/channels.hpp>
#include <steps/transient_step.hpp>
#include <study/study.hpp>
#include <core/table.hpp>
#include <io/results.hpp>
#include <system/momentum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>

namespace whirl::study {

namespace {

/// An exact solution given as a table (CSV, or HDF5 as `whirl run` writes it): displacements of probes at instants.
struct Exact {
  std::vector<double> t;
  struct Column {
    std::size_t point;
    int axis;
    std::vector<double> values;
  };  ///< axis 0, 1, 2: x, y, z
  std::vector<Column> columns;
  double next(double after) const {
    const auto i = std::upper_bound(t.begin(), t.end(), after);
    return i == t.end() ? infinity : *i;
  }
};

/// Columns "t [s]" and "PROBE.y [m]" as `whirl run` writes them. Errors: E96.
Exact read_exact(const std::filesystem::path& file,
                 const std::vector<std::pair<std::string, analysis::Point>>& points, double t1) {
  const auto wrong = [&file](const std::string& what, const std::string& hint) {
    return Error(Exit::deck, Diagnostic{Diagnostic::Severity::error, "E96", what, hint,
                                        Where{file.string(), 0, 0, 0, ""}});
  };
  if (!std::filesystem::exists(file))
    throw wrong("there is no file with an exact solution here",
                "give the path of a CSV or HDF5 file");
  const io::Columns c = file.extension() == ".h5" ? io::read_hdf5(file) : io::read_csv(file);
  Exact out;
  for (std::size_t k = 0; k < c.names.size(); ++k) {
    if (c.names[k] == "t" && c.units[k] == "s") {
      out.t = c.values[k];
      continue;
    }
    const std::size_t dot = c.names[k].rfind('.');
    const std::string probe = c.names[k].substr(0, dot),
                      axis = dot == std::string::npos ? "" : c.names[k].substr(dot + 1);
    std::size_t p = 0;
    while (p < points.size() && points[p].first != probe)
      ++p;
    if (p == points.size() || axis.size() != 1 || axis < "x" || axis > "z" || c.units[k] != "m") {
      std::string known;
      for (const auto& [name, point] : points)
        known += fmt::format("{}\"{}.y [m]\"", known.empty() ? "" : ", ", name);
      throw wrong(
          fmt::format("column '{} [{}]' is no displacement of a probe", c.names[k], c.units[k]),
          "columns are \"t [s]\" and displacements of this deck: " + known + ", ..");
    }
    out.columns.push_back({p, axis[0] - 'x', c.values[k]});
  }
  if (out.t.empty() || out.columns.empty())
    throw wrong("no exact solution: a column \"t [s]\" and one of a displacement are needed",
                "as in the histories that `whirl run` writes");
  bool good = out.t.front() > 0.0 && out.t.back() <= t1 * (1.0 + 1e-12);
  for (std::size_t k = 0; k < out.t.size(); ++k) {
    good = good && std::isfinite(out.t[k]) && (k == 0 || out.t[k] > out.t[k - 1]);
    for (const auto& col : out.columns)
      good = good && std::isfinite(col.values[k]);
  }
  if (!good)
    throw wrong(fmt::format("the times must increase, lie in 0 < t <= {:g} s, the length of the "
                            "run, and all cells be numbers",
                            t1),
                "");
  return out;
}

/// Displacements of the watched points, forces of the supports, spin and stored energy at equal
/// intervals; and what an exact solution has.
class Sampler final : public analysis::Observer {
 public:
  Sampler(const run::Job& job, const std::vector<std::pair<std::string, analysis::Point>>& points,
          const Exact* exact, double t0, double t1, int n)
      : job_(job),
        points_(points),
        exact_(exact),
        ticker_(t0, (t1 - t0) / n),
        displacement_(points.size()),
        force_(job.built.support_forces.size()),
        exact_values_(exact ? exact->columns.size() : 0),
        next_exact_(exact ? exact->t.front() : infinity) {
    ticker_.advance();
  }
  void step(analysis::StepAccess& s) override {
    for (; next_exact_ <= s.t1() * (1.0 + 1e-13); next_exact_ = exact_->next(next_exact_)) {
      const analysis::Snapshot& x = s.at(std::min(next_exact_, s.t1()));
      for (std::size_t k = 0; k < exact_values_.size(); ++k)
        exact_values_[k].push_back(analysis::displacement(
            x, points_[exact_->columns[k].point].second)[exact_->columns[k].axis]);
    }
    for (; ticker_.next() <= s.t1() * (1.0 + 1e-13); ticker_.advance()) {
      const analysis::Snapshot& x = s.at(std::min(ticker_.next(), s.t1()));
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec3 u = analysis::displacement(x, points_[i].second);
        displacement_[i].push_back(u.y());
        displacement_[i].push_back(u.z());
      }
      spin_.push_back(x.node(job_.reference()).spin());
      const system::Energy& e = x.energy();
      energy_.push_back(e.kinetic + e.elastic + e.gravity);
      system::Context now;
      now.time = x.t();
      for (std::size_t i = 0; i < force_.size(); ++i) {
        const Vec3 f = job_.built.support_forces[i].force(
            [&x](Index n) -> const system::NodeState& { return x.node(n); }, now,
            [&x](Index k) { return x.reactions()[k]; });
        force_[i].push_back(f.y());
        force_[i].push_back(f.z());
      }
    }
  }
  const std::vector<double>& displacement(std::size_t i) const { return displacement_[i]; }
  const std::vector<std::vector<double>>& forces() const { return force_; }
  const std::vector<double>& spin() const { return spin_; }
  const std::vector<double>& energy() const { return energy_; }
  const std::vector<double>& exact(std::size_t k) const { return exact_values_[k]; }

 private:
  const run::Job& job_;
  const std::vector<std::pair<std::string, analysis::Point>>& points_;
  const Exact* exact_;
  analysis::Ticker ticker_;
  std::vector<std::vector<double>> displacement_, force_, exact_values_;
  std::vector<double> spin_, energy_;
  double next_exact_;
};

/// Everything one mesh needs, made once.
struct Bench {
  model::Model model;
  run::Job job;
  const model::Step& step;
  const model::TransientStep& law;
  run::StepState start;
  Bench(model::Model m, const run::RunOptions& options, const std::filesystem::path& root,
        std::size_t which)
      : model(std::move(m)),
        job(model, options, root),
        step(model.steps[which]),
        law(std::get<model::TransientStep>(model.steps[which].law)) {
    job.build_for(step);
    start = steps::transient_start(job, step, law);
  }
  /// exact: its columns come last among the quantities. share: of the duration.
  analysis::StudySample run(const analysis::StudyCase& c, const Exact* exact,
                            double share = 1.0) const {
    const std::unique_ptr<system::SystemProblem> equations =
        steps::transient_problem(job, law, start);
    system::SystemProblem& problem = *equations;
    analysis::TransientOptions o = steps::transient_options(job, law, start.state.t);
    o.method = c.method;
    o.integrator.tolerance =
        c.tolerance > 0 ? c.tolerance : 1e-8;  // fixed steps: Newton well below the step's error
    o.integrator.dt_fixed = c.dt;
    o.integrator.t_end = start.state.t + share * law.duration;
    const auto points = results::watched_points(job);
    Sampler sampler(job, points, exact, start.state.t, o.integrator.t_end, 200);
    analysis::PeakTracker peaks(points, job.reference());
    std::vector<analysis::Observer*> observers{&sampler, &peaks};
    std::optional<analysis::KeptInTime> temperatures;
    if (!law.linear && analysis::KeptInTime::any(job.system())) {
      temperatures.emplace(job.system(), start.state.t, law.duration, c.dt, nullptr);
      observers.push_back(&*temperatures);
      o.between_steps = [&temperatures](double t, system::Frames& f) { temperatures->apply(t, f); };
      if (c.dt == 0.0) o.integrator.dt_max = std::min(o.integrator.dt_max, temperatures->every());
    }
    analysis::StudySample s;
    s.setting = c;
    try {
      const analysis::TransientResult r =
          analysis::run_transient(problem, start.state, o, observers);
      s.ok = r.reason == analysis::StopReason::end_time;
      if (!s.ok) s.note = fmt::format("{} {}", to_string(r.reason), r.detail);
      s.seconds = r.seconds;
      s.steps = r.statistics.accepted;
      s.newton = r.statistics.newton_iterations;
      s.factorizations = r.statistics.factorizations_real + r.statistics.factorizations_complex;
      for (std::size_t i = 0; i < points.size(); ++i) {
        s.quantities.push_back(
            {points[i].first + ": displacement", "m", sampler.displacement(i), 0.0});
        s.quantities.push_back(
            {points[i].first + ": peak", "m", {peaks.peaks()[i].amplitude}, 0.0});
        s.quantities.push_back(
            {points[i].first + ": speed at peak", "rad/s", {peaks.peaks()[i].speed}, 0.0, false});
      }
      for (std::size_t i = 0; i < sampler.forces().size(); ++i)
        s.quantities.push_back({"bearing " + job.built.support_forces[i].name + ": force", "N",
                                sampler.forces()[i], 0.0});
      s.quantities.push_back({"spin", "rad/s", sampler.spin(), 0.0});
      s.quantities.push_back({"stored energy", "J", sampler.energy(), 0.0});
      const Index n = job.reference();
      problem.frames = r.end.frames;
      analysis::Snapshot end(problem);
      end.set(r.end.t, r.end.q, r.end.v, r.end.a);
      s.quantities.push_back({"end angle", "rad", {end.total_phi(n)}, 0.0});
      for (std::size_t k = 0; exact && k < exact->columns.size(); ++k)
        s.quantities.push_back(
            {fmt::format("{}.{} against the exact solution", points[exact->columns[k].point].first,
                         "xyz"[exact->columns[k].axis]),
             "m", sampler.exact(k), 0.0});
    } catch (const Error& e) {
      s.ok = false;
      s.note = e.what();
    }
    return s;
  }
};

/// Benches of one deck, by mesh factor, made when first asked for.
class Benches {
 public:
  Benches(const model::Model& model, std::size_t which, const run::RunOptions& run,
          const std::filesystem::path& root)
      : model_(model),
        which_(which),
        run_(run),
        root_(root) {}
  const Bench& at(int factor) {
    const std::lock_guard lock(mutex_);
    return make(factor);
  }

 private:
  const Bench& make(int factor) {
    auto& b = known_[factor];
    if (!b && factor == 1) b = std::make_unique<Bench>(model_, run_, root_, which_);
    if (!b)
      b = std::make_unique<Bench>(refined(model_, make(1).job.mesh, factor), run_, root_, which_);
    return *b;
  }

  const model::Model& model_;
  std::size_t which_;
  const run::RunOptions& run_;
  const std::filesystem::path& root_;
  std::mutex mutex_;
  std::map<int, std::unique_ptr<Bench>> known_;
};

/// What a ladder of settings is built on.
struct Ground {
  bool flexible = false, rigid_bodies = false;
  analysis::StudySample probe;  ///< what the default accuracy costs
  double duration = 0;          ///< s
  double tight = 0;             ///< accuracy of the reference
  int finest = 1;               ///< mesh factor of the reference
};

// What the default accuracy costs says how tight a reference may be: one to 1e-10 on four times the
// elements takes a hundred times as long.
Ground survey(Benches& benches) {
  const Bench& bench = benches.at(1);
  Ground g;
  g.flexible = !bench.job.mesh.elements.empty();
  g.rigid_bodies = system::MomentumProblem::obstacle(bench.job.system()).empty();
  g.duration = bench.law.duration;
  g.probe = bench.run({"radau5", 1e-4, 0.0, 1}, nullptr);
  g.tight = g.probe.seconds < 0.2 ? 1e-10 : g.probe.seconds < 2.0 ? 1e-8 : 1e-7;
  g.finest = !g.flexible ? 1 : g.probe.seconds < 0.5 ? 4 : 2;
  return g;
}

/// What starts from rest in a large sag has rounding above the tightest accuracies: found out on a
/// hundredth of the run.
void choose_reference(Benches& benches, Ground& g, analysis::StudyOptions& o) {
  for (;; g.tight *= 10.0) {
    o.reference = {"gauss6", g.tight, 0.0, g.finest};
    o.cross_check = g.rigid_bodies ? analysis::StudyCase{"momentum_rk", 0.1 * g.tight, 0.0, 1}
                                   : analysis::StudyCase{"radau5", 10.0 * g.tight, 0.0, g.finest};
    const auto runs = [&](const analysis::StudyCase& c) {
      return benches.at(c.mesh_factor).run(c, nullptr, 0.01).ok;
    };
    if (g.tight > 5e-8 || (runs(o.reference) && runs(o.cross_check))) return;
  }
}

std::vector<analysis::StudyCase> make_ladder(const Ground& g) {
  std::vector<analysis::StudyCase> ladder;
  for (const char* m : {"radau5", "gauss4", "gauss6"})
    for (double tol : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
      if (tol > 5.0 * g.tight)
        ladder.push_back({m, tol, 0.0, 1});  // nothing as tight as the reference
  for (const char* m : {"generalized_alpha", "ida"})
    for (double tol : {1e-2, 1e-3, 1e-4, 1e-5})
      ladder.push_back({m, tol, 0.0, 1});
  if (g.rigid_bodies)
    for (double tol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9})
      ladder.push_back({"momentum_rk", tol, 0.0, 1});
  // equal steps around the one the default accuracy takes, on the reference's mesh: observed orders
  const double h = g.duration / static_cast<double>(std::max(g.probe.steps, 10L));
  for (const char* m : {"radau5", "gauss4", "gauss6", "generalized_alpha"})
    for (double f : {2.0, 1.0, 0.5, 0.25}) {
      // of second order, it would need a hundred times these steps; on long runs it fights for each
      // of them
      if (g.probe.seconds > 0.2 && std::string_view(m) == "generalized_alpha") continue;
      ladder.push_back({m, 0.0, f * h, g.finest});
    }
  if (g.flexible)
    for (int factor = 2; factor <= g.finest; factor *= 2)
      for (double tol : {1e-2, 1e-3, 1e-4, 1e-5})
        ladder.push_back({"radau5", tol, 0.0, factor});
  return ladder;
}

/// Settings of one series become more and more expensive.
std::string series_of(const analysis::StudyCase& c) {
  return c.method + (c.tolerance > 0 ? "" : " fixed") + (c.mesh_factor > 1 ? " finer" : "");
}

/// Runs the reference, its check and the ladder; each series by one thread at a time.
class Runner {
 public:
  Runner(Benches& benches, const Exact* exact, const analysis::StudyOptions& options)
      : benches_(benches),
        exact_(exact),
        options_(options) {
    for (const analysis::StudyCase& c : options.ladder)
      spent_[series_of(c)] = 0.0;
  }
  analysis::StudySample operator()(const analysis::StudyCase& c) {
    const Bench& bench = benches_.at(c.mesh_factor);
    if (c == options_.reference || c == options_.cross_check) {
      analysis::StudySample s = bench.run(c, exact_);
      if (c == options_.reference && exact_ && s.ok) take_exact(s);
      return s;
    }
    double& spent = spent_.at(series_of(c));
    if (spent > patience) return left_out(c);
    analysis::StudySample s = bench.run(c, exact_);
    spent = std::max(spent, s.seconds);
    return s;
  }

 private:
  /// s: a finer setting than one that took this long would take longer.
  static constexpr double patience = 4.0;

  static analysis::StudySample left_out(const analysis::StudyCase& c) {
    analysis::StudySample s;
    s.setting = c;
    s.ok = false;
    s.note = "left out: the setting before it took long";
    return s;
  }
  /// The exact solution is the reference.
  void take_exact(analysis::StudySample& s) const {
    const std::size_t first = s.quantities.size() - exact_->columns.size();
    for (std::size_t k = 0; k < exact_->columns.size(); ++k)
      s.quantities[first + k].values = exact_->columns[k].values;
  }

  Benches& benches_;
  const Exact* exact_;
  const analysis::StudyOptions& options_;
  std::map<std::string, double> spent_;
};

}  // namespace

StudyPart study_transient(const model::Model& model, std::size_t which, const StudyOptions& options,
                          const run::RunOptions& run, const std::filesystem::path& root) {
  Benches benches(model, which, run, root);
  std::unique_ptr<Exact> exact;
  if (!options.exact.empty())
    exact = std::make_unique<Exact>(read_exact(
        options.exact, results::watched_points(benches.at(1).job), benches.at(1).law.duration));
  Ground ground = survey(benches);
  analysis::StudyOptions o;
  choose_reference(benches, ground, o);
  o.ladder = make_ladder(ground);
  const bool talk = !options.run.quiet;
  if (talk) print_study_head();
  o.progress = [&](const analysis::StudySample& s) {
    if (talk) print_study_sample(s);
  };
  o.series = series_of;
  o.threads = run.jobs;
  Runner runner(benches, exact.get(), o);
  const analysis::StudyResult r =
      analysis::run_study([&](const analysis::StudyCase& c) { return runner(c); }, o);

  StudyText text;
  text.stem = "study";
  text.heading = "Error against run time";
  text.title = fmt::format("{}: error against run time",
                           model.title.empty() ? model.deck_name : model.title);
  text.reference = fmt::format("{}{}, checked by {}", o.reference.label(),
                               exact ? " and the exact solution given" : "", o.cross_check.label());
  text.target = benches.at(1).law.integrator.tolerance;
  return write_study(root, r, text, talk);
}

}  // namespace whirl::study
