// Journal bearings, squeeze-film dampers, seals.
#include <core/contract.hpp>
#include <assembly/film_kernels.hpp>
#include <assembly/support_parts.hpp>
#include <elements/films/annular_seal.hpp>
#include <elements/films/finite_journal.hpp>
#include <elements/films/oil.hpp>
#include <elements/films/short_journal.hpp>
#include <elements/films/squeeze_film.hpp>

namespace whirl::assembly {

double viscosity_of(const model::Oil& o) {
  return o.viscosity > 0 ? o.viscosity
                         : elements::iso_vg_viscosity(o.grade, o.temperature, o.density);
}

void follow_closely(Assembly& a, const meshes::BearingNodes& n, double clearance) {
  WHIRL_EXPECTS(clearance > 0.0);
  for (const Index node : {n.shaft.node, n.other.node})
    if (node >= 0) a.built.fine.push_back({node, clearance});
}

namespace {

/// What a journal has used of the clearance, m: that less the film where it is thinnest. Beside the middle
/// of its lobes a bush is wider than the clearance as assembled.
double used_clearance(const elements::ShortJournal&, const elements::LateralMotion& m) {
  return m.r.norm();
}
double used_clearance(const elements::FiniteJournal& film, const elements::LateralMotion& m) {
  if (film.surface->lift() == 0.0) return m.r.norm();
  const double thinnest = film.least_film(elements::FilmLaw<elements::FiniteJournal>::point(m));
  return std::max(0.0, film.surface->clearance() - thinnest);
}

/// Where on its way from the middle outwards a journal has used that much of the clearance.
template <class Film>
Vec2 place_where_used(const Film& film, elements::LateralMotion m, double wanted) {
  const Vec2 out = m.r.norm() > 0.0 ? Vec2(m.r.normalized()) : Vec2(0.0, -1.0);
  m.r = wanted * out;
  if (used_clearance(film, m) >= wanted * (1.0 - 1e-12)) return m.r;
  double low = wanted, high = 2.0 * wanted;
  const auto used = [&](double way) {
    m.r = way * out;
    return used_clearance(film, m);
  };
  for (int k = 0; used(high) < wanted; ++k) {
    if (k == 10) return wanted * out;  // there is no pad on that side
    high *= 2.0;
  }
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    (used(middle) < wanted ? low : high) = middle;
  }
  return low * out;
}

bool is_lobed(const elements::ShortJournal&) { return false; }
bool is_lobed(const elements::FiniteJournal& film) { return film.surface->lift() > 0.0; }

/// The journal in its film, as if it stood still.
auto journal_at(const meshes::BearingNodes& n) {
  return [r = displacement_of(n), nodes = Pair{n.shaft.node, n.other.node}](const NodeAt& at) {
    elements::LateralMotion m;
    m.r = r(at);
    m.v.setZero();
    m.a.setZero();
    m.spin = at(nodes[0]).spin();
    m.housing_spin = at(nodes[1]).spin();
    m.kept = at(nodes[0]).kept;
    return m;
  };
}

/// Of films: clearance, and the load they carry near it at the present spin in the direction of the
/// displacement.
template <class Film>
void add_film_condition(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                        const elements::FilmLaw<Film>& law, double clearance) {
  const Film& film = law.film;
  const double sommerfeld = 2.0 * film.viscosity * film.length * film.radius *
                            (film.radius / clearance) * (film.radius / clearance);
  follow_closely(a, n, clearance);
  const auto motion = journal_at(n);
  a.built.conditions.push_back({number_of(a, b), b.name, b.where,
                                [motion, law, clearance](const NodeAt& at) {
                                  elements::LateralMotion m = motion(at);
                                  Vector<4> z;
                                  law.force(m, z);
                                  SupportCondition::State s;
                                  s.film = true;
                                  s.gap = clearance;
                                  s.displacement = used_clearance(law.film, m);
                                  s.load = z.head<2>().norm();
                                  m.r = place_where_used(law.film, m,
                                                         SupportCondition::believed * clearance);
                                  law.force(m, z);
                                  s.capacity = z.head<2>().norm();
                                  return s;
                                },
                                sommerfeld});
  if (is_lobed(film))
    a.built.conditions.back().reach = [motion, film](const NodeAt& at) {
      return used_clearance(film, motion(at));
    };
}

template <class Film>
void add_film(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n, const Film& film,
              double clearance) {
  const elements::FilmLaw<Film> law{film};
  add_lateral(a, b, n, law, "journal bearings");
  add_film_condition(a, b, n, law, clearance);
}

/// The stretches that grooves leave of a cylinder.
std::vector<elements::JournalPad> pads_between(std::vector<model::FiniteJournal::Groove> grooves) {
  using Groove = model::FiniteJournal::Groove;
  for (Groove& g : grooves)
    g.at -= two_pi * std::floor(g.at / two_pi);
  std::sort(grooves.begin(), grooves.end(),
            [](const Groove& a, const Groove& b) { return a.at < b.at; });
  std::vector<elements::JournalPad> pads;
  for (std::size_t k = 0; k < grooves.size(); ++k) {
    const bool last = k + 1 == grooves.size();
    const Groove &own = grooves[k], &next = grooves[last ? 0 : k + 1];
    const double start = own.at + 0.5 * own.width,
                 end = next.at - 0.5 * next.width + (last ? two_pi : 0.0);
    pads.push_back({start, end, 0.5 * (start + end)});
  }
  return pads;
}

std::vector<elements::JournalPad> pads_of(const model::FiniteJournal& law) {
  using Shape = model::FiniteJournal::Shape;
  switch (law.shape) {
    case Shape::plain: return {};
    case Shape::two_grooves:
    case Shape::pressure_dam: return elements::two_groove_pads(law.groove_at, law.groove);
    case Shape::lobes:
    case Shape::tapered_land:
      return elements::lobe_pads(law.lobes, law.lobe_at, law.groove, law.lobe_offset);
    case Shape::grooves: return pads_between(law.grooves);
  }
  return {};
}

/// Of pad k, with the arc `arc`.
std::vector<elements::Recess> recesses_of(const model::FiniteJournal& law, std::size_t k,
                                          double arc) {
  using Shape = model::FiniteJournal::Shape;
  if (law.shape == Shape::pressure_dam && k == 1) {
    if (law.relief_width == 0) return {};
    return {{0.0, arc, 0.0, 0.0, law.relief_width / law.length, true}};
  }
  if (law.shape != Shape::pressure_dam && law.shape != Shape::tapered_land) return {};
  elements::Recess r;
  r.to = std::min(law.recess_arc, arc);
  r.depth_from = law.recess_depth;
  r.depth_to = law.shape == Shape::pressure_dam ? law.recess_depth : 0.0;
  r.width = law.recess_width / law.length;
  if (law.leading_at_end) {
    r.from = arc - r.to;
    r.to = arc;
    std::swap(r.depth_from, r.depth_to);
  }
  return {r};
}

template <class Film>
void add_damper(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                const Film& film) {
  add_joint(a, b, n, elements::SqueezeFilm<Film>{film}, "squeeze films");
}

}  // namespace

void make_uniform(elements::FiniteJournal& film) {
  film.mass_conserving = false;
  film.alike = true;
}

void put_on_grid(elements::FiniteJournal& film, FilmGrid grid, const RecessesOf& recesses) {
  WHIRL_EXPECTS(film.surface != nullptr);
  constexpr int fewest = 8;
  double total = 0.0;
  for (const elements::JournalSurface::Arc& arc : film.surface->arcs())
    total += arc.length;
  std::vector<elements::GridPad> pads, at_rest;
  for (std::size_t k = 0; k < film.surface->arcs().size(); ++k) {
    const elements::JournalSurface::Arc& arc = film.surface->arcs()[k];
    const int columns =
        std::max(fewest, static_cast<int>(std::lround(grid.points * arc.length / total)));
    pads.emplace_back(arc.start, arc.length, arc.round, film.radius / film.length, columns,
                      grid.rows, recesses(k, arc.length));
    at_rest.emplace_back(arc.start, arc.length, arc.round, film.radius / film.length,
                         std::clamp(columns / 4, fewest, columns), std::min(grid.rows, 4),
                         recesses(k, arc.length));
  }
  film.grid_at_rest = std::make_shared<const std::vector<elements::GridPad>>(std::move(at_rest));
  film.grid = std::make_shared<const std::vector<elements::GridPad>>(std::move(pads));
  film.leakage = film.source = 12.0;  // of Reynolds' equation itself
}

elements::FiniteJournal make_finite_journal(const model::FiniteJournal& law, FilmGrid grid) {
  elements::FiniteJournal film;
  film.radius = 0.5 * law.diameter;
  film.length = law.length;
  film.viscosity = viscosity_of(law.oil);
  film.surface = std::make_shared<elements::JournalSurface>(
      law.clearance, law.preload, pads_of(law),
      std::min(grid.points, elements::JournalSurface::max_nodes));
  set_flow(film, law.flow, law.oil);
  if (grid.uniform) make_uniform(film);
  if (grid.rows > 0)
    put_on_grid(film, grid, [&](std::size_t k, double arc) { return recesses_of(law, k, arc); });
  return film;
}

elements::FiniteJournal make_damper_film(const model::SqueezeFilm& law, FilmGrid grid) {
  using Film = model::SqueezeFilm::Film;
  WHIRL_EXPECTS(law.film == Film::finite || law.film == Film::sealed);
  elements::FiniteJournal film;
  film.radius = 0.5 * law.diameter;
  film.length = law.length;
  film.viscosity = viscosity_of(law.oil);
  std::vector<elements::JournalPad> pads;
  if (law.film == Film::sealed) {
    film.seal_ends();
    pads.push_back(
        {law.groove_at + 0.5 * law.groove, law.groove_at - 0.5 * law.groove + two_pi, 0.0});
  }
  film.surface = std::make_shared<elements::JournalSurface>(
      law.clearance, 0.0, pads, std::min(grid.points, elements::JournalSurface::max_nodes));
  if (grid.rows > 0) put_on_grid(film, grid, no_recesses);
  return film;
}

double short_bearing_excess(double length_over_diameter, double eccentricity) {
  WHIRL_EXPECTS(length_over_diameter > 0.0);
  WHIRL_EXPECTS(eccentricity >= 0.0 && eccentricity < 1.0);
  constexpr double clearance = 1e-3;  // of a journal of radius 1; the force goes by its ratio alone
  const double length = 2.0 * length_over_diameter;
  const elements::ShortJournal brief{1.0, length, clearance, 1.0};
  elements::FiniteJournal finite;
  finite.radius = 1.0;
  finite.length = length;
  finite.viscosity = 1.0;
  finite.surface = std::make_shared<elements::JournalSurface>(clearance, 0.0,
                                                              std::vector<elements::JournalPad>{});
  // near the middle both are proportional to the displacement
  constexpr double least = 1e-3;
  constexpr double most = 0.999;
  elements::LateralMotion m;
  m.r = Vec2(clearance * std::clamp(eccentricity, least, most), 0.0);
  m.v.setZero();
  m.a.setZero();
  m.spin = 1.0;
  m.housing_spin = 0.0;
  Vector<4> of_short, of_finite;
  elements::FilmLaw<elements::ShortJournal>{brief}.force(m, of_short);
  elements::FilmLaw<elements::FiniteJournal>{finite}.force(m, of_finite);
  return of_short.head<2>().norm() / of_finite.head<2>().norm();
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::ShortJournal& law) {
  guarded(a, b, [&] {
    add_film(a, b, n,
             elements::ShortJournal{0.5 * law.diameter, law.length, law.clearance,
                                    viscosity_of(law.oil)},
             law.clearance);
  });
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::FiniteJournal& law) {
  guarded(a, b, [&] {
    const auto film =
        std::make_shared<elements::FiniteJournal>(make_finite_journal(law, own_grid(law)));
    const HeatPadsAt pads = [film, journal = journal_at(n)](const NodeAt& at) {
      const elements::FilmPoint p = elements::FilmLaw<elements::FiniteJournal>::point(journal(at));
      std::vector<elements::HeatPad> out;
      for (std::size_t k = 0; k < film->surface->arcs().size(); ++k)
        out.push_back({film.get(), k, p});
      return out;
    };
    const auto films_on = [law](const FilmGrid& grid) {
      return std::vector{make_finite_journal(law, grid)};
    };
    film->kept_from =
        add_film_bearing(a, b, law.flow, law.oil, film->surface->arcs().size(), pads, films_on);
    if (add_carried_film(a, b, n, *film))
      add_film_condition(a, b, n, elements::FilmLaw<elements::FiniteJournal>{*film}, law.clearance);
    else
      add_film(a, b, n, *film, law.clearance);
  });
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::SqueezeFilm& law) {
  using Film = model::SqueezeFilm::Film;
  guarded(a, b, [&] {
    const double R = 0.5 * law.diameter, eta = viscosity_of(law.oil);
    if (law.film == Film::cavitated)
      add_damper(a, b, n, elements::ShortJournal{R, law.length, law.clearance, eta});
    else if (law.film == Film::full)
      add_damper(a, b, n, elements::ShortFullFilm{R, law.length, law.clearance, eta});
    else
      add_damper(a, b, n, make_damper_film(law, {damper_nodes, 0, false}));
    follow_closely(a, n, law.clearance);
    a.built.conditions.push_back(
        {number_of(a, b), b.name, b.where, [r = displacement_of(n), law](const NodeAt& at) {
           SupportCondition::State s;
           s.film = true;
           s.gap = law.clearance;
           s.displacement = r(at).norm();
           s.load = law.stiffness * s.displacement;
           s.capacity = law.stiffness * SupportCondition::believed * law.clearance;
           return s;
         }});
    if (law.stiffness == 0 && law.damping == 0) return;
    // The centring spring acts beside the film: one support, two elements. Its force is added to
    // the film's.
    model::LinearBearing spring;
    for (Index k : {1, 2}) {
      spring.K(k, k) = law.stiffness;
      spring.C(k, k) = law.damping;
    }
    auto film = a.built.support_forces.back().force;
    add_law(a, b, n, spring);
    auto centring = a.built.support_forces.back().force;
    a.built.support_forces.pop_back();
    a.built.support_forces.back().force =
        [film, centring](const NodeAt& at, const system::Context& c, const ReactionAt& r) {
          return Vec3(film(at, c, r) + centring(at, c, r));
        };
  });
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::AnnularSeal& law) {
  elements::AnnularSeal k;
  k.radius = 0.5 * law.diameter;
  k.length = law.length;
  k.clearance = law.clearance;
  k.pressure_drop = law.pressure_drop;
  k.density = law.density;
  k.viscosity = law.viscosity;
  k.inlet_loss = law.inlet_loss;
  k.inlet_swirl = law.inlet_swirl;
  add_lateral(a, b, n, k, "annular seals", Friction::none);
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::CrossCoupling& law) {
  using From = model::CrossCoupling::From;
  double k = law.k;
  if (law.from == From::alford)
    k = elements::alford_stiffness(law.alford.beta, law.alford.torque, law.alford.diameter,
                                   law.alford.blade_height);
  if (law.from == From::wachel) {
    const auto& w = law.wachel;
    k = elements::wachel_stiffness(w.power, w.speed, w.diameter, w.width, w.molar_mass,
                                   w.density_ratio);
  }
  model::LinearBearing linear;  // F = -K q: F_y = -k z, F_z = k y
  linear.K(1, 2) = k;
  linear.K(2, 1) = -k;
  add_law(a, b, n, linear);
}

}  // namespace whirl::assembly
