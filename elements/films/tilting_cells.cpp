#include <elements/films/tilting_cells.hpp>
#include <elements/films/pad_mount.hpp>
#include <elements/films/root_between.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

/// How well a pad's place is looked for: what is left Newton's method of an equilibrium finds.
constexpr double place_known = 1e-9;

/// A root near a place of a function that grows through zero; step: m or rad, how far to look at first.
/// NaN: there is none within `widest`.
template <class F>
double root_near(double near, double step, double widest, double scale, const F& f) {
  const double here = f(near);
  if (!std::isfinite(here)) return nan;
  if (here == 0.0) return near;
  const double side = here < 0.0 ? 1.0 : -1.0;
  constexpr int most = 60;
  double from = near, ahead = step;
  for (int k = 0; k < most && std::abs(from - near) < widest; ++k) {
    const double to = from + side * ahead;
    const double there = f(to);
    if (there == 0.0) return to;
    if (!std::isfinite(there)) {  // beyond the edge of what there is
      ahead *= 0.5;
      continue;
    }
    if ((there < 0.0) != (here < 0.0))
      return root_between(std::min(from, to), std::max(from, to), scale, f, place_known);
    from = to;
    ahead *= 2.0;
  }
  return nan;
}

}  // namespace

template <class Oil>
PadAtRest<Oil>::PadAtRest(const TiltingPad& pad, std::shared_ptr<const Oil> oil)
    : pad_(pad),
      oil_(std::move(oil)) {
  // a pivot without mass and damper that only its oil holds would move as far as rounding wants it
  if (pad.pivot_stiffness > 0.0) pad_.pivot_damping += pad.tilt_damping / (pad.arm * pad.arm);
}

template <class Oil>
Vec2 PadAtRest<Oil>::force(const Vec2& r, double slip) const {
  return oil_->force_in_balance(r, slip);
}

template <class Oil>
double PadAtRest<Oil>::find_tilt(const LateralMotion& journal, double pressed, double near) const {
  const double slip = journal.spin - journal.housing_spin;
  const double size = pad_.film.surface->pad_clearance() / pad_.arm;
  const auto moment = [&](double tilt) {
    const LateralMotion own = pad_.seen(journal, Vec2(tilt, pressed), Vec2::Zero());
    return force(own.r, slip).dot(pad_.direction(0)) + pad_.tilt_stiffness * tilt;
  };
  return root_near(near, 1e-3 * size, size, pad_.tilt_stiffness * size, moment);
}

/// tilt_at: the tilt that belongs to a compression.
template <class Oil>
template <class Tilt>
double PadAtRest<Oil>::find_pressed(const LateralMotion& journal, const Vec2& q,
                                    const Tilt& tilt_at) const {
  const double slip = journal.spin - journal.housing_spin;
  const auto balance = [&](double by) {
    const LateralMotion own = pad_.seen(journal, Vec2(tilt_at(by), by), Vec2::Zero());
    return pad_.pivot_force(by) + force(own.r, slip).dot(pad_.pivot);
  };
  const double size = pad_.film.surface->clearance();
  return root_near(q.y(), 1e-3 * size, size, pad_.pivot_force(size), balance);
}

template <class Oil>
Vec2 PadAtRest<Oil>::find_near(const LateralMotion& journal, const Vec2& q) const {
  if (pad_.pivot_stiffness == 0.0) return {find_tilt(journal, 0.0, q.x()), 0.0};
  const auto tilt_at = [&](double by) { return find_tilt(journal, by, q.x()); };
  const double by = find_pressed(journal, q, tilt_at);
  return {tilt_at(by), by};
}

template <class Oil>
Vec2 PadAtRest<Oil>::find(const LateralMotion& journal, const Vec2& q) const {
  LateralMotion still = journal;
  still.v.setZero();
  const Vec2 momentary = q.isZero(0.0) ? pad_.settled(still) : Vec2(nan, nan);
  // films at a supply pressure pull a pad that touches further: the momentary one then says nothing
  const Vec2 near = find_near(still, momentary.allFinite() ? momentary : q);
  return near.allFinite() || q.isZero(0.0) ? near : find(journal, Vec2::Zero());
}

template <class Oil>
Vec2 PadAtRest<Oil>::followed(const LateralMotion& journal, const Vec2& q) const {
  const bool tilts = pad_.inertia == 0.0;
  const bool gives = pad_.pivot_stiffness > 0.0 && pad_.mass == 0.0;
  if (tilts && (gives || pad_.pivot_stiffness == 0.0)) return settled(journal, q);
  if (tilts) return {find_tilt(journal, q.y(), q.x()), q.y()};
  if (gives) return {q.x(), find_pressed(journal, q, [&](double) { return q.x(); })};
  return q;
}

template <class Oil>
Vec2 PadAtRest<Oil>::settled(const LateralMotion& journal, const Vec2& q) const {
  const std::lock_guard guard(last_.lock);
  const double slip = journal.spin - journal.housing_spin;
  if (last_.r != journal.r || last_.slip != slip || last_.from != q) {
    last_.found = find(journal, q);
    last_.r = journal.r;
    last_.slip = slip;
    last_.from = q;
  }
  return last_.found;
}

template class PadAtRest<CarriedPad>;
template class PadAtRest<CarriedGrid>;

namespace {

/// Of the journal against its housing.
template <bool Offsets>
LateralMotion motion_between(const system::NodeState& journal, const system::NodeState& housing,
                             const std::array<double, 2>& offset, const system::Context& c) {
  const typename LateralLink<Offsets>::Spins spins{system::Spin(journal), system::Spin(housing)};
  return LateralLink<Offsets>{offset}.motion({&journal, &housing}, c, spins, false);
}

/// Tilt and compression of a pad, whose nodes stand behind journal and housing.
template <bool Pressed, class Nodes>
Vec2 place_of(const Nodes& x) {
  if constexpr (Pressed)
    return {x[2]->u.x(), x[3]->u.x()};
  else
    return {x[2]->u.x(), 0.0};
}

}  // namespace

template <class Oil, bool Pressed, bool Offsets>
LateralMotion PadMount<Oil, Pressed, Offsets>::journal(const Nodes& x) const {
  LateralMotion m = motion_between<Offsets>(*x[0], *x[1], offset, {});
  m.v.setZero();
  return m;
}

template <class Oil, bool Pressed, bool Offsets>
Vec2 PadMount<Oil, Pressed, Offsets>::place(const Nodes& x) const {
  return place_of<Pressed>(x);
}

template <class Oil, bool Pressed, bool Offsets>
void PadMount<Oil, Pressed, Offsets>::add_force(const Nodes& x, const system::Context&,
                                                system::ForceX<size>& f) const {
  pad_mount::add_force<Pressed>(rest->pad(), x, f);
}

template <class Oil, bool Pressed, bool Offsets>
void PadMount<Oil, Pressed, Offsets>::add_tangent(const Nodes& x, const system::Context&,
                                                  system::TangentX<size>& t) const {
  pad_mount::add_tangent<Pressed>(rest->pad(), x, t);
}

template <class Oil, bool Pressed, bool Offsets>
void PadMount<Oil, Pressed, Offsets>::add_energy(const Nodes& x, const system::Context&,
                                                 system::Energy& e) const {
  pad_mount::add_energy<Pressed>(rest->pad(), x, e);
}

template <class Oil, bool Pressed, bool Offsets>
void PadMount<Oil, Pressed, Offsets>::relax(const Nodes& x, const system::Context&,
                                            std::array<double, own>& q) const {
  const Vec2 settled = rest->settled(journal(x), place(x));
  if (!settled.allFinite()) return;
  q[0] = settled.x();
  if constexpr (Pressed) q[1] = settled.y();
}

template struct PadMount<CarriedPad, false, false>;
template struct PadMount<CarriedPad, false, true>;
template struct PadMount<CarriedPad, true, false>;
template struct PadMount<CarriedPad, true, true>;
template struct PadMount<CarriedGrid, false, false>;
template struct PadMount<CarriedGrid, false, true>;
template struct PadMount<CarriedGrid, true, false>;
template struct PadMount<CarriedGrid, true, true>;

template <class Oil, bool Pressed, bool Offsets>
void TiltingCell<Oil, Pressed, Offsets>::relax(const Nodes& x, const system::Context& c,
                                               typename Cell::Rows& q) const {
  const LateralMotion journal = motion_between<Offsets>(*x[0], *x[1], film.offset, c);
  const Vec2 settled = rest->settled(journal, place_of<Pressed>(x));
  if (!settled.allFinite()) return film.relax(x, c, q);
  const LateralMotion seen = rest->pad().seen(journal, settled, Vec2::Zero());
  const double slip = seen.spin - seen.housing_spin;
  for (std::size_t j = 0; j < q.size(); ++j) {
    const Index row = film.block * Oil::rows_of_node + static_cast<Index>(j);
    const double content = film.pad->balanced_cell(film.cell, row, seen.r, slip);
    if (std::isfinite(content)) q[j] = content - film.pad->reference(film.cell, row);
  }
}

template <class Oil, bool Pressed, bool Offsets>
auto TiltingCell<Oil, Pressed, Offsets>::of(const std::shared_ptr<const PadAtRest<Oil>>& rest,
                                            Index i, const std::array<double, 2>& offset,
                                            Index block) -> TiltingCell {
  WHIRL_EXPECTS(rest && i >= 0 && i < rest->oil()->cells());
  TiltingCell out;
  out.rest = rest;
  out.film.pad = rest->oil();
  out.film.cell = i;
  out.film.block = block;
  out.film.offset = offset;
  for (std::size_t k = 0; k < out.film.directions.size(); ++k)
    out.film.directions[k] = rest->pad().direction(static_cast<int>(k));
  return out;
}

template struct TiltingCell<CarriedPad, false, false>;
template struct TiltingCell<CarriedPad, false, true>;
template struct TiltingCell<CarriedPad, true, false>;
template struct TiltingCell<CarriedPad, true, true>;
template struct TiltingCell<CarriedGrid, false, false>;
template struct TiltingCell<CarriedGrid, false, true>;
template struct TiltingCell<CarriedGrid, true, false>;
template struct TiltingCell<CarriedGrid, true, true>;

}  // namespace whirl::elements
