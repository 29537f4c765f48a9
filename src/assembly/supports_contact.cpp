// Nonlinear springs and contacts.
#include <assembly/support_parts.hpp>
#include <elements/supports/nonlinear_spring.hpp>
#include <elements/supports/rub.hpp>

namespace whirl::assembly {
namespace {

elements::ForceCurve curve_of(const model::ForceLaw& f) {
  using Shape = model::ForceLaw::Shape;
  switch (f.shape) {
    case Shape::table: return elements::ForceCurve::table(f.q, f.F, f.monotone_cubic);
    case Shape::clearance:
      return elements::ForceCurve::clearance(f.gap_minus, f.gap_plus, f.stiffness, f.smooth);
    case Shape::one_sided:
      return elements::ForceCurve::one_sided(f.gap_plus, f.stiffness, f.smooth);
    case Shape::polynomial: break;
  }
  return elements::ForceCurve::polynomial(f.coefficients);
}

}  // namespace

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::NonlinearSpring& law) {
  using Along = model::NonlinearSpring::Along;
  elements::ForceCurvePtr F, D;
  const bool made = guarded(a, b, [&] {
    F = std::make_shared<elements::ForceCurve>(curve_of(law.force));
    D = std::make_shared<elements::ForceCurve>(
        elements::ForceCurve::polynomial({law.damping, 0.0, law.damping2}));
  });
  if (!made) return;
  const char* kind = "nonlinear springs";
  const Vec3 axes[3] = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const auto translation = [&](const Vec3& e) {
    add_joint(a, b, n, elements::ScalarSpring<3>::translation(e, F, D), kind);
  };
  switch (law.along) {
    case Along::x: return translation(axes[0]);
    case Along::y: return translation(axes[1]);
    case Along::z: return translation(axes[2]);
    case Along::radial: return add_joint(a, b, n, elements::RadialSpring{F, D}, kind);
    case Along::ry:
      return add_joint(a, b, n, elements::ScalarSpring<7>::tilt(axes[1], axes[0], F, D),
                       "nonlinear angular springs");
    case Along::rz:
      return add_joint(a, b, n, elements::ScalarSpring<7>::tilt(axes[2], axes[0], F, D),
                       "nonlinear angular springs");
    case Along::rx:
      return add_joint(a, b, n, elements::ScalarSpring<7>::twist(F, D),
                       "nonlinear angular springs");
  }
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::Rub& law) {
  elements::RubLaw k;
  k.gap = law.gap;
  k.stiffness = law.stiffness;
  k.damping = law.damping;
  k.friction = law.friction;
  k.slip_speed = law.slip_speed;
  k.radius = law.diameter > 0 ? 0.5 * law.diameter : a.mesh.radius(a.model, b.at.shaft, b.at.s);
  if (law.friction > 0 && !(k.radius > 0)) {
    a.error(
        "E05",
        fmt::format(
            "{}: friction needs the diameter of the rubbing surface, and the shaft has none there",
            name_of(b)),
        "diameter = \"80 mm\"", b, name_of(b));
    return;
  }
  add_lateral(a, b, n, k, "contacts");
  a.built.conditions.push_back(
      {number_of(a, b), b.name, b.where, [r = displacement_of(n), k](const NodeAt& at) {
         SupportCondition::State s;
         s.gap = k.gap;
         s.displacement = r(at).norm();
         s.load = k.stiffness * std::max(0.0, s.displacement - k.gap);
         return s;
       }});
}

}  // namespace whirl::assembly
