// Contracts inside the program (core/contract.hpp), checked here whatever the build checks: the only
// unit with the macro on its own terms, compiled by itself.
#ifndef WHIRL_CHECKS
#define WHIRL_CHECKS
#endif
#include <core/contract.hpp>
#include <gtest/gtest.h>

#include <string>

namespace {

int line_of_contract = 0;

double root_of_positive(double x) {
  line_of_contract = __LINE__ + 1;
  WHIRL_EXPECTS(x > 0.0);
  return x;
}

TEST(ContractDeathTest, BrokenEndsTheProgramWithFileAndLine) {
  root_of_positive(1.0);  // kept
  const std::string place = "test_contract.cpp:" + std::to_string(line_of_contract);
  EXPECT_DEATH(root_of_positive(-1.0), place + ": contract broken: x > 0.0");
}

TEST(Contract, AsksItsConditionOnce) {
  int asked = 0;
  WHIRL_EXPECTS(++asked == 1);
  EXPECT_EQ(asked, 1);
}

}  // namespace
