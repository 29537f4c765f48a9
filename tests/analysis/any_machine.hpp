// Random machines with supports of every kind, from one seed, and the same machine seen otherwise:
// turned about the axis, in a mirror, in other units, on another scale. What a view changes in the
// deck is known; what the program says of the machine may not change.
#pragma once
#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace whirl::tests {

/// A dimension: how a quantity grows with the size of a machine of the same materials, stresses and
/// surface speeds, and the two units that decks write it in.
struct Dimension {
  const char* unit;
  double power;  ///< of the scale
  const char* other;
  double other_si;
};
inline constexpr Dimension metre{"m", 1, "in", 0.0254};
inline constexpr Dimension kilogram{"kg", 3, "g", 1e-3};
inline constexpr Dimension inertia{"kg.m^2", 5, "g.mm^2", 1e-9};
inline constexpr Dimension newton{"N", 2, "lbf", 4.4482216152605};
inline constexpr Dimension spring{"N/m", 1, "lbf/in", 4.4482216152605 / 0.0254};
inline constexpr Dimension damper{"N.s/m", 2, "N.s/mm", 1e3};
inline constexpr Dimension cross_spring{"N/rad", 2, "kN/rad", 1e3};
inline constexpr Dimension cross_damper{"N.s/rad", 3, "kN.s/rad", 1e3};
inline constexpr Dimension tilt_spring{"N.m/rad", 3, "N.mm/rad", 1e-3};
inline constexpr Dimension tilt_damper{"N.m.s/rad", 4, "N.mm.s/rad", 1e-3};
inline constexpr Dimension seconds{"s", 1, "ms", 1e-3};
inline constexpr Dimension per_second{"1/s", -1, "1/s", 1};
inline constexpr Dimension spin{"rad/s", -1, "rpm", 0.10471975511965977};
inline constexpr Dimension viscosity{"Pa.s", 1, "cP", 1e-3};
inline constexpr Dimension pressure{"Pa", 0, "psi", 6894.757293168361};
inline constexpr Dimension density{"kg/m^3", 0, "g/cm^3", 1e3};
inline constexpr Dimension acceleration{"m/s^2", -1, "mm/s^2", 1e-3};
inline constexpr Dimension imbalance{"kg.m", 4, "g.mm", 1e-6};
inline constexpr Dimension per_ampere{"N/A", 2, "kN/A", 1e3};
inline constexpr Dimension ampere_metre{"A/m", -1, "A/mm", 1e3};
inline constexpr Dimension ampere_rate{"A/(m.s)", -2, "A/(mm.s)", 1e3};
inline constexpr Dimension ampere_second{"A.s/m", 0, "A.s/mm", 1e3};

class AnyMachine {
 public:
  struct View {
    double angle = 0;       ///< rad: space is turned by this about x
    bool mirrored = false;  ///< z becomes -z before it is turned; what turns turns the other way
    double scale = 1;       ///< of all lengths; materials, stresses and surface speeds stay
    bool other_units = false;
    int finer = 1;    ///< elements of each section, times
    double gear = 1;  ///< shafts over the reference, times: the reference turns slower by it
  };
  AnyMachine(unsigned seed, const View& view) : rng_(seed), view_(view) { build(); }
  explicit AnyMachine(unsigned seed) : AnyMachine(seed, View{}) {}

  const std::string& deck() const { return deck_; }
  double top_speed() const {
    return top_speed_ / (view_.scale * view_.gear);
  }  ///< rad/s, of the view
  /// Matrices depend on the rate of the motion: tables against frequency, hysteretic damping.
  bool by_rate() const { return by_rate_; }
  bool has(const std::string& kind) const { return kinds_.contains(kind); }
  const std::set<std::string>& kinds() const { return kinds_; }

 private:
  // --- chance
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng_); }
  double spread(double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(rng_); }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }

  // --- the view
  std::string bare(double si, const Dimension& d) const {
    const double unit = view_.other_units ? d.other_si : 1.0;
    return fmt::format("{:.17g}", si * std::pow(view_.scale, d.power) / unit);
  }
  const char* unit(const Dimension& d) const { return view_.other_units ? d.other : d.unit; }
  std::string value(double si, const Dimension& d) const {
    return fmt::format("\"{} {}\"", bare(si, d), unit(d));
  }
  std::string key(const char* name, double si, const Dimension& d) const {
    return fmt::format("{} = {}\n", name, value(si, d));
  }
  std::string inline_key(const char* name, double si, const Dimension& d) const {
    return fmt::format("{} = {}, ", name, value(si, d));
  }
  double sense() const { return view_.mirrored ? -1.0 : 1.0; }
  /// Of vectors across the shaft.
  Mat2 across() const {
    const double c = std::cos(view_.angle), s = std::sin(view_.angle);
    Mat2 turn, mirror = Mat2::Identity();
    turn << c, -s, s, c;
    mirror(1, 1) = sense();
    return turn * mirror;
  }
  Mat2 seen(const Mat2& m) const { return across() * m * across().transpose(); }
  /// Of matrices in (x, y, z, rx, ry, rz).
  Matrix<6> seen(const Matrix<6>& m) const {
    Matrix<6> t = Matrix<6>::Identity();
    t.block<2, 2>(1, 1) = across();
    t(3, 3) = sense();
    t.block<2, 2>(4, 4) = sense() * across();
    return t * m * t.transpose();
  }
  std::string angle_key(const char* name, double rad) const {
    return fmt::format("{} = \"{:.17g} deg\"\n", name,
                       (view_.angle + sense() * rad) * 57.29577951308232);
  }
  std::string ratio(double r) const {
    return fmt::format("speed_ratio = {:.17g}\n", sense() * r * view_.gear);
  }

  // --- the machine
  void build() {
    diameter_ = spread(5e-3, 0.3);
    span_ = diameter_ * uniform(6.0, 22.0);
    top_speed_ = std::min(uniform(0.2, 1.5) * 260.0 / diameter_, 1.2e4);
    const double gravity_angle = chance(0.5) ? -pi / 2 : uniform(-pi, pi);
    const Vec2 g = across() * Vec2(9.81 * std::cos(gravity_angle), 9.81 * std::sin(gravity_angle));
    deck_ = fmt::format(
        "format = 1\n[output]\nreport = false\n[model]\ngravity_vector = [{}, {}, {}]\n",
        value(0.0, acceleration), value(g.x(), acceleration), value(g.y(), acceleration));
    const double weight = add_shaft("s", 0.0, Vec2::Zero(), 1.0, true);
    const int more = pick(8);
    casing_ = more == 0;
    foundation_ = more == 4;
    if (casing_) add_casing();
    add_thrust("s", weight);
    add_bearing("s", "A", "sp0:start", 0.5 * weight, true);
    add_bearing("s", "B", fmt::format("sp{}:end", sections_ - 1), 0.5 * weight, true);
    if (chance(0.35)) add_bearing("s", "M", "sp0:mid", 0.2 * weight, false);
    add_spin_support(weight);
    if (more == 1) add_coupled();
    if (more == 2) add_geared();
    if (more == 3) add_inner();
    if (foundation_) add_foundation(weight);
  }

  /// Sections p0, p1, .. with disks; its weight.
  double add_shaft(const std::string& name, double from, const Vec2& at, double speed, bool main) {
    const int sections = 2 + pick(main ? 3 : 1);
    if (main) sections_ = sections;
    const Vec2 place = across() * at;
    deck_ += fmt::format("[[shaft]]\nname = \"{}\"\nmaterial = \"steel\"\n", name);
    deck_ += fmt::format("origin = [{}, {}, {}]\n", value(from, metre), value(place.x(), metre),
                         value(place.y(), metre));
    deck_ += ratio(speed);
    add_damping();
    double length = 0;
    for (int k = 0; k < sections; ++k) {
      const double l = span_ / sections * uniform(0.6, 1.4) * (main ? 1.0 : 0.4);
      length += l;
      deck_ += fmt::format("[[shaft.section]]\nname = \"{}p{}\"\n", name, k) +
               key("length", l, metre) + key("od", diameter_ * uniform(0.8, 1.2), metre) +
               fmt::format("min_elements = {}\n", view_.finer * (1 + pick(2)));
    }
    if (main) length_ = length;
    double weight = 9.81 * 7850.0 * 0.785 * diameter_ * diameter_ * length;
    const double shaft = 7850.0 * 0.785 * std::pow(diameter_, 3) * 12.0;
    const int disks = 1 + pick(main ? 3 : 1);
    for (int k = 0; k < disks; ++k) {
      const double mass = shaft * spread(0.1, 2.0) * (main ? 1.0 : 0.3);
      const double radius = diameter_ * uniform(1.0, 4.0);
      deck_ += fmt::format("[[disk]]\nname = \"{}d{}\"\nat = \"{}p{}:{}\"\n", name, k, name,
                           pick(sections), chance(0.5) ? "end" : "mid") +
               key("mass", mass, kilogram) + key("Ip", 0.5 * mass * radius * radius, inertia) +
               key("Id", 0.3 * mass * radius * radius, inertia);
      weight += 9.81 * mass;
      if (k > 0) continue;
      deck_ += fmt::format("[[unbalance]]\nat = \"{}d0\"\n", name) +
               key("amount", mass * 1e-6 * diameter_, imbalance) +
               angle_key("phase", uniform(-3.0, 3.0));
    }
    return weight;
  }

  void add_damping() {
    std::string keys;
    if (chance(0.25))
      keys += inline_key("internal_beta", spread(3e-8, 3e-6) * diameter_ * 20, seconds);
    if (chance(0.1)) {
      keys += fmt::format("internal_loss_factor = {:.17g}, ", spread(1e-4, 1e-2));
      by_rate_ = true;
      kinds_.insert("hysteretic");
    }
    if (chance(0.2))
      keys += inline_key("external_beta", spread(3e-8, 3e-6) * diameter_ * 20, seconds);
    if (chance(0.2))
      keys += inline_key("rayleigh_alpha", spread(1e-4, 1e-2) * top_speed_, per_second);
    if (chance(0.3))
      keys += inline_key("torsion_beta", spread(3e-8, 3e-6) * diameter_ * 20, seconds);
    if (keys.empty()) return;
    keys.resize(keys.size() - 2);
    deck_ += "damping = { " + keys + " }\n";
  }

  void add_casing() {
    kinds_.insert("casing");
    deck_ +=
        "[[shaft]]\nname = \"c\"\nmaterial = \"steel\"\nrotating = false\n"
        "[[shaft.section]]\nname = \"cp0\"\n" +
        key("length", length_, metre) + key("od", 4.0 * diameter_, metre) +
        key("id", 3.0 * diameter_, metre) + fmt::format("min_elements = {}\n", 2 * view_.finer);
    const bool joint = chance(0.3);
    if (joint) {
      kinds_.insert("joint");
      deck_ += "[[joint]]\nname = \"foot\"\nkind = \"rigid\"\nat = \"cp0:start\"\n";
    }
    const double k = 9.81 * 7850.0 * 60.0 * diameter_ * diameter_ * spread(1e3, 1e5);
    for (const char* at : {"start", "end"}) {
      if (joint && std::string(at) == "start") continue;
      deck_ += fmt::format(
          "[[bearing]]\nname = \"foot {0}\"\nat = \"cp0:{0}\"\ntype = \"linear\"\n", at);
      deck_ += key("kxx", k, spring) + matrix_keys(k, 1e-4 * k, 0.2);
    }
  }

  /// What holds a shaft along its axis.
  void add_thrust(const std::string& shaft, double weight) {
    const double axial = weight / diameter_ * spread(3e2, 3e4);
    deck_ +=
        fmt::format("[[bearing]]\nname = \"{0} thrust\"\nat = \"{0}p0:start\"\ntype = \"linear\"\n",
                    shaft) +
        key("kxx", axial, spring);
    if (chance(0.7)) deck_ += key("cxx", axial / top_speed_ * spread(1e-3, 0.3), damper);
  }

  /// The spin: free, or resisted by next to nothing, a soft coupling or a stiff one.
  void add_spin_support(double weight) {
    const int kind = pick(5);
    if (kind > 1) return;
    deck_ += "[[bearing]]\nname = \"spin\"\nat = \"sp0:start\"\ntype = \"linear\"\n";
    deck_ += kind == 0
                 ? key("krxx", spread(1e-6, 1e6) * weight * diameter_, tilt_spring)
                 : key("crxx", spread(1e-8, 1e-1) * weight * diameter_ / top_speed_, tilt_damper);
  }

  /// A second shaft behind the first, through a flexible coupling.
  void add_coupled() {
    kinds_.insert("coupling");
    const double weight = add_shaft("t", length_, Vec2::Zero(), 1.0, false);
    const double k = weight / diameter_ * spread(3e2, 1e4);
    deck_ +=
        fmt::format("[[bearing]]\nname = \"coupling\"\nat = \"sp{}:end\"\nto = \"tp0:start\"\n",
                    sections_ - 1) +
        "type = \"coupling\"\n" + key("kxx", k, spring) + key("kyy", k, spring) +
        key("kzz", k, spring) + key("krr", k * diameter_ * diameter_, tilt_spring) +
        key("krxx", 30 * k * diameter_ * diameter_, tilt_spring);
    add_thrust("t", weight);
    add_bearing("t", "C", "tp0:mid", weight, true);
    add_bearing("t", "D", "tp1:end", weight, true);
  }

  /// A parallel shaft driven by a gear pair.
  void add_geared() {
    kinds_.insert("gear");
    const int teeth = 20 + pick(20), other = 20 + pick(20);
    const double pitch = 4.0 * diameter_, distance = 0.5 * pitch * (1.0 + double(other) / teeth);
    const double toward = uniform(-pi, pi);
    const double weight = add_shaft("g", 0.0, distance * Vec2(std::cos(toward), std::sin(toward)),
                                    -double(teeth) / other, false);
    const bool helical = chance(0.5);
    const double helix = helical ? uniform(5.0, 25.0) * sense() : 0.0;
    deck_ += "[[bearing]]\nname = \"mesh\"\nat = \"sp0:mid\"\nto = \"gp0:mid\"\ntype = \"gear\"\n" +
             fmt::format("teeth = {}\nother_teeth = {}\n", teeth, other) +
             key("pitch_diameter", pitch, metre) +
             key("stiffness", weight / diameter_ * spread(1e4, 1e6), spring) +
             fmt::format("helix = \"{:.17g} deg\"\ndrive = \"{}\"\n", helix,
                         sense() > 0 ? "positive" : "negative");
    add_thrust("g", weight);
    add_bearing("g", "C", "gp0:start", weight, true);
    add_bearing("g", "D", "gp1:end", weight, true);
  }

  /// A shaft inside the first that turns at its own speed, often the other way.
  void add_inner() {
    kinds_.insert("inner shaft");
    const double speed = chance(0.6) ? -uniform(0.4, 1.6) : uniform(0.4, 1.6);
    const double weight = add_shaft("i", 0.0, Vec2::Zero(), speed, false);
    add_thrust("i", weight);
    add_bearing("i", "C", "ip0:start", weight, true);
    deck_ +=
        "[[bearing]]\nname = \"between\"\nat = \"ip1:end\"\nto = \"sp0:end\"\ntype = \"linear\"\n" +
        matrix_keys(weight / diameter_ * spread(3e2, 3e4),
                    weight / diameter_ / top_speed_ * spread(1.0, 1e2), 0.0);
  }

  // --- supports
  void add_bearing(const std::string& shaft, const std::string& name, const std::string& at,
                   double load, bool carries) {
    deck_ += fmt::format("[[bearing]]\nname = \"{}\"\nat = \"{}\"\n", name, at);
    const bool on_casing = casing_ && shaft == "s";
    if (on_casing) deck_ += "to = \"cp0:mid\"\n";
    const bool ground = !on_casing;
    std::string pedestal;
    if (ground && carries && !foundation_ && chance(0.2)) pedestal = pedestal_keys(load);
    deck_ += pedestal;
    const bool founded = foundation_ && shaft == "s" && carries;
    switch (founded ? 0 : carries ? pick(12) : 12 + pick(4)) {
      case 0: deck_ += linear(load); break;
      case 1: deck_ += table(load, false); break;
      case 2: deck_ += table(load, true); break;
      case 3: deck_ += short_journal(load); break;
      case 4:
      case 5: deck_ += journal(load); break;
      case 6: deck_ += tilting_pad(load); break;
      case 7: deck_ += rolling(load); break;
      case 8: deck_ += estimate(load); break;
      case 9: deck_ += magnetic(load); break;
      case 10: deck_ += damper_film(load); break;
      case 11: deck_ += full_matrices(load); break;
      case 12: deck_ += seal(); break;
      case 13: deck_ += cross_coupling(load); break;
      case 14:
        deck_ +=
            matrix_keys(0.1 * load / diameter_ * 1e3, load / diameter_ / top_speed_, 0.3, true);
        break;
      default: deck_ += hardening(load); break;
    }
  }

  /// kyy .. czz of a support, cross terms with a share of the stiffness.
  std::string matrix_keys(double k, double c, double cross, bool typed = false) {
    Mat2 K, C;
    K << k, cross * k, -cross * k * uniform(0.5, 1.5), k * uniform(0.5, 1.5);
    C << c, 0.1 * cross * c, 0.1 * cross * c, c * uniform(0.5, 1.5);
    K = seen(K);
    C = seen(C);
    std::string text = typed ? "type = \"linear\"\n" : "";
    const char* names[2][2] = {{"yy", "yz"}, {"zy", "zz"}};
    for (Index i = 0; i < 2; ++i)
      for (Index j = 0; j < 2; ++j)
        text += key(fmt::format("k{}", names[i][j]).c_str(), K(i, j), spring) +
                key(fmt::format("c{}", names[i][j]).c_str(), C(i, j), damper);
    return text;
  }

  std::string linear(double load) {
    kinds_.insert("linear");
    const double k = load / diameter_ * spread(1e2, 3e4);
    return "type = \"linear\"\n" +
           matrix_keys(k, k / top_speed_ * spread(1e-3, 3.0), chance(0.3) ? 0.3 : 0.0);
  }

  std::string full_matrices(double load) {
    kinds_.insert("6x6");
    const double k = load / diameter_ * spread(1e2, 1e4), d = diameter_;
    Matrix<6> K = Matrix<6>::Zero(), C = Matrix<6>::Zero();
    for (Index i = 0; i < 6; ++i)
      for (Index j = 0; j < 6; ++j) {
        if (i == 3 || j == 3 || ((i == 0) != (j == 0))) continue;
        const double arm = (i > 3 ? d : 1.0) * (j > 3 ? d : 1.0);
        K(i, j) = k * arm * (i == j ? uniform(0.5, 1.5) : uniform(-0.15, 0.15));
        C(i, j) = k / top_speed_ * arm * 0.1 * (i == j ? uniform(0.5, 1.5) : uniform(-0.1, 0.1));
      }
    const auto write = [&](const char* name, const Matrix<6>& m, const Dimension& force,
                           const Dimension& mixed, const Dimension& moment) {
      std::string text = fmt::format("{} = [", name);
      for (Index i = 0; i < 6; ++i) {
        text += i ? ", [" : "[";
        for (Index j = 0; j < 6; ++j) {
          const int turns = (i > 2) + (j > 2);
          text += (j ? ", " : "") + value(m(i, j), turns == 0   ? force
                                                   : turns == 1 ? mixed
                                                                : moment);
        }
        text += "]";
      }
      return text + "]\n";
    };
    return "type = \"linear\"\n" + write("K", seen(K), spring, cross_spring, tilt_spring) +
           write("C", seen(C), damper, cross_damper, tilt_damper);
  }

  std::string table(double load, bool by_frequency) {
    kinds_.insert(by_frequency ? "table by frequency" : "table by speed");
    by_rate_ = by_rate_ || by_frequency;
    const double k = load / diameter_ * spread(3e2, 1e4), c = k / top_speed_ * spread(0.03, 1.0);
    const double cross = chance(0.5) ? 0.3 : 0.0, slope = uniform(-0.5, 1.0),
                 rise = uniform(0.0, 0.5), unequal = uniform(0.6, 1.6);
    std::vector<std::string> rows;
    for (int s = 0; s < 4; ++s) {
      const double x = s / 3.0;
      for (int f = 0; f < (by_frequency ? 4 : 1); ++f) {
        const double y = f / 3.0;
        const double grow = 1.0 + slope * x + rise * y * y;
        Mat2 K, C;
        K << k * grow, cross * k * x, -cross * k * x, unequal * k * grow;
        C << c * (1.2 - 0.4 * y), 0.0, 0.0, unequal * c;
        K = seen(K);
        C = seen(C);
        std::string row = "[" + bare(sense() * (1.3 * x) * top_speed_, spin);
        if (by_frequency) row += ", " + bare(12.0 * y * top_speed_, spin);
        for (const double e : {K(0, 0), K(0, 1), K(1, 0), K(1, 1)})
          row += ", " + bare(e, spring);
        for (const double e : {C(0, 0), C(0, 1), C(1, 0), C(1, 1)})
          row += ", " + bare(e, damper);
        rows.push_back(row + "]");
      }
    }
    if (view_.mirrored) {  // speeds ascend, and the frequencies of each
      std::vector<std::string> turned;
      const std::size_t block = by_frequency ? 4 : 1;
      for (std::size_t s = 4; s-- > 0;)
        turned.insert(turned.end(), rows.begin() + static_cast<std::ptrdiff_t>(s * block),
                      rows.begin() + static_cast<std::ptrdiff_t>((s + 1) * block));
      rows = turned;
    }
    std::string text = "type = \"table\"\nextrapolate = \"hold\"\ncolumns = [\"speed[" +
                       std::string(unit(spin)) + "]\"";
    if (by_frequency) text += ", \"frequency[" + std::string(unit(spin)) + "]\"";
    for (const char* m : {"k", "c"})
      for (const char* e : {"yy", "yz", "zy", "zz"})
        text += fmt::format(", \"{}{}[{}]\"", m, e, unit(m[0] == 'k' ? spring : damper));
    text += "]\nrows = [";
    for (const std::string& row : rows)
      text += row + ",\n";
    return text + "]\n";
  }

  /// Diameter, length, clearance and a viscosity that carries the load somewhere in the range.
  std::string film(double load) {
    const double clearance = diameter_ * spread(7e-4, 2.5e-3),
                 length = diameter_ * uniform(0.3, 0.8);
    const double revolutions = 0.5 * top_speed_ / (2 * pi);
    const double modified = spread(0.05, 1.0);  // Sommerfeld number (L/D)^2 at half the top speed
    const double eta = modified * load * 4.0 * clearance * clearance /
                       (revolutions * diameter_ * std::pow(length, 3));
    return key("diameter", diameter_, metre) + key("length", length, metre) +
           key("clearance", clearance, metre) + key("viscosity", eta, viscosity);
  }

  std::string short_journal(double load) {
    kinds_.insert("short journal");
    return "type = \"short_journal\"\n" + film(load);
  }

  std::string journal(double load) {
    const int shape = pick(3);
    std::string text = "type = \"journal\"\n" + film(load);
    if (shape == 0) {
      kinds_.insert("plain journal");
      return text + "shape = \"plain\"\n";
    }
    if (shape == 1) {
      kinds_.insert("grooved journal");
      return text + "shape = \"two_grooves\"\n" + angle_key("groove_at", uniform(-pi, pi));
    }
    kinds_.insert("lobed journal");
    const double tight = uniform(0.4, 1.0);
    return text +
           fmt::format("shape = \"lobes\"\nlobes = {}\npreload = {:.17g}\n", 2 + pick(3),
                       uniform(0.2, 0.6)) +
           angle_key("lobe_at", uniform(-pi, pi)) +
           fmt::format("lobe_offset = {:.17g}\n", view_.mirrored ? 1.0 - tight : tight);
  }

  std::string tilting_pad(double load) {
    kinds_.insert("tilting pads");
    const int pads = 4 + pick(2);
    const double offset = uniform(0.5, 0.6);
    std::string text = "type = \"tilting_pad\"\n" + film(load) +
                       fmt::format("pads = {}\narc = \"{} deg\"\npreload = {:.17g}\n", pads,
                                   pads == 4 ? 75 : 60, uniform(0.1, 0.5)) +
                       angle_key("first_pivot", uniform(-pi, pi)) +
                       fmt::format("offset = {:.17g}\n", view_.mirrored ? 1.0 - offset : offset);
    if (chance(0.4)) text += key("pivot_stiffness", load / diameter_ * spread(3e3, 3e5), spring);
    if (chance(0.4)) text += key("inertia", load * 1e-3 * diameter_ * diameter_, inertia);
    return text;
  }

  std::string rolling(double load) {
    if (chance(0.5)) {
      kinds_.insert("ball bearing");
      return "type = \"ball\"\nballs = 11\n" + key("ball_diameter", 0.25 * diameter_, metre) +
             key("pitch_diameter", 1.5 * diameter_, metre) + "contact_angle = \"20 deg\"\n" +
             key("preload", load * uniform(1.0, 3.0), newton) +
             key("c_radial", load / diameter_ / top_speed_ * spread(10, 1e3), damper);
    }
    kinds_.insert("roller bearing");
    return "type = \"roller\"\nrollers = 13\n" + key("roller_diameter", 0.2 * diameter_, metre) +
           key("roller_length", 0.2 * diameter_, metre) +
           key("pitch_diameter", 1.5 * diameter_, metre) +
           key("clearance", -2e-5 * diameter_, metre) +
           key("c_radial", load / diameter_ / top_speed_ * spread(10, 1e3), damper);
  }

  std::string estimate(double load) {
    kinds_.insert("estimated bearing");
    const std::string damping =
        key("c_radial", load / diameter_ / top_speed_ * spread(1, 1e2), damper) +
        key("load", load, newton) + angle_key("load_angle", uniform(-pi, pi));
    if (chance(0.5))
      return "type = \"ball_estimate\"\nballs = 10\n" +
             key("ball_diameter", 0.25 * diameter_, metre) + damping;
    return "type = \"roller_estimate\"\nrollers = 13\n" +
           key("roller_length", 0.2 * diameter_, metre) + damping;
  }

  std::string magnetic(double load) {
    kinds_.insert("magnetic");
    const double k = load / diameter_ * spread(3e2, 3e3), current = 0.1 * load;
    std::string text = "type = \"magnetic\"\n" + key("current_stiffness", current, per_ampere) +
                       key("position_stiffness", 0.3 * k, spring) +
                       key("amplifier_bandwidth", 20 * top_speed_, spin) +
                       angle_key("angle", uniform(-pi, pi));
    if (chance(0.5)) text += key("sensor_bandwidth", 30 * top_speed_, spin);
    if (chance(0.4)) text += key("delay", 0.02 / top_speed_, seconds);
    text += "[[bearing.control]]\ntype = \"pid\"\n" + key("p", 1.3 * k / current, ampere_metre) +
            key("i", 0.2 * k / current * top_speed_, ampere_rate) +
            key("d", 0.6 * k / current / top_speed_, ampere_second) +
            key("lag", 0.05 / top_speed_, seconds);
    return text;
  }

  std::string damper_film(double load) {
    kinds_.insert("squeeze film");
    const double clearance = diameter_ * spread(1.5e-3, 3e-3),
                 length = diameter_ * uniform(0.2, 0.5);
    const double k = load / (clearance * uniform(0.2, 0.5));
    const double wanted = k / top_speed_ * spread(0.1, 1.0);
    const double eta = wanted / (pi * 0.5 * diameter_ * std::pow(length / clearance, 3));
    const int film = pick(4);
    const char* films[] = {"cavitated", "full", "finite", "sealed"};
    std::string text = fmt::format("type = \"squeeze_film\"\nfilm = \"{}\"\n", films[film]) +
                       key("diameter", diameter_, metre) + key("length", length, metre) +
                       key("clearance", clearance, metre) + key("viscosity", eta, viscosity) +
                       key("stiffness", k, spring) + key("damping", k / top_speed_ * 0.01, damper);
    if (film == 3) text += angle_key("groove_at", uniform(-pi, pi));
    return text;
  }

  std::string seal() {
    kinds_.insert("seal");
    return "type = \"annular_seal\"\n" + key("diameter", 1.2 * diameter_, metre) +
           key("length", diameter_ * uniform(0.1, 0.5), metre) +
           key("clearance", diameter_ * spread(1.5e-3, 4e-3), metre) +
           key("pressure_drop", spread(2e5, 3e6), pressure) + key("density", 1000.0, density) +
           key("viscosity", 2e-6 * diameter_ * 200, viscosity) +
           fmt::format("inlet_swirl = {:.17g}\n", uniform(0.0, 0.6));
  }

  std::string cross_coupling(double load) {
    kinds_.insert("cross-coupling");
    return "type = \"cross_coupling\"\n" +
           key("k", sense() * load / diameter_ * spread(10, 1e3), spring);
  }

  /// A spring that hardens, the same in all directions.
  std::string hardening(double load) {
    kinds_.insert("hardening spring");
    const double k = load / diameter_ * spread(1e2, 1e3);
    const Dimension cubic{"N/m^3", -1, "N/mm^3", 1e9};
    return "type = \"nonlinear_spring\"\ndirection = \"radial\"\nshape = \"polynomial\"\n"
           "coefficients = [\"0 N\", " +
           value(k, spring) + ", \"0 N/m^2\", " + value(k / std::pow(1e-3 * diameter_, 2), cubic) +
           "]\n" + key("damping", 0.05 * k / top_speed_, damper);
  }

  std::string pedestal_keys(double load) {
    kinds_.insert("pedestal");
    const double k = load / diameter_ * spread(1e3, 1e5), c = 0.02 * k / top_speed_;
    Mat2 K, C;
    K << k, 0.1 * k, 0.1 * k, k * uniform(0.5, 1.5);
    C << c, 0.0, 0.0, 2 * c;
    K = seen(K);
    C = seen(C);
    std::string text = "support = { " +
                       inline_key("mass", load / 9.81 * spread(0.05, 1.0), kilogram) +
                       inline_key("kxx", k, spring);
    const char* names[2][2] = {{"yy", "yz"}, {"zy", "zz"}};
    for (Index i = 0; i < 2; ++i)
      for (Index j = 0; j < 2; ++j)
        text += inline_key(fmt::format("k{}", names[i][j]).c_str(), K(i, j), spring) +
                inline_key(fmt::format("c{}", names[i][j]).c_str(), C(i, j), damper);
    text.resize(text.size() - 2);
    return text + " }\n";
  }

  /// Under both bearings of the first shaft: a frame whose feet are coupled.
  void add_foundation(double weight) {
    kinds_.insert("foundation");
    const double k = weight / diameter_ * spread(1e3, 1e5);
    const double m = weight / 9.81 * spread(0.05, 1.0);
    Matrix<4> K = Matrix<4>::Identity() * k, C = Matrix<4>::Identity() * (0.02 * k / top_speed_),
              M = Matrix<4>::Identity() * m, turn = Matrix<4>::Zero();
    for (Index i = 0; i < 4; ++i)
      for (Index j = 0; j < i; ++j) {
        K(i, j) = K(j, i) = k * uniform(-0.2, 0.2);
        M(i, j) = M(j, i) = m * uniform(-0.2, 0.2);
      }
    turn.topLeftCorner<2, 2>() = turn.bottomRightCorner<2, 2>() = across();
    K = turn * K * turn.transpose();
    C = turn * C * turn.transpose();
    M = turn * M * turn.transpose();
    deck_ += fmt::format(
        "[[foundation]]\nname = \"frame\"\ncoordinates = [\"A.y\", \"A.z\", \"B.y\", "
        "\"B.z\"]\ncolumns = [\"row\", \"column\", \"K[{}]\", \"C[{}]\", \"M[{}]\"]\nrows = [",
        unit(spring), unit(damper), unit(kilogram));
    for (Index i = 0; i < 4; ++i)
      for (Index j = 0; j <= i; ++j)
        deck_ += fmt::format("[{}, {}, {}, {}, {}], ", i + 1, j + 1, bare(K(i, j), spring),
                             bare(C(i, j), damper), bare(M(i, j), kilogram));
    deck_ += "]\n";
  }

  std::mt19937 rng_;
  View view_;
  std::string deck_;
  std::set<std::string> kinds_;
  double diameter_ = 0, span_ = 0, length_ = 0, top_speed_ = 0;
  int sections_ = 0;
  bool by_rate_ = false, casing_ = false, foundation_ = false;
};

}  // namespace whirl::tests
