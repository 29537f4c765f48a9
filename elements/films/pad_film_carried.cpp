// Films that conserve mass: ruptured stretches carry on what leaves the film before them.
#include <elements/films/pad_film.hpp>
#include <elements/films/pad_film_parts.hpp>
#include <core/contract.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace whirl::elements {

using namespace film_parts;

/// The latest place where a film can form: where the core is no thicker than what is carried to it.
/// False: it never is.
bool PadFilm::fill(const Vec2& e, int up, double content, double edge, Ends& s) const {
  const Place<double> at(e.x(), e.y());
  const auto thickness = [&](double theta) {
    return 1.0 - e.x() * std::cos(theta) - e.y() * std::sin(theta);
  };
  double &end = up == 0 ? s.a : s.b, &core = up == 0 ? s.core_a : s.core_b;
  const double other = up == 0 ? s.core_b : s.core_a;
  const bool fed = edge > 0.0 && (up == 0 ? s.held_b : s.held_a);
  const double down = up == 0 ? 1.0 : -1.0, first = at.theta(core);
  s.forms = up;
  s.content = content;
  if (core == other) return fed;  // a film at the edge alone
  constexpr double rounding = 1e-14;
  if (thickness(first) <= content + rounding) return true;
  const double cosine = (1.0 - content) / e.norm();
  double along = infinity;  // from `first` to where the gap is `content` and gets thinner
  if (std::abs(cosine) < 1.0) {
    const double there = std::atan2(e.y(), e.x()) - down * std::acos(cosine);
    along = down * (there - first);
    along -= two_pi * std::floor(along / two_pi);
  }
  if (along < down * (at.theta(other) - first)) {
    core = at.gamma(first + down * along);
    end = core;
    return true;
  }
  core = other;
  end = core - down * 0.05 * std::abs(s.high - s.low);
  return fed;
}

/// In the order in which the oil meets them.
template <class Medium>
int PadFilm::carried_films(const Vec2& e, const Vec2& W, const Medium& m, Films& out,
                           int& passes) const {
  constexpr double tolerance = 1e-10;  // the load feels where a film forms
  const Place<double> at(e.x(), e.y());
  Films guess;
  int found = 0;
  if (m.edge > 0.0) {
    found = fed_films(e, W, m, guess);
  } else if (!W.isZero(0.0)) {
    std::array<Ends, 2> films;
    found = cores(e, W, films);
    std::copy(films.begin(), films.end(), guess.begin());
  }
  const int up = m.carry > 0.0 ? 0 : 1;
  const auto thickness = [&](double angle) {
    return AtPoint<double>(at, {std::cos(angle), std::sin(angle)}).h;
  };
  double content = thickness(at.gamma(up == 0 ? start_ : start_ + arc_));
  std::size_t n = 0;
  for (int k = 0; k < found; ++k) {
    Ends s = guess[static_cast<std::size_t>(up == 0 ? k : found - 1 - k)];
    const bool begins = up == 0 ? s.held_a : s.held_b;
    if (n > 0) (up == 0 ? s.low : s.high) = up == 0 ? out[n - 1].b : out[n - 1].a;
    if (!begins && !fill(e, up, content, m.edge, s)) continue;
    if (s.core_b > s.core_a) find(e, W, m, s, passes);
    if (!(s.held_a && s.held_b)) settle(e, W, m, s, elements_, tolerance, 100, passes);
    if (n > 0 && (up == 0 ? s.a <= s.low : s.b >= s.high)) {  // it meets the film before it
      Ends& before = out[n - 1];
      if (up == 0) {
        before.b = s.b;
        before.core_b = s.core_b;
        before.high = s.high;
        before.held_b = s.held_b;
      } else {
        before.a = s.a;
        before.core_a = s.core_a;
        before.low = s.low;
        before.held_a = s.held_a;
      }
      if (!(before.held_a && before.held_b))
        settle(e, W, m, before, elements_, tolerance, 100, passes);
    } else {
      out[n++] = s;
    }
    content = thickness(up == 0 ? out[n - 1].b : out[n - 1].a);
  }
  if (up == 1) std::reverse(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(n));
  return static_cast<int>(n);
}

template int PadFilm::carried_films(const Vec2&, const Vec2&, const Through<double>&, Films&,
                                    int&) const;

namespace {

/// Ends of films, and slopes in these.
enum Variable : int { by_ex, by_ey, by_a, by_b, by_re, by_carry, variables };
/// What the film is a function of, once its ends are known.
enum Given : int { of_ex, of_ey, of_Wx, of_Wy, of_re, of_carry, givens };
using Local = Dual<variables>;
using Total = Dual<givens>;

/// Slopes at given ends that are not those of the ends.
Vector<givens> direct(const Local& x) {
  Vector<givens> g = Vector<givens>::Zero();
  g[of_ex] = x.g[by_ex];
  g[of_ey] = x.g[by_ey];
  g[of_re] = x.g[by_re];
  g[of_carry] = x.g[by_carry];
  return g;
}
/// Of a quantity whose ends follow.
Total followed(const Local& x, const Matrix<2, givens>& ends) {
  return {x.v, direct(x) + ends.transpose() * x.g.segment<2>(by_a)};
}
/// Clearance at an angle that follows.
Total thickness_at(const Vec2& e, const Total& angle) {
  const Place<Total> at(Total::variable(e.x(), of_ex), Total::variable(e.y(), of_ey));
  return AtPoint<Total>(at, {cos(angle), sin(angle)}).h;
}

/// int mu f_s/h (share of the width that is wet) dtheta from one end to another; no content: all is.
Total wet_shear(const Place<Total>& at, const Through<Total>& m, const Total& from, const Total& to,
                const Total* content) {
  static const Gauss<8> gauss;
  constexpr int panels = 4;
  const Total width = (1.0 / panels) * (to - from);
  Total sum(0.0);
  for (int panel = 0; panel < panels; ++panel)
    for (std::size_t q = 0; q < 8; ++q) {
      const Total angle = from + (panel + gauss.x[q]) * width;
      const AtPoint<Total> x(at, {cos(angle), sin(angle)});
      Total part = gauss.w[q] * width * x.stretch * m.at(x).shear / x.h;
      if (content && content->v < x.h.v) part = part * *content / x.h;
      sum += part;
    }
  return sum;
}

/// One stretch of film between its ends, of which it is condensed.
struct FilmAtEnds {
  Local a, b;
  Condensed<Local> c;
  bool free[2];
  double edge[2];  ///< pressure at the ends

  /// What its pressure drives out at an end.
  Local out(int k, const Vec2& W) const {
    const Pair<Local>& source = k == 0 ? c.out_a : c.out_b;
    const Local in =
        k == 0 ? c.D_aa * edge[0] + c.D_ab * edge[1] : c.D_ab * edge[0] + c.D_bb * edge[1];
    return source.x * W.x() + source.y * W.y() - in;
  }
  Local load(int k, const Vec2& W) const {
    const Local own = k == 0 ? c.S00 * W.x() + c.S01 * W.y() : c.S01 * W.x() + c.S11 * W.y();
    return k == 0 ? own + c.out_a.x * edge[0] + c.out_b.x * edge[1]
                  : own + c.out_a.y * edge[0] + c.out_b.y * edge[1];
  }
};

/// Slopes of the free ends. forms: that where the film forms of the content carried to it, or -1.
Matrix<2, givens> ends_follow(const FilmAtEnds& film, const Place<Local>& at, const Vec2& W,
                              int forms, const Local& carry, const Total& content) {
  Mat2 by_ends = Mat2::Identity();
  Matrix<2, givens> by_given = Matrix<2, givens>::Zero();
  for (int k = 0; k < 2; ++k) {
    if (!film.free[k]) continue;
    Local flow = film.out(k, W);
    const Local& angle = k == 0 ? film.a : film.b;
    const Local h = AtPoint<Local>(at, {cos(angle), sin(angle)}).h;
    if (k == forms && h.v > content.v) {
      flow -= carry * (h - Local(content.v));
      by_given.row(k) += carry.v * content.g.transpose();
    }
    by_ends.row(k) = flow.g.segment<2>(by_a).transpose();
    by_given.row(k) += direct(flow).transpose();
    const Pair<Local>& source = k == 0 ? film.c.out_a : film.c.out_b;
    by_given(k, of_Wx) += source.x.v;
    by_given(k, of_Wy) += source.y.v;
  }
  return -by_ends.inverse() * by_given;
}

void add_load(PadCarriedLoad& out, const FilmAtEnds& film, const Vec2& W,
              const Matrix<2, givens>& follow) {
  Mat2 S;
  S << film.c.S00.v, film.c.S01.v, film.c.S01.v, film.c.S11.v;
  for (int k = 0; k < 2; ++k) {
    const Total total = followed(film.load(k, W), follow);
    out.G[k] += total.v;
    out.by_e.row(k) += total.g.segment<2>(of_ex).transpose();
    out.by_W.row(k) += S.row(k) + total.g.segment<2>(of_Wx).transpose();
    out.by_reynolds[k] += total.g[of_re];
    out.by_carry[k] += total.g[of_carry];
  }
}

}  // namespace

PadCarriedLoad PadFilm::carried(const Vec2& e, const Vec2& W, const PadMedium& medium) const {
  WHIRL_EXPECTS(smallest_clearance(e) > 0.0);
  WHIRL_EXPECTS(medium.carry != 0.0);
  PadCarriedLoad out;
  out.G = out.by_reynolds = out.by_carry = Vec2::Zero();
  out.by_e = out.by_W = Mat2::Zero();
  Films films;
  int passes = 0;
  const int n =
      solve_through(e, W, Through<double>(medium, start_, arc_, medium.reynolds), films, passes);
  const Through<Local> m(medium, start_, arc_, Local::variable(medium.reynolds, by_re));
  const Through<Total> m_total(medium, start_, arc_, Total::variable(medium.reynolds, of_re));
  const Place<Local> at(Local::variable(e.x(), by_ex), Local::variable(e.y(), by_ey));
  const Place<Total> at_total(Total::variable(e.x(), of_ex), Total::variable(e.y(), of_ey));
  const double sense = medium.carry > 0.0 ? 1.0 : -1.0;
  const int up = sense > 0.0 ? 0 : 1;
  const Local carry(std::abs(medium.carry), sense * Local::variable(medium.carry, by_carry).g);
  const Total first = at_total.gamma(start_), last = at_total.gamma(start_ + arc_);
  Total reached = up == 0 ? first : last;  // downstream end of what has been passed
  Total content = thickness_at(e, reached), shear(0.0);
  const auto add_shear = [&](const Total& from, const Total& to, const Total* filled) {
    shear += sense * wet_shear(at_total, m_total, from, to, filled);
  };
  for (int i = 0; i < n; ++i) {
    const Ends& s = films[static_cast<std::size_t>(up == 0 ? i : n - 1 - i)];
    FilmAtEnds film;
    film.free[0] = !s.held_a && s.a > s.low;
    film.free[1] = !s.held_b && s.b < s.high;
    film.a = film.free[0] ? Local::variable(s.a, by_a) : at.gamma(start_);
    film.b = film.free[1] ? Local::variable(s.b, by_b) : at.gamma(start_ + arc_);
    film.edge[0] = s.held_a ? medium.edge : 0.0;
    film.edge[1] = s.held_b ? medium.edge : 0.0;
    film.c = condense(at, m, film.a, film.b, beta_, elements_);
    if (s.held_a) out.fed -= film.out(0, W).v;
    if (s.held_b) out.fed -= film.out(1, W).v;
    const Matrix<2, givens> follow = ends_follow(film, at, W, s.forms, carry, content);
    add_load(out, film, W, follow);
    const Total end_a = followed(film.a, follow), end_b = followed(film.b, follow);
    const Total &begin = up == 0 ? end_a : end_b, &end = up == 0 ? end_b : end_a;
    add_shear(reached, begin, &content);
    add_shear(begin, end, nullptr);
    reached = end;
    content = thickness_at(e, end);
  }
  add_shear(reached, up == 0 ? last : first, &content);
  out.shear = {shear.v, shear.g.segment<2>(of_ex), shear.g[of_re]};
  out.shear_by_W = shear.g.segment<2>(of_Wx);
  out.shear_by_carry = shear.g[of_carry];
  return out;
}

}  // namespace whirl::elements
