#include <python/toml_text.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace py = pybind11;

namespace whirl::python {

namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (byte < 0x20 || byte == 0x7f)
      out += fmt::format("\\u{:04X}", byte);
    else
      out += c;
  }
  return out + '"';
}

std::string key_text(const std::string& key) {
  const auto bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), bare) ? key : quoted(key);
}

std::string real_text(double x, const std::string& place) {
  if (!std::isfinite(x))
    throw py::value_error(fmt::format("{}: {} is no number a deck can hold", place, x));
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// A NumPy array or scalar as what Python has for it; anything else as it is.
py::object plain(const py::handle& value) {
  if (py::hasattr(value, "tolist") && py::hasattr(value, "dtype")) return value.attr("tolist")();
  return py::reinterpret_borrow<py::object>(value);
}

bool is_list(const py::handle& value) {
  return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
}

std::string inline_text(const py::handle& given, const std::string& place) {
  const py::object value = plain(given);
  if (py::isinstance<py::str>(value)) return quoted(value.cast<std::string>());
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::int_>(value)) return py::str(value).cast<std::string>();
  if (py::isinstance<py::float_>(value)) return real_text(value.cast<double>(), place);
  std::string out;
  if (is_list(value)) {
    std::size_t k = 0;
    for (const py::handle item : value)
      out += (out.empty() ? "" : ", ") + inline_text(item, fmt::format("{}[{}]", place, k++));
    return "[" + out + "]";
  }
  if (py::isinstance<py::dict>(value)) {
    for (const auto& [key, item] : value.cast<py::dict>()) {
      const std::string name = py::str(key).cast<std::string>();
      out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", key_text(name),
                         inline_text(item, fmt::format("{}.{}", place, name)));
    }
    return "{" + out + "}";
  }
  throw py::type_error(
      fmt::format("{}: a deck holds text, numbers, flags, lists and tables, not {}", place,
                  py::str(py::type::of(value)).cast<std::string>()));
}

bool is_list_of_tables(const py::handle& value) {
  if (!is_list(value) || py::len(value) == 0) return false;
  for (const py::handle item : value)
    if (!py::isinstance<py::dict>(item)) return false;
  return true;
}

/// Scalars and lists of a table, one line each; then the lists of tables, one table a heading.
void write_table(const py::dict& table, const std::string& heading, const std::string& place,
                 std::string& out) {
  if (!heading.empty()) out += "\n" + heading + "\n";
  for (const auto& [key, given] : table) {
    const std::string name = py::str(key).cast<std::string>();
    if (heading.empty() && (is_list_of_tables(given) || py::isinstance<py::dict>(given))) continue;
    out +=
        fmt::format("{} = {}\n", key_text(name),
                    inline_text(given, place.empty() ? name : fmt::format("{}.{}", place, name)));
  }
}

}  // namespace

std::string toml_of_value(const py::handle& value, const std::string& place) {
  return inline_text(value, place);
}

std::string toml_of_deck(const py::dict& deck) {
  std::string out;
  write_table(deck, "", "", out);
  for (const auto& [key, given] : deck) {
    const std::string name = py::str(key).cast<std::string>();
    if (py::isinstance<py::dict>(given)) {
      write_table(given.cast<py::dict>(), fmt::format("[{}]", key_text(name)), name, out);
    } else if (is_list_of_tables(given)) {
      std::size_t k = 0;
      for (const py::handle item : given)
        write_table(item.cast<py::dict>(), fmt::format("[[{}]]", key_text(name)),
                    fmt::format("{}[{}]", name, k++), out);
    }
  }
  return out;
}

}  // namespace whirl::python
