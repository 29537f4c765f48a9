#include <analysis/transient/measurement.hpp>
#include <core/contract.hpp>

#include <cmath>

namespace whirl::analysis {

void Snapshot::set(double t, const VecX& q, const VecX& v, const VecX& a) {
  WHIRL_EXPECTS(q.size() == system().size() && v.size() == q.size() && a.size() == q.size());
  t_ = t;
  q_ = &q;
  v_ = &v;
  a_ = &a;
  have_reactions_ = have_energy_ = have_stored_ = false;
  problem_.system().evaluate_nodes(problem_.workspace(), problem_.frames, t, q, v, a);
}

const VecX& Snapshot::reactions() const {
  WHIRL_EXPECTS(q_ != nullptr);
  if (!have_reactions_) {
    problem_.residual(t_, *q_, *v_, *a_, reactions_);
    have_reactions_ = true;
  }
  return reactions_;
}

time::Problem::Power Snapshot::power() const {
  WHIRL_EXPECTS(q_ != nullptr);
  if (!have_energy_) {
    power_ = problem_.power_here(*v_, problem_.power_needs_reactions() ? reactions() : reactions_);
    have_energy_ = true;
  }
  return power_;
}

time::Problem::Power Snapshot::exchange() const {
  return have_energy_ ? power_
                      : problem_.exchange_here(
                            *v_, problem_.power_needs_reactions() ? reactions() : reactions_);
}

const system::Energy& Snapshot::energy() const {
  WHIRL_EXPECTS(q_ != nullptr);
  if (have_energy_ || !problem_.power_needs_reactions()) {
    power();
    return problem_.energy();
  }
  if (!have_stored_) {
    stored_ = system().energy(problem_.workspace());
    have_stored_ = true;
  }
  return stored_;
}

double Snapshot::vibration_energy() const {
  WHIRL_EXPECTS(q_ != nullptr);
  const double kinetic = energy().kinetic;
  VecX turning = VecX::Zero(v_->size());
  for (Index i = 0; i < system().nodes(); ++i) {
    const Index spin = 6 * i + system::spin_phi;
    if (!system().node(i).scalar) turning[spin] = (*v_)[spin];
  }
  system::Workspace& w = problem_.workspace();
  system().evaluate_nodes(w, problem_.frames, t_, *q_, turning, *a_);
  const double spinning = system().energy(w).kinetic;
  system().evaluate_nodes(w, problem_.frames, t_, *q_, *v_, *a_);
  return std::max(0.0, kinetic - spinning);
}

double Snapshot::dissipation() const {
  WHIRL_EXPECTS(q_ != nullptr);
  return have_energy_ ? power_.dissipated : system().exchange(problem_.workspace()).dissipated;
}

double Snapshot::total_phi(Index i) const { return node(i).phi + two_pi * node(i).turns; }

Vec2 Snapshot::gamma(Index i) const {
  WHIRL_EXPECTS(q_ != nullptr);
  if (!frames().moved()) return q_->segment<2>(6 * i + system::gamma2);
  const system::NodeState& n = node(i);
  return rotation::gamma_of_director(n.chart->transpose() * n.t);
}

Vec3 displacement(const Snapshot& s, const Point& p) {
  return s.node(p.node).u + p.offset * s.node(p.node).t;
}
Vec3 velocity(const Snapshot& s, const Point& p) {
  return s.node(p.node).du + p.offset * s.node(p.node).dd;
}
Vec3 acceleration(const Snapshot& s, const Point& p) {
  return s.a().segment<3>(6 * p.node) + p.offset * s.node(p.node).ddd;
}

Measurement measure_displacement(std::string name, Point p, const std::vector<double>& angles) {
  Measurement m{std::move(name), "m", "displacement from the reference position",
                {"y", "z"},      1.0, {}};
  std::vector<std::pair<double, double>> axes{{1.0, 0.0}, {0.0, 1.0}};
  if (!angles.empty()) {
    axes.clear();
    m.components.clear();
    m.description = "displacement along the probe's direction, angle from +y towards +z";
    for (double angle : angles) {
      axes.emplace_back(std::cos(angle), std::sin(angle));
      m.components.push_back(std::to_string(static_cast<int>(std::lround(angle * 180.0 / pi))) +
                             "deg");
    }
  }
  m.evaluate = [p, axes](const Snapshot& s, double* out) {
    const Vec3 u = displacement(s, p);
    for (const auto& [cy, cz] : axes)
      *out++ = cy * u.y() + cz * u.z();
  };
  return m;
}

Measurement measure_velocity(std::string name, Point p) {
  return {std::move(name),
          "m/s",
          "velocity, global axes",
          {"x", "y", "z"},
          1.0,
          [p](const Snapshot& s, double* out) { Eigen::Map<Vec3>{out} = velocity(s, p); }};
}

Measurement measure_acceleration(std::string name, Point p) {
  return {std::move(name),
          "m/s^2",
          "acceleration relative to the base, global axes",
          {"x", "y", "z"},
          1.0,
          [p](const Snapshot& s, double* out) { Eigen::Map<Vec3>{out} = acceleration(s, p); }};
}

Measurement measure_position(std::string name, Point p) {
  return {std::move(name),
          "m",
          "position, global axes",
          {"x", "y", "z"},
          1.0,
          [p](const Snapshot& s, double* out) {
            Eigen::Map<Vec3>{out} =
                s.system().node(p.node).position + s.node(p.node).u + p.offset * s.node(p.node).d();
          }};
}

Measurement measure_spin(std::string name, Index node) {
  return {std::move(name),
          "rpm",
          "spin about the section's own normal, omega . d",
          {},
          to_rpm(1.0),
          [node](const Snapshot& s, double* out) { *out = s.node(node).spin(); }};
}

Measurement measure_phi(std::string name, Index node) {
  return {std::move(name),
          "rad",
          "axial angle phi with whole turns",
          {},
          1.0,
          [node](const Snapshot& s, double* out) { *out = s.total_phi(node); }};
}

Measurement measure_phi_rate(std::string name, Index node) {
  return {std::move(name),
          "rad/s",
          "rate of the axial angle, omega_phi = phi'",
          {},
          1.0,
          [node](const Snapshot& s, double* out) { *out = s.node(node).dphi; }};
}

Measurement measure_gamma(std::string name, Index node) {
  return {std::move(name),
          "rad",
          "transverse Euler vector gamma in the axes of the line",
          {"2", "3"},
          1.0,
          [node](const Snapshot& s, double* out) { Eigen::Map<Vec2>{out} = s.gamma(node); }};
}

Measurement measure_energy() {
  return {"energy",
          "J",
          "kinetic, elastic and gravity potential energy",
          {"kinetic", "elastic", "gravity"},
          1.0,
          [](const Snapshot& s, double* out) {
            const system::Energy& e = s.energy();
            out[0] = e.kinetic;
            out[1] = e.elastic;
            out[2] = e.gravity;
          }};
}

}  // namespace whirl::analysis
