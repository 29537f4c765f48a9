// Linear algebra of a chain of n nodes: ns per node of factorisation and solution. Run with
// --benchmark_min_time=0.2.
#include <benchmark/benchmark.h>
#include <la/block_lu.hpp>
#include <la/direct.hpp>
#include "../la/fixtures.hpp"
#include <string>

using namespace whirl;
using namespace whirl::la;

namespace {

template <class Scalar>
Scalar shift();
template <>
double shift<double>() {
  return 0.9;
}
template <>
Complex shift<Complex>() {
  return {0.9, 0.4};
}

template <class Scalar>
void run(benchmark::State& state, const BlockPattern& p, DirectSolver<Scalar>& solver, bool factor,
         bool solve) {
  std::mt19937 rng(1);
  const MCK m = test::random_matrices(p, 20.0, rng);
  Eigen::Matrix<Scalar, -1, 1> b = Eigen::Matrix<Scalar, -1, 1>::Random(6 * p.size()), x = b;
  if (solver.factor(m, shift<Scalar>(), shift<Scalar>(), Scalar(1.0)) != Status::ok)
    state.SkipWithError("singular");
  for (auto _ : state) {
    if (factor) solver.factor(m, shift<Scalar>(), shift<Scalar>(), Scalar(1.0));
    if (solve) {
      x = b;
      solver.solve(x);
    }
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
  state.counters["ns/node"] = benchmark::Counter(
      static_cast<double>(p.size()) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

enum class What { factor_solve, factor, solve };

template <class Scalar, What what>
void chain(benchmark::State& state, SolverKind kind) {
  const BlockPattern p(state.range(0), test::chain(state.range(0)));
  const auto active = test::all_active(p);
  const auto solver = make_direct_solver<Scalar>(p, active, kind);
  run<Scalar>(state, p, *solver, what != What::solve, what != What::factor);
}

template <class Scalar>
void ordered(benchmark::State& state, lu::Ordering o, const lu::Kernels* k) {
  const BlockPattern p(state.range(0), test::chain(state.range(0)));
  BlockLu<Scalar> solver(p, test::all_active(p), o, k);
  run<Scalar>(state, p, solver, true, true);
}

/// Two shafts coupled by gears every tenth node.
template <class Scalar>
void geared(benchmark::State& state, SolverKind kind) {
  const Index n = state.range(0) / 2;
  auto pairs = test::chain(2 * n);
  for (Index i = 5; i < n; i += 10)
    pairs.emplace_back(i, 2 * n - 1 - i);
  const BlockPattern p(2 * n, pairs);
  const auto active = test::all_active(p);
  const auto solver = make_direct_solver<Scalar>(p, active, kind);
  run<Scalar>(state, p, *solver, true, true);
}

void sizes(benchmark::internal::Benchmark* b) { b->Arg(10)->Arg(100)->Arg(1000)->Arg(5000); }

}  // namespace

int main(int argc, char** argv) {
  const auto add = [](const std::string& name, auto f) {
    return benchmark::RegisterBenchmark(name.c_str(), f);
  };
  for (const auto& [label, kind] :
       {std::pair{"block", SolverKind::block}, std::pair{"klu", SolverKind::klu}}) {
    const std::string l = label;
    const SolverKind k = kind;
    add("chain/real/factor_solve/" + l, [k](auto& s) {
      chain<double, What::factor_solve>(s, k);
    })->Apply(sizes);
    add("chain/real/factor/" + l, [k](auto& s) {
      chain<double, What::factor>(s, k);
    })->Apply(sizes);
    add("chain/real/solve/" + l, [k](auto& s) { chain<double, What::solve>(s, k); })->Apply(sizes);
    add("chain/complex/factor_solve/" + l, [k](auto& s) {
      chain<Complex, What::factor_solve>(s, k);
    })->Apply(sizes);
    add("chain/complex/factor/" + l, [k](auto& s) {
      chain<Complex, What::factor>(s, k);
    })->Apply(sizes);
    add("chain/complex/solve/" + l, [k](auto& s) {
      chain<Complex, What::solve>(s, k);
    })->Apply(sizes);
    add("geared/real/factor_solve/" + l, [k](auto& s) { geared<double>(s, k); })->Apply(sizes);
    add("geared/complex/factor_solve/" + l, [k](auto& s) { geared<Complex>(s, k); })->Apply(sizes);
  }
  // What ordering and instruction set are worth.
  for (const auto* k : {lu::base_kernels(), lu::avx2_kernels(), lu::avx512_kernels()}) {
    if (!k) continue;
    for (const auto& [label, order] : {std::pair{"natural", lu::Ordering::natural},
                                       std::pair{"two_ended", lu::Ordering::two_ended}}) {
      const std::string l = std::string(k->isa) + "/" + label;
      const lu::Ordering o = order;
      add("chain/real/" + l, [o, k](auto& s) { ordered<double>(s, o, k); })->Arg(200);
      add("chain/complex/" + l, [o, k](auto& s) { ordered<Complex>(s, o, k); })->Arg(200);
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
