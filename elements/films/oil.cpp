#include <elements/films/oil.hpp>

#include <core/error.hpp>

#include <cmath>

namespace whirl::elements {

namespace {
[[noreturn]] void oil_fault(const char* what) {
  throw run_error("E85", std::string("oil: ") + what);
}
}  // namespace

double iso_vg_viscosity(double grade, double temperature, double density) {
  if (!(grade > 0) || !(density > 0)) oil_fault("grade and density must be positive");
  if (!(temperature >= 243.0 && temperature <= 473.0))
    oil_fault("the temperature must lie between -30 and 200 degrees Celsius");
  constexpr double eta_x = 0.18e-3;
  const double celsius = temperature - 273.15;
  return eta_x * std::exp((159.55657 / (celsius + 95.0) - 0.181913) *
                          std::log(density * grade * 1e-6 / eta_x));
}

}  // namespace whirl::elements
