#include <convert/deck_values.hpp>
#include <core/units.hpp>
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

namespace whirl::convert {
namespace {

double in_unit(double x, const char* unit) {
  const units::Quantity u = units::unit(unit);
  const double scaled = x * (u.den / u.num);
  return std::strtod(fmt::format("{:.12g}", scaled).c_str(), nullptr);
}

}  // namespace

deck::Value quantity(double x, const char* unit) {
  return deck::Value::of_text(fmt::format("{} {}", in_unit(x, unit), unit));
}

deck::Value cell(double x, const char* unit) { return deck::Value::of_number(in_unit(x, unit)); }

std::string comment(const std::string& text) {
  std::string out, line = "#";
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string word = text.substr(at, end - at);
    if (line.size() + 1 + word.size() > 100) {
      out += line + "\n";
      line = "#  ";
    }
    if (!word.empty()) line += " " + word;
    at = end + 1;
  }
  return out + line + "\n";
}

std::string Names::unique(std::string wanted) {
  // names of decks go into places and file names
  for (char& c : wanted)
    if (c == ':' || c == '/' || c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20)
      c = ' ';
  const auto taken = [&](const std::string& n) {
    return std::find(used_.begin(), used_.end(), n) != used_.end();
  };
  std::string name = wanted;
  for (int k = 2; taken(name); ++k)
    name = fmt::format("{} ({})", wanted, k);
  used_.push_back(name);
  return name;
}

}  // namespace whirl::convert
