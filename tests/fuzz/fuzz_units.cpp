// Whatever a quantity is written as, reading it ends with a value or with a problem that lies inside
// the text; a finite value written again in its base units reads as itself.
#include "scratch.hpp"
#include <core/units.hpp>
#include <cmath>
#include <cstdlib>

using namespace whirl;

namespace {

void check_place(const std::optional<units::Problem>& p, std::size_t size) {
  if (!p) return;
  if (p->message.empty() || p->code.empty()) std::abort();
  if (p->offset > size || p->offset + p->length > size + 1) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fuzz::text_of(data, size);
  check_place(units::parse(text).problem, size);
  for (const char* wanted : {"", "m", "N.s/m", "rad/s", "K", "Pa.s", "kg.m^2"}) {
    const units::Converted x = units::convert(text, wanted);
    check_place(x.problem, size);
    if (x.problem || !std::isfinite(x.value)) continue;
    const units::Converted again = units::convert(units::format(x.value, wanted), wanted);
    const double allowed = 1e-12 * std::abs(x.value) + 1e-300;
    if (again.problem || !(std::abs(again.value - x.value) <= allowed)) std::abort();
  }
  return 0;
}
