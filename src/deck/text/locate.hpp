// Places on shafts by name: "body2:mid", "body2:end-20 mm", "hp/body2:mid", "hp:end", "impeller",
// "1.14 m".
#pragma once
#include <model/model.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace whirl::deck {

struct Located {
  std::optional<model::Location> at;
  std::string code, message, hint;     ///< set when `at` is not
  std::size_t offset = 0, length = 0;  ///< bytes of the text the problem is about; length 0 = all
};

/// Sections and shafts come first, then disks and bearings of that name. A section alone means its
/// start.
Located locate(const model::Model& model, std::string_view text);

}  // namespace whirl::deck
