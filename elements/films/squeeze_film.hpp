// Squeeze-film damper: a film between a ring that does not spin (node 0: the outer ring of a
// rolling bearing, or the shaft on it) and its housing (node 1). Only translations enter, whatever
// the spin: force -F(r, w = v) of a journal film (film.hpp).
//
// Films: ShortJournal     open ends, pi film (cavitated at ambient pressure): half Sommerfeld
//        ShortFullFilm    open ends, 2 pi film (feed pressure keeps it from cavitating)
//        FiniteJournal
//            any length, Swift-Stieber cavitation; sealed ends with FiniteJournal::seal_ends
// A centring spring is a bearing of its own in parallel (linear_bearing.hpp); without one the ring
// lies at the bottom at rest and needs a stop (rub.hpp) short of the clearance. Power F.v <= 0 is
// dissipated.
// For circular centred orbits of whirl omega the pi film gives the classical F_r = -2 eta R L^3
// omega eps^2/(c^2 (1-eps^2)^2) and F_t = -pi eta R L^3 omega eps/(2 c^2 (1-eps^2)^1.5) (Gunter,
// Barrett & Allaire, ASME J. Lubr. Tech. 99 (1977), doi 10.1115/1.3452979). Limits: no fluid
// inertia (squeeze Reynolds number rho omega c^2/eta below about 1), isoviscous.
#pragma once
#include <elements/films/film.hpp>

namespace whirl::elements {

/// Short film that does not cavitate: F = -eta R L^3/c^3 A w, A = pi (1-e^2)^(-3/2) 1 + 3 pi
/// (1-e^2)^(-5/2) e e^T, e = r/c.
struct ShortFullFilm {
  double radius = 0, length = 0, clearance = 0, viscosity = 0;  ///< R, L, c (radial), m; eta, Pa s
  void evaluate(const FilmPoint& p, FilmForce& f) const;
  void evaluate(const FilmPoint& p, FilmForce& f, FilmTangent& t) const;
};

template <class Film>
struct SqueezeFilm {
  static constexpr int n_nodes = 2, width = 3;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  Film film;

  static FilmPoint point(const system::Nodes<2>& x) {
    return {(x[0]->u - x[1]->u).template tail<2>(), (x[0]->du - x[1]->du).template tail<2>(), 0.0};
  }
  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<6>& f) const {
    FilmForce q;
    film.evaluate(point(x), q);
    f.template segment<2>(1) -= q.F;
    f.template segment<2>(4) += q.F;
  }
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<6>& t) const {
    FilmForce q;
    FilmTangent g;
    film.evaluate(point(x), q, g);
    const auto add = [](const Mat2& m, Matrix<6>& out) {
      out.template block<2, 2>(1, 1) -= m;
      out.template block<2, 2>(4, 4) -= m;
      out.template block<2, 2>(1, 4) += m;
      out.template block<2, 2>(4, 1) += m;
    };
    add(g.F_r, t.K);
    add(g.F_w, t.C);
  }
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const {
    const FilmPoint p = point(x);
    FilmForce q;
    film.evaluate(p, q);
    e.dissipated -= q.F.dot(p.w);
  }
};

}  // namespace whirl::elements
