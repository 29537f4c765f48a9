// A base that turns: one more element beside every inertia.
#include <assembly/parts.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/rigid/turning_base.hpp>
#include <elements/loads/unbalance.hpp>

namespace whirl::assembly {
namespace {

template <system::Kernel K>
void turn(Assembly& a, const elements::TurningBasePtr& base) {
  const system::Batch<K>* inertias = a.builder.batch<K>();
  if (!inertias) return;
  for (std::size_t i = 0; i < inertias->count(); ++i) {
    const auto& nodes = inertias->nodes()[i];
    std::array<Vec3, K::n_nodes> position;
    for (std::size_t k = 0; k < position.size(); ++k)
      position[k] = a.builder.node(nodes[k]).position;
    a.builder.add(elements::OnTurningBase<K>(inertias->elements()[i], base, position), nodes,
                  "inertia on a turning base");
  }
}

}  // namespace

void add_turning_base(Assembly& a) {
  const auto& t = a.model.base.turn;
  if (!t) return;
  auto base = std::make_shared<elements::TurningBase>();
  base->axis = t->axis;
  base->about = t->about;
  base->rate = t->rate;
  base->gravity = a.model.gravity;
  a.take_breakpoints(t->rate);
  turn<elements::ShaftBeam<false>>(a, base);
  turn<elements::ShaftBeam<true>>(a, base);
  turn<elements::GeneralBeam>(a, base);
  turn<elements::RigidDisk>(a, base);
  turn<elements::RigidBody>(a, base);
  turn<elements::PointMass>(a, base);
  turn<elements::UnbalanceMass>(a, base);
}

}  // namespace whirl::assembly
