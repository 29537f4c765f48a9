// The only file that sees nlohmann-json.
#include <io/value.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

namespace whirl::io {

Value& Value::operator[](std::string_view key) {
  if (is_null()) v_ = Object{};
  auto& object = std::get<Object>(v_);
  for (auto& [k, v] : object)
    if (k == key) return v;
  return object.emplace_back(std::string(key), Value{}).second;
}

const Value& Value::at(std::string_view key) const {
  static const Value none;
  if (const auto* object = std::get_if<Object>(&v_))
    for (const auto& [k, v] : *object)
      if (k == key) return v;
  return none;
}

Value& Value::push(Value v) {
  if (is_null()) v_ = Array{};
  return std::get<Array>(v_).emplace_back(std::move(v));
}

namespace {

using Json = nlohmann::ordered_json;

Json to_library(const Value& value) {
  struct Visitor {
    Json operator()(std::monostate) const { return nullptr; }
    Json operator()(bool b) const { return b; }
    Json operator()(std::int64_t i) const { return i; }
    Json operator()(double x) const {
      if (std::isfinite(x)) return x;
      return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
    }
    Json operator()(const std::string& s) const { return s; }
    Json operator()(const Value::Array& a) const {
      Json j = Json::array();
      for (const auto& v : a)
        j.push_back(to_library(v));
      return j;
    }
    Json operator()(const Value::Object& o) const {
      Json j = Json::object();
      for (const auto& [k, v] : o)
        j[k] = to_library(v);
      return j;
    }
  };
  return std::visit(Visitor{}, value.variant());
}

}  // namespace

std::string to_json(const Value& v, int indent) {
  return to_library(v).dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace whirl::io
