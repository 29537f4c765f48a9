// The only file that sees nlohmann-json.
#include <core/error.hpp>
#include <io/file.hpp>
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

std::string to_json(const Value& v, int indent) {
  return to_library(v).dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

Value parse_json(std::string_view text) {
  try {
    return from_library(Json::parse(text));
  } catch (const nlohmann::json::exception& e) {
    throw Error(
        Exit::io,
        Diagnostic{
            Diagnostic::Severity::error, "E92", std::string("not JSON: ") + e.what(), {}, Where{}});
  }
}

Value read_json(const std::filesystem::path& file) { return parse_json(read_text(file)); }

}  // namespace whirl::io
