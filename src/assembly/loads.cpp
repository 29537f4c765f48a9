#include <assembly/parts.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/loads/spin_torque.hpp>

#include <fmt/format.h>

#include <set>

namespace whirl::assembly {
namespace {

elements::TorqueLaw torque_law(const model::TorqueCurve& c) {
  elements::TorqueLaw t;
  t.of_time = c.of_time;
  t.speed = c.speed;
  t.torque = c.torque;
  t.friction = c.constant;
  t.viscous = c.viscous;
  t.quadratic = c.quadratic;
  if (c.induction)
    t.induction = {c.induction->breakdown, c.induction->slip_breakdown, c.induction->synchronous};
  if (const auto& p = c.pulsation)
    t.pulsation = {p->synchronous, p->poles, p->phase, p->speed, p->amplitude};
  if (c.power) t.power = {c.power->power, c.power->max_torque};
  if (c.dc) t.dc = {c.dc->stall, c.dc->no_load_speed};
  t.brake = c.brake;
  if (c.governor)
    t.governor = {c.governor->target, c.governor->kp, c.governor->ki, c.governor->max_torque};
  return t;
}

template <elements::TorqueAction A>
void add_torque(Assembly& a, const model::Drive& d, Index node) {
  elements::SpinTorque<A> k;
  k.law = torque_law(std::get<model::TorqueCurve>(d.law));
  if (k.law.governor) {
    const auto start = std::make_shared<elements::TorqueLaw::Start>();
    k.law.governor->start = start;
    a.built.turn_counts.push_back({d.name,
                                   node,
                                   [start](double time, double angle) {
                                     *start = {time, angle};
                                   },
                                   {}});
  }
  a.take_breakpoints(k.law.of_time);
  a.take_breakpoints(k.law.brake);
  a.builder.add(k, {node}, "drives");
  a.built.drive_torques.push_back(
      {d.name, [k, node](const NodeAt& at, double t, const ReactionAt&) {
         return k.working(at(node), t).torque;
       }});
}

void add_load(Assembly& a, const model::PointLoad& l) {
  const meshes::Place at = a.mesh.place(l.at);
  a.take_breakpoints(l.factor);
  if (l.frame == model::LoadFrame::rotating)
    a.builder.add(elements::BodyLoad{l.force, l.moment, at.offset, l.factor}, {at.node}, "loads");
  else if (l.moment.isZero(0.0) && at.offset == 0)
    a.builder.add(elements::PointForce{l.force, l.factor}, {at.node}, "forces");
  else
    a.builder.add(elements::FixedLoad{l.force, l.moment, at.offset, l.factor}, {at.node}, "loads");
}

/// The pair of forces that pulls at the ends of a shaft.
void add_axial_force(Assembly& a, std::size_t shaft) {
  const model::Shaft& s = a.model.shafts[shaft];
  if (s.axial_force == 0) return;
  const double length = s.length();
  for (const bool right : {false, true}) {
    model::PointLoad pull;
    pull.at.shaft = shaft;
    pull.at.s = right ? length : 0.0;
    const Vec3 outwards = s.path.empty() ? Vec3(Vec3::UnitX())
                          : right        ? Vec3(s.path.before(length).triad.col(0))
                                         : Vec3(s.path.after(0.0).triad.col(0));
    pull.force = (right ? s.axial_force : -s.axial_force) * outwards;
    add_load(a, pull);
  }
}

}  // namespace

void add_loads(Assembly& a) {
  for (int k = 0; k < 3; ++k)
    if (const LawPtr& law = a.model.base.acceleration[static_cast<std::size_t>(k)]) {
      a.builder.set_base_acceleration(k, law);
      a.take_breakpoints(law);
    }
  for (const model::PointLoad& l : a.model.loads)
    add_load(a, l);
  for (std::size_t k = 0; k < a.model.shafts.size(); ++k)
    add_axial_force(a, k);

  for (const model::Shaft& s : a.model.shafts) {
    LineSpin spin;
    spin.spin0 = s.rotating ? s.spin0 : 0.0;
    a.built.spins.push_back(spin);
  }
  std::set<Index> prescribed;
  Index first_drive = -1;
  bool counts = false;  // that the first drive's shaft turns at the reference speed
  for (const model::Drive& d : a.model.drives) {
    if (!a.acts(d)) continue;
    const Index node = a.mesh.place(d.at).node;
    const bool turns_as_reference = a.model.shafts[d.at.shaft].speed_ratio == 1.0;
    if (first_drive < 0 || (turns_as_reference && !counts)) first_drive = node;
    counts = counts || turns_as_reference;
    if (const auto* p = std::get_if<model::PrescribedSpin>(&d.law)) {
      if (!prescribed.insert(node).second) {
        const std::string who = fmt::format("drive '{}'", d.name);
        a.error(
            "E26",
            fmt::format("{}: the angle at {} is prescribed twice", who, a.builder.node(node).name),
            {}, d, who);
        continue;
      }
      // where another drive has turned the shaft before, the angle goes on from there
      const auto before = std::make_shared<double>(0.0);
      a.builder.hold(node, system::spin_phi, make_shifted(p->angle, before));
      a.built.turn_counts.push_back({d.name, node,
                                     [before, law = p->angle](double time, double angle) {
                                       *before = angle - law->at(time).f;
                                     },
                                     p->angle});
      LineSpin& spin = a.built.spins[d.at.shaft];
      if (!spin.prescribed) spin = {true, p->angle, spin.spin0};
      const Index unknown = 6 * node + system::spin_phi;
      a.built.drive_torques.push_back(
          {d.name, [unknown](const NodeAt&, double, const ReactionAt& r) { return r(unknown); }});
    } else if (d.kind == model::TorqueKind::fixed_direction) {
      add_torque<elements::TorqueAction::fixed>(a, d, node);
    } else {
      add_torque<elements::TorqueAction::joint>(a, d, node);
    }
  }
  // The speed axis: the node of the first drive on a shaft that turns at the reference speed, else
  // of the first drive, else the first node of the first line that turns.
  a.built.reference = first_drive;
  for (const meshes::Line& line : a.mesh.lines)
    if (a.built.reference < 0 && line.rotating) a.built.reference = line.first_node;
  if (a.built.reference < 0) a.built.reference = 0;
}

}  // namespace whirl::assembly
