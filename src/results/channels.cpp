#include <results/channels.hpp>

#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/section_results.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace whirl::results {

using analysis::Measurement;
using analysis::Point;
using analysis::Snapshot;

namespace {

bool wants(const model::Output& o, std::string_view quantity) {
  return std::find(o.quantities.begin(), o.quantities.end(), quantity) != o.quantities.end();
}

/// Node states of a snapshot, as the assembly asks for them.
auto nodes_of(const Snapshot& s) {
  return [&s](Index n) -> const system::NodeState& { return s.node(n); };
}

auto reactions_of(const Snapshot& s) {
  return [&s](Index k) { return s.reactions()[k]; };
}

void add_speeds(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "speed")) return;
  c.add(analysis::measure_spin("speed", job.reference()));
  c.add(analysis::measure_phi("phi", job.reference()));
  if (job.mesh.lines.size() == 1) return;
  for (const meshes::Line& line : job.mesh.lines)
    if (line.rotating) c.add(analysis::measure_spin("speed " + line.name, line.first_node));
}

void add_probes(const run::Job& job, Channels& c) {
  const model::Output& o = job.model.output;
  const std::vector<model::Probe>& probes = job.model.probes;
  if (wants(o, "probes"))
    for (const model::Probe& p : probes)
      c.add(analysis::measure_displacement(p.name, point_of(job, p.at), p.angles));
  if (wants(o, "positions"))
    for (const model::Probe& p : probes)
      c.add(analysis::measure_position(p.name + " position", point_of(job, p.at)));
  if (wants(o, "velocity"))
    for (const model::Probe& p : probes)
      c.add(analysis::measure_velocity(p.name + " velocity", point_of(job, p.at)));
  if (wants(o, "acceleration"))
    for (const model::Probe& p : probes)
      c.add(analysis::measure_acceleration(p.name + " acceleration", point_of(job, p.at)));
  if (wants(o, "rotation"))
    for (const model::Probe& p : probes) {
      const Index node = point_of(job, p.at).node;
      c.add(analysis::measure_gamma(p.name + " gamma", node));
      c.add(analysis::measure_phi(p.name + " phi", node));
      c.add(analysis::measure_phi_rate(p.name + " omega_phi", node));
    }
}

void add_support_forces(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "bearing_force")) return;
  for (const assembly::SupportForce& f : job.built.support_forces) {
    Measurement x{"bearing " + f.name + " force",
                  "N",
                  "force of the support on the shaft, fixed axes",
                  {"x", "y", "z"},
                  1.0,
                  {}};
    x.evaluate = [&f](const Snapshot& s, double* out) {
      Eigen::Map<Vec3>{out} = f.force(nodes_of(s), s.context(), reactions_of(s));
    };
    c.add(std::move(x));
  }
}

void add_support_moments(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "bearing_moment")) return;
  for (const assembly::SupportForce& f : job.built.support_forces) {
    if (!f.moment) continue;
    Measurement x{"bearing " + f.name + " moment",
                  "N.m",
                  "moment of the support on the shaft about its place, fixed axes; about x: torque",
                  {"x", "y", "z"},
                  1.0,
                  {}};
    x.evaluate = [&f](const Snapshot& s, double* out) {
      Eigen::Map<Vec3>{out} = f.moment(nodes_of(s), s.context(), reactions_of(s));
    };
    c.add(std::move(x));
  }
}

void add_drive_torques(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "torque")) return;
  for (const assembly::DriveTorque& d : job.built.drive_torques) {
    Measurement x{
        "drive " + d.name + " torque", "N.m", "torque of the drive on the shaft", {}, 1.0, {}};
    x.evaluate = [&d](const Snapshot& s, double* out) {
      *out = d.torque(nodes_of(s), s.t(), reactions_of(s));
    };
    c.add(std::move(x));
  }
}

void add_shaft_torques(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "shaft_torque")) return;
  for (const model::Probe& p : job.model.probes) {
    const std::vector<meshes::Element>& all = job.mesh.elements;
    const auto beside = std::find_if(all.begin(), all.end(), [&](const meshes::Element& e) {
      return at(e.line) == p.at.shaft && p.at.s <= e.s2;
    });
    if (p.at.housing >= 0 || beside == all.end()) continue;
    const double x = std::max(0.0, (p.at.s - beside->s1) / (beside->s2 - beside->s1));
    Measurement m{p.name + " shaft torque",
                  "N.m",
                  "torque of the part to the right on the part to the left, left of the probe",
                  {},
                  1.0,
                  {}};
    m.evaluate = [&job, x, k = static_cast<std::size_t>(beside - all.begin())](const Snapshot& s,
                                                                               double* out) {
      const auto [a, b] = assembly::calc_torques(job.mesh, job.built, s.workspace(), k);
      *out = a + x * (b - a);
    };
    c.add(std::move(m));
  }
}

void add_cracks(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "cracks")) return;
  for (const assembly::CrackOpening& k : job.built.cracks) {
    Measurement x{"crack " + k.name + " opening", "-", "0: closed, 1: open", {}, 1.0, {}};
    x.evaluate = [&k](const Snapshot& s, double* out) {
      *out = k.opening(nodes_of(s), s.context());
    };
    c.add(std::move(x));
  }
}

void add_joints(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "joints")) return;
  for (const assembly::JointResult& j : job.built.joints) {
    const auto add_load = [&](const char* what, const char* unit, const char* about,
                              const assembly::SupportForce::Law& law) {
      Measurement x{
          fmt::format("joint {} {}", j.name, what), unit, about, {"x", "y", "z"}, 1.0, {}};
      x.evaluate = [&law](const Snapshot& s, double* out) {
        Eigen::Map<Vec3>{out} = law(nodes_of(s), s.context(), reactions_of(s));
      };
      c.add(std::move(x));
    };
    const auto add_coordinate = [&](const char* what, const char* unit, const char* about,
                                    Index node) {
      Measurement x{fmt::format("joint {} {}", j.name, what), unit, about, {}, 1.0, {}};
      x.evaluate = [node](const Snapshot& s, double* out) { *out = s.q()[6 * node]; };
      c.add(std::move(x));
    };
    add_load("force", "N", "force of the joint on the line of its 'at', fixed axes", j.force);
    if (j.moment)
      add_load("moment", "N.m", "moment on the line of its 'at' about that place, fixed axes",
               j.moment);
    const char* angles[] = {"angle", "second angle"};
    for (std::size_t k = 0; k < j.angles.size(); ++k)
      add_coordinate(angles[k], "rad", "of the line of 'at' against the other, whole turns counted",
                     j.angles[k]);
    if (j.slide >= 0)
      add_coordinate("slide", "m", "of the line of 'at' against the other", j.slide);
  }
}

void add_control_currents(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "control")) return;
  for (const assembly::MagneticControl& m : job.built.magnetic_controls) {
    Measurement x{fmt::format("bearing {} current", job.model.bearings[m.bearing].name),
                  "A",
                  "control current of the axes",
                  {"1", "2"},
                  1.0,
                  {}};
    x.evaluate = [&m](const Snapshot& s, double* out) {
      for (std::size_t k = 0; k < 2; ++k)
        out[k] = m.current_unit * s.q()[6 * m.currents[k]];
    };
    c.add(std::move(x));
  }
}

void add_rings(const run::Job& job, Channels& c) {
  if (!wants(job.model.output, "rings")) return;
  for (const assembly::FloatingRingBearing& r : job.built.floating_rings) {
    const std::string name = "bearing " + job.model.bearings[r.bearing].name;
    const auto add = [&](const char* what, const char* unit, const char* about,
                         std::vector<std::string> components, double scale, auto evaluate) {
      Measurement x{
          fmt::format("{} {}", name, what), unit, about, std::move(components), scale, {}};
      x.evaluate = evaluate;
      c.add(std::move(x));
    };
    add("ring speed", "rpm", "spin of the floating ring", {}, to_rpm(1.0),
        [&r](const Snapshot& s, double* out) { *out = r.spin_unit * s.q()[6 * r.unknowns[2]]; });
    add("ring", "mm", "displacement of the ring, fixed axes", {"y", "z"}, 1e3,
        [&r](const Snapshot& s, double* out) {
          for (std::size_t k = 0; k < 2; ++k)
            out[k] = s.q()[6 * r.unknowns[k]];
        });
    const auto both = [&r](const Snapshot& s, double* out, auto of) {
      const elements::RingStanding now = r.standing(nodes_of(s));
      out[0] = of(now.inner);
      out[1] = of(now.outer);
    };
    add("eccentricity", "-", "of each film over its clearance", {"inner", "outer"}, 1.0,
        [both](const Snapshot& s, double* out) {
          both(s, out, [](const elements::RingFilmStanding& f) { return f.eccentricity; });
        });
    add("power loss", "W", "of each film", {"inner", "outer"}, 1.0,
        [both](const Snapshot& s, double* out) {
          both(s, out, [](const elements::RingFilmStanding& f) { return f.power; });
        });
    if (r.unknowns.size() < 5) continue;
    add("temperature", "degC", "of each film", {"inner", "outer"}, 1.0,
        [both](const Snapshot& s, double* out) {
          both(s, out, [](const elements::RingFilmStanding& f) { return f.temperature - 273.15; });
        });
  }
}

}  // namespace

Point point_of(const run::Job& job, const model::Location& at) {
  const meshes::Place p = job.mesh.place(at);
  return {p.node, p.offset};
}

std::vector<Point> probe_points(const run::Job& job) {
  std::vector<Point> points;
  for (const model::Probe& p : job.model.probes)
    points.push_back(point_of(job, p.at));
  return points;
}

std::string own_shaft(const run::Job& job, const model::Location& at) {
  const auto line_of = [&](Index node) {
    return job.mesh.nodes[static_cast<std::size_t>(node)].line;
  };
  const Index line = line_of(job.mesh.place(at).node);
  if (line < 0 || line == line_of(job.reference())) return {};
  const auto shaft = static_cast<std::size_t>(line);
  const bool joined = std::any_of(
      job.model.joints.begin(), job.model.joints.end(),
      [&](const model::Joint& j) { return j.at.shaft == shaft || (j.to && j.to->shaft == shaft); });
  return job.mesh.lines[shaft].rotating && !joined ? job.mesh.lines[shaft].name : "";
}

std::vector<double> probe_senses(const run::Job& job, const run::StepState& start) {
  std::vector<double> ratio = job.steady_rotation_of(start).ratio;
  const Index line = job.mesh.nodes[at(job.reference())].line;
  const double of_reference = job.model.shafts[at(line)].speed_ratio;
  for (std::size_t l = 0; l < job.model.shafts.size(); ++l)
    if (ratio[l] == 0.0 && job.model.shafts[l].rotating)
      ratio[l] = job.model.shafts[l].speed_ratio * of_reference;
  const std::vector<double> all = analysis::spin_senses(job.system(), ratio);
  std::vector<double> out;
  for (const Point& p : probe_points(job))
    out.push_back(all[at(p.node)] * all[at(job.reference())]);
  return out;
}

std::vector<std::pair<std::string, Point>> watched_points(const run::Job& job) {
  std::vector<std::pair<std::string, Point>> watched;
  for (const model::Probe& p : job.model.probes)
    watched.emplace_back(p.name, point_of(job, p.at));
  if (watched.empty())
    for (const model::Disk& d : job.model.disks)
      watched.emplace_back("disk " + d.name, point_of(job, d.at));
  return watched;
}

Channels make_channels(const run::Job& job) {
  Channels c;
  add_speeds(job, c);
  add_probes(job, c);
  add_support_forces(job, c);
  add_support_moments(job, c);
  add_drive_torques(job, c);
  add_shaft_torques(job, c);
  add_cracks(job, c);
  add_joints(job, c);
  add_control_currents(job, c);
  add_rings(job, c);
  if (wants(job.model.output, "energy")) c.add(analysis::measure_energy());
  return c;
}

std::vector<io::Channel> io_channels(const Channels& c) {
  std::vector<io::Channel> out{{"t", "s", "time", {}, 1.0, {}}};
  for (const Measurement& m : c.all)
    out.push_back({m.name, m.unit, m.description, m.components, m.scale, {}});
  return out;
}

}  // namespace whirl::results
