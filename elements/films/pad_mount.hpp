// What a tilting pad does of itself, whatever its film: springs, dampers and inertia at its scalars
// (tilting_pad.hpp), and how its motion enters the tangent of its film. Nodes: 0 journal, 1 housing,
// then a scalar for each direction in which the centre of the pad moves: tilt, compression of the pivot.
#pragma once
#include <elements/films/tilting_pad.hpp>

#include <array>

namespace whirl::elements::pad_mount {

/// Row of a pad's scalar.
constexpr Index row_of(std::size_t k) { return 14 + 7 * static_cast<Index>(k); }

/// N m on the tilt, N on the compression.
template <bool Pressed, class Nodes, class Force>
void add_force(const TiltingPad& pad, const Nodes& x, Force& f) {
  f[row_of(0)] += pad.tilt_stiffness * x[2]->u.x() + pad.tilt_damping * x[2]->du.x() +
                  pad.inertia * x[2]->ddu.x();
  if constexpr (Pressed)
    f[row_of(1)] +=
        pad.pivot_force(x[3]->u.x()) + pad.pivot_damping * x[3]->du.x() + pad.mass * x[3]->ddu.x();
}

template <bool Pressed, class Nodes, class Tangent>
void add_tangent(const TiltingPad& pad, const Nodes& x, Tangent& t) {
  constexpr Index tilt = row_of(0);
  t.K(tilt, tilt) += pad.tilt_stiffness;
  t.C(tilt, tilt) += pad.tilt_damping;
  t.M(tilt, tilt) += pad.inertia;
  if constexpr (Pressed) {
    constexpr Index pressed = row_of(1);
    t.K(pressed, pressed) += pad.pivot_slope(x[3]->u.x());
    t.C(pressed, pressed) += pad.pivot_damping;
    t.M(pressed, pressed) += pad.mass;
  }
}

template <bool Pressed, class Nodes>
void add_energy(const TiltingPad& pad, const Nodes& x, system::Energy& e) {
  const double tilt = x[2]->u.x(), tilt_rate = x[2]->du.x();
  e.kinetic += 0.5 * pad.inertia * tilt_rate * tilt_rate;
  e.elastic += 0.5 * pad.tilt_stiffness * tilt * tilt;
  e.dissipated += pad.tilt_damping * tilt_rate * tilt_rate;
  if constexpr (Pressed) {
    const double pressed = x[3]->u.x(), pressed_rate = x[3]->du.x();
    e.kinetic += 0.5 * pad.mass * pressed_rate * pressed_rate;
    e.elastic += pad.pivot_energy(pressed);
    e.dissipated += pad.pivot_damping * pressed_rate * pressed_rate;
  }
}

/// Rows and columns of the pad's scalars in the tangent of its film, whose part at journal and housing
/// is at_ends and by: the film sees the journal less sum q_k directions_k, and gives F.directions_k back.
template <class Link, std::size_t Moves, class Tangent>
void add_film_tangent(const Link& link, const typename Link::Spins& spins,
                      const std::array<Vec2, Moves>& directions, const LateralTangent& by,
                      const system::TangentX<14>& at_ends, Tangent& t) {
  for (std::size_t i = 0; i < Moves; ++i) {
    const Vec2& a = directions[i];
    const Index row = row_of(i);
    // rows 1, 2 of the ends are -dF/dX
    t.K.template block<1, 14>(row, 0) -= a.transpose() * at_ends.K.template middleRows<2>(1);
    t.C.template block<1, 14>(row, 0) -= a.transpose() * at_ends.C.template middleRows<2>(1);
    const Vector<4> by_place = -by.r * a, by_rate = -by.v * a;
    system::ForceX<14> column = system::ForceX<14>::Zero();
    link.add_force(spins, by_place, column);
    t.K.template block<14, 1>(0, row) += column;
    column.setZero();
    link.add_force(spins, by_rate, column);
    t.C.template block<14, 1>(0, row) += column;
    for (std::size_t j = 0; j < Moves; ++j) {
      t.K(row_of(j), row) += directions[j].dot(by_place.template head<2>());
      t.C(row_of(j), row) += directions[j].dot(by_rate.template head<2>());
    }
  }
}

}  // namespace whirl::elements::pad_mount
