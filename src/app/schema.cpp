// JSON schema (draft 2020-12) of decks, for editors that know TOML schemas (Even Better TOML, taplo).
#include <app/commands.hpp>
#include <core/units.hpp>
#include <cmath>
#include <cstdio>
#include <deck/describer.hpp>
#include <fmt/format.h>
#include <io/value.hpp>

namespace whirl::app {
namespace {

using deck::KeyInfo;
using deck::TableInfo;
using io::Value;

Value type(const char* name) {
  Value v = Value::object();
  v["type"] = name;
  return v;
}

Value any_of(std::vector<Value> list) {
  Value v = Value::object();
  v["anyOf"] = Value(Value::Array(list.begin(), list.end()));
  return v;
}

/// "${name}", where the value itself would not be a string.
Value parameter() {
  Value v = type("string");
  v["pattern"] = "\\$\\{[^}]+\\}";
  return v;
}

Value quantity(const std::string& unit, const deck::Range& range) {
  if (!unit.empty() && !units::unit(unit).dimension.dimensionless()) return type("string");
  Value n = type("number");
  if (std::isfinite(range.min)) n[range.open_min ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) n[range.open_max ? "exclusiveMaximum" : "maximum"] = range.max;
  return any_of({n, type("string")});   // "5 %"
}

Value words(const std::vector<deck::Option>& options) {
  Value e = type("string");
  e["enum"] = Value::array();
  for (const auto& o : options) e["enum"].push(o.name);
  return any_of({e, parameter()});
}

Value list_of(Value item, int count = -1) {
  Value v = type("array");
  v["items"] = std::move(item);
  if (count >= 0) { v["minItems"] = count; v["maxItems"] = count; }
  return v;
}

Value table_of(const TableInfo& t);

Value value_of(const KeyInfo& k) {
  switch (k.kind) {
    case KeyInfo::Kind::quantity: return quantity(k.unit, k.range);
    case KeyInfo::Kind::integer: {
      Value v = type("integer");
      if (std::isfinite(k.range.min)) v["minimum"] = k.range.min;
      if (std::isfinite(k.range.max)) v["maximum"] = k.range.max;
      return any_of({v, parameter()});
    }
    case KeyInfo::Kind::flag: return any_of({type("boolean"), parameter()});
    case KeyInfo::Kind::text:
    case KeyInfo::Kind::location:
    case KeyInfo::Kind::reference: return type("string");
    case KeyInfo::Kind::texts: return list_of(type("string"));
    case KeyInfo::Kind::quantities: return any_of({list_of(quantity(k.unit, k.range), k.count), parameter()});
    case KeyInfo::Kind::matrix: return list_of(list_of(any_of({type("string"), type("number")}), 6), 6);
    case KeyInfo::Kind::option: return words(k.words);
    case KeyInfo::Kind::options: return list_of(words(k.words));
    case KeyInfo::Kind::table: return any_of({table_of(*k.table), parameter()});
    case KeyInfo::Kind::list: {
      const Value t = table_of(*k.table);
      return any_of({list_of(t), t});
    }
    case KeyInfo::Kind::either: return any_of({k.unit.empty() ? any_of({type("number"), type("string")}) : type("string"), table_of(*k.table)});
    case KeyInfo::Kind::free_table: return type("object");
    case KeyInfo::Kind::alternatives: break;
  }
  return Value::object();
}

void add_key(Value& properties, Value& required, const KeyInfo& k) {
  Value v = value_of(k);
  std::string doc = k.doc;
  if (k.kind == KeyInfo::Kind::quantity && !k.unit.empty()) doc += fmt::format(" [{}]", k.unit);
  if (!k.default_text.empty()) doc += fmt::format("; default {}", k.default_text);
  else if (!k.absent.empty()) doc += fmt::format("; left out: {}", k.absent);
  for (const auto& w : k.words)
    if (*w.doc) doc += fmt::format("\n{}: {}", w.name, w.doc);
  v["description"] = doc;
  properties[k.name] = std::move(v);
  if (k.required) required.push(k.name);
}

void add_keys(Value& properties, Value& required, const TableInfo& t) {
  for (const auto& k : t.keys)
    if (k.kind != KeyInfo::Kind::alternatives) add_key(properties, required, k);
  if (t.row) {
    properties["columns"] = list_of(type("string"));
    properties["columns"]["description"] = "titles of the columns, \"key[unit]\"";
    properties["rows"] = list_of(type("array"));
    properties["file"] = type("string");
    properties["file"]["description"] = "CSV file with titled columns, instead of columns and rows";
  }
}

/// Tables with a "type" become one object per type: then editors offer the keys that belong to it.
Value table_of(const TableInfo& t) {
  const KeyInfo* fork = nullptr;
  for (const auto& k : t.keys)
    if (k.kind == KeyInfo::Kind::alternatives) fork = &k;
  const auto object = [&](const KeyInfo::Choice* choice) {
    Value v = type("object");
    v["additionalProperties"] = false;
    Value properties = Value::object(), required = Value::array();
    add_keys(properties, required, t);
    if (choice) {
      Value word = Value::object();
      word["const"] = choice->name;
      word["description"] = choice->doc;
      properties[fork->name] = std::move(word);
      required.push(fork->name);
      add_keys(properties, required, *choice->table);
    }
    v["properties"] = std::move(properties);
    if (!required.items().empty()) v["required"] = std::move(required);
    return v;
  };
  if (!fork) return object(nullptr);
  Value v = Value::object();
  v["oneOf"] = Value::array();
  for (const auto& c : fork->choices) v["oneOf"].push(object(&c));
  return v;
}

}  // namespace

std::string json_schema() {
  Value v = table_of(deck::deck_keys());
  Value root = Value::object();
  root["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  root["title"] = "Whirl deck, format 1";
  for (const auto& [key, value] : v.members()) root[key] = value;
  return io::to_json(root);
}

int print_schema(SchemaForm form) {
  const std::string text = form == SchemaForm::reference ? deck::reference_markdown() : form == SchemaForm::units ? deck::units_markdown() : json_schema();
  std::fputs(text.c_str(), stdout);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
