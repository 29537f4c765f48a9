// Whirl as a C++ library: a deck as text, its system, the modes at one speed. A simply supported
// Rayleigh shaft that spins whirls at (rho A + rho I k^2) w^2 - 2 rho I k^2 Omega w = E I k^4,
// k = pi/L: both roots are compared with the modes found.
#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>
#include <cmath>
#include <cstdio>

constexpr const char* text = R"(
format = 1
material = [{name = "steel", E = "200 GPa", nu = 0.3, density = "7800 kg/m^3"}]
[model]
gravity = "0 m/s^2"
[shaft]
material = "steel"
shear = "none"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["body", 1000, 200, 32]]
[[bearing]]
name = "left"
at = "body:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "right"
at = "body:end"
type = "rigid"
directions = ["y", "z"]
)";

int main() {
  const double E = 200e9, rho = 7800, L = 1, r = 0.1, Omega = 1000;  // Pa, kg/m3, m, m, rad/s
  const whirl::deck::Deck deck = whirl::deck::read_deck_text(text);
  if (!deck.ok()) {
    std::fputs(deck.report().c_str(), stderr);
    return 1;
  }
  const auto mesh = whirl::meshes::make_mesh(deck.model);
  const auto built = whirl::assembly::build_system(deck.model, mesh);
  whirl::analysis::Linearizer linear(built.system);
  whirl::analysis::ModesOptions options;
  options.count = 2;
  options.motion = whirl::analysis::Motion::lateral;
  const auto modes = whirl::analysis::whirl_modes(linear, Omega, options);

  const double k2 = std::pow(whirl::pi / L, 2), A = whirl::pi * r * r, I = A * r * r / 4;
  const double m = rho * (A + I * k2), g = rho * I * k2 * Omega, s = E * I * k2 * k2;
  const double root = std::sqrt(g * g + m * s);
  const double exact[] = {(root - g) / m, (root + g) / m};  // backward, forward
  int bad = modes.size() < 2;
  for (std::size_t i = 0; i < 2 && !bad; ++i) {
    std::printf("whirl at %.6f rad/s, exact %.6f\n", modes[i].frequency, exact[i]);
    bad = !(std::abs(modes[i].frequency / exact[i] - 1) < 1e-6);
  }
  return bad;
}
