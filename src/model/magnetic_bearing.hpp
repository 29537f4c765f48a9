// Active magnetic bearing: magnet, sensor, controller and amplifier, as plain values in SI.
#pragma once
#include <core/law.hpp>
#include <core/types.hpp>
#include <model/location.hpp>
#include <optional>
#include <variant>
#include <vector>

namespace whirl::model {

// ---------------------------------------------------------------- stages of a controller

/// kp + ki/s + kd s/(1 + s lag).
struct Pid {
  double kp = 0, ki = 0, kd = 0;  ///< A/m, A/(m s), A s/m
  double lag = 0;                 ///< s, of the derivative
};
/// (1 + s/zero)/(1 + s/pole).
struct LeadLag {
  double zero = 0, pole = 0;  ///< rad/s
};
/// (s^2 + 2 zeta depth w s + w^2)/(s^2 + 2 zeta w s + w^2): depth is what is left at w.
struct Notch {
  double frequency = 0;  ///< w, rad/s
  double damping = 0.5;  ///< zeta: half the width over w
  double depth = 0;
};
/// Butterworth.
struct LowPass {
  double frequency = 0;  ///< rad/s
  int order = 1;
};
/// gain (b0 + b1 s + ..)/(a0 + a1 s + ..), s in 1/s.
struct TransferFunction {
  std::vector<double> numerator, denominator;
  double gain = 0;  ///< A/m; 0: the stage has no dimension
};
/// x' = A x + B u, y = C x + D u as [A B; C D], with one input and one output, or one an axis.
struct StateSpaceStage {
  MatX matrix;
  double gain = 0;  ///< A/m; 0: the stage has no dimension
};

using ControlStage = std::variant<Pid, LeadLag, Notch, LowPass, TransferFunction, StateSpaceStage>;
/// In series; one of them turns displacement into current.
using Controller = std::vector<ControlStage>;
/// Whether a stage gives A for m.
bool gives_current(const ControlStage& s);

// ---------------------------------------------------------------- bearing

/// Two axes at right angles, each with a magnet, a sensor and a controller. The current of an axis is
/// minus what the controller makes of the displacement from the setpoint, so that positive gains
/// are positive stiffness and damping; `cross` adds, to axis 1 minus and to axis 2 plus what it
/// makes of the displacement along the other.
struct MagneticBearing {
  double per_current = 0;       ///< k_i, N/A
  double per_displacement = 0;  ///< k_s, N/m; positive: the magnet pulls more the nearer its pole
  double bias = 0, gap = 0;     ///< A, m, of the nonlinear force law; 0: the linear one
  double saturation = 0;        ///< largest force of a pair of poles, N; 0: none
  double current_limit = 0;     ///< A; 0: none
  double rate_limit = 0;        ///< of the current, A/s; 0: none
  double angle = 0;             ///< of axis 1, rad, from y towards z; axis 2 is 90 degrees further
  std::optional<Location> sensor_at;
  double sensor_bandwidth = 0;     ///< rad/s, of first order; 0: it follows at once
  double amplifier_bandwidth = 0;  ///< rad/s, of first order
  double delay = 0;                ///< s
  int delay_order = 2;             ///< of its Pade form
  Vec2 setpoint = Vec2::Zero();    ///< displacement along the axes that is held, m
  Controller control;
  Controller second;  ///< of axis 2; empty: as axis 1
  Controller cross;   ///< empty: none
  /// Displacements along both axes to what is taken from their currents, in place of the others.
  std::optional<StateSpaceStage> both;
  LawPtr power;  ///< factor on the forces; null: on

  const Controller& of_axis(std::size_t k) const {
    return k == 1 && !second.empty() ? second : control;
  }
};

}  // namespace whirl::model
