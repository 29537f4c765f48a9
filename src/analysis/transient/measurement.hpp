// What can be read off a moving system at an instant, as named, unit-carrying numbers: probes,
// spins, energies, reactions.
#pragma once
#include <system/problem.hpp>
#include <functional>
#include <string>
#include <vector>

namespace whirl::analysis {

/// The system at one instant, node states evaluated. Reactions and energy are computed when first
/// asked for.
class Snapshot {
 public:
  explicit Snapshot(system::SystemProblem& problem)
      : problem_(problem),
        reactions_(problem.size()) {}
  /// Points it at a state and evaluates the nodes.
  /// @pre vectors of length system().size(); they must outlive what is read.
  void set(double t, const VecX& q, const VecX& v, const VecX& a);
  double t() const { return t_; }
  const VecX& q() const { return *q_; }
  const VecX& v() const { return *v_; }
  const VecX& a() const { return *a_; }
  const system::System& system() const { return problem_.system(); }
  const system::Frames& frames() const { return problem_.frames; }
  const system::NodeState& node(Index i) const { return problem_.workspace().in_own_axes(i); }
  /// Nodes as elements see them.
  const system::Workspace& workspace() const { return problem_.workspace(); }
  /// Time, gravity and load factor as elements see them.
  const system::Context& context() const { return problem_.workspace().context; }
  /// In the axes of the line, rad.
  Vec2 gamma(Index i) const;
  /// Residual of the state: its held entries are the forces the supports exert, N and N m.
  const VecX& reactions() const;
  /// Energies by kind; what is supplied lacks the reactions' part.
  const system::Energy& energy() const;
  time::Problem::Power power() const;
  /// Power supplied and dissipated alone: cheaper where the stored energy is not asked for.
  time::Problem::Power exchange() const;
  /// Kinetic energy that the rotor would not have if every node but turned about its axis, J.
  double vibration_energy() const;
  /// Power dissipated, W: cheaper still.
  double dissipation() const;
  /// phi with its whole turns, rad.
  double total_phi(Index i) const;

 private:
  system::SystemProblem& problem_;
  double t_ = 0;
  const VecX *q_ = nullptr, *v_ = nullptr, *a_ = nullptr;
  mutable VecX reactions_;
  mutable bool have_reactions_ = false, have_energy_ = false, have_stored_ = false;
  mutable time::Problem::Power power_;
  mutable system::Energy stored_;  ///< without the power of reactions
};

/// One channel: a few numbers of one unit.
struct Measurement {
  std::string name, unit, description;
  std::vector<std::string> components;                     ///< empty: scalar
  double scale = 1.0;                                      ///< written value = scale * SI value
  std::function<void(const Snapshot&, double*)> evaluate;  ///< SI values
  std::size_t width() const { return components.empty() ? 1 : components.size(); }
};

/// A point on a shaft: a node and the axial offset along its director, m.
struct Point {
  Index node = 0;
  double offset = 0;
  bool operator==(const Point&) const = default;
};
Vec3 displacement(const Snapshot& s, const Point& p);  ///< of the section's centre, global axes, m
Vec3 velocity(const Snapshot& s, const Point& p);
Vec3 acceleration(const Snapshot& s, const Point& p);  ///< gravity-free (true) acceleration

/// Displacement along directions in the lateral plane, angle from +y towards +z; empty angles: y
/// and z.
Measurement measure_displacement(std::string name, Point p, const std::vector<double>& angles = {});
Measurement measure_velocity(std::string name, Point p);
Measurement measure_acceleration(std::string name, Point p);
Measurement measure_position(std::string name, Point p);     ///< x, y, z, m, global
Measurement measure_spin(std::string name, Index node);      ///< s = omega . d, written in rpm
Measurement measure_phi(std::string name, Index node);       ///< total axial angle, rad
Measurement measure_phi_rate(std::string name, Index node);  ///< omega_phi = phi', rad/s
Measurement measure_gamma(std::string name, Index node);     ///< gamma2, gamma3, rad
Measurement measure_energy();                                ///< kinetic, elastic, gravity, J

}  // namespace whirl::analysis
