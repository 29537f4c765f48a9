// A magnetic bearing's way from displacement to current: sensor, delay, controller and amplifier as
// one linear system of signals. Internal to src/assembly.
#pragma once
#include <elements/magnetic/transfer.hpp>
#include <model/magnetic_bearing.hpp>
#include <array>

namespace whirl::assembly {

/// Displacements along the two axes, m, to control currents. Its states are counted in units in
/// which they are about as large as the displacement.
struct ControlLoop {
  elements::StateSpace system;   ///< C picks the amplifiers' states, D = 0
  VecX size;                     ///< units of the states
  VecXc poles;                   ///< 1/s
  std::array<Vec2, 2> axis;      ///< in (y, z)
  std::array<Index, 2> sensor;   ///< states of the sensors; -1: they follow at once
  std::array<Index, 2> current;  ///< states of the amplifiers
  double current_unit = 1;       ///< A, of their states
};

/// One controller: displacement, m, to current, A.
/// @throws Error E84: a fraction that is none, or not proper.
elements::StateSpace make_controller(const model::Controller& c);
/// @throws Error as make_controller.
ControlLoop make_control_loop(const model::MagneticBearing& law);

}  // namespace whirl::assembly
