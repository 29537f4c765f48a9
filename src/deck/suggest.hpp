// "Did you mean": of the keys a table may have, those that fit the value that was written come
// first, and among them those that are near in spelling; a name alone decides only where no key
// takes such a value.
#pragma once
#include <core/units.hpp>
#include <deck/text/document.hpp>
#include <optional>
#include <string>
#include <vector>

namespace whirl::deck {

/// What kind of value a key takes.
struct KeyShape {
  enum class Kind { other, quantity, integer, flag, text, list, table };
  std::string name;
  Kind kind = Kind::other;
  std::string unit;  ///< of quantities; "" = plain number
};

/// What was written: the value of a key, or the cells of a column.
struct ValueShape {
  KeyShape::Kind kind = KeyShape::Kind::other;
  std::optional<units::Dimension> dimension;  ///< of quantities with a unit
};
ValueShape shape_of(const Value& v);
/// Of a column of cells in this unit (nothing: any cells).
ValueShape shape_of_column(const std::string& unit);

/// A hint for an unknown name, or empty. free: the keys that are not given yet.
std::string suggest(const std::string& name, const ValueShape& value,
                    const std::vector<KeyShape>& free);

}  // namespace whirl::deck
