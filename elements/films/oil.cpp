#include <elements/films/oil.hpp>

#include <core/error.hpp>

#include <cmath>

namespace whirl::elements {

namespace {
[[noreturn]] void fail(const char* what) { throw run_error("E85", std::string("oil: ") + what); }
}  // namespace

double iso_vg_viscosity(double grade, double temperature, double density) {
  if (!(grade > 0) || !(density > 0)) fail("grade and density must be positive");
  if (!(temperature >= 243.0 && temperature <= 473.0))
    fail("the temperature must lie between -30 and 200 degrees Celsius");
  constexpr double eta_x = 0.18e-3;
  const double celsius = temperature - 273.15;
  return eta_x * std::exp((159.55657 / (celsius + 95.0) - 0.181913) *
                          std::log(density * grade * 1e-6 / eta_x));
}

double walther_viscosity(double T1, double nu1, double T2, double nu2, double T, double density) {
  if (!(nu1 > 0.31e-6) || !(nu2 > 0.31e-6) || !(density > 0))
    fail("viscosities must exceed 0.31 mm2/s and the density must be positive");
  if (!(T1 > 0) || !(T2 > 0) || T1 == T2) fail("two different temperatures are needed");
  if (!(T >= 223.0 && T <= 523.0))
    fail("the temperature must lie between -50 and 250 degrees Celsius");
  const auto y = [](double nu) { return std::log10(std::log10(nu * 1e6 + 0.7)); };
  const double x1 = std::log10(T1), x2 = std::log10(T2);
  const double at = y(nu1) + (std::log10(T) - x1) / (x2 - x1) * (y(nu2) - y(nu1));
  const double nu = (std::pow(10.0, std::pow(10.0, at)) - 0.7) * 1e-6;
  if (!(nu > 0)) fail("the viscosity at this temperature is not positive: check the two points");
  return density * nu;
}

}  // namespace whirl::elements
