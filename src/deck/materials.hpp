// Built-in materials at room temperature.
#pragma once
#include <model/model.hpp>
#include <string_view>

namespace whirl::deck {

/// The built-in material of that name, or nullptr.
const model::Material* find_builtin_material(std::string_view name);
const std::vector<model::Material>& builtin_materials();

}  // namespace whirl::deck
