// The loop of a linear step in every instruction set against its formulas.
#include <gtest/gtest.h>
#include <core/types.hpp>
#include <time/stage_lanes.hpp>

#include <vector>

namespace whirl::time::test {
namespace {

std::vector<const lanes::Kernels*> tables_of_this_machine() {
  std::vector<const lanes::Kernels*> out{lanes::base_kernels()};
#if defined(__x86_64__)
  const bool fma = __builtin_cpu_supports("fma");
  if (lanes::avx2_kernels() && fma && __builtin_cpu_supports("avx2"))
    out.push_back(lanes::avx2_kernels());
  if (lanes::avx512_kernels() && fma && __builtin_cpu_supports("avx512vl"))
    out.push_back(lanes::avx512_kernels());
#endif
  return out;
}

TEST(StageLanes, EveryInstructionSetMakesTheSameSums) {
  constexpr Index n = 23;  // no multiple of a vector
  constexpr double h = 0.3;
  const VecX real = VecX::Random(n), q0 = VecX::Random(n), v0 = VecX::Random(n),
             a0 = VecX::Random(n), q0_low = 1e-17 * VecX::Random(n),
             v0_low = 1e-17 * VecX::Random(n);
  const VecXc z = VecXc::Random(n);
  lanes::Sums w;
  double number = 0.0;
  for (lanes::Weights* x : {&w.stage[0], &w.stage[1], &w.stage[2], &w.increment, &w.rate_increment,
                            &w.end, &w.last, &w.defect, &w.at_start, &w.leading}) {
    number += 0.25;
    *x = {number, 1.0 - number, 2.0 + number};
  }
  const auto sum = [&](const lanes::Weights& x) {
    return VecX(x.real * real + x.re * z.real() + x.im * z.imag());
  };
  const auto near = [](const VecX& x, const VecX& y) {
    return (x - y).cwiseAbs().maxCoeff() < 1e-13;
  };
  for (const lanes::Kernels* const k : tables_of_this_machine()) {
    MatX stages(n, 3);
    VecX q(n), v(n), a(n), q_low(n), v_low(n), last(n), stiff(n), inertia(n), filter(n);
    k->finish_three(w, {n,
                        real.data(),
                        reinterpret_cast<const double*>(z.data()),
                        q0.data(),
                        v0.data(),
                        a0.data(),
                        q0_low.data(),
                        v0_low.data(),
                        h,
                        1.0,
                        stages.data(),
                        q.data(),
                        v.data(),
                        a.data(),
                        q_low.data(),
                        v_low.data(),
                        last.data(),
                        stiff.data(),
                        inertia.data(),
                        filter.data()});
    for (Index j = 0; j < 3; ++j)
      EXPECT_TRUE(near(stages.col(j), sum(w.stage[at(j)]))) << k->isa << j;
    EXPECT_TRUE(near(q, q0 + h * v0 + sum(w.increment))) << k->isa;
    EXPECT_TRUE(near(v, v0 + sum(w.rate_increment))) << k->isa;
    EXPECT_TRUE(near(a, sum(w.end))) << k->isa;
    EXPECT_TRUE(near(last, h * v0 + sum(w.last))) << k->isa;
    EXPECT_TRUE(near(stiff, sum(w.leading))) << k->isa;
    EXPECT_TRUE(near(inertia, sum(w.at_start) - a0)) << k->isa;
    EXPECT_TRUE(near(filter, sum(w.defect))) << k->isa;
    // what rounding leaves is below a digit of the sum, and no increment is lost in it
    EXPECT_LT(q_low.cwiseAbs().maxCoeff(), 1e-15) << k->isa;
    EXPECT_GT(q_low.cwiseAbs().maxCoeff(), 1e-18) << k->isa;
    EXPECT_LT(v_low.cwiseAbs().maxCoeff(), 1e-15) << k->isa;
  }
}

}  // namespace
}  // namespace whirl::time::test
