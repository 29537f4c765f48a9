// JSON schema (draft 2020-12) of decks, for editors that know TOML schemas (Even Better TOML,
// taplo).
#include <app/commands.hpp>
#include <core/units.hpp>
#include <cmath>
#include <cstdio>
#include <deck/describer.hpp>
#include <deck/reference.hpp>
#include <fmt/format.h>
#include <io/file.hpp>
#include <io/value.hpp>
#include <map>
#include <set>

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

/// The parts that occur in more than one place stand once, in "$defs", and are referred to.
class Definitions {
 public:
  /// A reference to `v`, which is called after `hint`; v itself when it is shorter than one.
  Value refer(const std::string& hint, Value v) {
    const std::string text = io::to_json(v);
    if (text.size() < shortest) return v;
    auto known = names_.find(text);
    if (known == names_.end()) {
      std::string name = hint;
      for (int n = 2; taken_.count(name); ++n)
        name = fmt::format("{} {}", hint, n);
      taken_.insert(name);
      known = names_.emplace(text, name).first;
      all_[name] = std::move(v);
    }
    Value r = Value::object();
    r["$ref"] = "#/$defs/" + escaped(known->second);
    return r;
  }
  const Value& all() const { return all_; }

 private:
  static constexpr std::size_t shortest = 120;  // characters, of JSON as it is written
  /// As a JSON pointer in a URI.
  static std::string escaped(const std::string& name) {
    std::string out;
    for (const char c : name)
      out += c == ' ' ? "%20" : std::string(1, c);
    return out;
  }
  std::map<std::string, std::string> names_;  // by content
  std::set<std::string> taken_;
  Value all_ = Value::object();
};

Value quantity(const std::string& unit, const deck::Range& range, bool plain_zero = false) {
  const units::Dimension dimension = units::unit(unit).dimension;
  if (!dimension.dimensionless()) {
    if (!plain_zero && !dimension.plain_zero()) return type("string");
    Value zero = Value::object();
    zero["const"] = 0;
    return any_of({type("string"), zero});
  }
  Value n = type("number");
  if (std::isfinite(range.min)) n[range.open_min ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) n[range.open_max ? "exclusiveMaximum" : "maximum"] = range.max;
  return any_of({n, type("string")});  // "5 %"
}

Value words(const std::vector<deck::Option>& options) {
  Value e = type("string");
  e["enum"] = Value::array();
  for (const auto& o : options)
    e["enum"].push(o.name);
  return any_of({e, parameter()});
}

/// A list, or a parameter that is one.
Value list_of(Value item, int count = -1) {
  Value v = type("array");
  v["items"] = std::move(item);
  if (count >= 0) {
    v["minItems"] = count;
    v["maxItems"] = count;
  }
  return any_of({v, parameter()});
}

/// Entry of a matrix: a quantity, or a plain 0.
Value matrix_entry() {
  Value zero = Value::object();
  zero["const"] = 0;
  return any_of({type("string"), zero});
}

class Schema {
 public:
  Value root() {
    const Value deck = table_of(deck::deck_keys(), "deck");
    Value v = Value::object();
    v["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    v["title"] = "Whirl deck, format 1";
    for (const auto& [key, value] : deck.members())
      if (key != "required") v[key] = value;
    // what the deck itself lacks may stand in a file it includes
    Value whole = Value::object(), with_files = Value::object();
    whole["required"] = deck.at("required");
    with_files["required"].push("include");
    v["anyOf"].push(whole);
    v["anyOf"].push(with_files);
    v["$defs"] = definitions_.all();
    return v;
  }

 private:
  /// One way to fill a table. open: its "type" is a parameter, so which keys belong to it is not
  /// known.
  struct Form {
    Value properties = Value::object(), required = Value::array();
    bool open = false;
  };

  Value value_of(const KeyInfo& k, const std::string& path) {
    switch (k.kind) {
      case KeyInfo::Kind::quantity: {
        Value one = quantity(k.unit, k.range, k.plain_zero);
        return k.each ? any_of({one, list_of(one)}) : one;
      }
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
      case KeyInfo::Kind::quantities: return list_of(quantity(k.unit, k.range), k.count);
      case KeyInfo::Kind::matrix: return list_of(list_of(matrix_entry(), 6), 6);
      case KeyInfo::Kind::option: return words(k.words);
      case KeyInfo::Kind::options: return list_of(words(k.words));
      case KeyInfo::Kind::table:
        return any_of({definitions_.refer(path, table_of(*k.table, path)), parameter()});
      case KeyInfo::Kind::list: {
        const Value t = definitions_.refer(path, table_of(*k.table, path));
        return any_of({list_of(t), t});
      }
      case KeyInfo::Kind::either:
        return any_of(
            {quantity(k.unit, k.range), definitions_.refer(path, table_of(*k.table, path))});
      case KeyInfo::Kind::free_table: return type("object");
      case KeyInfo::Kind::alternatives: break;
    }
    return Value::object();
  }

  void add_key(Form& form, const KeyInfo& k, const std::string& table) {
    const std::string path = table == "deck" ? k.name : table + "." + k.name;
    Value v = value_of(k, path);
    if (path == "format") {  // the one there is
      Value version = Value::object();
      version["const"] = 1;
      v = any_of({version, parameter()});
    }
    std::string doc = k.doc;
    if (k.kind == KeyInfo::Kind::quantity && !k.unit.empty()) doc += fmt::format(" [{}]", k.unit);
    if (!k.default_text.empty())
      doc += fmt::format("; default {}", k.default_text);
    else if (!k.absent.empty())
      doc += fmt::format("; left out: {}", k.absent);
    for (const auto& w : k.words)
      if (*w.doc) doc += fmt::format("\n{}: {}", w.name, w.doc);
    v["description"] = doc;
    form.properties[k.name] = definitions_.refer(path, std::move(v));
    if (k.required) form.required.push(k.name);
  }

  void add_rows(Form& form) {
    form.properties["columns"] = list_of(type("string"));
    form.properties["columns"]["description"] = "titles of the columns, \"key[unit]\"";
    form.properties["rows"] = list_of(any_of({type("array"), parameter()}));
    form.properties["file"] = type("string");
    form.properties["file"]["description"] =
        "CSV file with titled columns, instead of columns and rows";
  }

  /// Every way to fill a table whose keys join those of `start`: each "type" of it, and each "type"
  /// among the keys of that one, is a form of its own, so that editors offer the keys that belong
  /// to it.
  std::vector<Form> forms_of(const TableInfo& t, Form start, const std::string& path) {
    for (const auto& k : t.keys)
      if (k.kind != KeyInfo::Kind::alternatives) add_key(start, k, path);
    if (t.row) add_rows(start);
    std::vector<Form> forms{std::move(start)};
    for (const auto& k : t.keys) {
      if (k.kind != KeyInfo::Kind::alternatives) continue;
      std::vector<Form> longer;
      for (const Form& f : forms) {
        Form open = f;
        open.properties[k.name] = parameter();
        open.required.push(k.name);
        open.open = true;
        longer.push_back(std::move(open));
        for (const KeyInfo::Choice& c : k.choices) {
          Form chosen = f;
          Value word = Value::object();
          word["const"] = c.name;
          word["description"] = c.doc;
          chosen.properties[k.name] = std::move(word);
          chosen.required.push(k.name);
          const std::vector<Form> all =
              f.open ? std::vector{chosen}
                     : forms_of(*c.table, std::move(chosen), path + "." + c.name);
          longer.insert(longer.end(), all.begin(), all.end());
        }
      }
      forms = std::move(longer);
    }
    return forms;
  }

  Value table_of(const TableInfo& t, const std::string& path) {
    const auto object = [](const Form& f) {
      Value v = type("object");
      if (!f.open) v["additionalProperties"] = false;
      v["properties"] = f.properties;
      if (!f.required.items().empty()) v["required"] = f.required;
      return v;
    };
    const std::vector<Form> forms = forms_of(t, {}, path);
    if (forms.size() == 1) return object(forms.front());
    Value v = Value::object();
    v["oneOf"] = Value::array();
    for (const Form& f : forms)
      v["oneOf"].push(object(f));
    return v;
  }

  Definitions definitions_;
};

}  // namespace

std::string json_schema() { return io::to_json(Schema().root()); }

int print_schema(SchemaForm form) {
  const std::string text = form == SchemaForm::reference ? deck::reference_markdown()
                           : form == SchemaForm::units   ? deck::units_markdown()
                                                         : json_schema();
  std::fputs(text.c_str(), stdout);
  return static_cast<int>(Exit::ok);
}

int write_reference(const std::filesystem::path& folder) {
  for (const deck::ReferencePage& page : deck::reference_pages())
    io::write_atomic(folder / page.file, page.text);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
