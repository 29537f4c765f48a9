// Pieces of decks.
#pragma once
#include <deck/text/document.hpp>
#include <string>

namespace whirl::convert {

/// x in a unit ("206.8 GPa"): twelve digits, so that 0.0355 m are 35.5 mm.
deck::Value quantity(double x, const char* unit);
/// The number alone, for a column of that unit.
deck::Value cell(double x, const char* unit);
/// "# " before every line of a text, wrapped at 100 columns.
std::string comment(const std::string& text);
/// A name that is not in use yet: "disk", "disk (2)", ...; and the names so far.
class Names {
 public:
  std::string unique(std::string wanted);

 private:
  std::vector<std::string> used_;
};

}  // namespace whirl::convert
