// A free flexible rotor over a thousand tumbles.
#include "../validation/free_motion.hpp"

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::test;

TEST(Tumbling, AFlexibleRotorTumblesAThousandTimes) {
  tumble_a_thousand_times("A flexible rotor over 1,000 tumbles", free_rotor(), Vec3(5, 1, -10),
                          640.0, "gauss4", 1e-6, 1e-2, 1e-2);
}
