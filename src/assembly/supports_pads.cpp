// Tilting-pad journal bearings: an element a pad, with scalar nodes for what the pad does.
#include <core/contract.hpp>
#include <assembly/carried_cells.hpp>
#include <assembly/film_kernels.hpp>
#include <assembly/support_parts.hpp>
#include <elements/rolling/hertz.hpp>
#include <elements/films/oil.hpp>
#include <elements/films/tilting_pad.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {

namespace {

/// The pivot of a pad as long as `length` becomes a contact.
void set_contact(elements::TiltingPad& pad, const model::TiltingPadJournal::Contact& c,
                 double length) {
  if (c.shape == model::TiltingPadJournal::Contact::Shape::line) {
    pad.pivot_exponent = 10.0 / 9.0;
    pad.pivot_stiffness = elements::hertz_line_stiffness(c.length > 0 ? c.length : length);
    return;
  }
  const double radius = 1.0 / (1.0 / c.radius - 1.0 / c.seat_radius);
  const elements::ContactMaterial material{c.E, c.nu};
  pad.pivot_exponent = 1.5;
  pad.pivot_stiffness = elements::hertz_point_stiffness(radius, radius, material, material);
}

/// How a pad gives along its pivot; a rigid one does not.
void set_pivot(elements::TiltingPad& pad, const model::TiltingPadJournal::Pad& p, double length) {
  if (p.rigid_pivot()) return;
  pad.mass = p.mass;
  pad.pivot_damping = p.pivot_damping;
  pad.pivot_stiffness = p.pivot_stiffness;
  if (p.contact) set_contact(pad, *p.contact, length);
}

}  // namespace

std::vector<elements::TiltingPad> make_tilting_pads(const model::TiltingPadJournal& law,
                                                    FilmGrid grid) {
  const std::vector<model::TiltingPadJournal::Pad> pads = law.pads();
  double arcs = 0;
  for (const auto& p : pads)
    arcs += p.arc;
  std::vector<elements::TiltingPad> out;
  for (const auto& p : pads) {
    elements::PadGeometry g;
    g.radius = 0.5 * law.diameter;
    g.length = law.length;
    g.viscosity = viscosity_of(law.oil);
    g.clearance = p.clearance;
    g.preload = p.preload;
    g.pivot = p.pivot;
    g.arc = p.arc;
    g.offset = p.offset;
    g.thickness = p.thickness;
    const int points = static_cast<int>(std::lround(grid.points * p.arc / arcs));
    g.points = std::min(points, elements::JournalSurface::max_nodes);
    elements::TiltingPad pad = elements::make_tilting_pad(g);
    set_flow(pad.film, law.flow, law.oil);
    if (grid.uniform) make_uniform(pad.film);
    if (grid.rows > 0) put_on_grid(pad.film, {points, grid.rows}, no_recesses);
    pad.tilt_stiffness += p.tilt_stiffness;
    pad.inertia = p.inertia;
    set_pivot(pad, p, law.length);
    out.push_back(std::move(pad));
  }
  return out;
}

namespace {

/// The pads of a bearing with the nodes they stand between. Pressed: one of the pivots gives; the
/// compression of those beside it that are rigid is held.
template <bool Pressed, bool Offsets>
class PadRing {
 public:
  using Kernel = elements::TiltingPadJoint<Pressed, Offsets>;

  PadRing(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
          const model::TiltingPadJournal& law)
      : law_(law),
        given_(law.pads()),
        offset_{n.shaft.offset, n.other.offset},
        ends_{n.shaft.node, n.other.node},
        pads_(make_tilting_pads(law, own_grid(law))) {
    const Index line = a.builder.add_line(fmt::format("pads of {}", name_of(b)));
    for (std::size_t k = 0; k < pads_.size(); ++k) {
      const auto add = [&](const char* what) {
        return a.builder.add_node(
            {Vec3::Zero(), line, fmt::format("{} of pad {} of {}", what, k + 1, name_of(b)), true});
      };
      std::vector<Index> unknowns{add("tilt")};
      if constexpr (Pressed) {
        unknowns.push_back(add("pivot"));
        if (given_[k].rigid_pivot()) a.builder.hold(unknowns.back(), 0);
      }
      unknowns_.push_back(std::move(unknowns));
    }
  }

  /// Where what the pads keep begins.
  void keep_from(std::ptrdiff_t first) {
    kept_from_ = first;
    place_kept(pads_);
  }
  std::size_t pads() const { return pads_.size(); }
  const std::vector<elements::TiltingPad>& all_pads() const { return pads_; }
  const std::vector<std::vector<Index>>& unknowns() const { return unknowns_; }
  /// Those of them that move.
  std::vector<std::vector<Index>> moving() const {
    std::vector<std::vector<Index>> out = unknowns_;
    for (std::size_t k = 0; k < pads(); ++k)
      out[k].resize(moves(k));
    return out;
  }
  Kernel kernel(std::size_t k) const {
    Kernel out;
    out.pad = pads_[k];
    out.offset = offset_;
    return out;
  }
  std::array<Index, Kernel::n_nodes> nodes(std::size_t k) const {
    std::array<Index, Kernel::n_nodes> out;
    out[0] = ends_[0];
    out[1] = ends_[1];
    for (std::size_t i = 0; i < unknowns_[k].size(); ++i)
      out[2 + i] = unknowns_[k][i];
    return out;
  }
  typename Kernel::Nodes states(std::size_t k, const NodeAt& at) const {
    typename Kernel::Nodes x;
    const auto n = nodes(k);
    for (std::size_t i = 0; i < n.size(); ++i)
      x[i] = &at(n[i]);
    return x;
  }
  /// What stands on the shaft for all pads together.
  Vector<7> on_shaft(const NodeAt& at, const system::Context& c) const {
    Vector<7> sum = Vector<7>::Zero();
    for (std::size_t k = 0; k < pads(); ++k) {
      system::ForceX<Kernel::size> f = system::ForceX<Kernel::size>::Zero();
      kernel(k).add_force(states(k, at), c, f);
      sum += f.template head<7>();
    }
    return sum;
  }
  std::vector<elements::PadStanding> standing(const NodeAt& at) const {
    std::vector<elements::PadStanding> out;
    for (std::size_t k = 0; k < pads(); ++k) {
      const auto m = kernel(k).motion_of(states(k, at), {});
      out.push_back(pads_[k].standing(m.journal, m.q));
    }
    return out;
  }
  std::vector<double> other_loads(const NodeAt& at) const {
    constexpr double apart = 1e-3;   // of the tilt at which the pad's clearance is gone
    constexpr double little = 0.05;  // of the largest load: with more the journal would not stay
    const std::vector<elements::PadStanding> now = standing(at);
    double most = 0.0;
    for (const elements::PadStanding& pad : now)
      most = std::max(most, pad.load);
    std::vector<double> out(pads(), nan);
    for (std::size_t k = 0; k < pads(); ++k) {
      if (now[k].load > little * most) continue;
      const elements::TiltingPad& pad = pads_[k];
      const auto m = kernel(k).motion_of(states(k, at), {});
      elements::LateralMotion pressed = m.journal;
      pressed.r -= m.q.y() * pad.pivot;
      const double size = pad.film.surface->pad_clearance() / pad.arm;
      for (const double tilt : pad.balances(pressed)) {
        if (std::abs(tilt - m.q.x()) <= apart * size) continue;
        const double load = pad.standing(m.journal, Vec2(tilt, m.q.y())).load;
        if (load <= little * most) out[k] = load;
      }
    }
    return out;
  }
  std::vector<TiltingPads::Face> faces(const NodeAt& at) const {
    std::vector<TiltingPads::Face> out;
    for (std::size_t k = 0; k < pads(); ++k) {
      const elements::TiltingPad& pad = pads_[k];
      const Vec2 q = kernel(k).motion_of(states(k, at), {}).q;
      const elements::JournalSurface& surface = *pad.film.surface;
      const auto& arc = surface.arcs().front();
      // r_p = r - a, e = r_p + lift n: the centre of the pad is at a - lift n
      const Vec2 centre =
          q.x() * pad.direction(0) + q.y() * pad.direction(1) - surface.lift() * arc.thinnest;
      out.push_back({arc.start, arc.start + arc.length, surface.pad_clearance(), centre});
    }
    return out;
  }
  /// The films, at rest where they stand.
  std::vector<elements::HeatPad> films(const NodeAt& at) const {
    std::vector<elements::HeatPad> out;
    for (std::size_t k = 0; k < pads(); ++k) {
      const elements::TiltingPad& pad = pads_[k];
      const auto m = kernel(k).motion_of(states(k, at), {});
      elements::LateralMotion still = m.journal;
      still.v.setZero();
      const elements::LateralMotion seen = pad.seen(still, m.q, Vec2::Zero());
      out.push_back({&pad.film, 0, elements::FilmLaw<elements::FiniteJournal>::point(seen),
                     given_[k].thickness});
    }
    return out;
  }
  elements::PadCoefficients coefficients(const NodeAt& at, const FilmGrid& grid) const {
    std::vector<elements::TiltingPad> finer =
        grid.points > 0 ? make_tilting_pads(law_, grid) : pads_;
    place_kept(finer);
    Index n = 2;
    for (std::size_t k = 0; k < pads(); ++k)
      n += static_cast<Index>(moves(k));
    elements::PadCoefficients out{MatX::Zero(n, n), MatX::Zero(n, n), MatX::Zero(n, n)};
    Index next = 2;
    for (std::size_t k = 0; k < pads(); ++k) {
      Kernel joint = kernel(k);
      joint.pad = finer[k];
      system::TangentX<Kernel::size> t;
      t.set_zero();
      joint.add_tangent(states(k, at), {}, t);
      std::vector<std::pair<Index, Index>> place{{0, 1}, {1, 2}};  // of the bearing, of the kernel
      for (std::size_t i = 0; i < moves(k); ++i)
        place.emplace_back(next++, 14 + 7 * static_cast<Index>(i));
      for (const auto& [row, from_row] : place)
        for (const auto& [column, from_column] : place) {
          out.K(row, column) += t.K(from_row, from_column);
          out.C(row, column) += t.C(from_row, from_column);
          out.M(row, column) += t.M(from_row, from_column);
        }
    }
    return out;
  }
  elements::LateralMotion journal(const NodeAt& at) const {
    return kernel(0).motion_of(states(0, at), {}).journal;
  }
  /// What of the smallest clearance is used, m, at the pivot of the pad where least of a clearance is
  /// left, and by how much that pad's own clearance is larger, m.
  struct Reach {
    double used = -infinity, wider = 0;
  };
  Reach reach(const NodeAt& at) const {
    Reach out;
    for (std::size_t k = 0; k < pads(); ++k) {
      const auto m = kernel(k).motion_of(states(k, at), {});
      const double wider = given_[k].clearance - law_.clearance;
      const double used = m.journal.r.dot(pads_[k].pivot) - m.q.y() - wider;
      if (used > out.used) out = {used, wider};
    }
    return out;
  }
  /// How far the journal is from the middle where no pad stands against it, m; else 0.
  double escaped(const NodeAt& at) const {
    const Vec2 r = journal(at).r;
    constexpr double against = 0.25;  // of the way, towards the pivot of a pad
    for (const elements::TiltingPad& pad : pads_)
      if (r.dot(pad.pivot) > against * r.norm()) return 0.0;
    return r.norm();
  }
  /// The first pad that finds no balance with the journal where it is, or farther out on that way while it is
  /// inside; 0: all do.
  struct Tipping {
    std::size_t pad = 0;
    double eccentricity = 0;  ///< towards its pivot
    bool there = true;        ///< where the journal is
  };
  Tipping tipping(const NodeAt& at) const {
    elements::LateralMotion m = journal(at);
    m.v.setZero();
    const double r = m.r.norm(), reach = SupportCondition::believed * law_.clearance;
    const double farther = r > 0.0 ? std::max(reach / r - 1.0, 0.0) : 0.0;
    constexpr int looks = 12;
    for (int look = 0; look <= (farther > 0.0 ? looks : 0); ++look) {
      elements::LateralMotion there = m;
      there.r *= 1.0 + farther * look / looks;
      for (std::size_t k = 0; k < pads_.size(); ++k)
        if (!pads_[k].settled(there).allFinite())
          return {k + 1, there.r.dot(pads_[k].pivot) / given_[k].clearance, look == 0};
    }
    return {};
  }
  /// What the pads carry with the journal where it is, times `factor`, and every pad in balance.
  double capacity(elements::LateralMotion m, double factor) const {
    m.r *= factor;
    m.v.setZero();
    Vec2 sum = Vec2::Zero();
    for (const elements::TiltingPad& pad : pads_) {
      const Vec2 q = pad.settled(m);
      if (q.allFinite()) sum += pad.standing(m, q).force;
    }
    return sum.norm();
  }

 private:
  void place_kept(std::vector<elements::TiltingPad>& pads) const {
    if (kept_from_ < 0) return;
    std::ptrdiff_t next = kept_from_;
    for (elements::TiltingPad& p : pads) {
      p.film.kept_from = next;
      next += p.film.kept_each();
    }
  }

  /// Of the unknowns of a pad.
  std::size_t moves(std::size_t k) const { return Pressed && !given_[k].rigid_pivot() ? 2 : 1; }

  model::TiltingPadJournal law_;
  std::vector<model::TiltingPadJournal::Pad> given_;
  std::ptrdiff_t kept_from_ = -1;
  std::array<double, 2> offset_;
  Pair ends_;
  std::vector<elements::TiltingPad> pads_;
  std::vector<std::vector<Index>> unknowns_;
};

/// Where the film with the most load stands, and the thinnest.
std::string describe_worst(const std::vector<elements::PadStanding>& pads) {
  const auto worst = std::max_element(pads.begin(), pads.end(),
                                      [](const auto& x, const auto& y) { return x.load < y.load; });
  std::string out =
      fmt::format("pad {} carries {:.4g} N at eccentricity {:.3f}, film {:.3g} um",
                  worst - pads.begin() + 1, worst->load, worst->eccentricity, 1e6 * worst->film);
  const auto thinnest = std::min_element(
      pads.begin(), pads.end(), [](const auto& x, const auto& y) { return x.film < y.film; });
  if (thinnest != worst)
    out += fmt::format("; the thinnest film is that of pad {}, {:.3g} um",
                       thinnest - pads.begin() + 1, 1e6 * thinnest->film);
  return out;
}

/// The pads with their films of the momentary state.
template <bool Pressed, bool Offsets>
void add_momentary_pads(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                        const std::shared_ptr<const PadRing<Pressed, Offsets>>& ring) {
  for (std::size_t k = 0; k < ring->pads(); ++k)
    a.built.support_terms[number_of(a, b)].push_back(
        a.builder.add(ring->kernel(k), ring->nodes(k), "tilting pads"));
  auto& terms = a.built.support_terms[number_of(a, b)];
  terms.erase(std::unique(terms.begin(), terms.end()), terms.end());
  a.built.support_forces.push_back(
      {b.name, [ring](const NodeAt& at, const system::Context& c, const ReactionAt&) {
         return Vec3(-ring->on_shaft(at, c).template head<3>());
       }});
  a.built.support_forces.back().moment =
      [ring, place = n.shaft](const NodeAt& at, const system::Context& c, const ReactionAt&) {
        return moment_about_place(at(place.node), ring->on_shaft(at, c), place.offset);
      };
}

template <bool Pressed, bool Offsets>
void add_ring(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
              const model::TiltingPadJournal& law) {
  using Ring = PadRing<Pressed, Offsets>;
  const auto made = std::make_shared<Ring>(a, b, n, law);
  const auto films_on = [law](const FilmGrid& grid) {
    std::vector<elements::FiniteJournal> films;
    for (const elements::TiltingPad& pad : make_tilting_pads(law, grid))
      films.push_back(pad.film);
    return films;
  };
  made->keep_from(add_film_bearing(
      a, b, law.flow, law.oil, made->pads(), [made](const NodeAt& at) { return made->films(at); },
      films_on));
  const std::shared_ptr<const Ring> ring = made;
  if (!law.flow.follows_oil() ||
      !add_pad_cells<Pressed, Offsets>(a, b, n, ring->all_pads(), ring->unknowns()))
    add_momentary_pads(a, b, n, ring);
  TiltingPads pads;
  pads.bearing = number_of(a, b);
  for (const auto& p : law.pads()) {
    pads.pivots.push_back(p.pivot);
    pads.follows.push_back(!p.rigid_pivot() && p.mass == 0.0);
    pads.light.push_back(p.inertia == 0.0);
  }
  pads.unknowns = ring->moving();
  pads.standing = [ring](const NodeAt& at) { return ring->standing(at); };
  pads.faces = [ring](const NodeAt& at) { return ring->faces(at); };
  pads.other_loads = [ring](const NodeAt& at) { return ring->other_loads(at); };
  pads.coefficients = [ring](const NodeAt& at, const FilmGrid& grid) {
    return ring->coefficients(at, grid);
  };
  a.built.tilting_pads.push_back(std::move(pads));

  const double R = 0.5 * law.diameter, slender = R / law.clearance;
  SupportCondition condition;
  condition.bearing = number_of(a, b);
  condition.name = b.name;
  condition.where = b.where;
  condition.sommerfeld = 2.0 * viscosity_of(law.oil) * law.length * R * slender * slender;
  condition.reach = [ring](const NodeAt& at) { return ring->reach(at).used; };
  std::vector<double> offsets;
  for (const auto& p : law.pads())
    offsets.push_back(p.offset);
  condition.detail = [ring, offsets, supplied = law.flow.supply_pressure > 0](const NodeAt& at) {
    std::string out = describe_worst(ring->standing(at));
    if (const auto tips = ring->tipping(at); tips.pad > 0)
      out += fmt::format(
          "; pad {} finds no balance {} (eccentricity {:.3f} towards its pivot, which stands at "
          "{:.3g} of its arc) and turns until it touches{}",
          tips.pad, tips.there ? "there" : "farther out", tips.eccentricity, offsets[tips.pad - 1],
          supplied ? ", which the supply pressure at its edges does to a pad without load" : "");
    return out;
  };
  condition.state = [ring, clearance = law.clearance](const NodeAt& at) {
    const std::vector<elements::PadStanding> now = ring->standing(at);
    Vec2 load = Vec2::Zero();
    for (const auto& p : now)
      load += p.force;
    SupportCondition::State s;
    s.film = true;
    s.gap = clearance;
    const auto reach = ring->reach(at);
    s.displacement = std::max({0.0, reach.used, ring->escaped(at)});
    // at its trailing edge a pad is closer than at its pivot
    for (const auto& p : now)
      if (p.film < (1.0 - SupportCondition::believed) * s.gap)
        s.displacement = std::max(s.displacement, s.gap - p.film);
    s.load = load.norm();
    constexpr double near =
        0.8;  // of the gap: what it could carry is of interest, and found slowly
    if (s.displacement > near * s.gap)
      s.capacity =
          ring->capacity(ring->journal(at), (SupportCondition::believed * s.gap + reach.wider) /
                                                (s.displacement + reach.wider));
    return s;
  };
  a.built.conditions.push_back(std::move(condition));
}

}  // namespace

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::TiltingPadJournal& law) {
  guarded(a, b, [&] {
    if (b.to && a.model.shafts[b.to->shaft].rotating) {
      throw run_error("E26", "its pads stand in a housing that does not turn",
                      "between two turning shafts use type = \"journal\"");
    }
    const auto pads = law.pads();
    const bool at_nodes = n.shaft.offset == 0 && n.other.offset == 0;
    const bool rigid =
        std::all_of(pads.begin(), pads.end(), [](const auto& pad) { return pad.rigid_pivot(); });
    if (rigid)
      at_nodes ? add_ring<false, false>(a, b, n, law) : add_ring<false, true>(a, b, n, law);
    else
      at_nodes ? add_ring<true, false>(a, b, n, law) : add_ring<true, true>(a, b, n, law);
    follow_closely(a, n, law.clearance);
  });
}

}  // namespace whirl::assembly
