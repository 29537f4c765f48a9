// Definitions: SI brochure (9th ed.); the inch (25.4 mm) and the avoirdupois pound (0.45359237 kg)
// are exact by the 1959 agreement, standard gravity 9.80665 m/s^2; derived imperial units follow
// from these three.
#include <core/types.hpp>
#include <core/units_table.hpp>
#include <cmath>
#include <unordered_map>

namespace whirl::units {
namespace {

constexpr double lbf_num = 44482216152605.0, lbf_den = 1e13;  // 0.45359237 * 9.80665
constexpr double psi_num = lbf_num, psi_den = 6451600000.0;   // lbf / (0.0254 m)^2

const std::vector<Entry>& table() {
  static const std::vector<Entry> t = {
      // length, area, volume
      {"m", "metre", "kdcmun", 1, 1, {1, 0, 0, 0, 0, 0}},
      {"in", "inch, 25.4 mm", "u", 254, 1e4, {1, 0, 0, 0, 0, 0}},
      {"inch", "inch, 25.4 mm", "", 254, 1e4, {1, 0, 0, 0, 0, 0}},
      {"ft", "foot, 304.8 mm", "", 3048, 1e4, {1, 0, 0, 0, 0, 0}},
      {"mil", "thousandth of an inch", "", 254, 1e7, {1, 0, 0, 0, 0, 0}},
      {"thou", "thousandth of an inch", "", 254, 1e7, {1, 0, 0, 0, 0, 0}},
      {"L", "litre", "m", 1, 1e3, {3, 0, 0, 0, 0, 0}},
      // mass
      {"kg", "kilogram", "", 1, 1, {0, 1, 0, 0, 0, 0}},
      {"g", "gram", "mu", 1, 1e3, {0, 1, 0, 0, 0, 0}},
      {"t", "tonne, 1000 kg", "", 1e3, 1, {0, 1, 0, 0, 0, 0}},
      {"lbm", "pound, mass", "", 45359237, 1e8, {0, 1, 0, 0, 0, 0}},
      {"oz", "ounce, mass (1/16 lbm)", "", 28349523125.0, 1e12, {0, 1, 0, 0, 0, 0}},
      {"slug", "lbf.s^2/ft", "", lbf_num, 3048e9, {0, 1, 0, 0, 0, 0}},
      // time
      {"s", "second", "mun", 1, 1, {0, 0, 1, 0, 0, 0}},
      {"min", "minute", "", 60, 1, {0, 0, 1, 0, 0, 0}},
      {"h", "hour", "", 3600, 1, {0, 0, 1, 0, 0, 0}},
      {"day", "day", "", 86400, 1, {0, 0, 1, 0, 0, 0}},
      // angle and speed
      {"rad", "radian", "mu", 1, 1, {0, 0, 0, 0, 0, 1}},
      {"deg", "degree", "", pi, 180, {0, 0, 0, 0, 0, 1}},
      {"rev", "revolution, 2 pi rad", "", two_pi, 1, {0, 0, 0, 0, 0, 1}},
      {"turn", "revolution, 2 pi rad", "", two_pi, 1, {0, 0, 0, 0, 0, 1}},
      {"rpm", "revolutions per minute", "k", two_pi, 60, {0, 0, -1, 0, 0, 1}},
      {"Hz",
       "1/s as a frequency; 2 pi rad/s where an angular speed is wanted",
       "mkMG",
       1,
       1,
       {0, 0, -1, 0, 0, 0},
       1},
      {"cpm", "cycles per minute", "", 1, 60, {0, 0, -1, 0, 0, 0}, 1},
      // force, pressure, energy, power
      {"N", "newton", "umkMG", 1, 1, {1, 1, -2, 0, 0, 0}},
      {"kgf", "kilogram-force", "", 980665, 1e5, {1, 1, -2, 0, 0, 0}},
      {"lbf", "pound-force", "", lbf_num, lbf_den, {1, 1, -2, 0, 0, 0}},
      {"ozf", "ounce-force (1/16 lbf)", "", lbf_num, 16 * lbf_den, {1, 1, -2, 0, 0, 0}},
      {"Pa", "pascal", "umkMG", 1, 1, {-1, 1, -2, 0, 0, 0}},
      {"bar", "1e5 Pa", "m", 1e5, 1, {-1, 1, -2, 0, 0, 0}},
      {"atm", "101325 Pa", "", 101325, 1, {-1, 1, -2, 0, 0, 0}},
      {"psi", "lbf/in^2", "", psi_num, psi_den, {-1, 1, -2, 0, 0, 0}},
      {"ksi", "1000 psi", "", psi_num, psi_den / 1e3, {-1, 1, -2, 0, 0, 0}},
      {"J", "joule", "umkMG", 1, 1, {2, 1, -2, 0, 0, 0}},
      {"W", "watt", "umkMG", 1, 1, {2, 1, -3, 0, 0, 0}},
      {"hp",
       "mechanical horsepower, 550 ft.lbf/s",
       "",
       550 * 3048 * (lbf_num / 1e4),
       lbf_den,
       {2, 1, -3, 0, 0, 0}},
      // viscosity
      {"P", "poise, 0.1 Pa.s", "cm", 1, 10, {-1, 1, -1, 0, 0, 0}},
      {"reyn", "lbf.s/in^2", "u", psi_num, psi_den, {-1, 1, -1, 0, 0, 0}},
      {"St", "stokes, 1 cm^2/s", "c", 1, 1e4, {2, 0, -1, 0, 0, 0}},
      // acceleration of gravity
      {"gn", "standard gravity, 9.80665 m/s^2", "m", 980665, 1e5, {1, 0, -2, 0, 0, 0}},
      // temperature
      {"K", "kelvin", "m", 1, 1, {0, 0, 0, 1, 0, 0}},
      {"degC",
       "degree Celsius (a temperature, not a difference)",
       "",
       1,
       1,
       {0, 0, 0, 1, 0, 0},
       0,
       273.15},
      {"degF",
       "degree Fahrenheit (a temperature, not a difference)",
       "",
       5,
       9,
       {0, 0, 0, 1, 0, 0},
       0,
       459.67 * 5 / 9},
      // electric
      {"A", "ampere", "umk", 1, 1, {0, 0, 0, 0, 1, 0}},
      {"V", "volt", "umk", 1, 1, {2, 1, -3, 0, -1, 0}},
      {"Ohm", "ohm", "mkM", 1, 1, {2, 1, -3, 0, -2, 0}},
      // plain numbers
      {"%", "1/100", "", 1, 100, {0, 0, 0, 0, 0, 0}},
      {"ppm", "1e-6", "", 1, 1e6, {0, 0, 0, 0, 0, 0}},
  };
  return t;
}

const std::unordered_map<std::string_view, const Entry*>& by_name() {
  static const auto m = [] {
    std::unordered_map<std::string_view, const Entry*> r;
    for (const auto& e : table())
      r.emplace(e.name, &e);
    return r;
  }();
  return m;
}

double power_of_ten(char prefix) {
  switch (prefix) {
    case 'G': return 1e9;
    case 'M': return 1e6;
    case 'k': return 1e3;
    case 'd': return 1e-1;
    case 'c': return 1e-2;
    case 'm': return 1e-3;
    case 'u': return 1e-6;
    case 'n': return 1e-9;
    default: return 1;
  }
}

Quantity of(const Entry& e) {
  Quantity q;
  q.number = 1;
  q.num = e.num;
  q.den = e.den;
  q.offset = e.offset;
  q.dimension.exponent = e.exponent;
  q.dimension.cycles = e.cycles;
  q.has_unit = true;
  return q;
}

}  // namespace

const std::vector<Entry>& entries() { return table(); }

std::optional<Quantity> find_unit(std::string_view name) {
  if (name == "\xC2\xB0") name = "deg";
  if (name ==
      "\xC2\xB0"
      "C")
    name = "degC";
  if (name ==
      "\xC2\xB0"
      "F")
    name = "degF";
  if (name == "\xCE\xA9" || name == "ohm") name = "Ohm";
  if (name == "l") name = "L";
  const auto& names = by_name();
  if (auto it = names.find(name); it != names.end()) return of(*it->second);
  std::size_t skip = 1;
  char prefix = name.empty() ? '\0' : name[0];
  if (name.starts_with("\xC2\xB5") || name.starts_with("\xCE\xBC")) {
    prefix = 'u';
    skip = 2;
  }
  if (name.size() <= skip) return {};
  auto it = names.find(name.substr(skip));
  if (it == names.end() ||
      std::string_view(it->second->prefixes).find(prefix) == std::string_view::npos)
    return {};
  Quantity q = of(*it->second);
  const double f = power_of_ten(prefix);
  if (f > 1)
    q.num *= f;
  else
    q.den *= std::round(1 / f);
  if (q.den > 1 && q.num >= q.den && std::fmod(q.num, q.den) == 0) {
    q.num /= q.den;
    q.den = 1;
  }
  return q;
}

const std::vector<DimensionName>& dimension_names() {
  static const std::vector<DimensionName> t = {
      {"", "a plain number"},
      {"m", "a length"},
      {"m^2", "an area"},
      {"m^3", "a volume"},
      {"m^4", "a second moment of area"},
      {"kg", "a mass"},
      {"s", "a time"},
      {"K", "a temperature"},
      {"1/K", "a coefficient per kelvin"},
      {"A", "a current"},
      {"V", "a voltage"},
      {"Ohm", "a resistance"},
      {"rad", "an angle"},
      {"1/m", "a curvature or wave number"},
      {"rad/m", "an angle per length"},
      {"m/s", "a speed"},
      {"m/s^2", "an acceleration"},
      {"rad/s", "an angular speed"},
      {"rad/s^2", "an angular acceleration"},
      {"rad/s^3", "a rate of angular acceleration"},
      {"Hz", "a frequency"},
      {"1/s", "a rate (1/s)"},
      {"1/s^2", "a rate squared (1/s^2)"},
      {"N", "a force"},
      {"N.m", "a torque, moment or energy"},
      {"N.s", "an impulse"},
      {"N/m", "a stiffness or force per length"},
      {"N.s/m", "a damping coefficient"},
      {"N.m/rad", "a torsional stiffness"},
      {"N.m.s/rad", "a torsional damping coefficient"},
      {"N.m.s", "a torque times time"},
      {"N.m.s^2/rad^2", "a torque per speed squared"},
      {"N/rad", "a force per angle"},
      {"N.s/rad", "a force per angular speed"},
      {"N.m^2", "a bending or torsion stiffness of a section"},
      {"Pa", "a pressure, stress or modulus"},
      {"Pa.s", "a viscosity"},
      {"m^2/s", "a kinematic viscosity"},
      {"W", "a power"},
      {"kg.m", "an unbalance (mass times length)"},
      {"kg.m^2", "a moment of inertia"},
      {"kg/m", "a mass per length"},
      {"kg/m^3", "a density"},
      {"kg/s", "a mass flow or damping coefficient"},
      {"s^2", "a time squared"},
      {"N/m^1.5", "a Hertz point-contact stiffness"},
  };
  return t;
}

}  // namespace whirl::units
