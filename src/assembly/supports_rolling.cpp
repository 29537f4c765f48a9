// Ball and roller bearings.
#include <assembly/support_parts.hpp>
#include <elements/rolling/hertz.hpp>
#include <elements/rolling/rolling_bearing.hpp>

#include <cmath>

namespace whirl::assembly {
namespace {

template <class Bearing>
void add_rolling(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                 const Bearing& k, const char* kind) {
  add_joint(a, b, n, k, kind);
  const Pair nodes{n.shaft.node, n.other.node};
  a.built.rolling_loads.push_back(
      {b.name, [k, nodes, off = std::array{n.shaft.offset, n.other.offset}](const NodeAt& at) {
         const elements::AtOffset<Bearing> shift{k, off};
         const typename elements::AtOffset<Bearing>::Shifted x(shift, nodes_of(at, nodes));
         const Vector<6> q = k.deflection(x.nodes);
         const std::vector<double> loads = k.loads(q);
         std::vector<RollingLoads::Element> out;
         for (std::size_t j = 0; j < loads.size(); ++j) {
           const double angle =
               q[5] + two_pi * static_cast<double>(j) / static_cast<double>(loads.size());
           out.push_back({angle - two_pi * std::floor(angle / two_pi), loads[j]});
         }
         return out;
       }});
}

}  // namespace

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::BallBearing& law) {
  guarded(a, b, [&] {
    elements::BallGeometry g;
    g.balls = law.balls;
    g.ball_diameter = law.ball_diameter;
    g.pitch_diameter = law.pitch_diameter;
    g.contact_angle = law.contact_angle;
    g.radial_clearance = law.clearance;
    g.f_inner = law.f_inner;
    g.f_outer = law.f_outer;
    g.direction = law.direction;
    g.stiffness = law.stiffness;
    elements::BallBearing k = elements::make_ball_bearing(g);
    if (law.preload > 0) elements::set_axial_preload(k, law.preload);
    k.c_radial = law.c_radial;
    k.c_axial = law.c_axial;
    add_rolling(a, b, n, k, "ball bearings");
  });
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::RollerBearing& law) {
  guarded(a, b, [&] {
    elements::RollerBearing k =
        elements::make_roller_bearing({law.rollers, law.roller_diameter, law.roller_length,
                                       law.pitch_diameter, law.clearance, law.stiffness});
    k.c_radial = law.c_radial;
    k.c_axial = law.c_axial;
    add_rolling(a, b, n, k, "roller bearings");
  });
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::RollingEstimate& law) {
  add_law(a, b, n, linear_form(law));
}

}  // namespace whirl::assembly
