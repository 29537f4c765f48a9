#include <convert/ross.hpp>
#include <convert/deck_values.hpp>
#include <convert/ross_elements.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <optional>

namespace whirl::convert {
namespace {

using deck::Value;

/// What stands between two nodes: one or more layers.
struct Span {
  std::vector<const RossLayer*> layers;  ///< from the inside out
  std::string name;
  double length = 0;
};

/// A tube of a stepless shaft in one row: outline for the mass, and for the stiffness where that
/// is another.
struct Row {
  double od_l = 0, id_l = 0, od_r = 0, id_r = 0;
  bool sleeve = false;
  double stiff_od_l = 0, stiff_id_l = 0, stiff_od_r = 0, stiff_id_r = 0;
  const RossLayer* of = nullptr;  ///< whose material and options hold
};

double bending(const RossLayer& s) {
  const double od = 0.5 * (s.od_l + s.od_r), id = 0.5 * (s.id_l + s.id_r);
  return s.material.E * std::numbers::pi / 64 * (std::pow(od, 4) - std::pow(id, 4));
}

bool touch(const RossLayer& inner, const RossLayer& outer) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(a, b); };
  return near(inner.od_l, outer.id_l) && near(inner.od_r, outer.id_r);
}

bool chained(const std::vector<const RossLayer*>& layers) {
  for (std::size_t k = 1; k < layers.size(); ++k)
    if (!touch(*layers[k - 1], *layers[k])) return false;
  return true;
}

/// The layers as one tube: of one material, or with sleeves that add mass and no stiffness.
std::optional<Row> as_row(const Span& span) {
  const auto& layers = span.layers;
  const double whole = [&] {
    double sum = 0;
    for (const RossLayer* s : layers)
      sum += bending(*s);
    return sum;
  }();
  std::vector<const RossLayer*> stiff;
  for (const RossLayer* s : layers)
    if (bending(*s) > 1e-5 * whole) stiff.push_back(s);
  if (stiff.empty()) return {};  // a modulus beyond all numbers
  for (const RossLayer* s : stiff)
    if (!(s->material == stiff.front()->material)) return {};
  for (const RossLayer* s : layers)
    if (s->material.rho != stiff.front()->material.rho) return {};
  if (!chained(layers) || !chained(stiff)) return {};
  const RossLayer &in = *layers.front(), &out = *layers.back();
  Row r;
  r.of = stiff.front();
  r.od_l = out.od_l;
  r.od_r = out.od_r;
  r.id_l = in.id_l;
  r.id_r = in.id_r;
  r.sleeve = stiff.size() < layers.size();
  r.stiff_od_l = stiff.back()->od_l;
  r.stiff_od_r = stiff.back()->od_r;
  r.stiff_id_l = stiff.front()->id_l;
  r.stiff_id_r = stiff.front()->id_r;
  return r;
}

/// Cowper's shear factor of a tube (1966), m = id/od.
double cowper(double nu, double m) {
  const double q = (1 + m * m) * (1 + m * m);
  return 6 * (1 + nu) * q / ((7 + 6 * nu) * q + (20 + 12 * nu) * m * m);
}

/// The layers side by side as constants of the section.
Value constants_of(const Span& span, Notes& notes) {
  double EA = 0, kGA = 0, GJ = 0, EI = 0, rhoA = 0, rhoI = 0;
  for (const RossLayer* s : span.layers) {
    if (!s->cylinder())
      notes.say("a cone of several layers is taken as a cylinder of its mean diameters", {},
                s->entity, s->line);
    const double od = 0.5 * (s->od_l + s->od_r), id = 0.5 * (s->id_l + s->id_r);
    const double area = std::numbers::pi / 4 * (od * od - id * id);
    const double second = std::numbers::pi / 64 * (std::pow(od, 4) - std::pow(id, 4));
    const RossMaterial& m = s->material;
    EA += m.E * area;
    kGA += cowper(m.E / (2 * m.G) - 1, id / od) * m.G * area;
    GJ += 2 * m.G * second;
    EI += m.E * second;
    rhoA += m.rho * area;
    rhoI += m.rho * second;
  }
  notes.say("layers of different materials become the sum of their stiffness and mass", {},
            fmt::format("section '{}'", span.name));
  Value t = Value::make_table();
  t.add("EA", quantity(EA, "N"));
  t.add("kGA", quantity(kGA, "N"));
  t.add("GJ", quantity(GJ, "N.m^2"));
  t.add("EI", quantity(EI, "N.m^2"));
  t.add("rhoA", quantity(rhoA, "kg/m"));
  t.add("rhoI", quantity(rhoI, "kg.m"));
  t.add("rhoIp", quantity(2 * rhoI, "kg.m"));
  return t;
}

class RossDeck {
 public:
  RossDeck(const RossRotor& rotor, Notes& notes) : rotor_(rotor), notes_(notes) {}

  std::string write() {
    join_layers();
    Value root = Value::make_table();
    root.add("format", Value::of_integer(1));
    root.add("title", Value::of_text(fmt::format("Converted from {}", notes_.file())));
    root.add("material", materials());
    Value shafts = Value::make_array();
    shafts.items.push_back(shaft());
    root.add("shaft", std::move(shafts));
    add(root, "disk", disks());
    add(root, "bearing", bearings());
    say_what_stands_apart();
    add(root, "step", steps());
    std::string head = comment(fmt::format(
        "Converted from '{}'{}. ROSS's axes x, y (across) and z (along the shaft) are y, z and x "
        "here; its weight acts along -y, here along -z.",
        notes_.file(), rotor_.version.empty() ? "" : ", written by ROSS " + rotor_.version));
    if (!notes_.list().empty()) head += "# Left out or assumed:\n";
    for (const Diagnostic& d : notes_.list())
      head += comment("- " + (d.where.entity.empty() ? "" : d.where.entity + ": ") + d.message);
    return head + write_toml(root);
  }

 private:
  static void add(Value& root, const char* key, Value list) {
    if (!list.items.empty()) root.add(key, std::move(list));
  }

  void join_layers() {
    std::map<long, Span> by_node;
    for (const RossLayer& s : rotor_.layers)
      by_node[s.n].layers.push_back(&s);
    long expected = 0;
    for (auto& [n, span] : by_node) {
      if (n != expected)
        notes_.refuse(fmt::format("there is no shaft element at node {}", expected),
                      "the elements of one shaft must follow each other; of several rotors in one "
                      "file convert each by itself");
      ++expected;
      auto& layers = span.layers;
      std::stable_sort(layers.begin(), layers.end(), [](const RossLayer* a, const RossLayer* b) {
        return a->id_l + a->id_r < b->id_l + b->id_r;
      });
      span.length = layers.front()->length;
      for (const RossLayer* s : layers)
        if (std::abs(s->length - span.length) > 1e-9 * span.length)
          notes_.refuse(
              fmt::format("the layers between nodes {} and {} differ in length", n, n + 1), {},
              s->entity, s->line);
      span.name = fmt::format("s{}", n);
      spans_.push_back(span);
    }
    for (const Span& span : spans_)
      for (const RossLayer* s : span.layers)
        material_name(*s);
  }

  const std::string& material_name(const RossLayer& s) {
    for (const auto& [m, name] : materials_)
      if (m == s.material) return name;
    const std::string wanted = s.material.name.empty() ? "steel" : s.material.name;
    materials_.emplace_back(s.material, material_names_.unique(wanted));
    return materials_.back().second;
  }

  Value materials() const {
    Value list = Value::make_array();
    for (const auto& [m, name] : materials_) {
      if (!used(m)) continue;
      Value t = Value::make_table();
      t.add("name", Value::of_text(name));
      t.add("E", quantity(m.E, "GPa"));
      t.add("G", quantity(m.G, "GPa"));
      t.add("density", quantity(m.rho, "kg/m^3"));
      list.items.push_back(std::move(t));
    }
    return list;
  }
  /// A sleeve without stiffness names no material of its own.
  bool used(const RossMaterial& m) const {
    return std::any_of(spans_.begin(), spans_.end(), [&](const Span& span) {
      const auto row = as_row(span);
      return (row ? row->of : main_layer(span))->material == m;
    });
  }

  Value shaft() {
    Value t = Value::make_table();
    t.add("name", Value::of_text("rotor"));
    t.add("material", Value::of_text(material_name(*main_layer(spans_.front()))));
    damping(t);
    bool rows = true;
    for (const Span& span : spans_)
      rows = rows && as_row(span).has_value();
    if (rows)
      section_rows(t);
    else
      section_tables(t);
    return t;
  }

  static const RossLayer* main_layer(const Span& span) {
    return *std::max_element(
        span.layers.begin(), span.layers.end(),
        [](const RossLayer* a, const RossLayer* b) { return bending(*a) < bending(*b); });
  }

  /// ROSS's alpha M + beta K acts in fixed axes.
  void damping(Value& shaft) {
    const RossLayer& first = rotor_.layers.front();
    for (const RossLayer& s : rotor_.layers)
      if (s.alpha != first.alpha || s.beta != first.beta) {
        notes_.say("damping by alpha and beta that differs along the shaft is not taken over",
                   "[shaft.damping] holds for a whole shaft", s.entity, s.line);
        return;
      }
    if (first.alpha == 0 && first.beta == 0) return;
    Value t = Value::make_table();
    t.add("rayleigh_alpha", quantity(first.alpha, "1/s"));
    t.add("external_beta", quantity(first.beta, "s"));
    shaft.add("damping", std::move(t));
  }

  const char* shear_word(const RossLayer& s) const {
    if (!s.shear) return "none";
    return s.hutchinson ? "hutchinson" : "cowper";
  }

  void section_rows(Value& shaft) {
    const auto any = [&](auto&& test) {
      return std::any_of(spans_.begin(), spans_.end(),
                         [&](const Span& s) { return test(*as_row(s)); });
    };
    const bool cones = any([](const Row& r) {
      return r.od_l != r.od_r || r.id_l != r.id_r || r.stiff_od_l != r.stiff_od_r ||
             r.stiff_id_l != r.stiff_id_r;
    });
    const bool sleeves = any([](const Row& r) { return r.sleeve; });
    const bool mixed = any(
        [&](const Row& r) { return !(r.of->material == main_layer(spans_.front())->material); });
    const bool shear = any([](const Row& r) { return !r.of->shear || r.of->hutchinson; });
    const bool rotary = any([](const Row& r) { return !r.of->rotary; });
    Value titles = Value::make_array(), rows = Value::make_array();
    const auto title = [&](const char* t) { titles.items.push_back(Value::of_text(t)); };
    title("name");
    title("length[mm]");
    const std::vector<const char*> outline =
        cones ? std::vector<const char*>{"od_l[mm]", "id_l[mm]", "od_r[mm]", "id_r[mm]"}
              : std::vector<const char*>{"od[mm]", "id[mm]"};
    for (const char* t : outline)
      title(t);
    if (sleeves)
      for (const char* t : outline)
        stiffness_titles_.push_back(fmt::format("stiffness_{}", t));
    for (const std::string& t : stiffness_titles_)
      title(t.c_str());
    if (mixed) title("material");
    if (shear) title("shear");
    if (rotary) title("rotary_inertia");
    for (const Span& span : spans_) {
      const Row r = *as_row(span);
      Value row = Value::make_array();
      row.items.push_back(Value::of_text(span.name));
      const auto mm = [&](double x) { row.items.push_back(cell(x, "mm")); };
      mm(span.length);
      const auto diameters = [&](double od_l, double id_l, double od_r, double id_r) {
        mm(od_l);
        mm(id_l);
        if (!cones) return;
        mm(od_r);
        mm(id_r);
      };
      diameters(r.od_l, r.id_l, r.od_r, r.id_r);
      if (sleeves) diameters(r.stiff_od_l, r.stiff_id_l, r.stiff_od_r, r.stiff_id_r);
      if (mixed) row.items.push_back(Value::of_text(material_name(*r.of)));
      if (shear) row.items.push_back(Value::of_text(shear_word(*r.of)));
      if (rotary) row.items.push_back(Value::of_flag(r.of->rotary));
      rows.items.push_back(std::move(row));
    }
    shaft.add("columns", std::move(titles));
    shaft.add("rows", std::move(rows));
  }

  void section_tables(Value& shaft) {
    Value list = Value::make_array();
    for (const Span& span : spans_) {
      Value t = Value::make_table();
      t.add("name", Value::of_text(span.name));
      t.add("length", quantity(span.length, "mm"));
      const auto row = as_row(span);
      const RossLayer& s = row ? *row->of : *main_layer(span);
      t.add("od_l", quantity(row ? row->od_l : span.layers.back()->od_l, "mm"));
      t.add("od_r", quantity(row ? row->od_r : span.layers.back()->od_r, "mm"));
      t.add("id_l", quantity(row ? row->id_l : span.layers.front()->id_l, "mm"));
      t.add("id_r", quantity(row ? row->id_r : span.layers.front()->id_r, "mm"));
      if (row && row->sleeve) {
        t.add("stiffness_od_l", quantity(row->stiff_od_l, "mm"));
        t.add("stiffness_od_r", quantity(row->stiff_od_r, "mm"));
        t.add("stiffness_id_l", quantity(row->stiff_id_l, "mm"));
        t.add("stiffness_id_r", quantity(row->stiff_id_r, "mm"));
      }
      t.add("material", Value::of_text(material_name(s)));
      if (row) {
        t.add("shear", Value::of_text(shear_word(s)));
        t.add("rotary_inertia", Value::of_flag(s.rotary));
      } else {
        t.add("constants", constants_of(span, notes_));
      }
      list.items.push_back(std::move(t));
    }
    shaft.add("section", std::move(list));
  }

  bool on_shaft(long n) const { return n >= 0 && n <= static_cast<long>(spans_.size()); }
  Value place(long n, const std::string& entity) const {
    if (!on_shaft(n))
      notes_.refuse(
          fmt::format("node {} is not on the shaft, which ends at node {}", n, spans_.size()), {},
          entity);
    const auto k = static_cast<std::size_t>(n);
    return Value::of_text(k < spans_.size() ? spans_[k].name + ":start"
                                            : spans_.back().name + ":end");
  }

  Value disks() {
    Value list = Value::make_array();
    const auto one = [&](const RossDisk& d) {
      Value t = Value::make_table();
      t.add("name", Value::of_text(names_.unique(d.name)));
      t.add("at", place(d.n, d.entity));
      t.add("mass", quantity(d.m, "kg"));
      t.add("Ip", quantity(d.Ip, "kg.m^2"));
      t.add("Id", quantity(d.Id, "kg.m^2"));
      list.items.push_back(std::move(t));
    };
    for (const RossDisk& d : rotor_.disks)
      one(d);
    for (const RossDisk& d : rotor_.masses)
      if (on_shaft(d.n)) one(d);
    return list;
  }

  Value bearings() {
    Value list = Value::make_array();
    for (const RossBearing& b : rotor_.bearings) {
      if (!on_shaft(b.n)) continue;  // the far side of another one
      Value t = Value::make_table();
      t.add("name", Value::of_text(names_.unique(b.name)));
      t.add("at", place(b.n, b.entity));
      t.add("type", Value::of_text(b.speed.empty() ? "linear" : "table"));
      if (b.speed.empty())
        constant_entries(t, b);
      else
        table_entries(t, b);
      if (b.n_link >= 0) pedestal(t, b);
      list.items.push_back(std::move(t));
    }
    return list;
  }

  static constexpr std::array<char, 3> kinds{'k', 'c', 'm'};
  static constexpr std::array<const char*, 3> units{"N/m", "N.s/m", "kg"};
  /// ROSS's x, y, z here.
  static constexpr std::array<const char*, 5> pairs{"yy", "yz", "zy", "zz", "xx"};

  static void constant_entries(Value& t, const RossBearing& b, bool mass = true) {
    for (std::size_t kind = 0; kind < (mass ? 3 : 2); ++kind)
      for (std::size_t pair = 0; pair < pairs.size(); ++pair)
        if (const double x = b.entry[kind][pair].front(); x != 0)
          t.add(std::string(1, kinds[kind]) + pairs[pair], quantity(x, units[kind]));
  }

  void table_entries(Value& t, const RossBearing& b) {
    t.add("extrapolate", Value::of_text("hold"));
    notes_.say("outside the speeds of a bearing's table its last row holds (ROSS extrapolates)");
    Value titles = Value::make_array(), rows = Value::make_array();
    titles.items.push_back(Value::of_text("speed[rad/s]"));
    std::vector<std::size_t> order(b.speed.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      order[k] = k;
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return b.speed[i] < b.speed[j]; });
    std::vector<std::pair<std::size_t, std::size_t>> columns;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind)
      for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
        const auto& entry = b.entry[kind][pair];
        if (std::all_of(entry.begin(), entry.end(), [](double x) { return x == 0; })) continue;
        columns.emplace_back(kind, pair);
        titles.items.push_back(
            Value::of_text(fmt::format("{}{}[{}]", kinds[kind], pairs[pair], units[kind])));
      }
    for (const std::size_t k : order) {
      Value row = Value::make_array();
      row.items.push_back(cell(b.speed[k], "rad/s"));
      for (const auto& [kind, pair] : columns)
        row.items.push_back(cell(b.entry[kind][pair][k], units[kind]));
      rows.items.push_back(std::move(row));
    }
    t.add("columns", std::move(titles));
    t.add("rows", std::move(rows));
  }

  /// A bearing to a node off the shaft: that node's mass and all that ties it to the ground.
  void pedestal(Value& t, const RossBearing& b) {
    if (on_shaft(b.n_link)) notes_.refuse("it connects two nodes of one shaft", {}, b.entity);
    const auto stands_there = [&](const RossBearing& o) { return o.n_link == b.n_link; };
    if (std::count_if(rotor_.bearings.begin(), rotor_.bearings.end(), stands_there) > 1)
      notes_.refuse(
          fmt::format("node {}, which it stands on, carries another element too", b.n_link),
          "a pedestal carries one bearing: make one element of those to the same node of the "
          "shaft; "
          "of several bearings on one mass write a [[foundation]]",
          b.entity);
    const RossBearing ground = ties_to_ground(b);
    Value support = Value::make_table();
    support.add("mass", quantity(mass_of_node(b.n_link) + isotropic_mass(ground), "kg"));
    constant_entries(support, ground, false);
    t.add("support", std::move(support));
  }

  double mass_of_node(long n) const {
    double mass = 0;
    for (const RossDisk& m : rotor_.masses)
      if (m.n == n) mass += m.m;
    return mass;
  }

  /// What stands between the ground and the node of a pedestal, in sum.
  RossBearing ties_to_ground(const RossBearing& b) {
    std::optional<RossBearing> sum;
    for (const RossBearing& g : rotor_.bearings) {
      if (g.n != b.n_link) continue;
      if (g.n_link >= 0)
        notes_.refuse(fmt::format("node {} stands on another node in turn", b.n_link),
                      "one mass between bearing and ground can be taken; more are a [[foundation]]",
                      g.entity);
      if (!g.speed.empty())
        notes_.say("a support that depends on the speed is taken with its first row", {}, g.entity);
      if (!sum) {
        sum = g;
        continue;
      }
      for (std::size_t kind = 0; kind < kinds.size(); ++kind)
        for (std::size_t pair = 0; pair < pairs.size(); ++pair)
          sum->entry[kind][pair].front() += g.entry[kind][pair].front();
    }
    if (!sum)
      notes_.refuse(fmt::format("nothing carries node {}, which it stands on", b.n_link), {},
                    b.entity);
    return *sum;
  }

  /// The mass that elements to the ground give to a pedestal, which is the same in all directions.
  double isotropic_mass(const RossBearing& ground) {
    const auto& m = ground.entry[2];
    const double yy = m[0].front(), yz = m[1].front(), zy = m[2].front(), zz = m[3].front();
    if (yz != 0 || zy != 0 || yy != zz)
      notes_.say(
          fmt::format("masses of {} kg, {} kg and cross terms at a pedestal become one of {} "
                      "kg",
                      yy, zz, 0.5 * (yy + zz)),
          {}, ground.entity);
    return 0.5 * (yy + zz);
  }

  /// Says what of the nodes off the shaft is no pedestal.
  void say_what_stands_apart() {
    const auto carries = [&](long n) {
      return std::any_of(rotor_.bearings.begin(), rotor_.bearings.end(),
                         [&](const RossBearing& b) { return b.n_link == n; });
    };
    const auto say = [&](long n, const std::string& entity) {
      if (!on_shaft(n) && !carries(n))
        notes_.say(fmt::format("it stands at node {}, which no bearing ties to the shaft", n), {},
                   entity);
    };
    for (const RossBearing& b : rotor_.bearings)
      say(b.n, b.entity);
    for (const RossDisk& m : rotor_.masses)
      say(m.n, m.entity);
  }

  Value steps() {
    Value list = Value::make_array();
    Value modal = Value::make_table();
    modal.add("name", Value::of_text("modes"));
    modal.add("type", Value::of_text("modal"));
    double speed = rotor_.rated;
    double most = rotor_.most;
    for (const RossBearing& b : rotor_.bearings)
      if (!b.speed.empty())
        most = std::max(most, *std::max_element(b.speed.begin(), b.speed.end()));
    modal.add("speed", quantity(speed, "rpm"));
    modal.add("motion", Value::of_text("lateral"));
    list.items.push_back(std::move(modal));
    if (most > 0) {
      Value campbell = Value::make_table();
      campbell.add("name", Value::of_text("campbell"));
      campbell.add("type", Value::of_text("campbell"));
      campbell.add("motion", Value::of_text("lateral"));
      Value range = Value::make_table();
      range.add("start", quantity(rotor_.least, "rpm"));
      range.add("stop", quantity(most, "rpm"));
      range.add("points", Value::of_integer(31));
      campbell.add("speed", std::move(range));
      list.items.push_back(std::move(campbell));
    }
    return list;
  }

  const RossRotor& rotor_;
  Notes& notes_;
  std::vector<Span> spans_;
  std::vector<std::pair<RossMaterial, std::string>> materials_;
  std::vector<std::string> stiffness_titles_;
  Names material_names_, names_;
};

}  // namespace

Converted convert_ross(const Value& file, const std::string& name) {
  Notes notes(name);
  const RossRotor rotor = read_ross(file, notes);
  Converted c;
  c.text = RossDeck(rotor, notes).write();
  c.left_out = notes.take();
  return c;
}

}  // namespace whirl::convert
