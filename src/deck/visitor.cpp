#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {

bool inside(const Range& r, double x) {
  return (r.open_min ? x > r.min : x >= r.min) && (r.open_max ? x < r.max : x <= r.max);
}

std::string text_of(const Range& r) {
  const auto number = [](double x) { return units::format_number(x); };
  if (std::isfinite(r.min) && std::isfinite(r.max)) {
    if (!r.open_min && !r.open_max)
      return fmt::format("must lie between {} and {}", number(r.min), number(r.max));
    return fmt::format("must be {} {} and {} {}", r.open_min ? "greater than" : "at least",
                       number(r.min), r.open_max ? "less than" : "at most", number(r.max));
  }
  if (r.min == 0) return r.open_min ? "must be positive" : "must not be negative";
  if (std::isfinite(r.min))
    return fmt::format("must be {} {}", r.open_min ? "greater than" : "at least", number(r.min));
  if (std::isfinite(r.max))
    return fmt::format("must be {} {}", r.open_max ? "less than" : "at most", number(r.max));
  return "must be finite";
}

bool Visitor::vector(const Key& k, Vec3& target, const char* unit, const char* doc) {
  std::vector<double> v{target.x(), target.y(), target.z()};
  const bool given = quantities(k, v, unit, any, 3, doc);
  target = Vec3(v[0], v[1], v[2]);
  return given;
}

}  // namespace whirl::deck
