// Handbook values at 20 C, rounded as design offices use them (steel: EN 1993-1-1, 3.2.6;
// stainless: EN 10088-1 for 1.4301; titanium Ti-6Al-4V, aluminium 6061-T6, Inconel 718: MIL-HDBK-5J
// chapters 5, 3, 6; cast iron: EN 1563, EN-GJS-400). A deck that needs others, or other
// temperatures, gives [[material]].
#include <deck/materials.hpp>

namespace whirl::deck {
namespace {

model::Material make(const char* name, double E, double nu, double rho) {
  model::Material m;
  m.name = name;
  m.E = E;
  m.nu = nu;
  m.G = E / (2 * (1 + nu));
  m.rho = rho;
  return m;
}

}  // namespace

const std::vector<model::Material>& builtin_materials() {
  static const std::vector<model::Material> t = {
      make("steel", 210e9, 0.3, 7850),        make("stainless_steel", 200e9, 0.3, 7900),
      make("titanium", 110e9, 0.31, 4430),    make("aluminium", 68.3e9, 0.33, 2710),
      make("inconel_718", 203e9, 0.29, 8220), make("cast_iron", 169e9, 0.275, 7100),
  };
  return t;
}

const model::Material* find_builtin_material(std::string_view name) {
  for (const auto& m : builtin_materials())
    if (m.name == name) return &m;
  return nullptr;
}

}  // namespace whirl::deck
