#include <elements/films/pad_cell.hpp>
#include <elements/films/pad_mount.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

template <class Pad, int Moves, bool Offsets>
LateralMotion PadCell<Pad, Moves, Offsets>::motion(const Nodes& x, const system::Context& c) const {
  LateralMotion m = Link{offset}.motion(ends(x), c, spins(x), false);
  for (std::size_t k = 0; k < directions.size(); ++k) {
    m.r -= x[2 + k]->u.x() * directions[k];
    m.v -= x[2 + k]->du.x() * directions[k];
  }
  return m;
}

/// Beyond the edges the cell itself.
template <class Pad, int Moves, bool Offsets>
auto PadCell<Pad, Moves, Offsets>::place(Index row, const CellStep& step) const -> Place {
  const Index wanted = std::clamp<Index>(row + step.row, 0, Pad::rows_in_time - 1);
  const int same = step.column < 0 ? before : step.column > 0 ? next : held;
  return {wanted / rows == block ? same : other, wanted % rows, wanted};
}

template <class Pad, int Moves, bool Offsets>
auto PadCell<Pad, Moves, Offsets>::contents(const Nodes& x, Index row) const -> Contents {
  Contents out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Place at_place = place(row, Pad::steps[k]);
    const Index column = std::clamp<Index>(cell + Pad::steps[k].column, 0, pad->cells() - 1);
    out[k] = x[at(at_place.node)]->u[at_place.unknown] + pad->reference(column, at_place.row);
  }
  return out;
}

template <class Pad, int Moves, bool Offsets>
auto PadCell<Pad, Moves, Offsets>::now(const LateralMotion& m, const Nodes& x, Index row) const ->
    typename Pad::template Cell<double> {
  return pad->cell(cell, row, m.r.x(), m.r.y(), m.spin - m.housing_spin, contents(x, row));
}

/// A pad that turns away from its journal touches at an edge first.
template <class Pad, int Moves, bool Offsets>
bool PadCell<Pad, Moves, Offsets>::inside(const Vec2& r) const {
  return Moves > 0 ? pad->open(cell, r) : pad->gap(cell, r) > 0.0;
}

namespace {

/// (F, T_0, T_1) on the journal of what a cell does (film.hpp).
template <class Pad, class T>
std::array<T, 4> load_of(const Pad& pad, const typename Pad::template Cell<T>& c, const T& ry,
                         const T& rz) {
  const Vec2 lever = pad.lever();
  const T torque = lever.x() * c.push[0] + lever.y() * c.push[1] + c.drag;
  const T half = -0.5 * (ry * c.push[1] - rz * c.push[0]);
  return {-c.push[0], -c.push[1], torque - half, -torque - half};
}

}  // namespace

template <class Pad, int Moves, bool Offsets>
Vector<4> PadCell<Pad, Moves, Offsets>::load(const Nodes& x, const system::Context& c) const {
  const LateralMotion m = motion(x, c);
  Vector<4> sum = Vector<4>::Zero();
  for (Index j = 0; j < rows; ++j) {
    const std::array<double, 4> z =
        load_of<Pad, double>(*pad, now(m, x, row_of(j)), m.r.x(), m.r.y());
    sum += Vector<4>(z[0], z[1], z[2], z[3]);
  }
  return sum;
}

template <class Pad, int Moves, bool Offsets>
void PadCell<Pad, Moves, Offsets>::add_force(const Nodes& x, const system::Context& c,
                                             system::ForceX<size>& f) const {
  const LateralMotion m = motion(x, c);
  Vector<4> z = Vector<4>::Zero();
  for (Index j = 0; j < rows; ++j) {
    const typename Pad::template Cell<double> own_now = now(m, x, row_of(j));
    const std::array<double, 4> load = load_of<Pad, double>(*pad, own_now, m.r.x(), m.r.y());
    z += Vector<4>(load[0], load[1], load[2], load[3]);
    f[7 * held + j] += pad->row_factor(cell, row_of(j)) * (x[held]->du[j] + own_now.outflow);
  }
  if (!inside(m.r)) z.setConstant(nan);
  system::ForceX<14> at_ends = system::ForceX<14>::Zero();
  Link{offset}.add_force(spins(x), z, at_ends);
  f.template head<14>() += at_ends;
  for (std::size_t k = 0; k < directions.size(); ++k)
    f[pad_mount::row_of(k)] += z.head<2>().dot(directions[k]);
}

template <class Pad, int Moves, bool Offsets>
void PadCell<Pad, Moves, Offsets>::add_row_tangent(const Nodes& x, const LateralMotion& m, Index j,
                                                   system::TangentX<size>& t) const {
  constexpr int by_ry = 0, by_rz = 1, by_slip = 2, by_contents = 3;
  const auto s = spins(x);
  const Contents q = contents(x, row_of(j));
  std::array<All, at(Pad::around)> local;
  for (std::size_t k = 0; k < q.size(); ++k)
    local[k] = All::variable(q[k], by_contents + static_cast<int>(k));
  const All ry = All::variable(m.r.x(), by_ry), rz = All::variable(m.r.y(), by_rz);
  const typename Pad::template Cell<All> here =
      pad->cell(cell, row_of(j), ry, rz, All::variable(m.spin - m.housing_spin, by_slip), local);
  const std::array<All, 4> load = load_of<Pad, All>(*pad, here, ry, rz);
  const double row = pad->row_factor(cell, row_of(j));
  const Index row_held = 7 * held + j;
  Vector<4> z;
  Matrix<4, Pad::around> of_contents;
  LateralTangent of_load, of_row;
  of_load.set_zero();
  of_row.set_zero();
  for (Index k = 0; k < 4; ++k) {
    const All& part = load[at(k)];
    z[k] = part.v;
    of_contents.row(k) = part.g.template tail<Pad::around>().transpose();
    of_load.r.row(k) = part.g.template head<2>().transpose();
    of_load.spin[k] = part.g[by_slip];
  }
  of_load.housing_spin = -of_load.spin;
  // a row of the ends is minus the slope of the force there
  of_row.r.row(0) = row * here.outflow.g.template head<2>().transpose();
  of_row.spin[0] = row * here.outflow.g[by_slip];
  of_row.housing_spin = -of_row.spin;
  system::TangentX<14> at_ends;
  at_ends.C.setZero();
  at_ends.K.setZero();
  Link{offset}.add_tangent(s, z, of_load, false, at_ends);
  t.C.template topLeftCorner<14, 14>() += at_ends.C;
  t.K.template topLeftCorner<14, 14>() += at_ends.K;
  pad_mount::add_film_tangent(Link{offset}, s, directions, of_load, at_ends, t);
  at_ends.C.setZero();
  at_ends.K.setZero();
  Link{offset}.add_tangent(s, Vector<4>::Zero(), of_row, false, at_ends);
  t.C.template block<1, 14>(row_held, 0) -= at_ends.C.row(1);
  t.K.template block<1, 14>(row_held, 0) -= at_ends.K.row(1);
  for (Index k = 0; k < Pad::around; ++k) {
    const Place of = place(row_of(j), Pad::steps[at(k)]);
    const Index column = 7 * of.node + of.unknown;
    system::ForceX<14> of_ends = system::ForceX<14>::Zero();
    Link{offset}.add_force(s, of_contents.col(k), of_ends);
    t.K.template block<14, 1>(0, column) += of_ends;
    for (std::size_t i = 0; i < directions.size(); ++i)
      t.K(pad_mount::row_of(i), column) += directions[i].dot(of_contents.col(k).template head<2>());
    t.K(row_held, column) += row * here.outflow.g[by_contents + k];
  }
  for (std::size_t k = 0; k < directions.size(); ++k)
    t.K(row_held, pad_mount::row_of(k)) -= of_row.r.row(0).dot(directions[k]);
  t.C(row_held, row_held) += row;
}

template <class Pad, int Moves, bool Offsets>
void PadCell<Pad, Moves, Offsets>::add_tangent(const Nodes& x, const system::Context& c,
                                               system::TangentX<size>& t) const {
  const LateralMotion m = motion(x, c);
  for (Index j = 0; j < rows; ++j)
    add_row_tangent(x, m, j, t);
}

template <class Pad, int Moves, bool Offsets>
void PadCell<Pad, Moves, Offsets>::add_energy(const Nodes& x, const system::Context& c,
                                              system::Energy& e) const {
  const LateralMotion m = motion(x, c);
  const FilmPoint p = FilmLaw<FiniteJournal>::point(m);
  double fed = 0.0;
  for (Index j = 0; j < rows; ++j) {
    const typename Pad::template Cell<double> here = now(m, x, row_of(j));
    const Vec2 push(here.push[0], here.push[1]);
    const double torque = pad->lever().dot(push) + here.drag;
    e.dissipated -= torque * p.slip - push.dot(p.w);
    fed += here.fed;
  }
  const double pump = pad->pump(cell, fed, p, 1.0 / blocks);
  e.dissipated += pump;
  e.supplied += pump;
}

template <class Pad, int Moves, bool Offsets>
void PadCell<Pad, Moves, Offsets>::relax(const Nodes& x, const system::Context& c, Rows& q) const {
  const LateralMotion m = motion(x, c);
  for (Index j = 0; j < rows; ++j) {
    const double content = pad->balanced_cell(cell, row_of(j), m.r, m.spin - m.housing_spin);
    if (std::isfinite(content)) q[at(j)] = content - pad->reference(cell, row_of(j));
  }
}

template <class Pad, int Moves, bool Offsets>
auto PadCell<Pad, Moves, Offsets>::full(const Nodes& x) const -> Rows {
  const Vec2 r = motion(x, {}).r;
  Rows out;
  for (Index j = 0; j < rows; ++j)
    out[at(j)] = pad->gap(cell, row_of(j), r) - pad->reference(cell, row_of(j));
  return out;
}

template struct PadCell<CarriedPad, 0, false>;
template struct PadCell<CarriedPad, 0, true>;
template struct PadCell<CarriedPad, 1, false>;
template struct PadCell<CarriedPad, 1, true>;
template struct PadCell<CarriedPad, 2, false>;
template struct PadCell<CarriedPad, 2, true>;
template struct PadCell<CarriedGrid, 0, false>;
template struct PadCell<CarriedGrid, 0, true>;
template struct PadCell<CarriedGrid, 1, false>;
template struct PadCell<CarriedGrid, 1, true>;
template struct PadCell<CarriedGrid, 2, false>;
template struct PadCell<CarriedGrid, 2, true>;

}  // namespace whirl::elements
