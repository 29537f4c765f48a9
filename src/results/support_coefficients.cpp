#include <core/contract.hpp>
#include <assembly/film_kernels.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/support_coefficients.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace whirl::results {

namespace {

/// Whether another bearing has an element at a node in one of the terms.
bool shared(const run::Job& job, std::size_t bearing, Index node,
            const std::vector<std::size_t>& terms) {
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const meshes::BearingNodes& n = job.mesh.bearings[i];
    if (i == bearing || (n.shaft.node != node && n.other.node != node)) continue;
    const std::vector<std::size_t>& own = job.built.support_terms[i];
    if (std::find_first_of(own.begin(), own.end(), terms.begin(), terms.end()) != own.end())
      return true;
  }
  return false;
}

/// -dF/dr or -dF/dr' of a support's force on the shaft, by differences of fourth order. The steps,
/// 1e-9 m and 1e-6 m/s, are small against every clearance and film, and what they change in the
/// force is 1e-10 of it and more: good to 1e-6 where the exact tangent cannot be had.
Mat2 differences(const assembly::SupportForce& f, const system::Workspace& w, Index shaft,
                 Vec3 system::NodeState::*motion, double step) {
  Mat2 out;
  for (Index j = 0; j < 2; ++j) {
    const auto at = [&](double x) {
      system::NodeState moved = w.in_own_axes(shaft);
      (moved.*motion)[1 + j] += x;
      return Vec2(f.force(
                       [&](Index k) -> const system::NodeState& {
                         return k == shaft ? moved : w.in_own_axes(k);
                       },
                       w.context, [](Index) { return 0.0; })
                      .tail<2>());
    };
    out.col(j) = -(8.0 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12.0 * step);
  }
  return out;
}

/// Stiffness in (x, y, z, ry, rz) of the point o along the axis from the node, from that of the
/// node in (x, y, z, phi, ry, rz). axial: force on the shaft there, which gives the node a moment
/// when the arm o tilts.
Matrix<5> at_point(const Matrix<6>& node, double o, double axial) {
  // of a shift and a turn of the point: u_y at the node = u_y - o rz, u_z = u_z + o ry
  Matrix<6, 5> A = Matrix<6, 5>::Zero();
  A(0, 0) = A(1, 1) = A(2, 2) = A(4, 3) = A(5, 4) = 1.0;
  A(1, 4) = -o;
  A(2, 3) = o;
  Matrix<5> K = A.transpose() * node * A;
  K(3, 3) -= o * axial;
  K(4, 4) -= o * axial;
  return K;
}

/// Threshold of a rigid rotor in translation on K, C: at the onset (m l^2 + C l + K) x = 0 has l =
/// i w. With k = m w^2 the real and imaginary parts of det(K - k + i w C) are k = (Kyy Czz + Kzz
/// Cyy - Kyz Czy - Kzy Cyz)/(Cyy + Czz) and w^2 = ((k - Kyy)(k - Kzz) - Kyz Kzy)/(Cyy Czz - Cyz
/// Czy).
void find_threshold(SupportCoefficients& b) {
  const Mat2 &K = b.K, &C = b.C;
  const double resisted =
      (K(0, 0) * C(1, 1) + K(1, 1) * C(0, 0) - K(0, 1) * C(1, 0) - K(1, 0) * C(0, 1)) / C.trace();
  // an unloaded round journal resists nothing directly: no mass is stable on it
  const double k = std::abs(resisted) < 1e-12 * K.norm() ? 0.0 : resisted;
  const double w2 = ((k - K(0, 0)) * (k - K(1, 1)) - K(0, 1) * K(1, 0)) / C.determinant();
  if (!(C.trace() > 0) || !(C.determinant() > 0) || !(k >= 0) || !(w2 > 0) || b.spin == 0) return;
  b.threshold_mass = k / w2;
  b.whirl_ratio = std::sqrt(w2) / std::abs(b.spin);
}

/// -dF/dr and -dF/dr' of a journal at rest in its bearing.
std::array<Mat2, 2> film_tangent(const elements::FiniteJournal& film,
                                 const elements::LateralMotion& m) {
  Vector<4> z;
  elements::LateralTangent t;
  t.set_zero();
  elements::FilmLaw<elements::FiniteJournal>{film}.tangent(m, z, t);
  return {-t.r.topRows<2>(), -t.v.topRows<2>()};
}

/// The larger of the relative distances of two pairs K and C from the second one.
double distance(const std::array<Mat2, 2>& own, const std::array<Mat2, 2>& other) {
  double worst = 0;
  for (int k = 0; k < 2; ++k) {
    const double size = other[at(k)].norm();
    if (size > 0) worst = std::max(worst, (own[at(k)] - other[at(k)]).norm() / size);
  }
  return worst;
}

/// Points of a grid to compare one of `nodes` with: the finest, where that is twice as fine; a pad has
/// four elements at least, so that twice the points need not be twice the elements.
int compared_with(int nodes) {
  const int finest = elements::JournalSurface::max_nodes;
  return 2 * nodes <= finest ? finest : nodes / 2;
}

/// Likewise, with the rows along the axis where there are.
template <class Law>
assembly::FilmGrid finer_grid(const Law& law) {
  assembly::FilmGrid grid = assembly::own_grid(law);
  if (grid.rows == 0) {
    grid.points = compared_with(grid.points);
    return grid;
  }
  const bool finest = 2 * grid.points > elements::GridPad::most_columns;
  grid.points = finest ? grid.points / 2 : elements::GridPad::most_columns;
  grid.rows = finest ? std::max(3, grid.rows / 2) : elements::GridPad::most_even_rows;
  return grid;
}

/// Films that differ in nothing but the pressure along the axis: one profile, and a grid.
constexpr assembly::FilmGrid of_one_profile{72, 0, true}, of_grid{240, 6, true};

double grid_error_of(const model::FiniteJournal& law, const elements::LateralMotion& m,
                     std::ptrdiff_t kept_from, const assembly::FilmGrid& one,
                     const assembly::FilmGrid& other) {
  const auto tangent = [&](const assembly::FilmGrid& grid) {
    elements::FiniteJournal film = assembly::make_finite_journal(law, grid);
    film.kept_from = kept_from;
    return film_tangent(film, m);
  };
  return distance(tangent(one), tangent(other));
}

/// Moves a journal to where its film carries `wanted`, N, on the shaft; false: there is no such place near.
bool move_to_load(const elements::FiniteJournal& film, const Vec2& wanted,
                  elements::LateralMotion& m) {
  const elements::FilmLaw<elements::FiniteJournal> law{film};
  constexpr int most = 20;
  constexpr double enough = 1e-6;
  for (int k = 0; k < most; ++k) {
    Vector<4> z;
    law.force(m, z);
    const Vec2 off = z.head<2>() - wanted;
    if (!off.allFinite()) return false;
    if (off.norm() <= enough * wanted.norm()) return true;
    m.r += film_tangent(film, m)[0].inverse() * off;
  }
  return false;
}

/// By the grid of the heat balance, under the same load: near contact a place says little of another
/// clearance. node: of the state.
double heat_error_of(const model::FiniteJournal& law, elements::LateralMotion m,
                     const assembly::FilmBearing& heated, const assembly::NodeAt& node) {
  elements::FiniteJournal film = assembly::make_finite_journal(law, assembly::own_grid(law));
  film.kept_from = heated.kept_from;
  const std::array<Mat2, 2> own = film_tangent(film, m);
  const std::vector<double> kept = heated.finer_heat(node).kept;
  Vector<4> load;
  elements::FilmLaw<elements::FiniteJournal>{film}.force(m, load);
  film.kept_from = 0;
  m.kept = kept.data();
  elements::LateralMotion moved = m;
  if (move_to_load(film, load.head<2>(), moved)) m = moved;
  return distance(own, film_tangent(film, m));
}

/// Of a damper's film, which resists velocities alone.
double grid_error_of(const model::SqueezeFilm& law, const Vec2& place,
                     const assembly::FilmGrid& other) {
  const auto tangent = [&](const assembly::FilmGrid& grid) {
    elements::FilmForce force;
    elements::FilmTangent t;
    elements::FiniteJournal film = assembly::make_damper_film(law, grid);
    film.grid_at_rest.reset();  // it is at rest that it is judged
    film.evaluate({place, Vec2::Zero(), 0.0}, force, t);
    return std::array<Mat2, 2>{Mat2(t.F_r), Mat2(t.F_w)};
  };
  return distance(tangent({assembly::damper_nodes, 0, false}), tangent(other));
}

/// How far coefficients that the shaft sees are from those on a finer grid.
double reduced_grid_error(const elements::PadCoefficients& finer, double spin,
                          const elements::ReducedCoefficients& own) {
  const elements::ReducedCoefficients fine = elements::reduce_pads(finer, std::abs(spin));
  const double k = fine.K.norm(), c = fine.C.norm();
  return std::max(k > 0 ? (own.K - fine.K).norm() / k : 0.0,
                  c > 0 ? (own.C - fine.C).norm() / c : 0.0);
}

/// Node states whose elements keep something else.
class OtherKept {
 public:
  OtherKept(assembly::NodeAt at, const assembly::FilmBearing& film, const std::vector<double>& kept)
      : at_(std::move(at)),
        kept_(static_cast<std::size_t>(film.kept_from)) {
    kept_.insert(kept_.end(), kept.begin(), kept.end());
  }
  const system::NodeState& operator()(Index n) {
    const auto [place, fresh] = copies_.try_emplace(n, at_(n));
    if (fresh) place->second.kept = kept_.data();
    return place->second;
  }

 private:
  assembly::NodeAt at_;
  std::vector<double> kept_;
  std::map<Index, system::NodeState> copies_;
};

/// The film of a bearing that keeps temperatures, or null.
const assembly::FilmBearing* heated_film(const run::Job& job, std::size_t bearing) {
  for (const assembly::FilmBearing& film : job.built.films)
    if (film.bearing == bearing && film.heated) return &film;
  return nullptr;
}

/// By how much the hottest faces differ, K.
double face_error(const elements::HeatBalance& own, const elements::HeatBalance& finer) {
  double worst = 0.0;
  for (std::size_t k = 0; k < own.pads.size(); ++k)
    worst = std::max(worst, std::abs(own.pads[k].hottest - finer.pads[k].hottest));
  return worst;
}

/// The pads of a bearing in an evaluated state; K and C become those with the pads following.
void describe_pads(SupportCoefficients& c, const run::Job& job, std::size_t bearing,
                   const system::Workspace& w) {
  const auto* law = std::get_if<model::TiltingPadJournal>(&job.model.bearings[bearing].law);
  if (!law) return;
  const auto node = [&](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  for (const assembly::TiltingPads& ring : job.built.tilting_pads) {
    if (ring.bearing != bearing) continue;
    PadResults p;
    p.spin = c.spin;
    p.pivots = ring.pivots;
    for (const std::vector<Index>& unknowns : ring.unknowns)
      p.gives.push_back(unknowns.size() > 1);
    p.pads = ring.standing(node);
    p.others = ring.other_loads(node);
    p.drawings = ring.faces(node);
    p.full = ring.coefficients(node, {});
    p.ratios = {1.0};
    for (const double r : law->frequency_ratios)
      if (r != 1.0) p.ratios.push_back(r);
    for (const double r : p.ratios)
      p.reduced.push_back(elements::reduce_pads(p.full, r * std::abs(c.spin)));
    c.K = p.reduced.front().K;
    c.C = p.reduced.front().C;
    c.grid_error =
        reduced_grid_error(ring.coefficients(node, finer_grid(*law)), p.spin, p.reduced.front());
    if (law->rows == 0)
      c.axial_error = reduced_grid_error(
          ring.coefficients(node, of_grid), p.spin,
          elements::reduce_pads(ring.coefficients(node, of_one_profile), std::abs(c.spin)));
    if (const assembly::FilmBearing* film = heated_film(job, bearing)) {
      const auto other = std::make_shared<OtherKept>(node, *film, film->finer_heat(node).kept);
      const assembly::NodeAt finer = [other](Index n) -> const system::NodeState& {
        return (*other)(n);
      };
      c.heat_error = reduced_grid_error(ring.coefficients(finer, {}), p.spin, p.reduced.front());
    }
    c.pads = std::move(p);
  }
}

/// What one profile along the axis leaves of the pressure and side flow of each pad.
void add_axial_errors(FilmResults& f, const assembly::FilmBearing& film,
                      const assembly::NodeAt& node) {
  const std::vector<elements::FilmStanding> one = film.standing_on(node, of_one_profile);
  const std::vector<elements::FilmStanding> solved = film.standing_on(node, of_grid);
  if (one.size() != f.pads.size() || solved.size() != f.pads.size()) return;
  const auto error = [](double own, double other) {
    return other != 0.0 ? std::abs(own - other) / std::abs(other) : nan;
  };
  for (std::size_t k = 0; k < one.size(); ++k) {
    f.pressure_error.push_back(error(one[k].highest, solved[k].highest));
    f.flow_error.push_back(error(one[k].side_flow, solved[k].side_flow));
  }
}

/// The films of a bearing in an evaluated state.
void describe_films(SupportCoefficients& c, const run::Job& job, std::size_t bearing,
                    const system::Workspace& w) {
  const auto node = [&](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  for (const assembly::FilmBearing& film : job.built.films) {
    if (film.bearing != bearing) continue;
    FilmResults f;
    f.pads = film.standing(node);
    if (f.pads.empty()) continue;
    f.fields = film.fields(node);
    if (film.heated) {
      f.heat = film.heat(node);
      f.face_error = face_error(*f.heat, film.finer_heat(node).balance);
    }
    double sum = 0.0, count = 0.0;
    for (const elements::FilmField& x : f.fields)
      for (const double eta : x.viscosity) {
        sum += eta;
        count += 1.0;
      }
    f.viscosity = sum / count;
    if (film.heated) f.effective_temperature = film.temperature_of(f.viscosity);
    const auto flow = [&](const auto& law) {
      const double R = 0.5 * law.diameter;
      const double widest = *std::max_element(f.clearances.begin(), f.clearances.end());
      f.laminar = law.flow.regime == model::FilmFlow::Regime::laminar;
      f.reynolds = law.oil.density * R * std::abs(c.spin) * widest / f.viscosity;
      f.transition = 41.2 * std::sqrt(R / widest);  // G. I. Taylor's vortices
    };
    const model::BearingLaw& law = job.model.bearings[bearing].law;
    if (const auto* journal = std::get_if<model::FiniteJournal>(&law)) {
      f.clearances.assign(f.pads.size(), journal->clearance);
      flow(*journal);
      if (journal->rows == 0) add_axial_errors(f, film, node);
    }
    if (const auto* tilting = std::get_if<model::TiltingPadJournal>(&law)) {
      for (const auto& pad : tilting->pads())
        f.clearances.push_back(pad.clearance);
      flow(*tilting);
      if (tilting->rows == 0) add_axial_errors(f, film, node);
    }
    c.films = std::move(f);
  }
}

/// The ring of a bearing in an evaluated state; K and C become those with the ring following.
void describe_ring(SupportCoefficients& c, const run::Job& job, std::size_t bearing,
                   const system::Workspace& w) {
  const auto* law = std::get_if<model::FloatingRing>(&job.model.bearings[bearing].law);
  if (!law) return;
  const auto node = [&](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  for (const assembly::FloatingRingBearing& ring : job.built.floating_rings) {
    if (ring.bearing != bearing) continue;
    RingResults r;
    r.standing = ring.standing(node);
    r.shaft_spin = c.spin;
    r.spin = r.standing.spin;
    r.turns = !law->pinned;
    if (law->supply_pressure > 0) {
      const double outside = 0.5 * law->outer.diameter;
      r.starved_spin = std::sqrt(2.0 * law->supply_pressure /
                                 (law->density * (outside * outside - law->bore() * law->bore())));
    }
    r.full = ring.coefficients(node, {});
    r.ratios = {1.0};
    for (const double ratio : law->frequency_ratios)
      if (ratio != 1.0) r.ratios.push_back(ratio);
    for (const double ratio : r.ratios)
      r.reduced.push_back(elements::reduce_pads(r.full, ratio * std::abs(c.spin)));
    c.K = r.reduced.front().K;
    c.C = r.reduced.front().C;
    c.clearance = r.standing.inner.clearance + r.standing.outer.clearance;
    if (law->theory != model::FloatingRing::Theory::brief) {  // short films have no grid
      const assembly::FilmGrid finer{compared_with(law->nodes), 0, false};
      const auto error_against = [&](const assembly::FilmGrid& grid) {
        return reduced_grid_error(ring.coefficients(node, grid), r.shaft_spin, r.reduced.front());
      };
      c.grid_error = error_against(finer);
      c.axial_error = error_against(of_grid);
    }
    c.ring = std::move(r);
  }
}

/// Of a magnetic bearing K and C become those with its control at the frequency of the spin. False:
/// at rest an integrator holds against anything.
bool take_control(SupportCoefficients& c, const run::Job& job, std::size_t bearing,
                  const system::Workspace& w) {
  const auto node = [&](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  for (const assembly::MagneticControl& m : job.built.magnetic_controls) {
    if (m.bearing != bearing) continue;
    const double frequency = std::abs(c.spin);
    if (frequency == 0) return false;
    const Eigen::Matrix2cd Z = m.stiffness(node, w.context, frequency);
    c.K = Z.real();
    c.C = Z.imag() / frequency;
  }
  return true;
}

/// Of a support without a constraint, in an evaluated state.
Vec3 force_on_shaft(const assembly::SupportForce& support, const system::Workspace& w) {
  return support.force([&](Index k) -> const system::NodeState& { return w.in_own_axes(k); },
                       w.context, [](Index) { return 0.0; });
}

/// A journal in the middle of its gap by all but rounding carries nothing: no number can be divided
/// by its load.
bool is_loaded(const SupportCoefficients& c) {
  constexpr double rounding = 1e-9;  // of the gap
  return c.load > 0 && !(c.place.norm() <= rounding * c.clearance);
}

/// Sealed ends have no profile along the axis to be wrong, short films no grid.
void describe_damper(SupportCoefficients& c, const model::SqueezeFilm& law) {
  using Film = model::SqueezeFilm::Film;
  if (law.film != Film::finite && law.film != Film::sealed) return;
  const assembly::FilmGrid finer{compared_with(assembly::damper_nodes), 0, false};
  constexpr assembly::FilmGrid along_axis_too{120, 4, false};
  c.grid_error = grid_error_of(law, c.place, finer);
  if (law.film == Film::finite) c.axial_error = grid_error_of(law, c.place, along_axis_too);
}

/// A journal at rest in its bearing.
elements::LateralMotion journal_in(const run::Job& job, std::size_t bearing,
                                   const system::Workspace& w) {
  const meshes::BearingNodes& n = job.mesh.bearings[bearing];
  const auto node = [&](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  const auto place = [&](const meshes::Place& p) {
    return Vec2((node(p.node).u + p.offset * node(p.node).t).tail<2>());
  };
  elements::LateralMotion m;
  m.r = place(n.shaft) - place(n.other);
  m.v.setZero();
  m.a.setZero();
  m.spin = node(n.shaft.node).spin();
  m.housing_spin = node(n.other.node).spin();
  m.kept = node(n.shaft.node).kept;
  return m;
}

/// K and C of a film beside other supports on its node.
std::pair<Mat2, Mat2> own_coefficients(const model::FiniteJournal& law, const run::Job& job,
                                       std::size_t bearing, const system::Workspace& w) {
  elements::FiniteJournal film = assembly::make_finite_journal(law, assembly::own_grid(law));
  for (const assembly::FilmBearing& x : job.built.films)
    if (x.bearing == bearing) film.kept_from = x.kept_from;
  const std::array<Mat2, 2> both = film_tangent(film, journal_in(job, bearing, w));
  return {both[0], both[1]};
}

/// Spin, place, load and its attitude, gap of a support in an evaluated state.
void describe_state(SupportCoefficients& c, const run::Job& job, std::size_t bearing,
                    const system::Workspace& w) {
  const meshes::BearingNodes& n = job.mesh.bearings[bearing];
  const assembly::SupportForce& force = job.built.support_forces[bearing];
  const auto node = [&](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  const auto place = [&](const meshes::Place& p) {
    return Vec2((node(p.node).u + p.offset * node(p.node).t).tail<2>());
  };
  c.spin = node(n.shaft.node).spin();
  c.place = place(n.shaft) - place(n.other);
  const Vec2 F = force_on_shaft(force, w).tail<2>();
  c.load = F.norm();
  if (c.load > 0 && c.place.norm() > 0) {
    c.attitude = (std::atan2(c.place.y(), c.place.x()) - std::atan2(-F.y(), -F.x())) * 180.0 / pi;
    c.attitude = std::remainder(c.attitude, 360.0);
  }
  if (const auto* law = std::get_if<model::FiniteJournal>(&job.model.bearings[bearing].law)) {
    const elements::LateralMotion m = journal_in(job, bearing, w);
    for (const assembly::FilmBearing& film : job.built.films)
      if (film.bearing == bearing) {
        c.grid_error =
            grid_error_of(*law, m, film.kept_from, assembly::own_grid(*law), finer_grid(*law));
        if (law->rows == 0)
          c.axial_error = grid_error_of(*law, m, film.kept_from, of_one_profile, of_grid);
        if (film.heated) c.heat_error = heat_error_of(*law, m, film, node);
      }
  }
  if (const auto* law = std::get_if<model::SqueezeFilm>(&job.model.bearings[bearing].law))
    describe_damper(c, *law);
  for (const assembly::SupportCondition& x : job.built.conditions) {
    if (x.bearing != bearing) continue;
    c.clearance = x.state(node).gap;
    if (x.sommerfeld > 0 && is_loaded(c))
      c.sommerfeld = x.sommerfeld * std::abs(c.spin) / two_pi / c.load;
  }
  if (!is_loaded(c)) c.attitude = nan;
}

}  // namespace

io::Table reduced_table(std::string title) {
  io::Table out;
  out.title = std::move(title);
  out.columns = {{"bearing", "-", ""},
                 {"speed", "rpm", ""},
                 {"frequency / speed", "-", ""},
                 {"frequency", "Hz", ""}};
  for (const char* m : {"k", "c"})
    for (const char* e : {"yy", "yz", "zy", "zz"})
      out.columns.push_back({std::string("reduced ") + m + e, m[0] == 'k' ? "N/m" : "N s/m", ""});
  return out;
}

void add_reduced(io::Table& t, const SupportCoefficients& c, std::span<const double> ratios,
                 std::span<const elements::ReducedCoefficients> reduced) {
  WHIRL_EXPECTS(ratios.size() == reduced.size());
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    const elements::ReducedCoefficients& r = reduced[k];
    t.add({c.name, to_rpm(c.spin), ratios[k], to_hz(ratios[k] * std::abs(c.spin)), r.K(0, 0),
           r.K(0, 1), r.K(1, 0), r.K(1, 1), r.C(0, 0), r.C(0, 1), r.C(1, 0), r.C(1, 1)});
  }
}

std::vector<SupportCoefficients> calc_support_coefficients(const run::Job& job,
                                                           const run::StepState& s) {
  std::vector<SupportCoefficients> out;
  const system::System& system = job.system();
  system::Workspace w = system.make_workspace();
  w.context.averaged = s.speed != 0.0;
  la::MCK matrices = system.make_matrices();
  const system::State& x = s.state;
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::Bearing& b = job.model.bearings[i];
    const model::SupportTraits law = model::traits_of(b.law);
    if (!(law.nonlinear || law.follows_spin) || law.pair->has_value()) continue;
    const std::vector<std::size_t>& only = job.built.support_terms[i];
    const meshes::BearingNodes& n = job.mesh.bearings[i];
    const assembly::SupportForce& support = job.built.support_forces[i];
    if (!system.tangent(w, x.frames, x.t, x.q, x.v, x.a, matrices, &only)) continue;
    const Index slot = matrices.K.pattern().slot(n.shaft.node, n.shaft.node);
    if (slot < 0) continue;
    SupportCoefficients c;
    if (!shared(job, i, n.shaft.node, only)) {
      c.K = matrices.K.block(slot).block<2, 2>(1, 1);
      c.C = matrices.C.block(slot).block<2, 2>(1, 1);
      if (law.rolling) {
        const double axial = force_on_shaft(support, w).x();
        c.K5 = at_point(matrices.K.block(slot), n.shaft.offset, axial);
      }
    } else if (const auto* film = std::get_if<model::FiniteJournal>(&b.law)) {
      std::tie(c.K, c.C) = own_coefficients(*film, job, i, w);
    } else {  // two of a kind on one node stand in one block
      c.K = differences(support, w, n.shaft.node, &system::NodeState::u, 1e-9);
      c.C = differences(support, w, n.shaft.node, &system::NodeState::du, 1e-6);
    }
    c.name = b.name;
    describe_state(c, job, i, w);
    describe_pads(c, job, i, w);
    describe_films(c, job, i, w);
    describe_ring(c, job, i, w);
    if (!take_control(c, job, i, w)) continue;
    find_threshold(c);
    out.push_back(std::move(c));
  }
  return out;
}

Matrix<6> support_stiffness(const run::Job& job, const run::StepState& s, std::size_t bearing) {
  const assembly::SupportForce& support = job.built.support_forces[bearing];
  const meshes::Place at = job.mesh.bearings[bearing].shaft;
  const system::System& system = job.system();
  system::Workspace w = system.make_workspace();
  w.context.averaged = s.speed != 0.0;
  const system::State& x = s.state;
  system.evaluate_nodes(w, x.frames, x.t, x.q, x.v, x.a);
  // Force and moment on the shaft at the bearing's place, with the shaft moved (e, e2, e3) or
  // tilted there about it.
  const auto load = [&](Index motion, double by) {
    system::NodeState moved = w.in_own_axes(at.node);
    if (motion < 3) moved.u[motion] += by;
    // a turn by ry takes the axis to -z, one by rz to +y; the place of the bearing stays where it
    // is
    const Vec3 turn = motion == 4 ? Vec3(0, 0, -by) : motion == 5 ? Vec3(0, by, 0) : Vec3(0, 0, 0);
    moved.t += turn;
    moved.u -= at.offset * turn;
    const auto node = [&](Index k) -> const system::NodeState& {
      return k == at.node ? moved : w.in_own_axes(k);
    };
    const auto no_reaction = [](Index) { return 0.0; };
    Vector<6> out = Vector<6>::Zero();
    out.head<3>() = support.force(node, w.context, no_reaction);
    if (support.moment) out.tail<3>() = support.moment(node, w.context, no_reaction);
    // from the node to the place
    out.tail<3>() -= (at.offset * moved.d()).cross(Vec3(out.head<3>()));
    return out;
  };
  Matrix<6> K = Matrix<6>::Zero();
  for (const Index j : {0, 1, 2, 4, 5}) {
    const double h = j < 3 ? 1e-9 : 1e-7;
    K.col(j) =
        -(8.0 * (load(j, h) - load(j, -h)) - (load(j, 2 * h) - load(j, -2 * h))) / (12.0 * h);
  }
  K.row(3).setZero();  // the axial moment of a tilted load: friction-free bearings have none about
                       // their own axis
  return K;
}

io::Table rolling_stiffness_table(std::span<const SupportCoefficients> list) {
  io::Table t;
  t.title = "Stiffness of the rolling bearings in five motions";
  t.columns = {{"bearing", "-", ""},
               {"force or moment", "-", "on the bearing, rows of the matrix"}};
  const char* motions[] = {"x", "y", "z", "ry", "rz"};
  for (int j = 0; j < 5; ++j)
    t.columns.push_back({std::string("per ") + motions[j], j < 3 ? "N/m, N" : "N/rad, N m/rad",
                         j < 3 ? "forces N/m, moments N" : "forces N/rad, moments N m/rad"});
  for (const SupportCoefficients& c : list)
    for (Index i = 0; i < 5 && c.K5; ++i)
      t.add({c.name, motions[i], (*c.K5)(i, 0), (*c.K5)(i, 1), (*c.K5)(i, 2), (*c.K5)(i, 3),
             (*c.K5)(i, 4)});
  return t;
}

std::string report_grid_error(io::Value& summary, std::span<const SupportCoefficients> list) {
  const SupportCoefficients* worst = nullptr;
  for (const SupportCoefficients& c : list)
    if (!std::isnan(c.grid_error) && !(worst && c.grid_error <= worst->grid_error)) worst = &c;
  if (!worst) return {};
  io::Value& v = summary["film grid"];
  v["relative error of coefficients"] = worst->grid_error;
  v["largest at"] = worst->name;
  double axial = 0, heat = -1;
  for (const SupportCoefficients& c : list) {
    axial = std::fmax(axial, c.axial_error);
    heat = std::fmax(heat, c.heat_error);
  }
  // the largest first
  std::vector<std::pair<double, const char*>> errors{{worst->grid_error, "film grid"}};
  if (axial > worst->grid_error) {
    v["relative error by the axial profile"] = axial;
    errors.emplace_back(axial, "axial profile of the film");
  }
  if (heat >= 0) {
    v["relative error by the heat balance"] = heat;
    errors.emplace_back(heat, "grid of the heat balance");
  }
  std::sort(errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a > b; });
  std::string text = "coefficients right to ";
  for (std::size_t k = 0; k < errors.size(); ++k)
    text +=
        fmt::format("{}{} ({})", k > 0 ? ", " : "", error_text(errors[k].first), errors[k].second);
  return text;
}

io::Table support_table(std::span<const SupportCoefficients> list) {
  io::Table t;
  t.title = "Bearings about the equilibrium";
  t.nan_means = "the bearing has no such number, or is never unstable";
  t.nan_is_absence = true;
  t.columns = {{"bearing", "-", ""},
               {"speed", "rpm", ""},
               {"load", "N", "on the bearing, lateral"},
               {"y", "m", "shaft against housing"},
               {"z", "m", ""},
               {"eccentricity", "m", ""},
               {"eccentricity / clearance", "-", ""},
               {"attitude", "deg", "from the load in the sense y to z"}};
  for (const char* m : {"k", "c"})
    for (const char* e : {"yy", "yz", "zy", "zz"})
      t.columns.push_back({std::string(m) + e, m[0] == 'k' ? "N/m" : "N s/m", ""});
  t.columns.push_back({"Sommerfeld number", "-", "eta N L D (R/c)^2/W, N in rev/s"});
  t.columns.push_back({"threshold mass", "kg",
                       "share of a rigid rotor's mass on this bearing beyond which it is unstable "
                       "at this speed; empty: never"});
  t.columns.push_back({"whirl / speed", "-", "whirl frequency over speed at that threshold"});
  t.columns.push_back(
      {"grid error", "-", "of k and c, relative, by the film's grid; empty: no grid"});
  t.columns.push_back(
      {"axial error", "-",
       "of k and c, relative, by the profile of the film's pressure along the axis, "
       "against a grid there too; empty: no profile"});
  t.columns.push_back(
      {"heat error", "-", "of k and c, relative, by the grid of the heat balance; empty: no heat"});
  for (const SupportCoefficients& c : list)
    t.add({c.name,
           to_rpm(c.spin),
           c.load,
           c.place.x(),
           c.place.y(),
           c.place.norm(),
           c.place.norm() / c.clearance,
           c.attitude,
           c.K(0, 0),
           c.K(0, 1),
           c.K(1, 0),
           c.K(1, 1),
           c.C(0, 0),
           c.C(0, 1),
           c.C(1, 0),
           c.C(1, 1),
           c.sommerfeld,
           c.threshold_mass,
           c.whirl_ratio,
           c.grid_error,
           c.axial_error,
           c.heat_error});
  return t;
}

}  // namespace whirl::results
