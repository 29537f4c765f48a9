// Random machines as decks: shafts with disks on supports of every kind that acts on small motions,
// from one seed.
#pragma once
#include <fmt/format.h>

#include <random>
#include <string>

namespace whirl::tests {

class RandomMachine {
 public:
  /// some: two of three machines stand on films; always: all, on films of every shape.
  enum class Films { some, always };
  explicit RandomMachine(unsigned seed, Films films = Films::some)
      : rng_(seed),
        always_films_(films == Films::always) {
    build();
  }
  const std::string& deck() const { return deck_; }
  double top_speed() const { return top_speed_; }  ///< rpm
  bool films() const { return films_; }

 private:
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng_); }
  double spread(double a, double b) {
    return a * std::pow(b / a, uniform(0.0, 1.0));
  }  ///< evenly over the decades
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(rng_); }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }

  void build() {
    diameter_ = spread(5e-3, 0.3);
    const double span = diameter_ * uniform(6.0, 25.0);
    top_speed_ = uniform(0.2, 1.5) * 2.5e3 / diameter_;  // surface speeds of some 10 to 200 m/s
    top_speed_ = std::min(top_speed_, 120e3);
    sections_ = 2 + pick(3);
    deck_ = fmt::format(
        "format = 1\n[output]\nreport = false\n[[shaft]]\nname = \"s\"\nmaterial = \"steel\"\n");
    if (chance(0.3))
      deck_ += fmt::format("damping = {{ internal_beta = \"{} s\" }}\n", spread(1e-7, 1e-5));
    for (int k = 0; k < sections_; ++k)
      deck_ += fmt::format(
          "[[shaft.section]]\nname = \"p{}\"\nlength = \"{} m\"\nod = \"{} m\"\nmin_elements = "
          "{}\n",
          k, span / sections_ * uniform(0.6, 1.4), diameter_ * uniform(0.8, 1.2), 1 + pick(3));
    const double weight = disks();
    supports(weight);
  }

  double disks() {
    const double shaft = 7850.0 * 0.785 * diameter_ * diameter_ * diameter_ * 15.0;
    double weight = 9.81 * shaft;
    const int count = 1 + pick(3);
    for (int k = 0; k < count; ++k) {
      const double mass = shaft * spread(0.1, 2.0), radius = diameter_ * uniform(1.0, 4.0);
      deck_ += fmt::format(
          "[[disk]]\nat = \"p{}:{}\"\nmass = \"{} kg\"\nIp = \"{} kg.m^2\"\nId = \"{} kg.m^2\"\n",
          pick(sections_), chance(0.5) ? "end" : "mid", mass, 0.5 * mass * radius * radius,
          0.3 * mass * radius * radius);
      weight += 9.81 * mass;
    }
    return weight;
  }

  std::string film(double load) {
    films_ = true;
    // A clearance and a viscosity that carry the load at a moderate eccentricity somewhere in the
    // range.
    const double clearance = diameter_ * spread(7e-4, 2.5e-3),
                 length = diameter_ * uniform(0.3, 0.8);
    const double speed = top_speed_ * 0.1047 * 0.5;
    const double modified = spread(0.05, 1.0);  // S (L/D)^2 at half the top speed
    const double viscosity =
        modified * load * clearance * clearance * 4.0 * diameter_ * diameter_ /
        (speed / 6.283 * diameter_ * length * diameter_ * diameter_ / 4.0 * length * length) * 0.25;
    const bool short_film = chance(0.7);
    std::string type = short_film ? "short_journal" : "journal\"\nshape = \"plain";
    if (always_films_) {
      const char* types[] = {"short_journal", "journal\"\nshape = \"plain",
                             "journal\"\nshape = \"two_grooves",
                             "journal\"\npreload = 0.4\nshape = \"lobes"};
      type = types[pick(4)];
    }
    return fmt::format(
        "type = \"{}\"\ndiameter = \"{} m\"\nlength = \"{} m\"\nclearance = \"{} m\"\nviscosity = "
        "\"{} Pa.s\"\n",
        type, diameter_, length, clearance, viscosity);
  }

  std::string linear(double load) {
    const double k = load / diameter_ * spread(1e2, 3e4),
                 c = k / (top_speed_ * 0.1047) * spread(1e-3, 3.0);
    std::string text = fmt::format(
        "type = \"linear\"\nkyy = \"{} N/m\"\nkzz = \"{} N/m\"\ncyy = \"{} N.s/m\"\nczz = \"{} "
        "N.s/m\"\n",
        k, k * uniform(0.5, 1.5), c, c * uniform(0.5, 1.5));
    if (chance(0.3))
      text += fmt::format("kyz = \"{} N/m\"\nkzy = \"{} N/m\"\n", 0.3 * k,
                          -0.3 * k * uniform(0.5, 1.5));
    if (chance(0.15))
      text += fmt::format("krr = \"{} N.m/rad\"\n", k * diameter_ * diameter_ * spread(0.01, 1.0));
    return text;
  }

  void supports(double weight) {
    const double axial = weight / diameter_ * 1e3;
    deck_ +=
        fmt::format("[[bearing]]\nat = \"p0:start\"\ntype = \"linear\"\nkxx = \"{} N/m\"\n", axial);
    if (chance(0.5)) deck_ += fmt::format("cxx = \"{} N.s/m\"\n", axial * 1e-4);
    const bool film_machine = chance(0.65) || always_films_;
    const std::string places[] = {"p0:start", fmt::format("p{}:end", sections_ - 1)};
    for (const std::string& at : places)
      deck_ += fmt::format("[[bearing]]\nat = \"{}\"\n{}", at,
                           film_machine ? film(0.5 * weight) : linear(0.5 * weight));
    // The spin: free, or resisted by next to nothing, a soft coupling or a stiff one.
    switch (pick(5)) {
      case 0:
        deck_ += fmt::format(
            "[[bearing]]\nat = \"p0:start\"\ntype = \"linear\"\nkrxx = \"{} N.m/rad\"\n",
            spread(1e-6, 1e6) * weight * diameter_);
        break;
      case 1:
        deck_ += fmt::format(
            "[[bearing]]\nat = \"p0:mid\"\ntype = \"linear\"\ncrxx = \"{} N.m.s/rad\"\n",
            spread(1e-8, 1e-1) * weight * diameter_);
        break;
      default: break;
    }
  }

  std::mt19937 rng_;
  std::string deck_;
  double diameter_ = 0, top_speed_ = 0;
  int sections_ = 0;
  bool films_ = false, always_films_ = false;
};

}  // namespace whirl::tests
