// The table of known units. Internal to core: read it through units::unit_table().
#pragma once
#include <core/units.hpp>

namespace whirl::units {

struct Entry {
  const char* name;
  const char* meaning;
  const char* prefixes;  ///< SI prefixes allowed before it ('u' also covers the micro signs)
  double num, den;  ///< scale to base units; ratios of exactly representable numbers where possible
  std::array<double, 6> exponent;  ///< m, kg, s, K, A, rad
  double cycles = 0;
  double offset = 0;
};

/// The unit `name` with an allowed prefix folded into its scale, or nothing.
std::optional<Quantity> find_unit(std::string_view name);
const std::vector<Entry>& entries();

struct DimensionName {
  const char* unit;
  const char* name;
};
const std::vector<DimensionName>& dimension_names();

}  // namespace whirl::units
