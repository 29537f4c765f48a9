#include <deck/reader.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

std::string shown_text(const Value& v) {
  switch (v.kind) {
    case Value::Kind::boolean: return v.boolean ? "true" : "false";
    case Value::Kind::integer: return fmt::format("{}", v.integer);
    case Value::Kind::real: return units::format_number(v.real);
    case Value::Kind::text: return fmt::format("\"{}\"", v.text);
    default: return name_of(v.kind);
  }
}

int characters(std::string_view s) {
  return static_cast<int>(std::count_if(
      s.begin(), s.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

Reader::Reader(Sources& sources, Diagnostics& diagnostics, Parameters& parameters,
               const Document& document, model::Model& model)
    : sources_(sources),
      diagnostics_(diagnostics),
      parameters_(parameters),
      document_(document),
      model_(model) {}

const model::Model& Reader::model() const { return model_; }

void Reader::read() {
  in_table("", document_.root, &resolved_, nullptr, [&](Visitor& v) { describe(v, model_); });
  settle_steps();
  // what is not said beside another error is said where there is none
  if (withheld_ && diagnostics_.errors() == 0)
    diagnostics_.error(withheld_->code.c_str(), withheld_->spot, withheld_->message,
                       withheld_->hint, withheld_->entity);
}

// ---------------------------------------------------------------- keys

const Member* Reader::find(const Key& k) {
  Scope& s = scope();
  s.known.emplace_back(k.name);
  const Member* m = s.table->find(k.name);
  if (m && m->value.kind == Value::Kind::unreadable) s.dirty = true;
  if (!m && k.required) {
    s.dirty = true;
    if (s.header)
      problem("E05", *s.header, fmt::format("the column '{}' is missing", k.name));
    else if (!document_.damaged)
      problem("E05", s.table->spot,
              s.table == &document_.root
                  ? fmt::format("the key '{}' is missing", k.name)
                  : fmt::format("{} lacks the key '{}'", s.entity.empty() ? "the table" : s.entity,
                                k.name));
  }
  return m;
}

void Reader::put(const Key& k, Value v) {
  if (!scope().resolved || v.kind == Value::Kind::unreadable) return;
  const Member* given = scope().table->find(k.name);
  if (given && given->value.is_text() && v.varied.empty() && !v.is_array() && !v.is_table())
    v.varied = expand(given->value).varied;
  Member* m = scope().resolved->find(k.name);
  if (m)
    m->value = std::move(v);
  else
    m = &scope().resolved->add(k.name, std::move(v));
  m->moves = k.moves;
}

void Reader::problem(const char* code, const Spot& spot, std::string message, std::string hint) {
  diagnostics_.error(code, spot, std::move(message), std::move(hint),
                     scopes_.empty() ? std::string() : scope().entity);
}

bool Reader::wrong_type(const char* key, const Value& v, const char* wanted, std::string hint) {
  if (v.kind == Value::Kind::unreadable)
    scope().dirty = true;
  else
    problem("E06", v.spot, fmt::format("'{}' must be {}, not {}", key, wanted, name_of(v.kind)),
            std::move(hint));
  return false;
}

Value Reader::expand(const Value& v, Parameters::Use use) {
  return parameters_.expand(v, use, diagnostics_);
}

bool Reader::clean() const {
  return !scope().dirty && diagnostics_.errors() == scope().errors_at_start;
}

bool Reader::given(const char* key) const { return scope().table->find(key) != nullptr; }

void Reader::error(const char* code, const char* key, std::string message, std::string hint) {
  const Member* m = key ? scope().table->find(key) : nullptr;
  problem(code, m ? m->value.spot : scope().table->spot, std::move(message), std::move(hint));
}

void Reader::warning(const char* code, const char* key, std::string message, std::string hint) {
  const Member* m = key ? scope().table->find(key) : nullptr;
  diagnostics_.warning(code, m ? m->value.spot : scope().table->spot, std::move(message),
                       std::move(hint), scope().entity);
}

Where Reader::where() const {
  Where w = sources_.where(scope().table->spot);
  w.entity = scope().entity;
  return w;
}

// ---------------------------------------------------------------- quantities and numbers

std::optional<double> Reader::in_unit(const char* key, const Value& v, const char* unit) {
  const double x = v.number();
  if (!std::isfinite(x)) {
    problem("E13", v.spot, fmt::format("'{}' is not a finite number", key),
            "leave the key out where no limit is meant");
    return std::nullopt;
  }
  if (v.column) {
    auto it = factors_.find({v.column->unit, unit});
    if (it == factors_.end())
      it = factors_
               .emplace(std::pair(v.column->unit, std::string(unit)),
                        units::factor(v.column->unit, unit))
               .first;
    const units::Factor& f = it->second;
    if (!f.problem) return f(x);
    Spot spot = v.column->spot;
    if (!v.column->given)
      problem("E07", spot, fmt::format("the column '{}' has no unit", key),
              fmt::format("write the unit in the title, for example \"{}[{}]\"", key, unit));
    else
      problem(f.problem->code.c_str(), spot,
              fmt::format("column '{}': {}", key, f.problem->message), f.problem->hint);
    return std::nullopt;
  }
  const units::Dimension wanted = units::unit(unit).dimension;
  if (!wanted.dimensionless() && !(x == 0 && wanted.plain_zero())) {
    problem("E07", v.spot,
            fmt::format("'{}' is a number without a unit where {} is needed", key,
                        units::name_of(wanted)),
            fmt::format("write the unit, for example {} = \"{} {}\"", key, shown_text(v), unit));
    return std::nullopt;
  }
  return x;
}

std::optional<double> Reader::convert(const char* key, const Value& v, const Value& given,
                                      const char* unit) {
  const units::Converted c = units::convert(v.text, unit);
  if (!c.problem) return c.value;
  Spot spot = v.spot;
  if (given.is_text() && given.text == v.text && !v.column &&
      characters(v.text) + 2 == spot.length) {  // as it stands in the file
    spot.column += 1 + characters(std::string_view(v.text).substr(0, c.problem->offset));
    spot.length = std::max(1, characters(std::string_view(v.text).substr(
                                  std::min(c.problem->offset, v.text.size()), c.problem->length)));
  }
  problem(c.problem->code.c_str(), spot, fmt::format("'{}': {}", key, c.problem->message),
          c.problem->hint);
  return std::nullopt;
}

bool Reader::read_quantity(const char* key, const Value& given, const char* unit, Range range,
                           double& target, Value& shown) {
  const Value v = expand(given, Parameters::Use::quantity);
  if (!v.is_number() && !v.is_text())
    return wrong_type(key, v, *unit ? "a quantity" : "a number",
                      *unit ? fmt::format("for example {} = \"1 {}\"", key, unit) : "");
  const std::optional<double> x =
      v.is_number() ? in_unit(key, v, unit) : convert(key, v, given, unit);
  if (!x) return false;
  if (!inside(range, *x)) {
    problem(
        "E14", v.spot,
        fmt::format("'{}' = {} {}", key,
                    v.column && v.is_number() ? fmt::format("{} {}", shown_text(v), v.column->unit)
                                              : shown_text(v),
                    text_of(range)));
    return false;
  }
  target = *x;
  shown = v;
  return true;
}

bool Reader::quantity(const Key& k, double& target, const char* unit, Range range, const char*) {
  note_shape(k, KeyShape::Kind::quantity, unit);
  const Member* m = find(k);
  if (!m) {
    if (shows_default(k) && std::isfinite(target))
      put(k, *unit ? Value::of_text(units::format(target, unit)) : Value::of_number(target));
    return false;
  }
  if (k.plain_zero && m->value.is_number() && m->value.number() == 0 && inside(range, 0)) {
    target = 0;
    put(k, m->value);
    return true;
  }
  Value shown;
  if (read_quantity(k.name, m->value, unit, range, target, shown)) put(k, shown);
  return true;
}

bool Reader::integer(const Key& k, int& target, Range range, const char*) {
  note_shape(k, KeyShape::Kind::integer);
  const Member* m = find(k);
  if (!m) {
    put_default(k, Value::of_integer(target));
    return false;
  }
  Value v = expand(m->value);
  if (v.is_text()) {  // "${n}" inside a longer text, or a --set value
    std::int64_t i = 0;
    const auto r = std::from_chars(v.text.data(), v.text.data() + v.text.size(), i);
    if (r.ec == std::errc() && r.ptr == v.text.data() + v.text.size() &&
        (v.column || v.text != m->value.text))
      v = Value::of_integer(i, v.spot);
  }
  if (v.kind == Value::Kind::real && v.real == std::floor(v.real) && std::abs(v.real) < 1e9)
    v = Value::of_integer(static_cast<std::int64_t>(v.real), v.spot);
  if (v.kind != Value::Kind::integer) {
    wrong_type(k.name, v, "a whole number");
    return true;
  }
  if (!inside(range, static_cast<double>(v.integer)) || std::abs(v.integer) > 2000000000) {
    problem("E14", v.spot,
            fmt::format("'{}' = {} {}", k.name, v.integer,
                        std::abs(v.integer) > 2000000000 ? "is too large" : text_of(range)));
    return true;
  }
  target = static_cast<int>(v.integer);
  put(k, v);
  return true;
}

bool Reader::flag(const Key& k, bool& target, const char*) {
  note_shape(k, KeyShape::Kind::flag);
  const Member* m = find(k);
  if (!m) {
    put_default(k, Value::of_flag(target));
    return false;
  }
  Value v = expand(m->value);
  if (v.is_text() && v.column && (v.text == "true" || v.text == "false"))
    v = Value::of_flag(v.text == "true", v.spot);
  if (v.kind != Value::Kind::boolean) {
    wrong_type(k.name, v, "true or false");
    return true;
  }
  target = v.boolean;
  put(k, v);
  return true;
}

bool Reader::read_list(const Key& k, const Member& m, int count, Value& list) {
  list = expand(m.value);
  if (!list.is_array()) return wrong_type(k.name, list, "a list");
  if (count >= 0 && static_cast<int>(list.items.size()) != count) {
    problem("E20", list.spot,
            fmt::format("'{}' needs {} values, not {}", k.name, count, list.items.size()));
    return false;
  }
  return true;
}

bool Reader::quantities(const Key& k, std::vector<double>& target, const char* unit, Range range,
                        int count, const char*, const char* per) {
  note_shape(k, KeyShape::Kind::list);
  const Member* m = find(k);
  if (!m) {
    if (shows_default(k) && !target.empty()) {
      Value list = Value::make_array();
      for (double x : target)
        list.items.push_back(*unit ? Value::of_text(units::format(x, unit)) : Value::of_number(x));
      put(k, std::move(list));
    }
    return false;
  }
  Value list;
  if (!read_list(k, *m, count, list)) return true;
  std::vector<double> values;
  Value shown_list = Value::make_array();
  bool good = true;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    std::string u = unit;
    if (per && i > 0)
      u = fmt::format("{}/{}{}", *unit ? unit : "1", per, i == 1 ? "" : fmt::format("^{}", i));
    double x = 0;
    Value shown;
    good = read_quantity(k.name, list.items[i], u.c_str(), range, x, shown) && good;
    values.push_back(x);
    shown_list.items.push_back(std::move(shown));
  }
  if (!good) return true;
  target = std::move(values);
  put(k, std::move(shown_list));
  return true;
}

bool Reader::one_or_each(const Key& k, double& all, std::vector<double>& each, const char* unit,
                         Range range, const char* doc) {
  const Member* m = scope().table->find(k.name);
  const Value v = m ? expand(m->value, Parameters::Use::quantity) : Value();
  if (!v.is_array()) {
    note_shape(k, KeyShape::Kind::list);
    return quantity(k, all, unit, range, doc);
  }
  note_shape(k, KeyShape::Kind::quantity, unit);
  if (v.items.empty()) problem("E20", v.spot, fmt::format("'{}' is a list without values", k.name));
  return quantities(k, each, unit, range, -1, doc, nullptr);
}

bool Reader::matrix(const Key& k, Matrix<6>& target, const char* translation, const char* coupling,
                    const char* rotation, const char*) {
  note_shape(k, KeyShape::Kind::list);
  const Member* m = find(k);
  if (!m) return false;
  Value list;
  if (!read_list(k, *m, 6, list)) return true;
  Matrix<6> value;
  bool good = true;
  for (int i = 0; i < 6; ++i) {
    Value row = expand(list.items[static_cast<std::size_t>(i)]);
    if (!row.is_array()) {
      wrong_type(k.name, row, "a list of six lists");
      return true;
    }
    if (row.items.size() != 6) {
      problem("E20", row.spot,
              fmt::format("a row of '{}' needs 6 values, not {}", k.name, row.items.size()));
      return true;
    }
    for (int j = 0; j < 6; ++j) {
      const Value& x = row.items[static_cast<std::size_t>(j)];
      double number = 0;
      Value shown;
      if (x.is_number() && x.number() == 0)
        number = 0;
      else
        good = read_quantity(k.name, x,
                             i < 3 && j < 3   ? translation
                             : i < 3 || j < 3 ? coupling
                                              : rotation,
                             any, number, shown) &&
               good;
      value(i, j) = number;
    }
  }
  if (!good) return true;
  target = value;
  for (auto& row : list.items)
    for (auto& x : row.items)
      x = expand(x, Parameters::Use::quantity);
  put(k, list);
  return true;
}

// ---------------------------------------------------------------- words

bool Reader::read_text(const char* key, const Value& given, std::string& target) {
  Value v = expand(given);
  if (v.is_number() && v.column && !v.text.empty())
    v.kind = Value::Kind::text;  // a CSV cell such as 1
  if (!v.is_text()) return wrong_type(key, v, "text");
  target = v.text;
  return true;
}

bool Reader::text(const Key& k, std::string& target, const char*) {
  note_shape(k, KeyShape::Kind::text);
  const Member* m = find(k);
  if (!m) {
    put_default(k, Value::of_text(target));
    return false;
  }
  if (read_text(k.name, m->value, target)) put(k, Value::of_text(target));
  return true;
}

bool Reader::texts(const Key& k, std::vector<std::string>& target, const char*) {
  note_shape(k, KeyShape::Kind::list);
  const Member* m = find(k);
  if (!m) {
    Value list = Value::make_array();
    for (const auto& s : target)
      list.items.push_back(Value::of_text(s));
    put_default(k, std::move(list));
    return false;
  }
  Value list;
  if (!read_list(k, *m, -1, list)) return true;
  std::vector<std::string> r;
  Value shown = Value::make_array();
  for (const auto& x : list.items) {
    std::string s;
    if (!read_text(k.name, x, s)) return true;
    r.push_back(s);
    shown.items.push_back(Value::of_text(s));
  }
  target = std::move(r);
  put(k, std::move(shown));
  return true;
}

bool Reader::read_option(const char* key, const Value& given, std::span<const Option> options,
                         int& index) {
  std::string word;
  if (!read_text(key, given, word)) return false;
  std::vector<std::string> names;
  std::string all;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (word == options[i].name) {
      index = static_cast<int>(i);
      return true;
    }
    names.emplace_back(options[i].name);
    all += fmt::format("{}\"{}\"",
                       i == 0                    ? ""
                       : i + 1 == options.size() ? " or "
                                                 : ", ",
                       options[i].name);
  }
  const auto near = nearest(word, names);
  problem("E15", given.spot, fmt::format("'{}' does not know the word \"{}\"", key, word),
          near.empty() ? fmt::format("it is {}", all)
                       : fmt::format("did you mean \"{}\"? It is {}", near.front(), all));
  return false;
}

bool Reader::option(const Key& k, int& index, std::span<const Option> options, const char*) {
  note_shape(k, KeyShape::Kind::text);
  const Member* m = find(k);
  if (!m) {
    put_default(k, Value::of_text(options[static_cast<std::size_t>(index)].name));
    return false;
  }
  if (read_option(k.name, m->value, options, index))
    put(k, Value::of_text(options[static_cast<std::size_t>(index)].name));
  return true;
}

bool Reader::options(const Key& k, std::vector<std::string>& target,
                     std::span<const Option> options, const char* doc) {
  const Member* m = find(k);
  if (!m) {
    scope().known.pop_back();
    return texts(k, target, doc);
  }
  Value list;
  if (!read_list(k, *m, -1, list)) return true;
  std::vector<std::string> words;
  Value shown = Value::make_array();
  bool good = true;
  for (const auto& x : list.items) {
    int i = 0;
    if (!read_option(k.name, x, options, i)) {
      good = false;
      continue;
    }
    const char* word = options[static_cast<std::size_t>(i)].name;
    if (std::find(words.begin(), words.end(), word) != words.end()) {
      problem("E26", x.spot, fmt::format("\"{}\" stands twice in '{}'", word, k.name),
              "once is enough");
      good = false;
    }
    words.emplace_back(word);
    shown.items.push_back(Value::of_text(words.back()));
  }
  if (!good) return true;
  target = std::move(words);
  put(k, std::move(shown));
  return true;
}

}  // namespace whirl::deck
