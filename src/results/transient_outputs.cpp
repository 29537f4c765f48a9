#include <results/transient_outputs.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::results {

using analysis::Measurement;
using analysis::Point;
using analysis::Snapshot;

namespace {

bool wants(const model::Output& o, std::string_view quantity) {
  return std::find(o.quantities.begin(), o.quantities.end(), quantity) != o.quantities.end();
}

}  // namespace

Point point_of(const run::Job& job, const model::Location& at) {
  const meshes::Place p = job.mesh.place(at);
  return {p.node, p.offset};
}

Channels make_channels(const run::Job& job) {
  const model::Model& m = job.model;
  Channels c;
  if (wants(m.output, "speed")) {
    c.add(analysis::measure_spin("speed", job.reference()));
    c.add(analysis::measure_phi("phi", job.reference()));
    for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
      const meshes::Line& line = job.mesh.lines[l];
      if (line.rotating && job.mesh.lines.size() > 1)
        c.add(analysis::measure_spin("speed " + line.name, line.first_node));
    }
  }
  if (wants(m.output, "probes"))
    for (const model::Probe& p : m.probes)
      c.add(analysis::measure_displacement(p.name, point_of(job, p.at), p.angles));
  if (wants(m.output, "positions"))
    for (const model::Probe& p : m.probes)
      c.add(analysis::measure_position(p.name + " position", point_of(job, p.at)));
  if (wants(m.output, "velocity"))
    for (const model::Probe& p : m.probes)
      c.add(analysis::measure_velocity(p.name + " velocity", point_of(job, p.at)));
  if (wants(m.output, "acceleration"))
    for (const model::Probe& p : m.probes)
      c.add(analysis::measure_acceleration(p.name + " acceleration", point_of(job, p.at)));
  if (wants(m.output, "rotation"))
    for (const model::Probe& p : m.probes) {
      const Point at = point_of(job, p.at);
      c.add(analysis::measure_gamma(p.name + " gamma", at.node));
      c.add(analysis::measure_phi(p.name + " phi", at.node));
      c.add(analysis::measure_phi_rate(p.name + " omega_phi", at.node));
    }
  if (wants(m.output, "bearing_force"))
    for (const assembly::SupportForce& f : job.built.support_forces) {
      Measurement x{"bearing " + f.name + " force",
                    "N",
                    "force of the support on the shaft, fixed axes",
                    {"x", "y", "z"},
                    1.0,
                    {}};
      x.evaluate = [&f](const Snapshot& s, double* out) {
        Eigen::Map<Vec3>{out} =
            f.force([&s](Index n) -> const system::NodeState& { return s.node(n); }, s.context(),
                    [&s](Index k) { return s.reactions()[k]; });
      };
      c.add(std::move(x));
    }
  if (wants(m.output, "bearing_moment"))
    for (const assembly::SupportForce& f : job.built.support_forces) {
      if (!f.moment) continue;
      Measurement x{
          "bearing " + f.name + " moment",
          "N.m",
          "moment of the support on the shaft about its place, fixed axes; about x: torque",
          {"x", "y", "z"},
          1.0,
          {}};
      x.evaluate = [&f](const Snapshot& s, double* out) {
        Eigen::Map<Vec3>{out} =
            f.moment([&s](Index n) -> const system::NodeState& { return s.node(n); }, s.context(),
                     [&s](Index k) { return s.reactions()[k]; });
      };
      c.add(std::move(x));
    }
  if (wants(m.output, "torque"))
    for (const assembly::DriveTorque& d : job.built.drive_torques) {
      Measurement x{
          "drive " + d.name + " torque", "N.m", "torque of the drive on the shaft", {}, 1.0, {}};
      x.evaluate = [&d](const Snapshot& s, double* out) {
        *out = d.torque([&s](Index n) -> const system::NodeState& { return s.node(n); }, s.t(),
                        [&s](Index k) { return s.reactions()[k]; });
      };
      c.add(std::move(x));
    }
  if (wants(m.output, "energy")) c.add(analysis::measure_energy());
  return c;
}

std::vector<io::Channel> io_channels(const Channels& c) {
  std::vector<io::Channel> out{{"t", "s", "time", {}, 1.0, {}}};
  for (const Measurement& m : c.all)
    out.push_back({m.name, m.unit, m.description, m.components, m.scale, {}});
  return out;
}

Frames::Frames(const run::Job& job, const model::VtkOutput& o, const std::string& step, double t0,
               double t1)
    : job_(job),
      schedule_({o.t0, o.t1, o.every, o.frames_per_revolution, o.frames, o.max_frames}, t0, t1),
      arrays_(job) {
  io::VtkFrameOptions options;
  options.directory = job.folder.subfolder("vtk");
  options.name = step;
  io::set_content(options, o.content);
  options.deformation_scale = o.deformation_scale;
  options.points_around = o.points_around;
  options.max_frames = static_cast<std::uint64_t>(o.max_frames);
  writer_ = io::make_vtk_frames(options);
  line_ = options.line;
  bearings_ = options.bearings;
}

void Frames::begin(const Snapshot& s) {
  writer_->begin(job_.scene);
  now_ = s.t();
  phi_ = s.total_phi(job_.reference());
  if (!schedule_.by_revolution() && schedule_.next_time() <= s.t()) {
    write(s);
    schedule_.advance();
  }
}

void Frames::step(analysis::StepAccess& s) {
  now_ = s.t1();
  if (!schedule_.by_revolution()) {
    for (; schedule_.next_time() <= s.t1() * (1 + 1e-12); schedule_.advance())
      write(s.at(std::min(schedule_.next_time(), s.t1())));
    return;
  }
  // frames at fixed angles of the reference: phi is nearly linear inside a step, so a secant needs
  // two or three looks
  const double phi1 = s.end().total_phi(job_.reference()), sign = phi1 >= phi_ ? 1.0 : -1.0;
  double target = schedule_.next_angle(phi_, sign), a = s.t0(), fa = phi_;
  while (sign * (phi1 - target) >= 0.0 && phi1 != phi_) {
    double lo = a, flo = fa, hi = s.t1(), fhi = phi1, t = hi;
    for (int k = 0; k < 8 && std::abs(fhi - flo) > 1e-9; ++k) {
      t = lo + (hi - lo) * (target - flo) / (fhi - flo);
      const double f = s.at(t).total_phi(job_.reference());
      if (std::abs(f - target) < 1e-6) break;
      (sign * (f - target) < 0.0 ? lo : hi) = t;
      (sign * (f - target) < 0.0 ? flo : fhi) = f;
    }
    if (schedule_.in_window(t)) write(s.at(t));
    a = t;
    fa = target;
    target = schedule_.next_angle(target + sign * 1e-9, sign);
  }
  phi_ = phi1;
}

void Frames::save(OutArchive& out) const {
  out.put(now_);
  out.put(phi_);
  out.put(schedule_.next_time());
  out.put_count(schedule_.planned());
  out.put_count(schedule_.taken());
  writer_->save(out);
}

void Frames::restore(InArchive& in) {
  now_ = in.number();
  phi_ = in.number();
  const double next = in.number();
  const std::uint64_t planned = in.count(), taken = in.count();
  if (planned == schedule_.planned()) schedule_.set_taken(taken);
  // another end time can mean another interval: go on with the new one
  if (!schedule_.by_revolution() && schedule_.next_time() != next)
    while (schedule_.next_time() <= now_)
      schedule_.advance();
  writer_->resume(job_.scene, in);
}

void Frames::write(const Snapshot& s) {
  const auto node = [&s](Index i) -> const system::NodeState& { return s.node(i); };
  arrays_.take_nodes(node);
  if (line_)
    arrays_.take_sections(
        assembly::calc_section_results(job_.model, job_.mesh, job_.built, node, s.context(), 0));
  if (bearings_)
    arrays_.take_supports(node, s.context(), [&s](Index k) { return s.reactions()[k]; });
  writer_->frame(arrays_.state(s.t(), s.frames(), true));
}

}  // namespace whirl::results
