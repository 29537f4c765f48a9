// What the functions that add one kind of support share. Internal to src/assembly.
#pragma once
#include <assembly/film_kernels.hpp>
#include <assembly/parts.hpp>
#include <elements/films/film_heat.hpp>
#include <elements/supports/at_offset.hpp>
#include <elements/supports/lateral_joint.hpp>
#include <elements/loads/moment.hpp>

#include <fmt/format.h>

namespace whirl::assembly {

using Pair = std::array<Index, 2>;

inline std::string name_of(const model::Bearing& b) { return fmt::format("bearing '{}'", b.name); }
inline system::Nodes<2> nodes_of(const NodeAt& at, const Pair& n) { return {&at(n[0]), &at(n[1])}; }

inline std::size_t number_of(const Assembly& a, const model::Bearing& b) {
  return static_cast<std::size_t>(&b - a.model.bearings.data());
}

/// Adds an element of a bearing whose coefficients may depend on the state.
template <class Kernel>
void add_element(Assembly& a, const model::Bearing& b, const Kernel& k, const Pair& nodes,
                 const char* kind) {
  a.built.support_terms[number_of(a, b)].push_back(a.builder.add(k, nodes, kind));
}

/// What a kernel's factory refuses becomes an error of the deck. Returns whether it went well.
template <class Make>
bool guarded(Assembly& a, const model::Bearing& b, Make make) {
  try {
    make();
    return true;
  } catch (const Error& e) {
    const Diagnostic& d = e.diagnostics().front();
    a.error(d.code.c_str(), fmt::format("{}: {}", name_of(b), d.message), d.hint, b, name_of(b));
    return false;
  }
}

/// Moment of a support on the shaft about the place of the support, N m, global axes. f: what
/// stands on the node for it (left side); offset: of the place from the node along its normal, m.
inline Vec3 moment_about_place(const system::NodeState& n, const Vector<7>& f, double offset) {
  const Vec3 about_node = -elements::moment_of(n, f.segment<3>(3), f[6]);
  return about_node + offset * n.d().cross(Vec3(f.head<3>()));
}

enum class Friction { none, torque };

/// A lateral law between journal and housing. friction: whether it gives a torque on the journal.
template <class Law>
void add_lateral(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                 const Law& law, const char* kind, Friction friction = Friction::torque) {
  const Pair nodes{n.shaft.node, n.other.node};
  const auto add = [&](auto joint) {
    joint.law = law;
    joint.offset = {n.shaft.offset, n.other.offset};
    add_element(a, b, joint, nodes, kind);
    a.built.support_forces.push_back(
        {b.name, [joint, nodes](const NodeAt& at, const system::Context& c, const ReactionAt&) {
           Vector<4> z;
           joint.law.force(joint.motion_of(nodes_of(at, nodes), c), z);
           return Vec3(0, z[0], z[1]);
         }});
    if (friction == Friction::none) return;
    a.built.support_forces.back().moment =
        [joint, nodes](const NodeAt& at, const system::Context& c, const ReactionAt&) {
          system::ForceX<14> f = system::ForceX<14>::Zero();
          joint.add_force(nodes_of(at, nodes), c, f);
          return moment_about_place(at(nodes[0]), f.template head<7>(), joint.offset[0]);
        };
  };
  if (n.shaft.offset == 0 && n.other.offset == 0)
    add(elements::LateralJoint<Law, false>{});
  else
    add(elements::LateralJoint<Law, true>{});
}

/// Any other two-node kernel; off the nodes through AtOffset. The force on the shaft is what stands
/// on its node, with the sign changed.
template <class K>
void add_joint(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n, const K& kernel,
               const char* kind) {
  const Pair nodes{n.shaft.node, n.other.node};
  const auto add = [&](const auto& k) {
    using Kernel = std::decay_t<decltype(k)>;
    add_element(a, b, k, nodes, kind);
    const auto left_side = [k, nodes](const NodeAt& at, const system::Context& c) {
      system::ForceX<2 * Kernel::width> f = system::ForceX<2 * Kernel::width>::Zero();
      k.add_force(nodes_of(at, nodes), c, f);
      return f;
    };
    a.built.support_forces.push_back(
        {b.name, [left_side](const NodeAt& at, const system::Context& c, const ReactionAt&) {
           return Vec3(-left_side(at, c).template head<3>());
         }});
    if constexpr (K::width == 7)
      a.built.support_forces.back().moment = [left_side, place = n.shaft](const NodeAt& at,
                                                                          const system::Context& c,
                                                                          const ReactionAt&) {
        return moment_about_place(at(place.node), left_side(at, c).template head<7>(),
                                  place.offset);
      };
  };
  if (n.shaft.offset == 0 && n.other.offset == 0)
    add(kernel);
  else
    add(elements::AtOffset<K>{kernel, {n.shaft.offset, n.other.offset}});
}

/// Displacement of the shaft against the other side in (y, z), m.
inline std::function<Vec2(const NodeAt&)> displacement_of(const meshes::BearingNodes& n) {
  return [n](const NodeAt& at) {
    const system::NodeState &s = at(n.shaft.node), &h = at(n.other.node);
    return Vec2((s.u + n.shaft.offset * s.t - h.u - n.other.offset * h.t).tail<2>());
  };
}

/// What a film does depends on the motion of both its sides against the clearance.
void follow_closely(Assembly& a, const meshes::BearingNodes& n, double clearance);
double viscosity_of(const model::Oil& o);
/// Turbulence and supply pressure of a film, and how much it keeps of its heat.
void set_flow(elements::FiniteJournal& film, const model::FilmFlow& flow, const model::Oil& oil);
/// The recesses of a pad by its number and its arc, rad.
using RecessesOf = std::function<std::vector<elements::Recess>(std::size_t, double)>;
/// As FilmGrid::uniform.
void make_uniform(elements::FiniteJournal& film);
inline std::vector<elements::Recess> no_recesses(std::size_t, double) { return {}; }
/// From now on the pressure of a film is found on a grid along its axis too.
void put_on_grid(elements::FiniteJournal& film, FilmGrid grid, const RecessesOf& recesses);
/// A film bearing for results; with heat it becomes something that states keep. pads_at: its pads in
/// a state, which live as long as the function.
using HeatPadsAt = std::function<std::vector<elements::HeatPad>(const NodeAt&)>;
/// Its film on another grid: one, or one a pad.
using FilmsOn = std::function<std::vector<elements::FiniteJournal>(const FilmGrid&)>;
/// Returns where what it keeps begins, -1 without heat.
std::ptrdiff_t add_film_bearing(Assembly& a, const model::Bearing& b, const model::FilmFlow& flow,
                                const model::Oil& oil, std::size_t pads, const HeatPadsAt& pads_at,
                                const FilmsOn& films_on);

/// The cells of a film that conserves mass, where the step follows its oil; false: it does not, and
/// the film is that of the momentary state. Decks with such a step have the cells' nodes in all steps.
bool add_carried_film(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                      const elements::FiniteJournal& film);

// One a law: how it comes into the system. Rigid supports: supports.cpp.
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::LinearBearing&);  // supports.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::SpringBlock&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::TableBearing&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::NonlinearSpring&);  // supports_contact.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&, const model::Rub&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::ShortJournal&);  // supports_film.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::FiniteJournal&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::TiltingPadJournal&);  // supports_pads.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::FloatingRing&);  // supports_rings.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::SqueezeFilm&);  // supports_film.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::AnnularSeal&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::CrossCoupling&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::BallBearing&);  // supports_rolling.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::RollerBearing&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::RollingEstimate&);
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::MagneticBearing&);  // supports_magnetic.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&,
             const model::Coupling&);  // supports_shafts.cpp
void add_law(Assembly&, const model::Bearing&, const meshes::BearingNodes&, const model::GearPair&);

}  // namespace whirl::assembly
