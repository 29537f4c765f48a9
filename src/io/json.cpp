// The only file that sees nlohmann-json.
#include <core/error.hpp>
#include <io/json.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

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

// What no document of an engineer reaches and no stack notices.
constexpr int deepest = 256;

Value from_library(const Json& json, int depth = 0) {
  if (depth > deepest) throw std::length_error("nested more than 256 deep");
  switch (json.type()) {
    case Json::value_t::boolean: return json.get<bool>();
    case Json::value_t::number_integer: return json.get<std::int64_t>();
    case Json::value_t::number_unsigned: return json.get<std::uint64_t>();
    case Json::value_t::number_float: return json.get<double>();
    case Json::value_t::string: return json.get<std::string>();
    case Json::value_t::array: {
      Value list = Value::array();
      for (const Json& item : json)
        list.push(from_library(item, depth + 1));
      return list;
    }
    case Json::value_t::object: {
      Value object = Value::object();
      for (const auto& [key, item] : json.items())
        object[key] = from_library(item, depth + 1);
      return object;
    }
    default: return {};
  }
}

}  // namespace

Value parse_json(std::string_view text, std::string_view name) {
  const auto refused = [&](std::string why, std::size_t byte) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    const Where where{std::string(name), static_cast<int>(line), 0, 0, {}};
    return Error(Exit::io,
                 Diagnostic{Diagnostic::Severity::error, "E92", std::move(why), {}, where});
  };
  try {
    return from_library(Json::parse(text));
  } catch (const Json::parse_error& e) {
    throw refused("this is not JSON", e.byte);
  } catch (const Json::out_of_range& e) {  // the one that parsing throws: a number beyond 1e308
    const std::string what = e.what();
    const auto open = what.find('\'');
    const std::string number = what.substr(open + 1, what.rfind('\'') - open - 1);
    throw refused("the number " + number + " is beyond what a double holds", text.find(number));
  } catch (const std::length_error& e) {
    throw refused(e.what(), 0);
  }
}

std::string to_json(const Value& v, int indent) {
  return to_library(v).dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace whirl::io
