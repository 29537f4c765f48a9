#include <deck/text/assemble.hpp>
#include <deck/deck.hpp>
#include <deck/materials.hpp>
#include <deck/parsed_deck.hpp>
#include <deck/reader.hpp>
#include <deck/validate.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace whirl::deck {
namespace {

std::string stem_of(const std::filesystem::path& file) {
  const std::string s = file.stem().string();
  if (s == "-") return "deck";  // standard input
  // examples/01_paper_rotor/deck.toml is better called after its folder
  if (s == "deck" && file.has_parent_path() && file.parent_path().has_filename() &&
      file.parent_path().filename() != "." && file.parent_path().filename() != "..")
    return file.parent_path().filename().string();
  return s.empty() ? "deck" : s;
}

/// Leaves out what no motion depends on.
Value moving_part(const Value& v) {
  Value out = v;
  out.varied.clear();
  std::erase_if(out.members, [](const Member& m) { return !m.moves; });
  for (Member& m : out.members)
    m.value = moving_part(m.value);
  for (Value& x : out.items)
    x = moving_part(x);
  return out;
}

model::MovingDeck moving_deck(const Value& resolved) {
  Value machine = moving_part(resolved);
  model::MovingDeck out;
  if (const Member* steps = machine.find("step"))
    for (const Value& s : steps->value.items) {
      Value one = Value::make_table();
      Value list = steps->value;
      list.items = {s};
      one.add("step", std::move(list));
      out.steps.push_back(write_toml(one));
    }
  std::erase_if(machine.members, [](const Member& m) { return m.key == "step"; });
  out.machine = write_toml(machine);
  return out;
}

/// Built-in materials that were used go into the resolved deck, so that it stands alone.
void add_builtin_materials(Value& resolved, const model::Model& m) {
  Member* list = resolved.find("material");
  std::size_t have = list ? list->value.items.size() : 0;
  if (have >= m.materials.size()) return;
  Value all = list ? list->value : Value::make_array();
  for (; have < m.materials.size(); ++have) {
    const auto& x = m.materials[have];
    Value t = Value::make_table();
    t.add("name", Value::of_text(x.name));
    t.add("E", Value::of_text(units::format(x.E, "GPa")));
    t.add("nu", Value::of_number(x.nu));
    t.add("density", Value::of_text(units::format(x.rho, "kg/m^3")));
    t.add("expansion", Value::of_text(units::format(x.expansion, "1/K")));
    all.items.push_back(std::move(t));
  }
  if (list) {
    list->value = std::move(all);
    return;
  }
  // where the reader puts a given one: right after [model], so that a resolved deck resolves to
  // itself
  const auto model = std::find_if(resolved.members.begin(), resolved.members.end(),
                                  [](const Member& x) { return x.key == "model"; });
  resolved.members.insert(model == resolved.members.end() ? model : model + 1,
                          Member{"material", {}, std::move(all)});
}

/// Names of the parameters that maps of the steps vary.
std::set<std::string> varied_names(const Value& root) {
  std::set<std::string> names;
  const Member* steps = root.find("step");
  if (!steps) return names;
  const std::vector<Value> one{steps->value};
  for (const Value& step : steps->value.is_array() ? steps->value.items : one) {
    const Member* map = step.find("map");
    const Member* name = map && map->value.is_table() ? map->value.find("parameter") : nullptr;
    if (name && name->value.is_text()) names.insert(name->value.text);
  }
  return names;
}

/// Maps of a resolved deck vary what they varied: their parameters stay.
void add_varied_parameters(Value& resolved, Value table) {
  if (table.members.empty()) return;
  const auto first_table = std::find_if(resolved.members.begin(), resolved.members.end(),
                                        [](const Member& m) { return m.value.is_table(); });
  resolved.members.insert(first_table, Member{"parameters", {}, std::move(table), false});
}

/// Of source 0; incomplete where it cannot be parsed.
Document parse(Sources& sources, bool files_allowed, Diagnostics& diagnostics) {
  const TextProblem bad = check_text(sources[0].text, TextKind::deck);
  if (bad.ok()) return assemble(sources, diagnostics, {files_allowed});
  diagnostics.error("E03", Spot{0, bad.line, bad.column, 1}, bad.message, bad.hint);
  Document none;
  none.complete = false;
  return none;
}

/// The model of a document, whose texts are the sources of the deck; the overrides become one more.
void read_document(Deck& deck, const std::filesystem::path& file, const ReadOptions& options,
                   Document& document, Diagnostics& diagnostics) {
  apply_overrides(document, options.set, deck.sources, diagnostics);
  if (document.root.spot.line == 0) document.root.spot = Spot{0, 1, 1, 1};
  deck.model.deck_path = file.string();
  deck.model.deck_name = stem_of(file);
  deck.model.output.directory = "results/" + deck.model.deck_name;
  const Member* parameters = document.root.find("parameters");
  Parameters names(parameters && parameters->value.is_table() ? &parameters->value : nullptr,
                   {{"deck", deck.model.deck_name}}, varied_names(document.root));
  Reader reader(deck.sources, diagnostics, names, document, deck.model);
  reader.files_allowed = options.files_allowed;
  reader.read();
  if (diagnostics.errors() == 0) names.warn_unused(diagnostics);
  Value resolved = reader.take_resolved();
  add_builtin_materials(resolved, deck.model);
  add_varied_parameters(resolved, names.varied_table());
  if (diagnostics.errors() > 0) return;
  deck.model.resolved = write_toml(resolved);
  deck.model.moving = moving_deck(resolved);
}

void read_into(Deck& deck, const std::filesystem::path& file, const ReadOptions& options,
               Document document, Diagnostics diagnostics) {
  if (document.complete) read_document(deck, file, options, document, diagnostics);
  deck.errors = diagnostics.errors();
  deck.diagnostics = diagnostics.take(deck.sources);
  if (deck.errors > 0) return;
  for (auto& p : check_model(deck.model)) {
    Diagnostic d;
    d.severity = p.severity;
    d.code = p.code;
    d.message = p.message;
    d.hint = p.hint;
    d.where = p.where;
    deck.errors += p.severity == Diagnostic::Severity::error;
    deck.diagnostics.push_back(std::move(d));
  }
  std::stable_sort(deck.diagnostics.begin(), deck.diagnostics.end(),
                   [](const Diagnostic& a, const Diagnostic& b) {
                     return a.where.file == b.where.file &&
                            std::pair(a.where.line, a.where.column) <
                                std::pair(b.where.line, b.where.column);
                   });
  for (const auto& d : deck.diagnostics)
    if (d.severity == Diagnostic::Severity::warning) deck.model.warnings.push_back(d);
}

}  // namespace

std::string Deck::report(bool colour) const {
  std::string out;
  for (const auto& d : diagnostics)
    out += format(d, sources.line(d.where), colour);
  return out;
}

namespace {

/// Adds the text of a deck as the first source; what stands against it.
std::optional<Diagnostic> read_text_of(const std::filesystem::path& file, Sources& sources) {
  const bool standard_input = file == "-";
  FileText text =
      standard_input ? read_standard_input(max_deck_bytes) : read_file(file, max_deck_bytes);
  sources.add(standard_input ? "standard input" : file.string(), file.parent_path(),
              std::move(text.text));
  if (text.ok()) return std::nullopt;
  Diagnostic d;
  d.code = text.code;
  d.message = text.message;
  d.hint = text.hint;
  return d;
}

Deck unreadable_deck(Sources sources, Diagnostic why) {
  Deck deck;
  deck.sources = std::move(sources);
  deck.diagnostics.push_back(std::move(why));
  deck.errors = 1;
  return deck;
}

model::Model model_of(Deck deck) {
  if (!deck.ok()) throw Error(exit_of(deck.diagnostics), std::move(deck.diagnostics));
  return std::move(deck.model);
}

}  // namespace

ParsedDeck::ParsedDeck(const std::filesystem::path& file, bool files_allowed)
    : file_(file),
      files_allowed_(files_allowed),
      unreadable_(read_text_of(file, sources_)) {
  if (!unreadable_) document_ = parse(sources_, files_allowed, diagnostics_);
}

Deck ParsedDeck::read(const std::vector<std::string>& set) const {
  if (unreadable_) return unreadable_deck(sources_, *unreadable_);
  Deck deck;
  deck.sources = sources_;
  read_into(deck, file_, {set, files_allowed_}, document_, diagnostics_);
  return deck;
}

model::Model ParsedDeck::load(const std::vector<std::string>& set) const {
  return model_of(read(set));
}

std::string ParsedDeck::entry(const std::string& path) const { return entry_of(document_, path); }

Deck read_deck(const std::filesystem::path& file, const ReadOptions& options) {
  Deck deck;
  if (auto problem = read_text_of(file, deck.sources))
    return unreadable_deck(std::move(deck.sources), std::move(*problem));
  Diagnostics diagnostics;
  Document document = parse(deck.sources, options.files_allowed, diagnostics);
  read_into(deck, file, options, std::move(document), std::move(diagnostics));
  return deck;
}

Deck read_deck_text(std::string text, const std::string& name, const ReadOptions& options,
                    const std::filesystem::path& folder) {
  Deck deck;
  deck.sources.add(name, folder, std::move(text));
  Diagnostics diagnostics;
  Document document = parse(deck.sources, options.files_allowed, diagnostics);
  read_into(deck, name, options, std::move(document), std::move(diagnostics));
  return deck;
}

model::Model load_model(const std::filesystem::path& file, const ReadOptions& options) {
  return model_of(read_deck(file, options));
}

Exit exit_of(const std::vector<Diagnostic>& diagnostics) {
  bool usage = false, other = false, io = false;
  for (const auto& d : diagnostics) {
    if (d.severity != Diagnostic::Severity::error) continue;
    if (d.where.file == "--set" && d.code == "E34")
      usage = true;
    else if (d.code == "E02" && d.where.line == 0)
      io = true;
    else
      other = true;
  }
  return other ? Exit::deck : usage ? Exit::usage : io ? Exit::io : Exit::deck;
}

}  // namespace whirl::deck
