#include <convert/convert.hpp>
#include <convert/notes.hpp>
#include <convert/ross.hpp>
#include <convert/workbook.hpp>
#include <io/json.hpp>
#include <algorithm>
#include <cctype>
#include <deck/text/sources.hpp>
#include <variant>

namespace whirl::convert {
namespace {

using deck::Value;

/// The tree a deck's reader makes of TOML, of JSON. null becomes "unreadable".
Value tree_of(const io::Value& json, int depth = 0) {
  if (depth > deck::max_depth) {
    Value none;
    none.kind = Value::Kind::unreadable;
    return none;
  }
  struct Visitor {
    int depth;
    Value operator()(std::monostate) const {
      Value none;
      none.kind = Value::Kind::unreadable;
      return none;
    }
    Value operator()(bool b) const { return Value::of_flag(b); }
    Value operator()(std::int64_t i) const { return Value::of_integer(i); }
    Value operator()(double x) const { return Value::of_number(x); }
    Value operator()(const std::string& s) const { return Value::of_text(s); }
    Value operator()(const io::Value::Array& a) const {
      Value list = Value::make_array();
      for (const io::Value& item : a)
        list.items.push_back(tree_of(item, depth + 1));
      return list;
    }
    Value operator()(const io::Value::Object& o) const {
      Value table = Value::make_table();
      for (const auto& [key, item] : o)
        table.add(key, tree_of(item, depth + 1));
      return table;
    }
  };
  return std::visit(Visitor{depth}, json.variant());
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string e = file.extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return std::tolower(c); });
  return e;
}

}  // namespace

Converted convert_ross_toml(const std::string& text, const std::string& name) {
  deck::Sources sources;
  const int source = sources.add(name, {}, text);
  deck::Diagnostics diagnostics;
  // what the TOML library may not be asked about: letters outside quotes, deep nesting
  if (const deck::TextProblem bad = deck::check_text(text, deck::TextKind::deck); !bad.ok()) {
    diagnostics.error("E03", deck::Spot{source, bad.line, bad.column, 1}, bad.message, bad.hint);
    throw Error(Exit::deck, diagnostics.take(sources));
  }
  const deck::Document document = deck::parse_toml(sources, source, diagnostics);
  if (diagnostics.errors() > 0) throw Error(Exit::deck, diagnostics.take(sources));
  if (document.root.find("format"))
    Notes(name).refuse("it is a deck of Whirl already", "whirl check tells what is in it");
  return convert_ross(document.root, name);
}

Converted convert_ross_json(const std::string& text, const std::string& name) {
  return convert_ross(tree_of(io::parse_json(text, name)), name);
}

namespace {

Converted convert_workbook(const std::filesystem::path& file, const std::string& sheet) {
  const std::string name = file.filename().string();
  Notes notes(name);
  const std::string text = sheet_as_csv(file, sheet, notes);
  Converted out = convert_csv(text, name);
  std::vector<Diagnostic> said = notes.take();
  out.left_out.insert(out.left_out.begin(), said.begin(), said.end());
  return out;
}

}  // namespace

Converted convert_file(const std::filesystem::path& file, const std::string& sheet) {
  const std::string name = file.filename().string();
  const std::string extension = lower_extension(file);
  if (extension == ".xls" || extension == ".ods")
    Notes(name).refuse("workbooks of this kind are not read",
                       "save it as .xlsx, or the sheet as CSV (soffice --convert-to xlsx '" + name +
                           "'), and convert that");
  if (extension != ".xlsx" && !sheet.empty())
    Notes(name).refuse("only a workbook (.xlsx) has sheets", "leave --sheet out");
  const deck::FileText text = deck::read_file(file, deck::max_table_bytes);
  if (!text.ok())
    throw Error(Exit::io, Diagnostic{Diagnostic::Severity::error, text.code, text.message,
                                     text.hint, Where{file.string(), 0, 0, 0, {}}});
  if (extension == ".xlsx") return convert_workbook(file, sheet);
  if (extension == ".toml") return convert_ross_toml(text.text, name);
  if (extension == ".json") return convert_ross_json(text.text, name);
  if (extension == ".csv" || extension == ".txt" || extension == ".tsv")
    return convert_csv(text.text, name);
  Notes(name).refuse("its kind is not known by its name",
                     "rotors saved by ROSS are .toml or .json, tables are .csv or .xlsx");
}

}  // namespace whirl::convert
