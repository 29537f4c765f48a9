#include "read_json.hpp"

#include <io/file.hpp>

#include <nlohmann/json.hpp>

#include <stdexcept>

namespace whirl::tests {
namespace {

using io::Value;
using Json = nlohmann::ordered_json;

Value from_library(const Json& j) {
  switch (j.type()) {
    case Json::value_t::boolean: return j.get<bool>();
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned: return j.get<std::int64_t>();
    case Json::value_t::number_float: return j.get<double>();
    case Json::value_t::string: return j.get<std::string>();
    case Json::value_t::array: {
      Value::Array a;
      a.reserve(j.size());
      for (const auto& x : j)
        a.push_back(from_library(x));
      return a;
    }
    case Json::value_t::object: {
      Value::Object o;
      for (const auto& [k, v] : j.items())
        o.emplace_back(k, from_library(v));
      return o;
    }
    default: return {};
  }
}

}  // namespace

Value parse_json(std::string_view text) {
  try {
    return from_library(Json::parse(text));
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(std::string("not JSON: ") + e.what());
  }
}

Value read_json(const std::filesystem::path& file) { return parse_json(io::read_text(file)); }

}  // namespace whirl::tests
