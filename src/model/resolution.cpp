#include <model/resolution.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::model {
namespace {

/// Of a section at one end (the softer plane).
struct EndProperties {
  double EI = 0, kGA = infinity, GJ = 0, rhoA = 0, rhoI = 0, rhoIp = 0;
};

double area_moment(double od, double id) { return pi / 64.0 * (std::pow(od, 4) - std::pow(id, 4)); }
double area(double od, double id) { return pi / 4.0 * (od * od - id * id); }

EndProperties properties_at(const Model& m, const Section& s, bool right) {
  EndProperties p;
  if (s.constants) {
    const Section::Constants& c = *s.constants;
    p = {c.EI, c.kGA > 0 ? c.kGA : infinity, c.GJ, c.rhoA, c.rhoI, c.rhoIp};
    return p;
  }
  if (s.material >= m.materials.size()) return p;
  const Material& material = m.materials[s.material];
  if (s.general) {
    const Section::General& g = *s.general;
    const double kappa = std::min(g.kappa_y, g.kappa_z);
    p.EI = material.E * std::min(g.Iy, g.Iz);
    p.kGA = kappa > 0 && s.shear != ShearFactor::none ? kappa * material.G * g.A : infinity;
    p.GJ = material.G * g.J;
    p.rhoA = material.rho * g.A;
    p.rhoI = material.rho * std::max(g.Iy, g.Iz);
    p.rhoIp = material.rho * (g.Iy + g.Iz);
  } else {
    const double mass_od = right ? s.od_r : s.od_l, mass_id = right ? s.id_r : s.id_l;
    double od = mass_od, id = mass_id;
    if (s.stiffness_diameters) {
      od = (*s.stiffness_diameters)[right ? 2 : 0];
      id = (*s.stiffness_diameters)[right ? 3 : 1];
    }
    constexpr double least_shear_factor = 0.5;  // a thin tube's
    p.EI = material.E * area_moment(od, id);
    p.kGA =
        s.shear == ShearFactor::none ? infinity : least_shear_factor * material.G * area(od, id);
    p.GJ = 2.0 * material.G * area_moment(od, id);
    p.rhoA = material.rho * area(mass_od, mass_id);
    p.rhoI = material.rho * area_moment(mass_od, mass_id);
    p.rhoIp = 2.0 * p.rhoI;
  }
  if (!s.rotary_inertia) p.rhoI = 0;
  p.rhoA += s.added_mass_per_length;
  return p;
}

/// c of the header, s^2.
double clamped_compliance(const EndProperties& p, double h) {
  const double shear = std::isfinite(p.kGA) ? 12.0 * p.EI / (p.kGA * h * h) : 0.0;
  const double by_mass = p.rhoA * std::pow(h, 4) * (1.0 + 5.0 * shear) / (720.0 * p.EI);
  const double by_rotation = p.rhoI * h * h / (12.0 * p.EI) * shear / (1.0 + shear);
  const double inertia = p.rhoI + p.rhoA * h * h / 15.0;
  const double share = inertia > 0 ? p.rhoI / inertia : 0.0;
  return (1.0 - share) * by_mass + share * by_rotation;
}

bool resolves(const EndProperties& p, double h, const Resolution& r, double accuracy) {
  if (p.EI > 0 && r.lateral * r.lateral * clamped_compliance(p, h) > 2.0 * accuracy) return false;
  const double twist = p.GJ > 0 ? r.torsional * h * std::sqrt(p.rhoIp / p.GJ) : 0.0;
  constexpr double held_by_bodies =
      1.0 / 3.0;  // of the kinetic energy in the highest mode asked for
  return twist * twist <= std::min(std::sqrt(240.0 * accuracy), 24.0 / held_by_bodies * accuracy);
}

/// Frequency of the n-th lateral mode at most, rad/s; see the header.
double lateral_bound(const Model& m, int modes) {
  double waves = 0;  // int (rhoA/EI)^(1/4) ds
  for (const Shaft& shaft : m.shafts)
    for (const Section& s : shaft.sections) {
      if (s.rigid) continue;
      const EndProperties a = properties_at(m, s, false), b = properties_at(m, s, true);
      const auto of = [](const EndProperties& p) { return std::pow(p.rhoA / p.EI, 0.25); };
      if (a.EI > 0 && b.EI > 0) waves += 0.5 * s.length * (of(a) + of(b));
    }
  const double half_waves = 0.5 * modes + 1.0;
  return waves > 0 ? std::pow(half_waves * pi / waves, 2) : 0.0;
}

/// Half-waves of torsion that a shaft free at both ends has room for at a frequency: with phi = r cos p,
/// T = -Z omega r sin p, Z = sqrt(GJ rhoIp), p grows by omega/c over a section and turns where Z jumps, and
/// as many modes lie below as p has passed multiples of pi (H. Pruefer, Math. Ann. 95, 1926, doi
/// 10.1007/BF01206624).
double torsional_half_waves(const Model& m, const Shaft& shaft, double omega) {
  double phase = 0.0, impedance = 0.0;
  for (const Section& s : shaft.sections) {
    if (s.rigid) continue;
    const EndProperties a = properties_at(m, s, false), b = properties_at(m, s, true);
    if (!(a.GJ > 0 && b.GJ > 0 && a.rhoIp > 0 && b.rhoIp > 0)) continue;
    const double here = std::pow(a.GJ * a.rhoIp * b.GJ * b.rhoIp, 0.25);
    if (impedance > 0.0) {
      const double passed = pi * std::floor(phase / pi + 0.5);
      phase = passed + std::atan(impedance / here * std::tan(phase - passed));
    }
    impedance = here;
    phase += omega * 0.5 * s.length * (std::sqrt(a.rhoIp / a.GJ) + std::sqrt(b.rhoIp / b.GJ));
  }
  return phase / pi;
}

/// Frequency of the n-th elastic torsional mode at most, rad/s: bodies lower what the bare shafts have, a
/// tie between two shafts raises one mode at most to the next.
double torsional_bound(const Model& m, int modes) {
  double time = 0;  // int sqrt(rhoIp/GJ) ds
  for (const Shaft& shaft : m.shafts)
    for (const Section& s : shaft.sections) {
      if (s.rigid) continue;
      const EndProperties a = properties_at(m, s, false), b = properties_at(m, s, true);
      if (a.GJ > 0 && b.GJ > 0)
        time += 0.5 * s.length * (std::sqrt(a.rhoIp / a.GJ) + std::sqrt(b.rhoIp / b.GJ));
    }
  if (!(time > 0)) return 0.0;
  const double wanted = modes + static_cast<double>(m.shafts.size()) - 1.0;
  constexpr double rounding = 1e-9;
  const auto reached = [&](double omega) {
    double count = 0;
    for (const Shaft& shaft : m.shafts)
      count += std::floor(torsional_half_waves(m, shaft, omega) + rounding);
    return count >= wanted;
  };
  double low = 0.0, high = wanted * pi / time;
  if (reached(high)) return high;
  do {
    low = high;
    high *= 1.5;
  } while (!reached(high));
  constexpr double close_enough = 1e-3;
  while (high - low > close_enough * high)
    (reached(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  return high;
}

double top_of(const SpeedRange& r) {
  double top = std::max(std::abs(r.start), std::abs(r.stop));
  for (const double x : r.values)
    top = std::max(top, std::abs(x));
  return top;
}

double top_of(const FrequencyRange& r) {
  double top = std::max(r.start, r.stop);
  for (const double x : r.values)
    top = std::max(top, x);
  return top;
}

double largest(const std::vector<double>& orders) {
  double n = 1;
  for (const double x : orders)
    n = std::max(n, std::abs(x));
  return n;
}

/// Of the fastest shaft, over the reference; at least 1.
double largest_ratio(const Model& m) {
  double most = 1;
  for (const Shaft& s : m.shafts)
    if (s.rotating) most = std::max(most, std::abs(s.speed_ratio));
  return most;
}

/// Highest spin a transient is known to reach, rad/s; 0: nothing says.
double top_speed(const Model& m, const Step& step, const TransientStep& law) {
  const double ratio = largest_ratio(m);
  double top = ratio * std::max(std::abs(law.speed0), std::abs(law.stop_speed.value_or(0.0)));
  for (const Shaft& s : m.shafts)
    top = std::max(top, std::abs(s.spin0));
  for (const Drive& d : m.drives) {
    if (!d.step.empty() && d.step != step.name) continue;
    if (const auto* spin = std::get_if<PrescribedSpin>(&d.law)) {
      constexpr int looks = 64;
      for (int k = 0; k <= looks; ++k)
        top = std::max(top, std::abs(spin->angle->at(law.duration * k / looks).df));
    } else if (const auto& curve = std::get<TorqueCurve>(d.law); curve.governor) {
      top = std::max(top, std::abs(curve.governor->target));
    }
  }
  for (const Event& e : m.events)
    if (e.kind == Event::Kind::speed) top = std::max(top, ratio * std::abs(e.value));
  return top;
}

/// What each kind of step asks for.
struct Demand {
  const Model& m;
  const Step& step;

  /// Up to a number of modes, but not beyond a frequency.
  Resolution modes(int count, double max_frequency, MotionKind motion) const {
    Resolution r;
    if (motion != MotionKind::torsional)
      r.lateral = std::min(lateral_bound(m, count), max_frequency);
    if (motion != MotionKind::lateral)
      r.torsional = std::min(torsional_bound(m, count), max_frequency);
    // In a list of all motions the first `count` end where either kind alone would reach it.
    if (motion == MotionKind::all) {
      const double both = std::min(r.lateral, r.torsional);
      if (both > 0) r.lateral = r.torsional = both;
    }
    return r;
  }

  Resolution operator()(const StaticStep& s) const {
    Resolution r;
    if (s.path || s.load_steps > 1) r.half_waves = 1;
    return r;
  }
  Resolution operator()(const ModalStep& s) const {
    return modes(s.modes, s.max_frequency, s.motion);
  }
  Resolution operator()(const CampbellStep& s) const {
    return modes(s.modes, s.max_frequency, s.motion);
  }
  Resolution operator()(const CriticalStep& s) const {
    return modes(s.modes,
                 s.max_speed > 0 ? s.max_speed * largest(orders_of(m, s.orders)) : infinity,
                 s.motion);
  }
  Resolution operator()(const CriticalMapStep& s) const {
    return {std::abs(s.max_speed * s.order), 0.0, 0};
  }
  Resolution operator()(const StabilityStep& s) const {
    return modes(s.modes, infinity, MotionKind::all);
  }
  Resolution operator()(const UnbalanceStep& s) const {
    return {largest_ratio(m) * top_of(s.speed), 0.0, 0};
  }
  Resolution operator()(const HarmonicStep& s) const {
    double top = s.frequency ? top_of(*s.frequency) : 0.0;
    if (s.speeds) top = std::max(top, std::abs(s.order) * top_of(*s.speeds));
    return {top, top, 0};
  }
  Resolution operator()(const SensitivityStep& s) const {
    const double top = top_of(s.frequency);
    return {top, top, 0};
  }
  Resolution operator()(const TorsionalStep& s) const {
    return {0.0, torsional_bound(m, s.modes), 0};
  }
  Resolution operator()(const ApiLateralStep& s) const {
    return {largest_ratio(m) * s.max_speed, 0.0, 0};
  }
  Resolution operator()(const BalancingStep& s) const {
    return {largest_ratio(m) * largest(s.speeds), 0.0, 0};
  }
  Resolution operator()(const ApiTorsionalStep& s) const {
    return {0.0, torsional_bound(m, s.modes), 0};
  }
  Resolution operator()(const BucklingStep& s) const {
    return {0.0, 0.0, std::max(1, (s.modes + 1) / 2)};
  }
  Resolution operator()(const TransientStep& s) const {
    constexpr int modes_in_motion = 4;      // where nothing says how fast it turns
    constexpr double above_the_spin = 1.5;  // what unbalance, gyroscopic effect and films excite
    const double top = above_the_spin * top_speed(m, step, s);
    const double lateral = top > 0 ? top : lateral_bound(m, modes_in_motion);
    return {lateral, lateral, 0};
  }
};

}  // namespace

std::vector<double> orders_of(const Model& model, const std::vector<double>& asked) {
  if (!asked.empty()) return asked;
  std::vector<double> ratios;
  for (const Shaft& s : model.shafts)
    if (s.rotating && s.speed_ratio != 0.0) ratios.push_back(std::abs(s.speed_ratio));
  if (ratios.empty()) ratios.push_back(1.0);
  std::sort(ratios.begin(), ratios.end());
  const auto same = [](double a, double b) { return b - a < 1e-9 * b; };
  ratios.erase(std::unique(ratios.begin(), ratios.end(), same), ratios.end());
  return ratios;
}

Resolution resolution_of(const Model& m) {
  Resolution all;
  for (const Step& step : m.steps) {
    const Resolution r = std::visit(Demand{m, step}, step.law);
    all.lateral = std::max(all.lateral, r.lateral);
    all.torsional = std::max(all.torsional, r.torsional);
    all.half_waves = std::max(all.half_waves, r.half_waves);
  }
  return all;
}

bool mesh_is_chosen(const Model& m, const Section& s) {
  return !s.rigid && m.min_elements == 0 && s.min_elements == 0 &&
         !std::isfinite(m.max_element_length) && !std::isfinite(s.max_element_length);
}

double longest_element(const Model& m, const Shaft& shaft, const Section& s, const Resolution& r) {
  if (!mesh_is_chosen(m, s)) return std::min(s.max_element_length, m.max_element_length);
  constexpr int most = 100;  // elements of a section
  const EndProperties a = properties_at(m, s, false), b = properties_at(m, s, true);
  const auto fine = [&](double h) {
    return resolves(a, h, r, m.mesh_accuracy) && resolves(b, h, r, m.mesh_accuracy);
  };
  double h = infinity;
  if (!fine(s.length)) {
    int n = 2;
    while (n < most && !fine(s.length / n))
      ++n;
    h = s.length / n;
  }
  if (r.half_waves > 0) {
    const double a_half_wave = 8.0 * std::pow(1e-3 / m.mesh_accuracy, 0.25);  // elements
    h = std::min(h, shaft.length() / (a_half_wave * r.half_waves));
  }
  return std::max(h, s.length / most);
}

}  // namespace whirl::model
