// The suite itself: deliberate faults must be found.
#include "conformance.hpp"
#include <elements/rigid/rigid_disk.hpp>
#include <gtest/gtest-spi.h>
#include <functional>

using namespace whirl;
using namespace whirl::test;

namespace {

// A disk with a fault put in afterwards.
struct Faulty {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr bool has_M = true, has_C = true, has_K = true;
  elements::RigidDisk disk{5.0, 0.08, 0.15, 0.2};
  std::function<void(const system::NodeState&, system::ForceX<7>&)> force = [](auto&, auto&) {};
  std::function<void(const system::NodeState&, system::TangentX<7>&)> tangent = [](auto&, auto&) {};
  std::function<void(const system::NodeState&, system::Energy&)> energy = [](auto&, auto&) {};
  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const {
    disk.add_force(x, c, f);
    force(*x[0], f);
  }
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const {
    disk.add_tangent(x, c, t);
    tangent(*x[0], t);
  }
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const {
    disk.add_energy(x, c, e);
    energy(*x[0], e);
  }
};

int failures(const Faulty& k) {
  ::testing::TestPartResultArray found;
  {
    ::testing::ScopedFakeTestPartResultReporter catcher(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &found);
    ConformanceOptions o;
    o.objective = true;
    o.samples = 2;
    check_kernel(k, o);
  }
  return found.size();
}

}  // namespace

TEST(Conformance, FindsFaults) {
  EXPECT_EQ(failures(Faulty{}), 0);
  Faulty k;
  k.force = [](auto& n, auto& f) { f[3] += 1e-6 * n.t.x(); };  // a force the tangent does not know
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.tangent = [](auto&, auto& t) { t.C(6, 3) += 1e-6; };
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.tangent = [](auto&, auto& t) { t.K(0, 4) += 1e-6; };
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.energy = [](auto& n, auto& e) { e.kinetic += 1e-6 * n.du.squaredNorm(); };
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.energy = [](auto&, auto& e) { e.dissipated -= 1.0; };
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.force = [](auto&, auto& f) { f = Vector<7>::Ones(); };  // overwrites
  EXPECT_GT(failures(k), 0);
  k = Faulty{};  // a spring to a fixed direction: consistent but not objective
  k.force = [](auto& n, auto& f) { f[0] += 3.0 * n.u.x(); };
  k.tangent = [](auto&, auto& t) { t.K(0, 0) += 3.0; };
  k.energy = [](auto& n, auto& e) { e.elastic += 1.5 * n.u.x() * n.u.x(); };
  EXPECT_GT(failures(k), 0);
}
