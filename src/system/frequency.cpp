#include <system/frequency.hpp>

#include <cmath>
#include <limits>

namespace whirl::system {

namespace {
thread_local double asked = std::numeric_limits<double>::quiet_NaN();
}

double asked_frequency() noexcept { return asked; }
FrequencyScope::FrequencyScope(double w) noexcept : before_(asked) { asked = std::abs(w); }
FrequencyScope::~FrequencyScope() { asked = before_; }

}  // namespace whirl::system
