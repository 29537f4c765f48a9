#include <convert/ross_elements.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace whirl::convert {
namespace {

using deck::Member;
using deck::Value;

/// One element of the file: class, tag and arguments.
struct Element {
  const Value* table = nullptr;
  std::string kind, tag, entity;
  int line = 0;
};

class ElementReader {
 public:
  ElementReader(const Element& e, const Notes& notes) : element_(e), notes_(notes) {}

  const Value* value(std::initializer_list<const char*> keys) const {
    for (const char* key : keys)
      if (const Member* m = element_.table->find(key)) return &m->value;
    return nullptr;
  }
  std::optional<double> given(std::initializer_list<const char*> keys) const {
    const Value* v = value(keys);
    if (!v) return {};
    if (v->is_number() && std::isfinite(v->number())) return v->number();
    if (v->kind == Value::Kind::unreadable) return {};  // null
    fail(fmt::format("'{}' is {}, not a number", *keys.begin(), name_of(v->kind)));
  }
  double number(std::initializer_list<const char*> keys) const {
    const auto x = given(keys);
    if (!x) fail(fmt::format("'{}' is missing", *keys.begin()));
    return *x;
  }
  double number(std::initializer_list<const char*> keys, double absent) const {
    return given(keys).value_or(absent);
  }
  bool flag(const char* key, bool absent) const {
    const Value* v = value({key});
    return v && v->kind == Value::Kind::boolean ? v->boolean : absent;
  }
  std::string text(const char* key) const {
    const Value* v = value({key});
    return v && v->is_text() ? v->text : std::string();
  }
  /// One number or a list of them.
  std::vector<double> numbers(const char* key) const {
    const Value* v = value({key});
    if (!v || v->kind == Value::Kind::unreadable) return {};
    if (v->is_number()) return {number({key})};
    if (!v->is_array()) fail(fmt::format("'{}' is {}, not numbers", key, name_of(v->kind)));
    std::vector<double> r;
    for (const Value& x : v->items) {
      if (!x.is_number() || !std::isfinite(x.number()))
        fail(fmt::format("'{}' holds something that is no number", key));
      r.push_back(x.number());
    }
    return r;
  }
  [[noreturn]] void fail(const std::string& what) const {
    notes_.refuse(fmt::format("{}: {}", element_.entity, what), {}, {}, element_.line);
  }

 private:
  const Element& element_;
  const Notes& notes_;
};

long node_of(const ElementReader& r, const char* key = "n") {
  const double n = r.number({key});
  if (n != std::floor(n) || n < 0 || n > 1e6) r.fail(fmt::format("'{}' is no node", key));
  return static_cast<long>(n);
}

RossMaterial material_of(const ElementReader& r) {
  const Value* v = r.value({"material"});
  if (!v || !v->is_table())
    r.fail("its material is not in the file (a name alone refers to a list that ROSS keeps)");
  Element e;
  e.table = v;
  const auto number = [&](const char* key) -> std::optional<double> {
    const Member* m = v->find(key);
    if (!m || !m->value.is_number()) return {};
    return m->value.number();
  };
  RossMaterial material;
  if (const Member* m = v->find("name"); m && m->value.is_text()) material.name = m->value.text;
  const auto rho = number("rho"), E = number("E"), nu = number("Poisson");
  auto G = number("G_s");
  if (!G && E && nu) G = *E / (2 * (1 + *nu));
  if (!rho || !E || !G) r.fail("its material lacks rho, E or G_s");
  material.rho = *rho;
  material.E = *E;
  material.G = *G;
  if (!(*rho > 0 && *E > 0 && *G > 0)) r.fail("rho, E or G_s of its material is not positive");
  return material;
}

RossLayer layer_of(const Element& e, const Notes& base, Notes& notes) {
  const ElementReader r(e, base);
  RossLayer s;
  s.entity = e.entity;
  s.line = e.line;
  s.n = node_of(r);
  s.length = r.number({"L"});
  s.od_l = r.number({"odl", "o_d_l", "o_d"});
  s.id_l = r.number({"idl", "i_d_l", "i_d"}, 0);
  s.od_r = r.number({"odr", "o_d_r"}, s.od_l);
  s.id_r = r.number({"idr", "i_d_r"}, s.id_l);
  if (!(s.length > 0)) r.fail("its length 'L' is not positive");
  if (!(s.id_l >= 0 && s.id_l < s.od_l && s.id_r >= 0 && s.id_r < s.od_r))
    r.fail("an inner diameter is not less than the outer one");
  s.material = material_of(r);
  s.alpha = r.number({"alpha"}, 0);
  s.beta = r.number({"beta"}, 0);
  s.shear = r.flag("shear_effects", true);
  s.rotary = r.flag("rotary_inertia", true);
  s.hutchinson = r.text("shear_method_calc") == "hutchinson";
  if (!r.flag("gyroscopic", true))
    notes.say("gyroscopic = false is not taken over: every section has its gyroscopic moment", {},
              e.entity, e.line);
  if (r.number({"axial_force"}, 0) != 0)
    notes.say(fmt::format("the axial force {} N of the element is not taken over",
                          r.number({"axial_force"})),
              "a force in the shaft comes from [[load]] or the bearings' axial_force", e.entity,
              e.line);
  if (r.number({"torque"}, 0) != 0)
    notes.say(
        fmt::format("the torque {} N m of the element is not taken over", r.number({"torque"})),
        "a torque in the shaft comes from [[load]]", e.entity, e.line);
  return s;
}

RossDisk disk_of(const Element& e, const Notes& base) {
  const ElementReader r(e, base);
  return {e.entity, e.tag, node_of(r), r.number({"m"}), r.number({"Id"}, 0), r.number({"Ip"}, 0)};
}

RossDisk mass_of(const Element& e, const Notes& base, Notes& notes) {
  const ElementReader r(e, base);
  RossDisk m{e.entity, e.tag, node_of(r), 0, 0, 0};
  const auto all = r.given({"m"});
  const double mx = r.number({"mx"}, all.value_or(0)), my = r.number({"my"}, all.value_or(0));
  m.m = all.value_or(0.5 * (mx + my));
  if (mx != my)
    notes.say(
        fmt::format("a mass of {} kg along x and {} kg along y becomes one of {} kg", mx, my, m.m),
        {}, e.entity, e.line);
  return m;
}

RossBearing bearing_of(const Element& e, const Notes& base) {
  const ElementReader r(e, base);
  RossBearing b;
  b.entity = e.entity;
  b.name = e.tag;
  b.n = node_of(r);
  if (r.given({"n_link"})) b.n_link = node_of(r, "n_link");
  b.speed = r.numbers("frequency");
  if (b.speed.empty()) b.speed = r.numbers("w");
  const std::size_t rows = std::max<std::size_t>(b.speed.size(), 1);
  static constexpr std::array<char, 3> kinds{'k', 'c', 'm'};
  static constexpr std::array<const char*, 5> pairs{"xx", "xy", "yx", "yy", "zz"};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
      const std::string key = std::string(1, kinds[kind]) + pairs[pair];
      auto& entry = b.entry[kind][pair];
      entry = r.numbers(key.c_str());
      // what is isotropic is written once: kyy follows kxx
      if (entry.empty()) entry = pair == 3 ? b.entry[kind][0] : std::vector<double>{0.0};
      if (entry.size() == 1) entry.assign(rows, entry.front());
      if (entry.size() != rows)
        r.fail(fmt::format("'{}' has {} values for {} speeds", key, entry.size(), rows));
    }
  if (b.speed.size() == 1) b.speed.clear();
  return b;
}

/// "BearingElement_Bearing 0": class and tag.
std::optional<Element> element_of(const Member& m) {
  if (!m.value.is_table()) return {};
  const std::size_t cut = m.key.find('_');
  if (cut == std::string::npos || cut == 0) return {};
  Element e;
  e.table = &m.value;
  e.kind = m.key.substr(0, cut);
  e.tag = m.key.substr(cut + 1);
  if (const Member* t = m.value.find("tag"); t && t->value.is_text()) e.tag = t->value.text;
  if (e.tag.empty() || e.tag == "None") e.tag = e.kind;
  e.entity = fmt::format("{} '{}'", e.kind, e.tag);
  e.line = m.spot.line;
  return e;
}

double parameter(const Value& file, const char* key) {
  const Member* parameters = file.find("parameters");
  const Member* m =
      parameters && parameters->value.is_table() ? parameters->value.find(key) : nullptr;
  return m && m->value.is_number() ? m->value.number() : 0;
}

void take(const Element& e, RossRotor& rotor, Notes& notes) {
  if (e.kind.rfind("ShaftElement", 0) == 0) {
    rotor.layers.push_back(layer_of(e, notes, notes));
  } else if (e.kind.rfind("DiskElement", 0) == 0) {
    rotor.disks.push_back(disk_of(e, notes));
  } else if (e.kind.rfind("GearElement", 0) == 0) {
    rotor.disks.push_back(disk_of(e, notes));
    notes.say("a gear is taken as a disk, without its mesh",
              "[[bearing]] type = \"gear\" connects two shafts", e.entity, e.line);
  } else if (e.kind == "PointMass") {
    rotor.masses.push_back(mass_of(e, notes, notes));
  } else if (e.table->find("kxx")) {
    rotor.bearings.push_back(bearing_of(e, notes));
    if (e.kind != "BearingElement" && e.kind != "SealElement" && e.kind != "BearingElement6DoF")
      notes.say(
          fmt::format("of a {} its coefficients are taken, not what they were made of", e.kind),
          "a film or rolling bearing by its geometry is another type of [[bearing]]", e.entity,
          e.line);
  } else {
    notes.say(fmt::format("an element of class {} is not taken over", e.kind), {}, e.entity,
              e.line);
  }
}

}  // namespace

RossRotor read_ross(const Value& file, Notes& notes) {
  RossRotor rotor;
  if (const Member* m = file.find("ross_version"); m && m->value.is_text())
    rotor.version = m->value.text;
  rotor.rated = parameter(file, "rated_w");
  rotor.least = parameter(file, "min_w");
  rotor.most = parameter(file, "max_w");
  for (const Member& m : file.members) {
    if (m.key == "parameters") continue;
    if (const auto e = element_of(m)) take(*e, rotor, notes);
  }
  if (rotor.layers.empty())
    notes.refuse("there is no ShaftElement in it",
                 "a file written by Rotor.save() of ROSS holds one table for each element");
  return rotor;
}

}  // namespace whirl::convert
