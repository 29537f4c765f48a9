#include <core/text.hpp>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <string>

namespace {

/// The C++ library's own digits, without zeros at the end.
std::string by_library(double x, int decimals) {
  char b[64];
  const auto end = std::to_chars(b, b + sizeof b, x, std::chars_format::fixed, decimals).ptr;
  std::string s(b, end);
  if (decimals > 0) s.erase(s.find_last_not_of('0') + 1);
  if (s.back() == '.') s.pop_back();
  return s == "-0" ? "0" : s;
}

}  // namespace

// Middles between two numbers (exact in binary or a digit beside), signs, zeros at either end, sizes
// at which the quick way leaves off.
TEST(Text, NumbersOfPicturesAreRoundedAsTheLibraryRounds) {
  for (int decimals = 0; decimals <= 4; ++decimals) {
    for (const double x : {0.0, 0.001, 0.004, 0.005, 0.0051, 0.5, 1.5, 2.5, 0.125, 0.375, 9.995,
                           10.0, 100.0, 120.5, 99999.99, 99999.999999, 1e5, 123456.789, 3e14})
      for (const double sign : {1.0, -1.0})
        EXPECT_EQ(whirl::number_text(sign * x, decimals), by_library(sign * x, decimals))
            << sign * x << " to " << decimals;
    for (int k = -2000; k <= 2000; ++k) {
      const double x = 0.0005 * k, beside = std::nextafter(x, 1.0);
      EXPECT_EQ(whirl::number_text(x, decimals), by_library(x, decimals)) << x;
      EXPECT_EQ(whirl::number_text(beside, decimals), by_library(beside, decimals)) << x;
    }
  }
}
