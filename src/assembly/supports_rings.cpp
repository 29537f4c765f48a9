// Bearings with a floating ring: one element a bearing, with scalar nodes for what the ring does.
#include <core/contract.hpp>
#include <assembly/support_parts.hpp>
#include <elements/films/floating_ring.hpp>
#include <elements/films/oil.hpp>

#include <fmt/format.h>

#include <cmath>

namespace whirl::assembly {
namespace {

double film_viscosity(const model::FloatingRing& law, const model::FloatingRing::Film& f) {
  if (f.viscosity > 0) return f.viscosity;
  return elements::iso_vg_viscosity(law.grade, law.heat ? law.supply_temperature : f.temperature,
                                    law.density);
}

void make_film(const model::FloatingRing& law, const model::FloatingRing::Film& f, const FilmGrid&,
               elements::ShortJournal& out) {
  out.radius = 0.5 * f.diameter;
  out.length = law.carrying_length(f);
  out.clearance = f.clearance;
  out.viscosity = film_viscosity(law, f);
}

void make_film(const model::FloatingRing& law, const model::FloatingRing::Film& f,
               const FilmGrid& grid, elements::FiniteJournal& out) {
  out.radius = 0.5 * f.diameter;
  out.length = law.carrying_length(f);
  out.viscosity = film_viscosity(law, f);
  out.surface = std::make_shared<elements::JournalSurface>(
      f.clearance, 0.0, std::vector<elements::JournalPad>{},
      std::min(grid.points, elements::JournalSurface::max_nodes));
  if (grid.rows > 0) put_on_grid(out, grid, no_recesses);
}

elements::RingHeat make_heat(const model::FloatingRing& law) {
  elements::RingHeat out;
  const model::FloatingRing::Heat& h = *law.heat;
  out.oil = elements::OilViscosity(law.grade, law.density);
  out.supply_temperature = law.supply_temperature;
  out.specific_heat = h.specific_heat;
  out.share = h.share;
  out.capacity = 0.5 * law.ring_mass() * h.ring_specific_heat;
  out.conductance = h.conductance;
  out.reference = h.reference;
  out.shaft = h.shaft;
  out.ring = h.ring;
  out.housing = h.housing;
  return out;
}

template <class Film>
elements::FloatingRing<Film> make_ring(const model::FloatingRing& law, const FilmGrid& grid) {
  elements::FloatingRing<Film> ring;
  for (const auto& [side, film] :
       {std::pair{&ring.inner, &law.inner}, std::pair{&ring.outer, &law.outer}}) {
    make_film(law, *film, grid, side->film);
    side->radius = side->film.radius;
    side->length = side->film.length;
    side->viscosity = side->film.viscosity;
    side->clearance = film->clearance;
  }
  ring.mass = law.ring_mass();
  ring.inertia = law.ring_inertia();
  ring.pinned = law.pinned;
  ring.stiffness = law.stiffness;
  ring.damping = law.damping;
  const double outside = 0.5 * law.outer.diameter;
  ring.supply = {law.supply_pressure, law.density, outside * outside - law.bore() * law.bore()};
  if (law.heat) ring.heat = make_heat(law);
  return ring;
}

/// A ring with the nodes it stands between.
template <class Film, bool Heat, bool Offsets>
class RingOnNodes {
 public:
  using Kernel = elements::FloatingRingJoint<Film, Heat, Offsets>;
  static constexpr Index own = Kernel::own;

  RingOnNodes(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
              const model::FloatingRing& law)
      : law_(law) {
    kernel_.ring = make_ring<Film>(law, {law.nodes, 0, false});
    kernel_.offset = {n.shaft.offset, n.other.offset};
    nodes_[0] = n.shaft.node;
    nodes_[1] = n.other.node;
    const Index line = a.builder.add_line(fmt::format("ring of {}", name_of(b)));
    constexpr const char* what[] = {
        "displacement along y of the ring", "displacement along z of the ring", "spin of the ring",
        "temperature of the inner film", "temperature of the outer film"};
    for (std::size_t k = 0; k < at(own); ++k)
      nodes_[2 + k] = a.builder.add_node(
          {Vec3::Zero(), line, fmt::format("{} of {}", what[k], name_of(b)), true, false, k >= 2});
    if (law.pinned) a.builder.hold(nodes_[4], 0);
  }
  const Kernel& kernel() const { return kernel_; }
  const std::array<Index, Kernel::n_nodes>& nodes() const { return nodes_; }
  typename Kernel::Nodes states(const NodeAt& at) const {
    typename Kernel::Nodes x;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      x[i] = &at(nodes_[i]);
    return x;
  }
  Vector<7> on_shaft(const NodeAt& at, const system::Context& c) const {
    system::ForceX<Kernel::size> f = system::ForceX<Kernel::size>::Zero();
    kernel_.add_force(states(at), c, f);
    return f.template head<7>();
  }
  elements::RingStanding standing(const NodeAt& at) const {
    return kernel_.standing(states(at), {});
  }
  elements::PadCoefficients coefficients(const NodeAt& at, const FilmGrid& grid) const {
    Kernel joint = kernel_;
    if (grid.points > 0) joint.ring = make_ring<Film>(law_, grid);
    system::TangentX<Kernel::size> t;
    t.set_zero();
    joint.add_tangent(states(at), {}, t);
    std::vector<Index> from{1, 2};  // of the kernel
    for (Index k = 0; k < own; ++k)
      if (!(law_.pinned && k == 2)) from.push_back(14 + 7 * k);
    const Index n = static_cast<Index>(from.size());
    elements::PadCoefficients out{MatX::Zero(n, n), MatX::Zero(n, n), MatX::Zero(n, n)};
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const Index row = from[whirl::at(i)], column = from[whirl::at(j)];
        out.K(i, j) = t.K(row, column);
        out.C(i, j) = t.C(row, column);
        out.M(i, j) = t.M(row, column);
      }
    return out;
  }

 private:
  model::FloatingRing law_;
  Kernel kernel_;
  std::array<Index, Kernel::n_nodes> nodes_{};
};

/// "ring at 0.21 of the shaft's speed, film 12 um at 132 degC"
template <class Ring>
std::string describe_film(const Ring& ring, const elements::RingStanding& s,
                          const elements::RingFilmStanding& f, double shaft_spin) {
  std::string out = fmt::format("ring at {:.4f} of the shaft's speed, thinnest film {:.3g} um",
                                shaft_spin != 0 ? s.spin / shaft_spin : 0.0, 1e6 * f.thinnest());
  if (std::isnan(f.temperature)) return out;
  out +=
      fmt::format(", {:.4g} degC, clearance {:.3g} um", f.temperature - 273.15, 1e6 * f.clearance);
  const auto& heat = ring.kernel().ring.heat;
  if (const double closes = ring.kernel().ring.closing_excess(); std::isfinite(closes))
    out += fmt::format(" (a clearance closes where both films have {:.4g} degC)",
                       heat.supply_temperature + closes - 273.15);
  return out;
}

/// One a film: how it stands against its clearance.
template <class Ring>
SupportCondition make_condition(const Assembly& a, const model::Bearing& b,
                                const std::shared_ptr<const Ring>& ring, bool inner) {
  const auto film = [inner](const elements::RingStanding& s) -> const elements::RingFilmStanding& {
    return inner ? s.inner : s.outer;
  };
  SupportCondition out;
  out.bearing = number_of(a, b);
  out.name = fmt::format("{} {} film", b.name, inner ? "inner" : "outer");
  out.where = b.where;
  const auto& sides = ring->kernel().ring;
  const Vec2 fed = Ring::Kernel::own == 5 ? sides.clearances(Vec2::Zero()).c
                                          : Vec2(sides.inner.clearance, sides.outer.clearance);
  out.reach = [ring, film, clearance = fed[inner ? 0 : 1]](const NodeAt& at) {
    return clearance * film(ring->standing(at)).eccentricity;
  };
  out.state = [ring, film, inner](const NodeAt& at) {
    const elements::RingStanding now = ring->standing(at);
    SupportCondition::State s;
    s.film = true;
    s.gap = film(now).clearance;
    s.displacement = film(now).place.norm();
    s.load = film(now).force.norm();
    s.capacity = ring->kernel().capacity(ring->states(at), {}, inner, SupportCondition::believed);
    return s;
  };
  out.detail = [ring, film](const NodeAt& at) {
    const elements::RingStanding now = ring->standing(at);
    return describe_film(*ring, now, film(now), at(ring->nodes()[0]).spin());
  };
  return out;
}

template <class Film, bool Heat, bool Offsets>
void add_ring(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
              const model::FloatingRing& law) {
  using Ring = RingOnNodes<Film, Heat, Offsets>;
  const auto ring = std::make_shared<const Ring>(a, b, n, law);
  a.built.support_terms[number_of(a, b)].push_back(
      a.builder.add(ring->kernel(), ring->nodes(), "floating rings"));
  a.built.support_forces.push_back(
      {b.name, [ring](const NodeAt& at, const system::Context& c, const ReactionAt&) {
         return Vec3(-ring->on_shaft(at, c).template head<3>());
       }});
  a.built.support_forces.back().moment =
      [ring, place = n.shaft](const NodeAt& at, const system::Context& c, const ReactionAt&) {
        return moment_about_place(at(place.node), ring->on_shaft(at, c), place.offset);
      };
  FloatingRingBearing out;
  out.bearing = number_of(a, b);
  for (const Index node : ring->nodes())
    if (node != n.shaft.node && node != n.other.node) out.unknowns.push_back(node);
  out.spin_unit = ring->kernel().ring.spin_unit();
  out.standing = [ring](const NodeAt& at) { return ring->standing(at); };
  out.coefficients = [ring](const NodeAt& at, const FilmGrid& grid) {
    return ring->coefficients(at, grid);
  };
  for (const bool inner : {true, false})
    a.built.conditions.push_back(make_condition(a, b, ring, inner));
  const double closest = std::min(law.inner.clearance, law.outer.clearance);
  for (const std::size_t k : {0, 1})
    a.built.fine.push_back({out.unknowns[k], closest});
  follow_closely(a, n, law.inner.clearance);
  a.built.floating_rings.push_back(std::move(out));
}

template <class Film>
void add_ring_of(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                 const model::FloatingRing& law) {
  const bool at_nodes = n.shaft.offset == 0 && n.other.offset == 0;
  if (law.heat)
    at_nodes ? add_ring<Film, true, false>(a, b, n, law) : add_ring<Film, true, true>(a, b, n, law);
  else
    at_nodes ? add_ring<Film, false, false>(a, b, n, law)
             : add_ring<Film, false, true>(a, b, n, law);
}

}  // namespace

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::FloatingRing& law) {
  guarded(a, b, [&] {
    if (b.to && a.model.shafts[b.to->shaft].rotating && law.pinned)
      throw run_error("E26", "its ring is pinned against a housing that turns",
                      "a pinned ring stands in a housing that does not turn");
    if (law.theory == model::FloatingRing::Theory::brief)
      add_ring_of<elements::ShortJournal>(a, b, n, law);
    else
      add_ring_of<elements::FiniteJournal>(a, b, n, law);
  });
}

}  // namespace whirl::assembly
