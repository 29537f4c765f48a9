// The parts build_system() is made of; each adds one kind of thing. Internal to src/assembly.
#pragma once
#include <assembly/build_system.hpp>

namespace whirl::assembly {

struct Assembly {
  const model::Model& model;
  const meshes::Mesh& mesh;
  const std::string& step;
  FilmOil oil;
  system::Builder builder;
  Built built;
  std::vector<Diagnostic> errors;
  int translational = 0;  ///< linear bearings without moments

  bool acts(const model::Drive& d) const { return d.step.empty() || d.step == step; }
  void error(const char* code, std::string message, std::string hint, const model::Entity& e,
             std::string entity);
  void take_breakpoints(const std::vector<double>& t) {
    built.breakpoints.insert(built.breakpoints.end(), t.begin(), t.end());
  }
  void take_breakpoints(const LawPtr& law) {
    if (!law) return;
    take_breakpoints(law->breakpoints());
    const std::vector<Pace> paces = law->paces();
    built.paces.insert(built.paces.end(), paces.begin(), paces.end());
  }
};

/// Shaft and casing elements with their damping, and rigid sections as bodies.
void add_shafts(Assembly& a);
/// Cracks, in the elements beside them.
void add_cracks(Assembly& a);
/// Bows that grow or decay.
void add_thermal_bows(Assembly& a);
/// Disks.
void add_bodies(Assembly& a);
/// Unbalances, on as many nodes as can carry them.
void add_unbalances(Assembly& a);
/// Bearings, rigid supports, pedestals.
void add_supports(Assembly& a);
/// Joints between lines, or to the ground.
void add_joints(Assembly& a);
/// Reduced foundations under bearings.
void add_foundations(Assembly& a);
/// Loads and drives, and what each line spins with.
void add_loads(Assembly& a);
/// What turning of the base adds to every inertia there is by now.
void add_turning_base(Assembly& a);
/// The step follows what films that conserve mass hold.
bool follows_oil(const model::Model& m, const model::Step& step);
/// Unrestrained motion: left out where nothing excites it, else an error.
void check_restraint(Assembly& a);

}  // namespace whirl::assembly
