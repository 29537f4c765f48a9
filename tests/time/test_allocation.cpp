// Steps do not allocate: operator new is counted while they run.
#include "sign_watch.hpp"
#include "toys.hpp"
#include <gtest/gtest.h>
#include <atomic>
#include <cstdlib>
#include <new>

// The sanitizers bring their own operator new and malloc.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<bool> counting{false};
std::atomic<long> allocations{0};
void* get(std::size_t size, std::size_t alignment) {
  if (counting) ++allocations;
  void* p = alignment
                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size ? size : 1);
  if (!p) throw std::bad_alloc();
  return p;
}
}  // namespace

void* operator new(std::size_t size) { return get(size, 0); }
void* operator new[](std::size_t size) { return get(size, 0); }
void* operator new(std::size_t size, std::align_val_t a) {
  return get(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return get(size, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

// Eigen takes memory from malloc itself: the matrices of the schemes are caught by this hook.
extern "C" void* __libc_malloc(std::size_t);
extern "C" void* malloc(std::size_t size) {
  if (counting.load(std::memory_order_relaxed)) ++allocations;
  return __libc_malloc(size);
}

namespace whirl::time::test {
namespace {

TEST(Allocation, TheCounterCounts) {
  counting = true;
  VecX x(100);
  double* volatile y = new double[10];  // the compiler may leave out what nobody looks at
  counting = false;
  EXPECT_GE(allocations.exchange(0), 2);
  EXPECT_EQ(x.size(), 100);
  delete[] y;
}

// Nonlinear, with rejections, changes of step, breakpoints, whole turns, events and interpolation.
TEST(Allocation, StepsDoNotAllocate) {
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha"}) {
    LavalRotor p;
    p.m = 1.0;
    p.e = 0.05;
    p.J = 0.02;
    p.k = 100.0;
    p.c = 0.3;
    p.torque = 3.0;
    Options o;
    o.tolerance = 1e-4;
    o.breakpoints = {0.3, 0.77};
    o.dt_first = 0.3;
    auto integrator = make_integrator(name, p, o);
    SignWatch watch(
        3, [](CRef, CRef v) { return v[2] - 50.0; }, 0);
    integrator->start(0.0, Vec3(0.02, 0.0, 0.0), Vec3(0.0, 0.5, 5.0));
    watch.begin(*integrator);
    VecX q(3), v(3), a(3);
    double t = 0.0;
    bool ok = true;
    int events = 0;
    allocations = 0;
    counting = true;
    for (int k = 0; k < 400; ++k) {
      const StepReport s = integrator->advance();
      ok = ok && s.ok();
      integrator->interpolate(0.3 * s.t0 + 0.7 * s.t1, q, v, a);
      if (watch.find(*integrator, s, t)) {
        ++events;
        if (t < s.t1) ok = ok && integrator->shorten_to(t).ok();
        integrator->restart(integrator->q(), integrator->v());
        watch.begin(*integrator);
      }
    }
    counting = false;
    EXPECT_TRUE(ok) << name;
    EXPECT_EQ(allocations, 0) << name;
    EXPECT_GT(integrator->statistics().rejected_error, 0) << name;
    if (name != std::string_view("generalized_alpha")) {
      EXPECT_GT(integrator->time(), 0.3) << name;
      EXPECT_GT(events, 0) << name;
    }
  }
}

}  // namespace
}  // namespace whirl::time::test

#endif
