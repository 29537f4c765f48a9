// A Jeffcott rotor: one disk on an isotropic spring, its plane kept upright, so that the equations
// of the textbooks hold exactly.
#pragma once
#include <analysis/transient/transient.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/loads/spin_torque.hpp>
#include <elements/loads/unbalance.hpp>

namespace whirl::test {

struct Jeffcott {
  double m = 10, k = 1e5, zeta = 0.0, e = 1e-4,
         J = 0.05;             ///< kg, N/m, -, m, kg m2 (about the shaft's centre)
  LawPtr phi;                  ///< prescribed angle; null: free
  LawPtr unbalance;            ///< factor on m e
  elements::TorqueLaw torque;  ///< when phi is free
  bool driven = false;
  Vec3 gravity = Vec3::Zero();
  LawPtr base_y;  ///< acceleration of the base along y

  system::System make() const {
    system::Builder b;
    b.add_line("rotor");
    b.add_node({Vec3::Zero(), 0, "disk", false});
    elements::RigidDisk disk;
    disk.mass = m;
    disk.Jp = J;
    disk.Jt = J;
    b.add(disk, {Index(0)}, "rigid disks");
    if (e != 0.0) b.add(elements::UnbalanceMass(m * e, 0.0, unbalance), {Index(0)}, "unbalances");
    elements::TranslationalBearing spring;
    spring.K.diagonal() << 0, k, k;
    const double c = 2.0 * zeta * std::sqrt(k * m);
    spring.C.diagonal() << 0, c, c;
    if (k > 0.0) b.add(spring, {Index(0), b.add_ground(Vec3::Zero(), "ground")}, "linear bearings");
    if (driven) {
      elements::JointTorque motor;
      motor.law = torque;
      b.add(motor, {Index(0)}, "drives");
    }
    for (const int c6 : {0, 4, 5})
      b.hold(0, c6);
    if (k == 0.0) {
      b.hold(0, 1);
      b.hold(0, 2);
    }
    if (phi) b.hold(0, system::spin_phi, phi);
    b.set_gravity(gravity);
    if (base_y) b.set_base_acceleration(1, base_y);
    return b.finalize();
  }
};

/// The state of the disk at given times.
class At final : public analysis::Observer {
 public:
  struct Sample {
    double t, y, z, spin;
  };
  explicit At(std::vector<double> times) : times_(std::move(times)) {}
  void step(analysis::StepAccess& s) override {
    for (; next_ < times_.size() && times_[next_] <= s.t1(); ++next_) {
      const analysis::Snapshot& x = s.at(times_[next_]);
      samples.push_back({times_[next_], x.node(0).u.y(), x.node(0).u.z(), x.node(0).spin()});
    }
  }
  std::vector<Sample> samples;

 private:
  std::vector<double> times_;
  std::size_t next_ = 0;
};

struct JeffcottRun {
  analysis::TransientResult result;
  analysis::Peak peak;
  std::vector<At::Sample> samples;
  double energy_defect = 0;
};

inline JeffcottRun run(const Jeffcott& rotor, double t_end, double tolerance, double spin0 = 0.0,
                       std::vector<double> times = {}, const std::string& method = "radau5",
                       std::vector<analysis::SpeedStop> stops = {}) {
  const system::System sys = rotor.make();
  system::SystemProblem problem(sys);
  analysis::TransientOptions o;
  o.method = method;
  o.integrator.tolerance = tolerance;
  o.integrator.t_end = t_end;
  o.integrator.breakpoints = sys.breakpoints();
  o.speed_stops = std::move(stops);
  analysis::PeakTracker peaks({{"disk", {0, 0.0}}}, 0);
  analysis::EnergyBalance energy;
  At at(std::move(times));
  system::State start = sys.make_state();
  start.v[system::spin_phi] = spin0;
  JeffcottRun r;
  r.result = analysis::run_transient(problem, start, o, {&peaks, &energy, &at});
  r.peak = peaks.peaks().front();
  r.samples = at.samples;
  r.energy_defect = energy.worst_defect();
  return r;
}

}  // namespace whirl::test
