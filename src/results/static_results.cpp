#include <results/static_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

void add_magnets(const run::Job& job, const system::Workspace& state, StaticResults& out,
                 io::Value& summary) {
  out.magnets.title = "Magnetic bearings";
  out.magnets.columns = {{"bearing", "-", ""},
                         {"axis", "-", ""},
                         {"displacement", "m", "of the shaft along the axis, at the magnet"},
                         {"control current", "A", ""},
                         {"force", "N", "on the shaft"}};
  const auto node = [&](Index k) -> const system::NodeState& { return state.in_own_axes(k); };
  for (const assembly::MagneticControl& m : job.built.magnetic_controls) {
    const std::string& name = job.model.bearings[m.bearing].name;
    double most = 0, number = 0;
    for (const assembly::MagneticControl::Standing& s : m.standing(node, state.context)) {
      out.magnets.add({name, ++number, s.displacement, s.current, s.force});
      most = std::max(most, std::abs(s.current));
    }
    summary["magnetic bearings"][name]["largest control current [A]"] = most;
  }
}

void add_rolling_loads(const run::Job& job, const system::Workspace& state, StaticResults& out,
                       io::Value& summary) {
  out.rolling.title = "Loads of the rolling elements";
  out.rolling.columns = {{"bearing", "-", ""},
                         {"element", "-", ""},
                         {"angle", "deg", "from +y towards +z"},
                         {"load", "N", ""}};
  const auto node = [&](Index n) -> const system::NodeState& { return state.in_own_axes(n); };
  for (const assembly::RollingLoads& b : job.built.rolling_loads) {
    double most = 0;
    int number = 0, loaded = 0;
    for (const auto& e : b.loads(node)) {
      out.rolling.add({b.name, static_cast<double>(++number), e.angle * 180.0 / pi, e.load});
      most = std::max(most, e.load);
      loaded += e.load > 0 ? 1 : 0;
    }
    summary["rolling elements"][b.name]["largest load [N]"] = most;
    summary["rolling elements"][b.name]["loaded"] = loaded;
  }
}

void push_components(io::Value& list, const Vec3& v) {
  for (const double x : v)
    list.push(x);
}

/// N, and N m: what is below 1e-14 of the largest force is rounding of springs without load.
double rounding_of(const std::vector<PlaceLoad>& loads) {
  double largest_force = 0;
  for (const PlaceLoad& f : loads)
    largest_force = std::max(largest_force, f.force.norm());
  return 1e-14 * largest_force;
}

void add_supports(const run::Job& job, const std::vector<PlaceLoad>& loads, StaticResults& out,
                  io::Value& summary) {
  out.supports.title = "Supports: force and moment on the shaft";
  out.supports.columns = {{"support", "-", ""},
                          {"F_x", "N", ""},
                          {"F_y", "N", ""},
                          {"F_z", "N", ""},
                          {"M_x", "N m", "about the place of the support"},
                          {"M_y", "N m", ""},
                          {"M_z", "N m", ""}};
  const double rounding = rounding_of(loads);
  const auto clean = [&](Vec3 v) { return Vec3((v.array().abs() < rounding).select(0.0, v)); };
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string& name = job.built.support_forces[i].name;
    const Vec3 v = clean(loads[i].force), m = clean(loads[i].moment);
    out.supports.add({name, v.x(), v.y(), v.z(), m.x(), m.y(), m.z()});
    push_components(summary["support forces [N]"][name], v);
    std::string line =
        fmt::format("support '{}': {:.5g}, {:.5g}, {:.5g} N", name, v.x(), v.y(), v.z());
    if (!m.isZero(0.0)) {
      push_components(summary["support moments [N m]"][name], m);
      line += fmt::format("; {:.5g}, {:.5g}, {:.5g} N m", m.x(), m.y(), m.z());
    }
    out.lines.push_back(std::move(line));
  }
}

void add_joints(const run::Job& job, const system::Workspace& state,
                const std::vector<PlaceLoad>& loads, StaticResults& out, io::Value& summary) {
  out.joints.title = "Joints: force and moment on the line of 'at', about that place";
  out.joints.columns = {{"joint", "-", ""},
                        {"F_x", "N", ""},
                        {"F_y", "N", ""},
                        {"F_z", "N", ""},
                        {"M_x", "N m", ""},
                        {"M_y", "N m", ""},
                        {"M_z", "N m", ""},
                        {"angle", "rad", "of the line of 'at' against the other"},
                        {"second angle", "rad", "of a universal joint"},
                        {"slide", "m", ""}};
  const auto coordinate = [&](Index n) { return state.nodes[at(n)].u[0]; };
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const assembly::JointResult& j = job.built.joints[i];
    const Vec3 &F = loads[i].force, &M = loads[i].moment;
    const auto angle = [&](std::size_t k) {
      return k < j.angles.size() ? coordinate(j.angles[k]) : 0.0;
    };
    out.joints.add({j.name, F.x(), F.y(), F.z(), M.x(), M.y(), M.z(), angle(0), angle(1),
                    j.slide >= 0 ? coordinate(j.slide) : 0.0});
    push_components(summary["joint forces [N]"][j.name], F);
    std::string line =
        fmt::format("joint '{}': {:.5g}, {:.5g}, {:.5g} N", j.name, F.x(), F.y(), F.z());
    if (j.moment) line += fmt::format("; {:.5g}, {:.5g}, {:.5g} N m", M.x(), M.y(), M.z());
    out.lines.push_back(std::move(line));
  }
}

/// Torques of what keeps the speed of shafts that nothing else holds.
void add_spin_holds(const run::Job& job, std::span<const Index> spin_holds, const VecX& reactions,
                    double rounding, StaticResults& out, io::Value& summary) {
  for (const Index k : spin_holds) {
    const std::string& line = job.system().line_name(job.system().node(k / 6).line);
    const double torque = std::abs(reactions[k]) < rounding ? 0.0 : reactions[k];
    summary["torque that keeps the speed [N m]"][line] = torque;
    if (torque != 0)
      out.lines.push_back(
          fmt::format("shaft '{}': torque that keeps its speed {:.5g} N m", line, torque));
  }
}

}  // namespace

StaticResults make_static_results(run::Job& job, const std::string& step,
                                  system::SystemProblem& problem, const MeanLoads& loads,
                                  const VecX& reactions, std::span<const Index> spin_holds,
                                  io::Value& summary) {
  StaticResults out;
  const system::Workspace& state = problem.workspace();
  add_deflection(job, step, state, loads, out, summary);
  add_rolling_loads(job, state, out, summary);
  add_magnets(job, state, out, summary);
  add_supports(job, loads.supports, out, summary);
  add_joints(job, state, loads.joints, out, summary);
  add_spin_holds(job, spin_holds, reactions, rounding_of(loads.supports), out, summary);
  summary["elastic energy [J]"] = loads.elastic_energy;
  out.points =
      assembly::calc_section_results(job.model, job.mesh, job.built, state, loads.elements);
  add_sections(job, step, loads.elements_vary, out, summary);
  return out;
}

}  // namespace whirl::results
