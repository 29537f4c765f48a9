#include <run/job.hpp>
#include <assembly/tied_lines.hpp>
#include <run/progress.hpp>
#include <run/support_diagnosis.hpp>

#include <analysis/statics/equilibrium.hpp>
#include <core/rotation.hpp>
#include <model/support_traits.hpp>
#include <system/joint_start.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <optional>
#include <unistd.h>

namespace whirl::run {

Job::Job(const model::Model& m, const RunOptions& o, const std::filesystem::path& root)
    : model(m),
      options(o),
      mesh(meshes::make_mesh(m)),
      scene(meshes::make_scene(m, mesh)),
      folder(root) {
  if (!options.only_files.empty()) folder.write_only(options.only_files);
  folder.protect(options.inputs);
  folder.show_tables_to(options.seen_table);
}

Job::Job(const model::Model& m, const Job& parent, const RunOptions& o)
    : model(m),
      options(o),
      mesh(meshes::make_mesh(m)),
      scene(meshes::make_scene(m, mesh)),
      folder(parent.folder) {}

void Job::hand_over(Job& parent, io::Value& steps) {
  // first: what follows may move the value that `steps` is
  if (summary.at("steps").is_object())
    for (const auto& [name, of_step] : summary.at("steps").members())
      steps[name] = of_step;
  for (io::ReportSection& s : report.sections)
    parent.report.sections.push_back(std::move(s));
  for (std::string& w : report.warnings)
    parent.report.warnings.push_back(std::move(w));
  if (summary.at("warnings").is_array())
    for (const io::Value& w : summary.at("warnings").items())
      parent.summary["warnings"].push(w);
  for (auto& phase : phases)
    parent.phases.push_back(std::move(phase));
  for (std::string& u : uncertified)
    parent.uncertified.push_back(std::move(u));
}

void Job::build_for(const model::Step& step) {
  const std::string key = assembly::system_key(model, step);
  if (!built_for.empty() && key_ == key) return;
  const PhaseTimer timer(*this, "assembly");
  built = assembly::build_system(model, mesh, step.name);
  built_for = step.name;
  key_ = key;
}

double Job::reference_ratio() const {
  const model::Shaft& shaft = model.shafts[at(mesh.nodes[at(reference())].line)];
  return shaft.speed_ratio != 0.0 ? shaft.speed_ratio : 1.0;
}

bool Job::goes_on_in_motion(const model::Step& step) const {
  return std::any_of(model.steps.begin(), model.steps.end(), [&](const model::Step& s) {
    return s.name == step.from && std::holds_alternative<model::TransientStep>(s.law);
  });
}

double Job::angle_of_drive(const system::State& s, std::size_t line) const {
  for (const auto& h : system().holds()) {
    const Index node = h.unknown / 6;
    if (h.law && h.unknown % 6 == system::spin_phi &&
        system().node(node).line == static_cast<Index>(line))
      return s.total_phi(node, static_cast<Index>(line));
  }
  return 0.0;
}

StepState Job::start_of(const model::Step& step, std::optional<double> speed) const {
  const bool in_time = std::holds_alternative<model::TransientStep>(step.law);
  if (!step.from.empty()) {
    StepState s = states.at(step.from);
    const bool in_motion = goes_on_in_motion(step);
    if (speed) s.speed = *speed;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      const meshes::Line& line = mesh.lines[l];
      const assembly::LineSpin& law = built.spins[l];
      // an equilibrium has its lines at angle zero, or where a drive of its step has them; another may begin
      // elsewhere
      const double turned = in_time && !in_motion && law.prescribed
                                ? law.angle->at(s.state.t).f - angle_of_drive(s.state, l)
                                : 0.0;
      for (Index n = line.first_node; n < line.first_node + line.nodes; ++n) {
        s.state.q[6 * n + system::spin_phi] += turned;
        if (speed)
          s.state.v[6 * n + system::spin_phi] =
              model.shafts[l].rotating ? *speed * model.shafts[l].speed_ratio : 0.0;
      }
    }
    return s;
  }
  StepState s{system().make_state(), 0.0, {}};
  system::State& x = s.state;
  double reference_spin = 0.0, some_spin = 0.0;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const meshes::Line& line = mesh.lines[l];
    const model::Shaft& shaft = model.shafts[l];
    const assembly::LineSpin& law = built.spins[l];
    const LawValue drive = law.prescribed ? law.angle->at(0.0) : LawValue{0.0, law.spin0, 0.0};
    const double phi = drive.f;
    const bool follows_drive = law.prescribed && in_time;
    double spin = speed && !follows_drive ? *speed * shaft.speed_ratio : drive.df;
    if (!shaft.rotating) spin = 0.0;
    if (static_cast<Index>(l) == mesh.nodes[static_cast<std::size_t>(built.reference)].line)
      reference_spin = spin;
    if (some_spin == 0.0) some_spin = spin;
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n) {
      x.q[6 * n + system::spin_phi] = phi;
      x.v[6 * n + system::spin_phi] = spin;
    }
  }
  // a reference that stands still while another line turns cannot measure the speeds
  s.speed = speed ? *speed : reference_spin != 0.0 ? reference_spin : some_spin;
  for (const model::InitialMotion& i : model.initial) {
    const double own = x.v[6 * mesh.lines[i.shaft].first_node + system::spin_phi];
    if (in_time && own != 0.0 && i.omega.x() != 0.0) {
      Diagnostic d;
      d.code = "E26";
      d.message = fmt::format(
          "the spin of shaft '{}' is given twice: {:.6g} rpm by its drive or the step, {:.6g} "
          "rad/s "
          "about x in the initial motion '{}'",
          model.shafts[i.shaft].name, to_rpm(own), i.omega.x(), i.name);
      d.hint = "leave out one of them";
      d.where = i.where;
      throw Error(Exit::deck, std::move(d));
    }
    const meshes::Line& line = mesh.lines[i.shaft];
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n) {
      const Mat3& chart = x.frames.chart[i.shaft];
      const Vec3 arm = mesh.nodes[static_cast<std::size_t>(n)].position - i.about;
      const Mat3 R = rotation::L(chart * Vec3(0, i.gamma[0], i.gamma[1]));
      x.q.segment<3>(6 * n) += i.displacement + (R - Mat3::Identity()) * arm;
      x.q.segment<2>(6 * n + 4) = i.gamma;
      // the line's own spin is about the tilted axis; it stays where omega has none
      const Vec3 omega = i.omega + x.v[6 * n + system::spin_phi] * R * chart.col(0);
      const rotation::ChartRates r = rotation::rates_of_omega(i.gamma, chart.transpose() * omega);
      x.v[6 * n + system::spin_phi] = r.phi;
      x.v.segment<2>(6 * n + 4) = r.gamma;
      x.v.segment<3>(6 * n) += i.velocity + i.omega.cross(R * arm);
    }
  }
  if (const std::string wrong = system::fit_joints(system(), x); !wrong.empty())
    throw run_error("E40", wrong + ": the lines it holds would come apart at the start",
                    "speeds, angles and initial motions of the two lines must be such as the "
                    "joint allows");
  return s;
}

std::vector<double> Job::mean_spins(const StepState& start) const {
  std::vector<double> spin;
  for (const meshes::Line& line : mesh.lines)
    spin.push_back(start.state.v[6 * line.first_node + system::spin_phi]);
  // What meshes turns in proportion; the rest of what it does at a moment is vibration of twist.
  const std::vector<std::size_t> tied = assembly::tied_lines(model);
  const auto of_reference = static_cast<std::size_t>(mesh.nodes[at(reference())].line);
  for (std::size_t group = 0; group < tied.size(); ++group) {
    double along = 0.0, size = 0.0;
    Index members = 0;
    for (std::size_t l = group; l < tied.size(); ++l) {
      if (tied[l] != group) continue;
      const double ratio = model.shafts[l].speed_ratio;
      // the reference is what speeds are measured by
      const double weight = l == of_reference ? 1e12 : 1.0;
      along += weight * ratio * spin[l];
      size += weight * ratio * ratio;
      ++members;
    }
    if (members < 2 || size == 0.0) continue;
    for (std::size_t l = group; l < tied.size(); ++l)
      if (tied[l] == group) spin[l] = along / size * model.shafts[l].speed_ratio;
  }
  return spin;
}

std::vector<time::TwistGroup> Job::twisting_shafts() const {
  const std::vector<std::size_t> tied = assembly::tied_lines(model);
  std::vector<time::TwistGroup> groups(tied.size());
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const bool alone = std::count(tied.begin(), tied.end(), tied[l]) == 1;
    const double ratio =
        alone ? 1.0 : model.shafts[l].speed_ratio / model.shafts[tied[l]].speed_ratio;
    if (!std::isfinite(ratio) || ratio == 0.0) continue;
    const meshes::Line& line = mesh.lines[l];
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n) {
      groups[tied[l]].unknowns.push_back(6 * n + system::spin_phi);
      groups[tied[l]].ratios.push_back(ratio);
    }
  }
  std::erase_if(groups, [](const time::TwistGroup& g) { return g.unknowns.size() < 2; });
  return groups;
}

analysis::SteadyRotation Job::steady_rotation_of(const StepState& start) const {
  analysis::SteadyRotation running;
  const std::vector<double> spins = mean_spins(start);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    // at rest too a rotor that nothing holds is free to turn
    running.ratio.push_back(start.speed != 0.0         ? spins[l] / start.speed
                            : model.shafts[l].rotating ? model.shafts[l].speed_ratio
                                                       : 0.0);
  }
  running.ratio.resize(static_cast<std::size_t>(system().lines()), 0.0);
  running.axially_free = built.axially_free;
  running.mean = start.speed != 0.0;  // at rest every part stands where it stands: no mean over a
                                      // revolution that nobody makes
  return running;
}

analysis::Equilibrium Job::settle(StepState& start, analysis::EquilibriumOptions asked,
                                  bool in_time) const {
  analysis::SteadyRotation running = steady_rotation_of(start);
  running.hysteretic = !in_time;
  analysis::SteadySystem turning(system(), running);
  asked.chart_change = model.chart_change;
  analysis::EquilibriumSolver solver(turning, asked);
  analysis::Equilibrium found;
  try {
    found = solver.solve(start.speed, &start.state);
  } catch (const Error& e) {
    throw explain_no_equilibrium(*this, turning, start, e);
  }
  const VecX begun = start.state.q;
  start.state = found.state;
  start.state.a.setZero();
  // an equilibrium that turns has its lines at angle zero, one at rest those of drives at theirs
  if (!in_time) return found;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    if (!running.mean && built.spins[l].prescribed) continue;
    const meshes::Line& line = mesh.lines[l];
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n)
      start.state.q[6 * n + system::spin_phi] += begun[6 * line.first_node + system::spin_phi];
  }
  return found;
}

}  // namespace whirl::run
