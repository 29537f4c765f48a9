#include <core/units.hpp>
#include <deck/describer.hpp>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {

KeyInfo& Describer::add(const Key& k, KeyInfo::Kind kind, const char* doc) {
  KeyInfo i;
  i.name = k.name;
  i.kind = kind;
  i.doc = doc;
  i.required = k.required;
  i.listed = k.listed;
  i.plain_zero = k.plain_zero;
  if (k.absent) i.absent = k.absent;
  tables_.back()->keys.push_back(std::move(i));
  return tables_.back()->keys.back();
}

std::shared_ptr<TableInfo> Describer::collect(const std::function<void(Visitor&)>& body) {
  auto t = std::make_shared<TableInfo>();
  tables_.push_back(t.get());
  body(*this);
  tables_.pop_back();
  return t;
}

bool Describer::quantity(const Key& k, double& target, const char* unit, Range range,
                         const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::quantity, doc);
  i.unit = unit;
  i.range = range;
  if (!k.required && !k.absent && std::isfinite(target))
    i.default_text = *unit ? '"' + units::format(target, unit) + '"' : units::format_number(target);
  return false;
}

bool Describer::integer(const Key& k, int& target, Range range, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::integer, doc);
  i.range = range;
  if (!k.required && !k.absent) i.default_text = std::to_string(target);
  return false;
}

bool Describer::flag(const Key& k, bool& target, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::flag, doc);
  if (!k.required && !k.absent) i.default_text = target ? "true" : "false";
  return false;
}

bool Describer::text(const Key& k, std::string& target, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::text, doc);
  if (!k.required && !k.absent && !target.empty()) i.default_text = '"' + target + '"';
  return false;
}

namespace {
std::string list_text(const std::vector<std::string>& words) {
  std::string r = "[";
  for (const auto& w : words)
    r += (r.size() > 1 ? ", \"" : "\"") + w + '"';
  return r + "]";
}
}  // namespace

bool Describer::texts(const Key& k, std::vector<std::string>& target, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::texts, doc);
  if (!k.required && !k.absent && !target.empty()) i.default_text = list_text(target);
  return false;
}

bool Describer::quantities(const Key& k, std::vector<double>& target, const char* unit, Range range,
                           int count, const char* doc, const char*) {
  KeyInfo& i = add(k, KeyInfo::Kind::quantities, doc);
  i.unit = unit;
  i.range = range;
  i.count = count;
  if (!k.required && !k.absent && !target.empty()) {
    std::vector<std::string> words;
    std::string plain = "[";
    for (double x : target) {
      words.push_back(units::format(x, unit));
      plain += (plain.size() > 1 ? ", " : "") + words.back();
    }
    i.default_text = *unit ? list_text(words) : plain + "]";
  }
  return false;
}

bool Describer::one_or_each(const Key& k, double& all, std::vector<double>&, const char* unit,
                            Range range, const char* doc) {
  quantity(k, all, unit, range, doc);
  tables_.back()->keys.back().each = true;
  return false;
}

bool Describer::matrix(const Key& k, Matrix<6>&, const char* translation, const char* coupling,
                       const char* rotation, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::matrix, doc);
  i.unit = fmt::format("{} | {} | {}", translation, coupling, rotation);
  return false;
}

bool Describer::option(const Key& k, int& index, std::span<const Option> options, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::option, doc);
  i.words.assign(options.begin(), options.end());
  if (!k.required && !k.absent)
    i.default_text = fmt::format("\"{}\"", options[static_cast<std::size_t>(index)].name);
  return false;
}

bool Describer::options(const Key& k, std::vector<std::string>& target,
                        std::span<const Option> options, const char* doc) {
  KeyInfo& i = add(k, KeyInfo::Kind::options, doc);
  i.words.assign(options.begin(), options.end());
  if (!k.required && !k.absent && !target.empty()) i.default_text = list_text(target);
  return false;
}

bool Describer::name(model::Entity&, const char* kind) {
  KeyInfo& i = add(optional("name", "numbered by kind"), KeyInfo::Kind::text,
                   "name, unique among its kind; used in references, results and messages");
  i.absent = fmt::format("\"{} 1\", \"{} 2\", ...", kind, kind);
  return false;
}

bool Describer::location(const Key& k, model::Location&, const char* doc) {
  add(k, KeyInfo::Kind::location, doc);
  return false;
}

bool Describer::material(const Key& k, std::size_t&, const char* doc) {
  add(k, KeyInfo::Kind::reference, doc);
  return false;
}

bool Describer::shaft(const Key& k, std::size_t&, const char* doc) {
  add(k, KeyInfo::Kind::reference, doc);
  return false;
}

bool Describer::step(const Key& k, std::string&, const char* doc) {
  add(k, KeyInfo::Kind::reference, doc);
  return false;
}

void Describer::free_table(const Key& k, const char* doc) {
  add(k, KeyInfo::Kind::free_table, doc);
}

bool Describer::table(const Key& k, const std::function<void(Visitor&)>& body, const char* doc) {
  auto t = collect(body);
  add(k, KeyInfo::Kind::table, doc).table = std::move(t);
  return false;
}

void Describer::list(const Key& k, const ListBody& body, const char* doc) {
  auto t = collect(body.prototype);
  add(k, KeyInfo::Kind::list, doc).table = std::move(t);
}

namespace {
bool fits_a_cell(const KeyInfo& i) {
  return i.kind != KeyInfo::Kind::table && i.kind != KeyInfo::Kind::list &&
         i.kind != KeyInfo::Kind::matrix && i.kind != KeyInfo::Kind::quantities &&
         i.kind != KeyInfo::Kind::texts;
}
}  // namespace

bool Describer::rows(const ListBody& body, bool must, const char* doc) {
  auto t = collect(body.prototype);
  std::erase_if(t->keys, [](const KeyInfo& i) { return !fits_a_cell(i); });
  tables_.back()->row = std::move(t);
  tables_.back()->row_required = must;
  tables_.back()->row_doc = doc;
  return false;
}

void Describer::alternatives(const Key& k, std::span<const Alternative> list, const char* doc) {
  std::vector<KeyInfo::Choice> choices;
  for (const auto& a : list)
    choices.push_back({a.name, a.doc, collect(a.body)});
  add(k, KeyInfo::Kind::alternatives, doc).choices = std::move(choices);
}

bool Describer::either(const Key& k, double&, const char* unit, bool&,
                       const std::function<void(Visitor&)>& body, const char* doc) {
  auto t = collect(body);
  KeyInfo& i = add(k, KeyInfo::Kind::either, doc);
  i.unit = unit;
  i.table = std::move(t);
  return false;
}

bool Describer::clean() const { return false; }
bool Describer::given(const char*) const { return false; }
void Describer::error(const char*, const char*, std::string, std::string) {}
void Describer::warning(const char*, const char*, std::string, std::string) {}
Where Describer::where() const { return {}; }
const model::Model& Describer::model() const {
  static const model::Model empty;
  return empty;
}

const TableInfo& deck_keys() {
  static const TableInfo root = [] {
    TableInfo t;
    Describer d(t);
    model::Model m;
    m.output.directory = "results/${deck}";
    describe(d, m);
    return t;
  }();
  return root;
}

std::vector<std::string> key_names(const std::function<void(Visitor&)>& body) {
  TableInfo t;
  Describer d(t);
  body(d);
  std::vector<std::string> r;
  for (const auto& k : t.keys)
    r.push_back(k.name);
  return r;
}

std::vector<KeyShape> column_shapes(const std::function<void(Visitor&)>& body) {
  TableInfo t;
  Describer d(t);
  body(d);
  const auto kind_of = [](const KeyInfo& k) {
    switch (k.kind) {
      case KeyInfo::Kind::quantity: return KeyShape::Kind::quantity;
      case KeyInfo::Kind::integer: return KeyShape::Kind::integer;
      case KeyInfo::Kind::flag: return KeyShape::Kind::flag;
      default: return KeyShape::Kind::text;
    }
  };
  std::vector<KeyShape> r;
  for (const auto& k : t.keys)
    if (fits_a_cell(k)) r.push_back({k.name, kind_of(k), k.unit});
  return r;
}

}  // namespace whirl::deck
