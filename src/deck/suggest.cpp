#include <algorithm>
#include <deck/suggest.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

using Kind = KeyShape::Kind;

units::Dimension dimension_of(const KeyShape& k) {
  return k.unit.empty() ? units::Dimension{} : units::unit(k.unit).dimension;
}

bool fits(const KeyShape& key, const ValueShape& value) {
  if (value.kind != key.kind)
    return value.kind == Kind::integer && key.kind == Kind::quantity &&
           dimension_of(key).dimensionless();
  if (key.kind != Kind::quantity) return true;
  return value.dimension ? dimension_of(key) == *value.dimension
                         : dimension_of(key).dimensionless();
}

std::string joined(const std::vector<std::string>& names, std::size_t most) {
  std::string out;
  const std::size_t n = std::min(names.size(), most);
  for (std::size_t i = 0; i < n; ++i)
    out += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == n ? " or " : ", ", names[i]);
  return out;
}

std::vector<std::string> names_of(const std::vector<KeyShape>& keys) {
  std::vector<std::string> out;
  out.reserve(keys.size());
  for (const auto& k : keys)
    out.push_back(k.name);
  return out;
}

/// outer_diameter: od. Empty of one word.
std::string initials(const std::string& name) {
  std::string out;
  for (std::size_t k = 0; k < name.size(); ++k)
    if (k == 0 || name[k - 1] == '_' || name[k - 1] == ' ') out += name[k];
  return out.size() > 1 ? out : std::string();
}

}  // namespace

ValueShape shape_of(const Value& v) {
  switch (v.kind) {
    case Value::Kind::boolean: return {Kind::flag, {}};
    case Value::Kind::integer: return {Kind::integer, {}};
    case Value::Kind::real: return {Kind::quantity, {}};
    case Value::Kind::text: {
      const units::Parsed p = units::parse(v.text);
      if (p.problem || !p.quantity.has_unit) return {Kind::text, {}};
      return {Kind::quantity, p.quantity.dimension};
    }
    default: break;
  }
  if (v.is_table()) return {Kind::table, {}};
  if (v.is_array()) return {Kind::list, {}};
  return {};
}

ValueShape shape_of_column(const std::string& unit) {
  const units::Parsed p = units::parse("1 " + unit);
  if (unit.empty() || p.problem) return {};
  return {Kind::quantity, p.quantity.dimension};
}

std::string suggest(const std::string& name, const ValueShape& value,
                    const std::vector<KeyShape>& free) {
  std::vector<KeyShape> right;
  std::copy_if(free.begin(), free.end(), std::back_inserter(right),
               [&](const KeyShape& k) { return fits(k, value); });
  const std::string shortened = initials(name);
  for (const KeyShape& k : right)
    if (!shortened.empty() && k.name == shortened) return fmt::format("did you mean '{}'?", k.name);
  if (const auto near = nearest(name, names_of(right)); !near.empty())
    return fmt::format("did you mean '{}'?", near.front());
  const auto by_spelling = nearest(name, names_of(free));
  constexpr std::size_t most = 4;  // more are no help
  if (value.dimension && !value.dimension->dimensionless() && !right.empty()) {
    const std::string of_its_kind =
        fmt::format("{} here is {}{}", units::name_of(*value.dimension),
                    joined(names_of(right), most), right.size() > most ? ", .." : "");
    return by_spelling.empty()
               ? of_its_kind
               : fmt::format("{}; near in spelling: '{}'", of_its_kind, by_spelling.front());
  }
  return by_spelling.empty() ? std::string()
                             : fmt::format("did you mean '{}'?", by_spelling.front());
}

}  // namespace whirl::deck
