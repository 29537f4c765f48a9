// Arnoldi's method beside a locked space: the searched part is the operator on the rest.
#include <gtest/gtest.h>
#include <la/dense.hpp>
#include <la/krylov.hpp>

using namespace whirl;
using namespace whirl::la;

namespace {

// More vectors are locked than are searched, and more than the projected matrix has rows at first.
TEST(Krylov, SearchesBesideManyLockedVectors) {
  constexpr Index dim = 90, locked = 70;
  const auto scale = [](const auto& in, auto& out) {
    out = in;
    for (Index i = 0; i < in.size(); ++i)
      out(i) *= static_cast<double>(i + 1);
  };
  Krylov<double> krylov;
  krylov.reset(dim, 3);
  for (Index i = 0; i < locked; ++i)
    ASSERT_TRUE(krylov.lock(VecX::Unit(dim, i)));
  EXPECT_FALSE(krylov.lock(VecX::Unit(dim, 4)));
  bool more = true;
  while (more)
    more = krylov.step(scale);
  ASSERT_EQ(krylov.processed(), dim - locked);
  const MatX projected = krylov.projected();
  const VecX values = symmetric_eigenpairs(projected).values;
  for (Index i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values(i), static_cast<double>(locked + i + 1), 1e-9);
  EXPECT_EQ(krylov.rest().rows(), 0);
}

}  // namespace
