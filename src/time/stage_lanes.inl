// Body of the loop over the entries of a step; see stage_lanes.hpp. Included by one .cpp per
// instruction set, which defines WHIRL_LANES_TABLE and WHIRL_LANES_ISA. Everything here has internal
// linkage.
#include <time/stage_lanes.hpp>

namespace whirl::time::lanes {
namespace {

template <int S>
void finish(const Sums& w, const Vectors& x) {
  const std::ptrdiff_t n = x.n;
  const double h = x.h, share = x.share;
  const double *const real = x.real, *const complex = x.complex, *const q0 = x.q0, *const v0 = x.v0,
                      *const a0 = x.a0, *const q0_low = x.q0_low, *const v0_low = x.v0_low;
  double *const first = x.stages, *const second = x.stages + n,
                *const third = x.stages + (S - 1) * n;
  double *const q = x.q, *const v = x.v, *const a = x.a, *const q_low = x.q_low,
                *const v_low = x.v_low, *const last = x.last_increment, *const stiff = x.stiff,
                *const inertia = x.inertia, *const filter = x.filter;
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#else
#pragma GCC ivdep
#endif
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double u = real[i], re = complex[2 * i], im = complex[2 * i + 1], free = h * v0[i];
    const auto sum = [&](const Weights& k) { return k.real * u + k.re * re + k.im * im; };
    first[i] = sum(w.stage[0]);
    second[i] = sum(w.stage[1]);
    if constexpr (S == 3) third[i] = sum(w.stage[2]);
    a[i] = sum(w.end);
    last[i] = free + sum(w.last);
    stiff[i] = sum(w.leading);
    inertia[i] = sum(w.at_start) - share * a0[i];
    filter[i] = sum(w.defect);
    // sums with the rounding error carried in `low`: Knuth's two-sum
    const double dq = free + sum(w.increment) + q0_low[i], to_q = q0[i] + dq, of_q = to_q - q0[i];
    q_low[i] = (q0[i] - (to_q - of_q)) + (dq - of_q);
    q[i] = to_q;
    const double dv = sum(w.rate_increment) + v0_low[i], to_v = v0[i] + dv, of_v = to_v - v0[i];
    v_low[i] = (v0[i] - (to_v - of_v)) + (dv - of_v);
    v[i] = to_v;
  }
}

constexpr Kernels table = {WHIRL_LANES_ISA, finish<3>, finish<2>};

}  // namespace

const Kernels* WHIRL_LANES_TABLE() { return &table; }

}  // namespace whirl::time::lanes
