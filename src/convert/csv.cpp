// Tables as they come out of spreadsheets: columns are known by their titles and by the dimension of
// their units.
#include <convert/convert.hpp>
#include <convert/deck_values.hpp>
#include <convert/notes.hpp>
#include <deck/materials.hpp>
#include <core/table.hpp>
#include <core/units.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>

namespace whirl::convert {
namespace {

using deck::Value;

/// A column that is understood: values in SI units, one a row; a cell may be empty.
struct Column {
  std::string key;  ///< "length", "od_l", "mass", "kyy", ...
  std::vector<std::optional<double>> values;
  std::vector<std::string> texts;
};

/// What titles mean, by their letters and figures alone; the first whose dimension fits.
struct Meaning {
  const char* key;
  const char* unit;  ///< "" for text
  std::vector<const char*> titles;
};

const std::vector<Meaning>& station_meanings() {
  static const std::vector<Meaning> t = {
      {"name", "", {"name", "station", "stn", "section", "element", "no", "n", "id", "label"}},
      {"comment", "", {"comment", "comments", "remark", "description", "notes"}},
      {"material", "", {"material", "mat"}},
      {"length", "m", {"l", "length", "len", "elementlength", "sectionlength"}},
      {"od_l",
       "m",
       {"od", "do", "outerdiameter", "outsidediameter", "odleft", "odl", "odl1", "diameter", "d",
        "massod", "outsidedia"}},
      {"id_l",
       "m",
       {"id", "di", "innerdiameter", "insidediameter", "idleft", "idl", "bore", "massid",
        "insidedia"}},
      {"od_r", "m", {"odright", "odr", "odr1"}},
      {"id_r", "m", {"idright", "idr", "idr1"}},
      {"stiffness_od", "m", {"stiffnessod", "stiffod", "odstiffness", "stiffnessdiameter"}},
      {"stiffness_id", "m", {"stiffnessid", "stiffid", "idstiffness"}},
      {"E", "Pa", {"e", "youngsmodulus", "elasticmodulus", "modulus"}},
      {"G", "Pa", {"g", "gs", "shearmodulus"}},
      {"density", "kg/m^3", {"density", "rho"}},
      {"mass", "kg", {"mass", "m", "addedmass", "lumpedmass", "weight", "addedweight", "w"}},
      {"Ip", "kg.m^2", {"ip", "polarinertia", "polar", "jp"}},
      {"Id",
       "kg.m^2",
       {"id", "it", "diametralinertia", "transverseinertia", "transverse", "jd", "jt"}},
  };
  return t;
}

const std::vector<Meaning>& coefficient_meanings() {
  static const std::vector<Meaning> t = [] {
    std::vector<Meaning> r = {{"speed", "rad/s", {"speed", "rpm", "n", "omega"}},
                              {"frequency", "rad/s", {"frequency", "excitationfrequency"}}};
    // x, y across are y, z here; z along is x
    static constexpr std::array<std::array<const char*, 2>, 5> pairs{
        {{"xx", "yy"}, {"xy", "yz"}, {"yx", "zy"}, {"yy", "zz"}, {"zz", "xx"}}};
    static std::array<std::array<std::string, 5>, 3> theirs, ours;
    static constexpr std::array<char, 3> kinds{'k', 'c', 'm'};
    static constexpr std::array<const char*, 3> units{"N/m", "N.s/m", "kg"};
    for (std::size_t kind = 0; kind < 3; ++kind)
      for (std::size_t pair = 0; pair < 5; ++pair) {
        theirs[kind][pair] = std::string(1, kinds[kind]) + pairs[pair][0];
        ours[kind][pair] = std::string(1, kinds[kind]) + pairs[pair][1];
        r.push_back({ours[kind][pair].c_str(), units[kind], {theirs[kind][pair].c_str()}});
      }
    return r;
  }();
  return t;
}

std::string letters(std::string_view title) {
  std::string r;
  for (const char c : title)
    if (std::isalnum(static_cast<unsigned char>(c)))
      r += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return r;
}

/// A unit as it is spelt here: "kg m2" is kg.m^2, "RPM" rpm, "lb" the pound that is given.
std::string respelt(std::string_view unit, const char* pound) {
  std::string r, word;
  const auto end_word = [&] {
    static const std::map<std::string, std::string> words = {
        {"RPM", "rpm"}, {"Rpm", "rpm"}, {"inches", "in"}, {"IN", "in"}, {"MM", "mm"}, {"KG", "kg"}};
    if (word == "lb" || word == "lbs" || word == "LB") word = pound;
    const auto it = words.find(word);
    r += it == words.end() ? word : it->second;
    word.clear();
  };
  for (const char c : unit) {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      word += c;
      continue;
    }
    const bool power = std::isdigit(static_cast<unsigned char>(c)) && !word.empty();
    end_word();
    if (power) r += '^';
    r += c == '-' || c == ' ' || c == '*' ? '.' : c;
  }
  end_word();
  return r;
}

/// Factor to SI where the unit, in one of its spellings, has the dimension wanted.
std::optional<units::Factor> factor_of(const std::string& unit, const char* wanted) {
  for (const std::string& spelt : {unit, respelt(unit, "lbm"), respelt(unit, "lbf")})
    if (const units::Factor f = units::factor(spelt, wanted); !f.problem) return f;
  return {};
}

std::optional<double> number_of(const std::string& text) {
  double x = 0;
  const char* end = text.data() + text.size();
  const auto [at, problem] = std::from_chars(text.data(), end, x);
  if (problem != std::errc() || at != end || !std::isfinite(x)) return {};
  return x;
}

class TableReader {
 public:
  TableReader(const CellTable& table, const std::vector<Meaning>& meanings, Notes& notes)
      : table_(table),
        meanings_(meanings),
        notes_(notes) {}

  std::vector<Column> read() {
    std::vector<Column> columns;
    for (std::size_t k = 0; k < table_.header.size(); ++k)
      if (auto c = column(k)) {
        if (std::any_of(columns.begin(), columns.end(),
                        [&](const Column& o) { return o.key == c->key; })) {
          notes_.say(fmt::format("a second column '{}' is left out", table_.header[k].text), {}, {},
                     table_.header[k].line);
          continue;
        }
        columns.push_back(std::move(*c));
      }
    return columns;
  }

 private:
  /// The meaning whose title and dimension fit.
  const Meaning* meaning_of(const ColumnTitle& title, const Cell& cell) const {
    const std::string wanted = letters(title.name);
    const char* expected = nullptr;
    for (const Meaning& m : meanings_) {
      if (std::none_of(m.titles.begin(), m.titles.end(),
                       [&](const char* t) { return wanted == t; }))
        continue;
      const bool text = *m.unit == '\0';
      if (!title.has_unit && text) return &m;
      // a title that is a unit itself
      if (!title.has_unit && wanted == "rpm") return &m;
      if (!text) expected = m.unit;
      if (!text && title.has_unit && factor_of(title.unit, m.unit)) return &m;
    }
    if (expected && !title.has_unit)
      notes_.refuse(
          fmt::format("the column '{}' has no unit", cell.text),
          fmt::format("write it as '{} [{}]' or with the unit it has", cell.text, expected), {},
          cell.line);
    // numbers that belong to the machine are not dropped for a spelling
    if (expected)
      notes_.refuse(fmt::format("the unit of column '{}' is none of {}", cell.text, expected),
                    "`whirl schema --units` lists the units", {}, cell.line);
    return nullptr;
  }

  std::optional<Column> column(std::size_t k) {
    const Cell& cell = table_.header[k];
    const ColumnTitle title = split_title(cell.text);
    if (letters(title.name).empty()) return {};
    const Meaning* m = meaning_of(title, cell);
    if (!m) {
      notes_.say(fmt::format("the column '{}' is left out", cell.text), {}, {}, cell.line);
      return {};
    }
    Column c;
    c.key = m->key;
    const bool text = *m->unit == '\0';
    const units::Factor factor =
        text ? units::Factor{} : *factor_of(title.has_unit ? title.unit : "rpm", m->unit);
    for (const auto& row : table_.rows) {
      const std::string& value = k < row.size() ? row[k].text : std::string();
      c.texts.push_back(value);
      if (text || value.empty()) {
        c.values.emplace_back();
        continue;
      }
      const auto x = number_of(value);
      if (!x)
        notes_.refuse(fmt::format("'{}' in column '{}' is no number", value, cell.text), {}, {},
                      row[k].line);
      c.values.push_back(factor(*x));
    }
    return c;
  }

  const CellTable& table_;
  const std::vector<Meaning>& meanings_;
  Notes& notes_;
};

const Column* find(const std::vector<Column>& columns, std::string_view key) {
  for (const Column& c : columns)
    if (c.key == key) return &c;
  return nullptr;
}

double at(const Column* c, std::size_t row, double absent) {
  return c && c->values[row] ? *c->values[row] : absent;
}

std::string coefficient_table(const CellTable& cells, Notes& notes) {
  const auto columns = TableReader(cells, coefficient_meanings(), notes).read();
  const Column *speed = find(columns, "speed"), *frequency = find(columns, "frequency");
  if (!speed && !frequency)
    notes.refuse("there is no column of speeds", "a title like 'speed [rpm]'");
  if (!speed) {
    notes.say("there is no column of speeds: every frequency is taken for that of the rotation",
              "coefficients at a frequency of the motion need a column 'speed [rpm]' beside it");
    std::swap(speed, frequency);
  }
  std::string out = frequency ? "speed[rpm],frequency[Hz]" : "speed[rpm]";
  std::vector<std::pair<const Column*, const char*>> shown;
  for (const Column& c : columns) {
    if (&c == speed || &c == frequency) continue;
    const char* unit = c.key[0] == 'k' ? "N/m" : c.key[0] == 'c' ? "N.s/m" : "kg";
    shown.emplace_back(&c, unit);
    out += fmt::format(",{}[{}]", c.key, unit);
  }
  out += "\n";
  std::vector<std::size_t> order(cells.rows.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  for (const std::size_t k : order) {
    if (!speed->values[k])
      notes.refuse("a row without a speed", {}, {}, cells.rows[k].front().line);
    if (frequency && !frequency->values[k])
      notes.refuse("a row without a frequency", {}, {}, cells.rows[k].front().line);
  }
  const auto place = [&](std::size_t k) {
    return std::pair(*speed->values[k], frequency ? *frequency->values[k] : 0.0);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  for (const std::size_t k : order) {
    out += units::format_number(cell(*speed->values[k], "rpm").real);
    if (frequency) out += "," + units::format_number(cell(to_hz(*frequency->values[k]), "Hz").real);
    for (const auto& [c, unit] : shown) {
      if (!c->values[k])
        notes.refuse(fmt::format("a row without '{}'", c->key), {}, {}, cells.rows[k].front().line);
      out += "," + units::format_number(cell(*c->values[k], unit).real);
    }
    out += "\n";
  }
  return out;
}

/// A deck of a table of stations.
class StationDeck {
 public:
  StationDeck(const CellTable& cells, Notes& notes)
      : cells_(cells),
        notes_(notes),
        columns_(TableReader(cells, station_meanings(), notes).read()) {}

  std::string write() {
    const Column *length = find(columns_, "length"), *od = find(columns_, "od_l");
    if (!length || !od)
      notes_.refuse("there are no columns of lengths and outer diameters",
                    "titles like 'Length [mm]' and 'OD [mm]'; of coefficients 'speed [rpm]' and "
                    "'Kxx [N/m]'");
    refuse_layers();
    Value root = Value::make_table();
    root.add("format", Value::of_integer(1));
    root.add("title", Value::of_text(fmt::format("Converted from {}", notes_.file())));
    Value shafts = Value::make_array();
    shafts.items.push_back(shaft());
    if (Value list = materials(); !list.items.empty()) root.add("material", std::move(list));
    root.add("shaft", std::move(shafts));
    if (!disks_.items.empty()) root.add("disk", std::move(disks_));
    Value bearings = Value::make_array();
    root.add("bearing", two_supports());
    Value steps = Value::make_array(), modal = Value::make_table();
    modal.add("name", Value::of_text("modes"));
    modal.add("type", Value::of_text("modal"));
    modal.add("motion", Value::of_text("lateral"));
    steps.items.push_back(std::move(modal));
    root.add("step", std::move(steps));
    std::string head = comment(fmt::format("Converted from '{}'.", notes_.file()));
    head += "# Left out or assumed:\n";
    for (const Diagnostic& d : notes_.list())
      head += comment("- " + d.message);
    return head + write_toml(root);
  }

 private:
  /// Layers of one element stand in rows of their own: put one after the other they would make the
  /// rotor longer.
  void refuse_layers() const {
    constexpr const char* hint =
        "make one row of the layers of an element: the outer diameter of what is stiff, and masses "
        "that are not as disks; tables of ROSS are read with their layers (.toml, .json)";
    std::size_t layer = cells_.header.size();
    for (std::size_t k = 0; k < cells_.header.size(); ++k)
      if (const std::string title = letters(cells_.header[k].text);
          title == "layer" || title == "layers" || title == "sublayer")
        layer = k;
    const auto text = [](const std::vector<Cell>& row, std::size_t k) {
      return k < row.size() ? row[k].text : std::string();
    };
    const Column* name = find(columns_, "name");
    for (std::size_t r = 1; r < cells_.rows.size(); ++r) {
      const auto &row = cells_.rows[r], &first = cells_.rows.front();
      if (layer < cells_.header.size() && text(row, layer) != text(first, layer))
        notes_.refuse("the table has layers of elements in rows of their own", hint, {},
                      row.front().line);
      const bool numbered = name && number_of(name->texts[r]).has_value();
      if (numbered && name->texts[r] == name->texts[r - 1])
        notes_.refuse(fmt::format("the number {} stands in two rows", name->texts[r]), hint, {},
                      row.front().line);
    }
  }

  std::string material_of(std::size_t row) {
    const Column *E = find(columns_, "E"), *G = find(columns_, "G"),
                 *rho = find(columns_, "density");
    const Column* word = find(columns_, "material");
    if (E == nullptr && rho == nullptr) return named_material(word, row);
    if (E == nullptr || rho == nullptr)
      notes_.refuse(fmt::format("there is a column of {} and none of {}", E ? "E" : "density",
                                E ? "density" : "E"),
                    "titles like 'E [GPa]' and 'Density [kg/m3]', or a column of materials");
    for (const auto& [column, what] : {std::pair(E, "E"), std::pair(rho, "density")})
      if (!column->values[row])
        notes_.refuse(fmt::format("a station without {}", what), {}, {}, line(row));
    const std::array<double, 3> now{at(E, row, 0), at(G, row, at(E, row, 0) / 2.6),
                                    at(rho, row, 0)};
    if (!G) notes_.say("without a column of G it is E / 2.6");
    for (std::size_t k = 0; k < given_.size(); ++k)
      if (given_[k] == now) return given_names_[k];
    given_.push_back(now);
    given_names_.push_back(material_names_.unique(word && !word->texts[row].empty()
                                                      ? word->texts[row]
                                                      : fmt::format("material {}", given_.size())));
    return given_names_.back();
  }

  /// By its word alone: one of those that every deck knows, or steel where there is none.
  std::string named_material(const Column* word, std::size_t row) {
    if (word == nullptr || word->texts[row].empty()) {
      notes_.say(
          "without columns of E and density the shaft is of steel: E 210 GPa, density 7850 "
          "kg/m^3, Poisson's ratio 0.3");
      assumed_steel_ = true;
      return assumed_name;
    }
    std::string known;
    for (const auto& m : deck::builtin_materials()) {
      known += (known.empty() ? "" : ", ") + m.name;
      if (letters(m.name) == letters(word->texts[row])) return m.name;
    }
    notes_.refuse(
        fmt::format("of the material '{}' there are neither E nor density", word->texts[row]),
        fmt::format("give columns like 'E [GPa]' and 'Density [kg/m3]', or one of {}", known), {},
        line(row));
  }

  Value materials() const {
    Value list = Value::make_array();
    const auto one = [&](const std::string& name, double E, double G, double rho) {
      Value t = Value::make_table();
      t.add("name", Value::of_text(name));
      t.add("E", quantity(E, "GPa"));
      t.add("G", quantity(G, "GPa"));
      t.add("density", quantity(rho, "kg/m^3"));
      list.items.push_back(std::move(t));
    };
    for (std::size_t k = 0; k < given_.size(); ++k)
      one(given_names_[k], given_[k][0], given_[k][1], given_[k][2]);
    if (assumed_steel_) one(assumed_name, 210e9, 210e9 / 2.6, 7850);
    return list;
  }

  Value shaft() {
    Value titles = Value::make_array(), rows = Value::make_array();
    const auto title = [&](const char* t) { titles.items.push_back(Value::of_text(t)); };
    for (const char* t : {"name", "length[mm]", "od_l[mm]", "id_l[mm]", "od_r[mm]", "id_r[mm]"})
      title(t);
    const Column *stiff_od = find(columns_, "stiffness_od"),
                 *stiff_id = find(columns_, "stiffness_id");
    const bool stiffness = stiff_od || stiff_id;
    if (stiffness) title("stiffness_od[mm]");
    if (stiffness) title("stiffness_id[mm]");
    title("material");
    const Column *length = find(columns_, "length"), *od_l = find(columns_, "od_l"),
                 *id_l = find(columns_, "id_l"), *od_r = find(columns_, "od_r"),
                 *id_r = find(columns_, "id_r"), *label = find(columns_, "name");
    std::string last;
    for (std::size_t k = 0; k < cells_.rows.size(); ++k) {
      const double L = at(length, k, 0);
      const std::string wanted =
          label && !label->texts[k].empty() ? label->texts[k] : fmt::format("{}", k + 1);
      if (L == 0) {
        // a last station has a lumped mass and no shaft beyond it
        if (last.empty()) notes_.refuse("the first station has no length", {}, {}, line(k));
        disk(k, last + ":end");
        continue;
      }
      if (!od_l->values[k])
        notes_.refuse("a station with a length and without a diameter", {}, {}, line(k));
      const std::string name = section_names_.unique("s" + wanted);
      Value row = Value::make_array();
      row.items.push_back(Value::of_text(name));
      const double od = *od_l->values[k], id = at(id_l, k, 0);
      for (const double x : {L, od, id, at(od_r, k, od), at(id_r, k, id)})
        row.items.push_back(cell(x, "mm"));
      if (stiffness) row.items.push_back(cell(at(stiff_od, k, od), "mm"));
      if (stiffness) row.items.push_back(cell(at(stiff_id, k, id), "mm"));
      row.items.push_back(Value::of_text(material_of(k)));
      rows.items.push_back(std::move(row));
      disk(k, name + ":start");
      last = name;
      total_ += L;
    }
    if (rows.items.empty()) notes_.refuse("no station has a length");
    Value t = Value::make_table();
    t.add("name", Value::of_text("rotor"));
    t.add("columns", std::move(titles));
    t.add("rows", std::move(rows));
    return t;
  }

  int line(std::size_t row) const {
    return cells_.rows[row].empty() ? 0 : cells_.rows[row].front().line;
  }

  void disk(std::size_t k, const std::string& place) {
    const double mass = at(find(columns_, "mass"), k, 0), Ip = at(find(columns_, "Ip"), k, 0),
                 Id = at(find(columns_, "Id"), k, 0);
    if (mass == 0 && Ip == 0 && Id == 0) return;
    Value t = Value::make_table();
    t.add("name", Value::of_text(fmt::format("disk {}", disks_.items.size() + 1)));
    t.add("at", Value::of_text(place));
    t.add("mass", quantity(mass, "kg"));
    t.add("Ip", quantity(Ip, "kg.m^2"));
    t.add("Id", quantity(Id, "kg.m^2"));
    disks_.items.push_back(std::move(t));
  }

  /// A table of stations has no bearings: two, to be replaced.
  Value two_supports() {
    notes_.say(
        "a table of stations has no bearings: two of 1e8 N/m stand at a tenth and nine "
        "tenths of the length, to be replaced");
    Value list = Value::make_array();
    for (const double where : {0.1, 0.9}) {
      Value t = Value::make_table();
      t.add("name", Value::of_text(where < 0.5 ? "left" : "right"));
      t.add("at", quantity(where * total_, "mm"));
      t.add("type", Value::of_text("linear"));
      for (const char* key : {"kyy", "kzz"})
        t.add(key, quantity(1e8, "N/m"));
      list.items.push_back(std::move(t));
    }
    return list;
  }

  const CellTable& cells_;
  Notes& notes_;
  std::vector<Column> columns_;
  static constexpr const char* assumed_name = "steel";
  bool assumed_steel_ = false;
  std::vector<std::array<double, 3>> given_;
  std::vector<std::string> given_names_;
  Names material_names_, section_names_;
  Value disks_ = Value::make_array();
  double total_ = 0;
};

}  // namespace

Converted convert_csv(const std::string& text, const std::string& name) {
  Notes notes(name);
  const CellTable cells = read_cells(text);
  if (!cells.problem.empty()) notes.refuse(cells.problem, {}, {}, cells.problem_line);
  if (cells.rows.empty()) notes.refuse("there are no rows below the titles");
  Converted c;
  c.is_table = std::any_of(cells.header.begin(), cells.header.end(), [](const Cell& h) {
    return letters(split_title(h.text).name) == "kxx";
  });
  const auto own = std::find_if(cells.header.begin(), cells.header.end(), [](const Cell& h) {
    const std::string title = letters(split_title(h.text).name);
    return title == "kzz" || title == "kyz" || title == "kzy";
  });
  if (!c.is_table && own != cells.header.end())
    notes.refuse(
        fmt::format("'{}' is a title of this program's own, whose axes across are y and z",
                    own->text),
        fmt::format("a deck reads the table as it is: [[bearing]] type = \"table\", file = \"{}\"",
                    name),
        {}, own->line);
  c.text = c.is_table ? coefficient_table(cells, notes) : StationDeck(cells, notes).write();
  c.left_out = notes.take();
  return c;
}

}  // namespace whirl::convert
