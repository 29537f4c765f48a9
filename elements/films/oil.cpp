#include <elements/films/oil.hpp>

#include <core/error.hpp>

#include <cmath>
#include <limits>

namespace whirl::elements {

namespace {
[[noreturn]] void oil_fault(const char* what) {
  throw run_error("E85", std::string("oil: ") + what);
}

constexpr double eta_x = 0.18e-3;  // Pa s
constexpr double coldest = 243.0, hottest = 473.0;

double vogel(double celsius) { return 159.55657 / (celsius + 95.0) - 0.181913; }

}  // namespace

OilViscosity::OilViscosity(double grade, double density) {
  if (!(grade > 0) || !(density > 0)) oil_fault("grade and density must be positive");
  factor = std::log(density * grade * 1e-6 / eta_x);
}

double OilViscosity::at(double temperature) const {
  if (!(temperature >= coldest && temperature <= hottest))
    return std::numeric_limits<double>::quiet_NaN();
  return eta_x * std::exp(vogel(temperature - 273.15) * factor);
}

double OilViscosity::slope(double temperature) const {
  const double shifted = temperature - 273.15 + 95.0;
  return -159.55657 / (shifted * shifted) * factor;
}

double iso_vg_viscosity(double grade, double temperature, double density) {
  const OilViscosity oil(grade, density);
  if (!(temperature >= coldest && temperature <= hottest))
    oil_fault("the temperature must lie between -30 and 200 degrees Celsius");
  return oil.at(temperature);
}

}  // namespace whirl::elements
