// Tables in tables, lists, rows with column titles (in the deck or a CSV file), and keys chosen by
// a "type".
#include <core/table.hpp>
#include <deck/text/assemble.hpp>
#include <deck/describer.hpp>
#include <deck/reader.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace whirl::deck {

std::string Reader::path_of(const char* key) const {
  return scopes_.empty() || scope().path.empty() ? std::string(key)
                                                 : fmt::format("{}.{}", scope().path, key);
}

void Reader::in_table(const char* key, const Value& table, Value* resolved, const Spot* header,
                      const std::function<void(Visitor&)>& body) {
  Scope s;
  s.table = &table;
  s.resolved = resolved;
  s.header = header;
  s.errors_at_start = diagnostics_.errors();
  s.path = path_of(key);
  if (!scopes_.empty()) s.entity = scope().entity;
  scopes_.push_back(std::move(s));
  body(*this);
  close_table();
  const bool dirty = !clean();
  scopes_.pop_back();
  if (dirty && !scopes_.empty()) scope().dirty = true;
}

void Reader::close_table() {
  const Scope& s = scope();
  if (s.any_key || s.header) return;
  std::optional<std::vector<std::vector<std::string>>> of_others;
  for (const auto& m : s.table->members) {
    if (std::find(s.known.begin(), s.known.end(), m.key) != s.known.end()) continue;
    if (diagnostics_.full()) break;
    std::string hint;
    if (!of_others) {
      // Describing an alternative makes what it describes, in place of what stands there: from the
      // last to the first, for a choice within a chosen one comes later and refers to what that made.
      of_others.emplace(s.others.size());
      for (std::size_t i = s.others.size(); i-- > 0;)
        (*of_others)[i] = key_names(s.others[i].alternative.body);
    }
    const Scope::Other* owner = nullptr;  // the first of the innermost choice that has the key
    for (std::size_t i = 0; i < s.others.size(); ++i) {
      const std::vector<std::string>& keys = (*of_others)[i];
      if (std::find(keys.begin(), keys.end(), m.key) != keys.end() &&
          (!owner || owner->key != s.others[i].key))
        owner = &s.others[i];
    }
    if (owner) hint = fmt::format("it belongs to {} = \"{}\"", owner->key, owner->alternative.name);
    if (hint.empty()) {
      std::vector<KeyShape>
          free;  // a choice of keys ("type") is none of them, nor is what is given already
      for (const auto& k : s.shapes)
        if (!s.table->find(k.name)) free.push_back(k);
      hint = suggest(m.key, shape_of(m.value), free);
      const auto given =
          nearest(m.key, s.known);  // one that is written right elsewhere in the table
      if (hint.empty() && !given.empty()) hint = fmt::format("did you mean '{}'?", given.front());
    }
    if (hint.empty()) {
      if (s.known.size() <= 16)
        hint = fmt::format("known here: {}", fmt::join(s.known, ", "));
      else
        hint = "`whirl schema --reference` lists all keys";
    }
    problem("E04", m.spot,
            fmt::format("unknown key '{}'{}", m.key, s.entity.empty() ? "" : " in " + s.entity),
            std::move(hint));
  }
}

void Reader::free_table(const Key& k, const char*) {
  note_shape(k, KeyShape::Kind::table);
  const Member* m = find(k);
  if (m && !m->value.is_table()) wrong_type(k.name, m->value, "a table");
}

bool Reader::table(const Key& k, const std::function<void(Visitor&)>& body, const char*) {
  note_shape(k, KeyShape::Kind::table);
  const Member* m = find(k);
  Value resolved = Value::make_table();
  if (!m) {
    if (k.required || k.absent) return false;
    const Value empty = Value::make_table(scope().table->spot);  // its defaults
    in_table(k.name, empty, &resolved, nullptr, body);
    if (!resolved.members.empty()) put(k, std::move(resolved));
    return false;
  }
  expanded_.push_back(expand(m->value));
  const Value& v = expanded_.back();
  if (!v.is_table()) {
    wrong_type(k.name, v, "a table");
    return true;
  }
  in_table(k.name, v, &resolved, nullptr, body);
  put(k, std::move(resolved));
  return true;
}

void Reader::list(const Key& k, const ListBody& body, const char*) {
  note_shape(k, KeyShape::Kind::list);
  const Member* m = find(k);
  if (!m) return;
  expanded_.push_back(expand(m->value));
  const Value& v = expanded_.back();
  if (!v.is_array() && !v.is_table()) {
    wrong_type(k.name, v, "a list of tables", fmt::format("write [[{}]]", path_of(k.name)));
    return;
  }
  Value all = Value::make_array();
  const bool dirty_before = scope().dirty;
  scope().dirty = false;
  const auto one = [&](const Value& item) {
    if (!item.is_table()) {
      wrong_type(k.name, item, "a list of tables", fmt::format("write [[{}]]", path_of(k.name)));
      return;
    }
    Value resolved = Value::make_table();
    in_table(k.name, item, &resolved, nullptr, body.add_and_describe);
    all.items.push_back(std::move(resolved));
  };
  if (v.is_table())
    one(v);
  else
    for (const auto& item : v.items) {
      if (diagnostics_.full()) break;
      one(item);
    }
  if (scopes_.size() == 1 && std::string_view(k.name) == "shaft") shafts_bad_ = scope().dirty;
  scope().dirty = scope().dirty || dirty_before;
  if (!all.items.empty()) put(k, std::move(all));
}

void Reader::alternatives(const Key& k, std::span<const Alternative> list, const char*) {
  Key must = k;
  must.required = true;
  const Member* m = find(must);
  int index = 0;
  std::vector<Option> words;
  words.reserve(list.size());
  for (const auto& a : list)
    words.push_back({a.name, a.doc});
  if (!m || !read_option(k.name, m->value, words, index)) {
    scope().any_key = true;
    return;
  }
  put(k, Value::of_text(words[static_cast<std::size_t>(index)].name));
  for (std::size_t i = 0; i < list.size(); ++i)
    if (static_cast<int>(i) != index) scope().others.push_back({k.name, list[i]});
  list[static_cast<std::size_t>(index)].body(*this);
}

bool Reader::either(const Key& k, double& simple, const char* unit, bool& is_simple,
                    const std::function<void(Visitor&)>& body, const char*) {
  note_shape(k, KeyShape::Kind::quantity, unit);
  note_shape(k, KeyShape::Kind::table);
  const Member* m = find(k);
  if (!m) return false;
  expanded_.push_back(expand(m->value, Parameters::Use::quantity));
  const Value& v = expanded_.back();
  if (v.is_table()) {
    is_simple = false;
    Value resolved = Value::make_table();
    in_table(k.name, v, &resolved, nullptr, body);
    put(k, std::move(resolved));
    return true;
  }
  is_simple = true;
  Value shown;
  if (read_quantity(k.name, m->value, unit, any, simple, shown)) put(k, shown);
  return true;
}

// ---------------------------------------------------------------- rows

bool Reader::read_titles(const std::vector<Value>& titles, const ListBody& body,
                         std::vector<ColumnUnit*>& columns, std::vector<std::string>& keys) {
  const auto shapes = column_shapes(body.prototype);
  std::vector<std::string> known;
  for (const auto& k : shapes)
    known.push_back(k.name);
  bool good = true;
  for (const auto& given : titles) {
    const Value t = expand(given);
    if (!t.is_text()) {
      wrong_type("columns", t, "a list of texts");
      return false;
    }
    const ColumnTitle title = split_title(t.text);
    columns_.push_back({title.unit, title.has_unit, t.spot});
    columns.push_back(&columns_.back());
    if (std::find(known.begin(), known.end(), title.name) == known.end()) {
      std::vector<KeyShape> free;
      std::copy_if(shapes.begin(), shapes.end(), std::back_inserter(free), [&](const KeyShape& k) {
        return std::find(keys.begin(), keys.end(), k.name) == keys.end();
      });
      const std::string hint = suggest(title.name, shape_of_column(title.unit), free);
      problem("E04", t.spot, fmt::format("unknown column '{}'", title.name),
              hint.empty() ? fmt::format("known here: {}", fmt::join(known, ", ")) : hint);
      good = false;
    } else if (std::find(keys.begin(), keys.end(), title.name) != keys.end()) {
      problem("E29", t.spot, fmt::format("the column '{}' stands twice in the table", title.name));
      good = false;
    }
    keys.push_back(title.name);
  }
  return good;
}

void Reader::read_row(const std::vector<ColumnUnit*>& columns, const std::vector<std::string>& keys,
                      std::vector<Value> cells, const Spot& row, const Spot& header,
                      const ListBody& body) {
  if (cells.size() != columns.size()) {
    problem("E20", row,
            fmt::format("the row has {} values for {} columns", cells.size(), columns.size()),
            fmt::format("the columns are {}", fmt::join(keys, ", ")));
    return;
  }
  Value table = Value::make_table(row);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].column = columns[i];
    const Spot spot = cells[i].spot;
    table.add(keys[i], std::move(cells[i]), spot);
  }
  in_table("", table, nullptr, &header, body.add_and_describe);
}

void Reader::read_rows_from_deck(const Value& titles, const Value& rows, const ListBody& body,
                                 Value& out_columns, Value& out_rows) {
  std::vector<ColumnUnit*> columns;
  std::vector<std::string> keys;
  if (!read_titles(titles.items, body, columns, keys)) return;
  for (const auto& t : titles.items)
    out_columns.items.push_back(expand(t));
  if (rows.items.empty()) problem("E35", rows.spot, "the table has no rows");
  for (const auto& r : rows.items) {
    if (diagnostics_.full()) break;  // a wholly wrong table need not be shown line by line
    const Value row = expand(r);
    if (!row.is_array()) {
      wrong_type("rows", row, "a list of lists");
      continue;
    }
    std::vector<Value> cells;
    for (const auto& c : row.items)
      cells.push_back(expand(c, Parameters::Use::quantity));
    Value shown = row;
    shown.items = cells;
    out_rows.items.push_back(std::move(shown));
    const bool bad = std::any_of(cells.begin(), cells.end(),
                                 [](const Value& c) { return c.kind == Value::Kind::unreadable; });
    if (bad) scope().dirty = true;
    read_row(columns, keys, std::move(cells), row.spot, titles.spot, body);
  }
}

int Reader::open_table(const Value& file) {
  std::string name;
  if (!read_text("file", file, name)) return -1;
  if (!files_allowed) {
    problem("E02", file.spot, fmt::format("cannot read '{}': files are not allowed here", name));
    return -1;
  }
  const std::filesystem::path path = sources_[file.spot.source].folder / name;
  if (!may_be_read(sources_, path, {".csv", ".tsv", ".txt", ".dat"})) {
    problem("E02", file.spot,
            fmt::format("cannot read '{}': it lies outside the deck's folder and is not named "
                        "*.csv, *.tsv, *.txt or *.dat",
                        name),
            "move it beside the deck, or give it the name of a table");
    return -1;
  }
  FileText text = read_file(path, max_table_bytes);
  if (!text.ok()) {
    problem(text.code.c_str(), file.spot, text.message, text.hint);
    return -1;
  }
  const TextProblem bad = check_text(text.text, TextKind::table);
  const int source = sources_.add(path.string(), path.parent_path(), std::move(text.text));
  if (bad.ok()) return source;
  problem("E03", Spot{source, bad.line, bad.column, 1}, bad.message, bad.line ? bad.hint : "");
  return -1;
}

namespace {

/// A cell as a deck's value: a number where it is one and does not stand in quotes.
Value value_of(const Cell& c, const Spot& spot) {
  Value v = Value::of_text(c.text, spot);
  double x = 0;
  const char* first = c.text.data() + (c.text.starts_with('+') ? 1 : 0);
  const auto n = std::from_chars(first, c.text.data() + c.text.size(), x);
  if (!c.quoted && n.ec == std::errc() && n.ptr == c.text.data() + c.text.size() &&
      !c.text.empty()) {
    v.kind = Value::Kind::real;
    v.real = x;
  }
  return v;
}

/// The value as it is shown again. A number in a column without unit may be a name: it keeps its
/// spelling.
Value shown_value(const Value& v, const Cell& c, bool has_unit) {
  if (!v.is_number()) return v;
  const double x = v.real;
  const bool whole = x == std::floor(x) && std::abs(x) < 1e15;
  return !std::isfinite(x) || (!has_unit && whole) ? Value::of_text(c.text) : v;
}

}  // namespace

void Reader::read_rows_from_file(const Value& file, const ListBody& body, Value& out_columns,
                                 Value& out_rows) {
  const int source = open_table(file);
  if (source < 0) return;
  const auto at = [&](int line, int column, int length) {
    return Spot{source, line, column, length};
  };
  const CellTable cells = read_cells(sources_[source].text);
  if (!cells.problem.empty()) {
    problem("E10", at(cells.problem_line, cells.problem_column, 1), cells.problem);
    return;
  }
  const auto spot = [&](const Cell& c) { return at(c.line, c.column, c.length); };
  std::vector<Value> titles;
  for (const auto& c : cells.header)
    titles.push_back(Value::of_text(c.text, spot(c)));
  std::vector<ColumnUnit*> columns;
  std::vector<std::string> keys;
  if (!read_titles(titles, body, columns, keys)) return;
  out_columns.items = titles;
  if (cells.rows.empty())
    problem("E35", at(cells.header.front().line, 1, 1), "the table has no rows");
  const Spot header = at(cells.header.front().line, 1,
                         std::max(1, cells.header.back().column + cells.header.back().length - 1));
  for (const auto& r : cells.rows) {
    std::vector<Value> values;
    Value shown = Value::make_array();
    for (const auto& c : r) {
      Value v = value_of(c, spot(c));
      const bool has_unit = keys.size() <= values.size() || columns[values.size()]->given;
      shown.items.push_back(shown_value(v, c, has_unit));
      values.push_back(std::move(v));
    }
    out_rows.items.push_back(std::move(shown));
    const Spot row = at(r.front().line, r.front().column,
                        std::max(1, r.back().column + r.back().length - r.front().column));
    read_row(columns, keys, std::move(values), row, header, body);
    if (diagnostics_.full()) break;  // a wholly wrong table need not be shown line by line
  }
}

bool Reader::rows(const ListBody& body, bool must, const char*) {
  for (const char* part : {"columns", "rows"})
    note_shape(part, KeyShape::Kind::list);
  note_shape("file", KeyShape::Kind::text);
  const Member* columns = find(optional("columns", ""));
  const Member* rows = find(optional("rows", ""));
  const Member* file = find(optional("file", ""));
  if (!columns && !rows && !file) {
    if (must && !document_.damaged) {
      problem("E05", scope().table->spot,
              fmt::format("{} lacks its table", scope().entity.empty() ? "this" : scope().entity),
              "give file = \"table.csv\", or columns and rows");
    }
    return false;
  }
  Value out_columns = Value::make_array(), out_rows = Value::make_array();
  if (file) {
    if (rows || columns)
      problem("E26", file->spot, "the table is given by 'file' and by 'rows'",
              "keep one of the two");
    else
      read_rows_from_file(expand(file->value), body, out_columns, out_rows);
  } else if (!rows || !columns) {
    if (!document_.damaged)
      problem("E05", (rows ? rows : columns)->spot,
              rows ? "'rows' needs 'columns'" : "'columns' needs 'rows'",
              "columns = [\"length[mm]\", ...] names the cells of each row");
  } else {
    expanded_.push_back(expand(columns->value));
    const Value& c = expanded_.back();
    expanded_.push_back(expand(rows->value));
    const Value& r = expanded_.back();
    if (!c.is_array())
      wrong_type("columns", c, "a list of texts");
    else if (!r.is_array())
      wrong_type("rows", r, "a list of lists");
    else
      read_rows_from_deck(c, r, body, out_columns, out_rows);
  }
  put("columns", std::move(out_columns));
  put("rows", std::move(out_rows));
  return true;
}

}  // namespace whirl::deck
