#include <assembly/control_loop.hpp>

#include <core/contract.hpp>

#include <la/dense.hpp>

#include <cmath>

namespace whirl::assembly {

using elements::StateSpace;

namespace {

StateSpace stage_of(const model::Pid& s) {
  StateSpace out = elements::make_gain(s.kp);
  if (s.ki != 0)
    out = parallel(out, elements::make_transfer(std::array{s.ki}, std::array{0.0, 1.0}));
  if (s.kd != 0)
    out = parallel(out, elements::make_transfer(std::array{0.0, s.kd}, std::array{1.0, s.lag}));
  return out;
}

StateSpace stage_of(const model::LeadLag& s) {
  return elements::make_transfer(std::array{1.0, 1.0 / s.zero}, std::array{1.0, 1.0 / s.pole});
}

StateSpace stage_of(const model::Notch& s) {
  const double w = s.frequency, width = 2.0 * s.damping * w;
  return elements::make_transfer(std::array{w * w, width * s.depth, 1.0},
                                 std::array{w * w, width, 1.0});
}

StateSpace first_order(double w) {
  return elements::make_transfer(std::array{1.0}, std::array{1.0, 1.0 / w});
}

/// Poles on a circle, in pairs at the angles pi (2k - 1)/(2n) from the imaginary axis.
StateSpace stage_of(const model::LowPass& s) {
  const double w = s.frequency;
  StateSpace out = s.order % 2 == 1 ? first_order(w) : elements::make_gain(1.0);
  for (int k = 1; k <= s.order / 2; ++k) {
    const double damping = std::sin(pi * (2 * k - 1) / (2.0 * s.order));
    out = series(out, elements::make_transfer(std::array{1.0},
                                              std::array{1.0, 2.0 * damping / w, 1.0 / (w * w)}));
  }
  return out;
}

StateSpace stage_of(const model::TransferFunction& s) {
  StateSpace out = elements::make_transfer(s.numerator, s.denominator);
  if (s.gain != 0) out = series(out, elements::make_gain(s.gain));
  return out;
}

StateSpace stage_of(const model::StateSpaceStage& s) {
  const Index n = s.matrix.rows() - 1;
  StateSpace out{s.matrix.topLeftCorner(n, n), s.matrix.topRightCorner(n, 1),
                 s.matrix.bottomLeftCorner(1, n), s.matrix.bottomRightCorner(1, 1)};
  if (s.gain != 0) out = series(out, elements::make_gain(s.gain));
  return out;
}

StateSpace on_both_axes(const StateSpace& s) { return beside(s, s); }

/// Of two inputs and two outputs, which are taken from the currents.
StateSpace controller_of_both(const model::StateSpaceStage& s) {
  const Index n = s.matrix.rows() - 2;
  return {s.matrix.topLeftCorner(n, n), s.matrix.topRightCorner(n, 2),
          -s.gain * s.matrix.bottomLeftCorner(2, n), -s.gain * s.matrix.bottomRightCorner(2, 2)};
}

/// -diag(first, second) and the cross control: -c y2 to the first, +c y1 to the second.
StateSpace make_control(const model::MagneticBearing& law) {
  if (law.both) return controller_of_both(*law.both);
  StateSpace out = beside(make_controller(law.of_axis(0)), make_controller(law.of_axis(1)));
  out.C *= -1.0;
  out.D *= -1.0;
  if (law.cross.empty()) return out;
  StateSpace cross = on_both_axes(make_controller(law.cross));
  cross.B.col(0).swap(cross.B.col(1));
  cross.D.col(0).swap(cross.D.col(1));
  cross.C.row(0) *= -1.0;
  cross.D.row(0) *= -1.0;
  return parallel(out, cross);
}

}  // namespace

StateSpace make_controller(const model::Controller& c) {
  WHIRL_EXPECTS(!c.empty());
  StateSpace out = elements::make_gain(1.0);
  for (const model::ControlStage& s : c)
    out = series(out, std::visit([](const auto& x) { return stage_of(x); }, s));
  return out;
}

ControlLoop make_control_loop(const model::MagneticBearing& law) {
  ControlLoop out;
  const Vec2 first(std::cos(law.angle), std::sin(law.angle));
  out.axis = {first, Vec2(-first.y(), first.x())};
  StateSpace way = on_both_axes(law.sensor_bandwidth > 0 ? first_order(law.sensor_bandwidth)
                                                         : elements::make_gain(1.0));
  out.sensor = law.sensor_bandwidth > 0 ? std::array<Index, 2>{0, 1} : std::array<Index, 2>{-1, -1};
  if (law.delay > 0)
    way = series(way, on_both_axes(elements::make_delay(law.delay, law.delay_order)));
  way = series(way, make_control(law));
  way = series(way, on_both_axes(first_order(law.amplifier_bandwidth)));
  const Index n = way.states();
  out.current = {n - 2, n - 1};
  out.poles = la::eigenvalues(way.A);
  out.size = sizes_of_states(way);
  // the last states are the amplifiers', whose output is their state: 1/(1 + s/w) has C = 1
  out.current_unit = law.per_displacement / law.per_current;
  out.size.tail<2>().setConstant(out.current_unit);
  out.system = rescaled(way, out.size);
  return out;
}

}  // namespace whirl::assembly
