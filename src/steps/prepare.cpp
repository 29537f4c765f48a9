#include <analysis/transient/momentum_route.hpp>
#include <analysis/spectra/rotating_axes.hpp>
#include <analysis/statics/buckling.hpp>
#include <analysis/steady_rotation.hpp>
#include <core/plugin.hpp>
#include <run/checkpoint.hpp>
#include <results/frequency.hpp>
#include <steps/api_models.hpp>
#include <steps/prepare.hpp>
#include <run/results_folder.hpp>
#include <steps/stability_map.hpp>
#include <steps/step_kinds.hpp>
#include <assembly/build_system.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace whirl::steps {

namespace {

/// Finds what stands against a run step by step; systems that steps share are put together once.
class Obstacles {
 public:
  Obstacles(const model::Model& model, const meshes::Mesh& mesh, const run::RunOptions& options)
      : model_(model),
        mesh_(mesh),
        options_(options) {}

  void find() {
    look_at_steps();
    if (!found_.empty()) throw Error(exit_, std::move(found_));
  }

 private:
  void look_at_steps() {
    if (note({}, [&] { run::check_folder(model_, options_); }))
      note({}, [&] { run::check_space(model_, options_); });
    // the system without drives of any step is put together in any case: what is wrong with the
    // model itself
    if (!note({}, [&] { system_of({}); })) return;
    for (const model::Step& step : model_.steps) {
      note(step.where, [&] { check_plugins(step); });
      if (!note(step.where, [&] { system_of(step.name); })) continue;
      note(step.where, [&] { check_turning(step); });
      if (const auto* t = std::get_if<model::TransientStep>(&step.law))
        note(step.where, [&] { check_transient(step, *t); });
      if (const auto* b = std::get_if<model::BucklingStep>(&step.law))
        note(step.where, [&] { check_buckling(step, *b); });
      if (const auto* a = std::get_if<model::ApiLateralStep>(&step.law))
        note(step.where, [&] { check_report(step, *a); });
      if (const auto* b = std::get_if<model::BalancingStep>(&step.law))
        note(step.where, [&] { check_balancing(model_, step, *b); });
      if (const auto* s = std::get_if<model::StabilityStep>(&step.law); s) {
        note(step.where, [&] { check_axes(step); });
        if (s->map) note(step.where, [&] { check_map(step, *s->map); });
      }
    }
  }

  /// Whether `look` found nothing; what it throws is noted, at the place of the step when it has
  /// none.
  template <class Look>
  bool note(const Where& step, Look look) {
    try {
      look();
      return true;
    } catch (const Error& e) {
      if (found_.empty()) exit_ = e.exit();
      for (Diagnostic d : e.diagnostics()) {
        if (d.where.line == 0 && step.line != 0) {
          const std::string entity = d.where.entity;
          d.where = step;
          if (!entity.empty()) d.where.entity = entity;
        }
        if (d.where.file.empty()) d.where.file = model_.deck_path;
        found_.push_back(std::move(d));
      }
      return false;
    }
  }

  const assembly::Built& system_of(const std::string& step) {
    std::string key = "(model)";
    for (const model::Step& s : model_.steps)
      if (s.name == step) key = assembly::system_key(model_, s);
    const auto made = built_.find(key);
    if (made != built_.end()) return made->second;
    return built_.emplace(key, assembly::build_system(model_, mesh_, step)).first->second;
  }

  /// E90: what the outputs of the step need is installed.
  void check_plugins(const model::Step& step) const {
    const bool in_time = std::holds_alternative<model::TransientStep>(step.law);
    const bool has_frames = !std::holds_alternative<model::CampbellStep>(step.law) &&
                            !std::holds_alternative<model::CriticalMapStep>(step.law);
    for (const model::VtkOutput& o : model_.output.vtk)
      if (has_frames && (o.step.empty() || o.step == step.name))
        Plugin::require(o.one_file ? "hdf5" : "vtk");
    if (in_time && model_.output.binary) Plugin::require("hdf5");
  }

  /// E88: a rotor whose stiffness turns with it has axes in which it is simple.
  void check_axes(const model::Step& step) {
    if (!results::turns_with_stiffness(model_)) return;
    analysis::SteadyRotation running;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      running.ratio.push_back(model_.shafts[l].rotating ? model_.shafts[l].speed_ratio : 0.0);
    const assembly::Built& built = system_of(step.name);
    running.ratio.resize(static_cast<std::size_t>(built.system.lines()), 0.0);
    running.axially_free = built.axially_free;
    analysis::RotatingAxes::require(analysis::SteadySystem(built.system, running));
  }

  /// E78: what shall turn can.
  void check_turning(const model::Step& step) {
    const assembly::Built& built = system_of(step.name);
    std::optional<double> own;
    if (const auto* s = std::get_if<model::StaticStep>(&step.law))
      own = s->speeds ? std::optional(results::speeds_of(*s->speeds).back()) : s->own_speed();
    else if (const auto* t = std::get_if<model::TransientStep>(&step.law))
      own = t->own_speed();
    else
      own = top_speed(step.law);
    if (!own && !step.from.empty()) return;  // that of the step it starts from
    analysis::SteadyRotation running;
    double reference = 0.0;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      const assembly::LineSpin& law = built.spins[l];
      const double given = law.prescribed ? law.angle->at(0.0).df : law.spin0;
      const double spin = !model_.shafts[l].rotating ? 0.0
                          : own                      ? *own * model_.shafts[l].speed_ratio
                                                     : given;
      running.ratio.push_back(spin);
      if (reference == 0.0) reference = spin;
    }
    if (reference == 0.0) return;
    for (double& r : running.ratio)
      r /= reference;
    running.ratio.resize(static_cast<std::size_t>(built.system.lines()), 0.0);
    // a motion in time that starts at rest may well have a brake on
    if (const auto* t = std::get_if<model::TransientStep>(&step.law);
        t && t->start == model::TransientStep::Start::rest && !t->linear)
      return;
    const analysis::SteadySystem turning(built.system, running);
    VecX v(built.system.size());
    turning.set_rates(reference, v);
  }

  /// E79: something can make it buckle. What else is wrong the run will say.
  void check_buckling(const model::Step& step, const model::BucklingStep& law) {
    const assembly::Built& built = system_of(step.name);
    analysis::SteadyRotation rotation;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      rotation.ratio.push_back(model_.shafts[l].rotating ? model_.shafts[l].speed_ratio : 0.0);
    rotation.ratio.resize(static_cast<std::size_t>(built.system.lines()), 0.0);
    rotation.axially_free = built.axially_free;
    analysis::SteadySystem running(built.system, rotation);
    try {
      analysis::require_loads(running, law.speed);
    } catch (const Error& e) {
      if (e.diagnostics().front().code == "E79") throw;
    }
  }

  static std::optional<double> top_speed(const model::StepLaw& law) {
    return std::visit(
        [](const auto& s) -> std::optional<double> {
          using T = std::decay_t<decltype(s)>;
          if constexpr (std::is_same_v<T, model::HarmonicStep>)
            return s.speeds ? results::speeds_of(*s.speeds).back() : s.speed;
          else if constexpr (requires { s.max_speed; })
            return s.max_speed;
          else if constexpr (requires { s.speed.points; })
            return results::speeds_of(s.speed).back();
          else if constexpr (std::is_same_v<T, model::ModalStep> ||
                             std::is_same_v<T, model::SensitivityStep> ||
                             std::is_same_v<T, model::BucklingStep>)
            return s.speed;
          else
            return std::nullopt;
        },
        law);
  }

  /// E76: a mode to start in that no model of so many unknowns has: each gives one at most.
  static void check_mode(const model::TransientStep& law, const system::System& built) {
    if (law.start != model::TransientStep::Start::mode) return;
    const auto active = built.active();
    const auto unknowns =
        std::count_if(active.begin(), active.end(), [](auto a) { return a != 0; });
    if (law.mode > unknowns)
      throw run_error("E76",
                      fmt::format("the rotor has {} modes at most, one for each unknown, not {}",
                                  unknowns, law.mode),
                      "choose a lower number");
  }

  /// E74, N10, N11: the integrator can be made. E91, E94: the state it goes on from is there and
  /// fits.
  void check_transient(const model::Step& step, const model::TransientStep& law) {
    const assembly::Built& built = system_of(step.name);
    if (!law.previous.empty()) {
      const run::Checkpoint c = run::last_state_of(law.previous, law.previous_step);
      run::check_state_fits(c, law.previous, built.system, model_.deck_path);
    }
    check_mode(law, built.system);
    system::SystemProblem problem(built.system, {la::SolverKind::automatic, model_.chart_change});
    time::Options o;
    o.t_end = law.duration;
    o.tolerance = law.integrator.tolerance;
    o.dt_fixed = law.integrator.dt;
    if (law.integrator.method == "momentum_rk")
      analysis::make_momentum_integrator(problem, o);
    else
      time::make_integrator(law.integrator.method, problem, o);
  }

  /// E70, and what is wrong with the deck with one of its sets of bearings.
  void check_report(const model::Step& step, const model::ApiLateralStep& law) {
    if (results::turns_with_stiffness(model_))
      throw run_error("E88",
                      fmt::format("step '{}': a report looks at round, sound shafts, whose "
                                  "matrices are constant in fixed axes",
                                  step.name),
                      "a stability step finds the bands of an asymmetric one", step.name);
    for (const ApiMachine& a : api_machines(model_, options_, step, law)) {
      model::Model m = a.model;
      const auto add = [&](const std::string& name, const model::Location& at) {
        model::Probe p;
        p.name = name;
        p.at = at;
        m.probes.push_back(std::move(p));
      };
      for (const model::ApiClearance& c : law.clearances)
        add(c.name, c.at);
      for (const model::ApiStage& s : law.stages)
        if (s.at) add(s.name, *s.at);
      if (law.cross_coupling_at) add("cross-coupling", *law.cross_coupling_at);
      assembly::build_system(m, meshes::make_mesh(m), step.name);
    }
  }

  /// E89, and what is wrong with the deck at another value of the parameter.
  void check_map(const model::Step& step, const model::StabilityMap& map) {
    if (results::is_judged_in_turning_axes(model_)) throw no_map_of_bands(step);
    if (!options_.variant) return;
    for (const std::string& value : map.values) {
      const model::Model m = variant_of(options_, step, map, value);
      assembly::build_system(m, meshes::make_mesh(m), step.name);
    }
  }

  const model::Model& model_;
  const meshes::Mesh& mesh_;
  const run::RunOptions& options_;
  std::map<std::string, assembly::Built> built_;
  std::vector<Diagnostic> found_;
  Exit exit_ = Exit::ok;
};

}  // namespace

void check_steps(const model::Model& model, const meshes::Mesh& mesh,
                 const run::RunOptions& options) {
  Obstacles(model, mesh, options).find();
}

}  // namespace whirl::steps
