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
  static constexpr system::Family family = system::Family::body;
  system::Dependence declared = elements::RigidDisk::depends;
  system::Dependence depends(const system::Context&) const { return declared; }
  elements::RigidDisk disk{5.0, 0.08, 0.15, 0.2};
  std::function<void(const system::NodeState&, system::ForceX<7>&)> force = [](auto&, auto&) {};
  /// Of a context: a force that no tangent misses.
  std::function<double(const system::Context&)> push = [](auto&) { return 0.0; };
  std::function<void(const system::NodeState&, system::TangentX<7>&)> tangent = [](auto&, auto&) {};
  std::function<void(const system::NodeState&, system::Energy&)> energy = [](auto&, auto&) {};
  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const {
    disk.add_force(x, c, f);
    force(*x[0], f);
    f[0] += push(c);
  }
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const {
    disk.add_tangent(x, c, t);
    tangent(*x[0], t);
  }
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const {
    disk.add_energy(x, c, e);
    energy(*x[0], e);
    e.supplied -= push(c) * x[0]->du.x();
  }
};

template <system::Kernel K>
int failures_of(const K& k, bool objective) {
  ::testing::TestPartResultArray found;
  {
    ::testing::ScopedFakeTestPartResultReporter catcher(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &found);
    ConformanceOptions o;
    o.objective = objective;
    o.samples = 2;
    check_kernel(k, o);
  }
  return found.size();
}
int failures(const Faulty& k, bool objective = true) { return failures_of(k, objective); }

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

TEST(Conformance, FindsFalseDeclarations) {
  using system::Context;
  Faulty k;
  k.declared.spin = false;  // gyroscopic moments
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.declared.weight = false;
  EXPECT_GT(failures(k), 0);
  k = Faulty{};
  k.push = [](const Context& c) { return std::isnan(c.frequency) ? 0.0 : 1e-3 * c.frequency; };
  EXPECT_GT(failures(k), 0);
  k.declared.frequency = true;
  EXPECT_EQ(failures(k), 0);
  k = Faulty{};
  k.push = [](const Context& c) { return 1e-3 * c.whirl; };
  EXPECT_GT(failures(k), 0);
  k.declared.rate = true;
  EXPECT_EQ(failures(k), 0);
  k = Faulty{};
  k.push = [](const Context& c) { return 2.0 + c.time; };
  EXPECT_GT(failures(k, false), 0);
  k.declared.time = true;
  EXPECT_EQ(failures(k, false), 0);
}

// A potential of phi.
TEST(Conformance, FindsAngles) {
  Faulty k;
  // conservative, V = cos(phi)
  k.force = [](auto& n, auto& f) { f[6] -= std::sin(n.phi); };
  k.tangent = [](auto& n, auto& t) { t.K(6, 6) -= std::cos(n.phi); };
  k.energy = [](auto& n, auto& e) { e.elastic += std::cos(n.phi); };
  EXPECT_GT(failures(k, false), 0);
  k.declared.angle = system::each_angle;
  EXPECT_EQ(failures(k, false), 0);
}

TEST(Conformance, FindsNeedlessDeclarations) {
  for (const auto set : {+[](system::Dependence& d) { d.angle = system::each_angle; },
                         +[](system::Dependence& d) { d.frequency = true; },
                         +[](system::Dependence& d) { d.rate = true; },
                         +[](system::Dependence& d) { d.time = true; }}) {
    Faulty k;
    set(k.declared);
    EXPECT_GT(failures(k), 0);
  }
}

namespace {

// A torsional spring that names the wrong sum of its angles.
struct Twisted {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = false, has_C = false, has_K = true;
  static constexpr system::Family family = system::Family::support;
  system::SeenAngle declared = system::twist_angle;
  system::Dependence depends(const system::Context&) const { return {.angle = declared}; }
  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<14>& f) const {
    const double T = 3.0 * (x[0]->phi - x[1]->phi);
    f[6] += T;
    f[13] -= T;
  }
  void add_tangent(const system::Nodes<2>&, const system::Context&, system::TangentX<14>& t) const {
    t.K(6, 6) += 3.0;
    t.K(13, 13) += 3.0;
    t.K(6, 13) -= 3.0;
    t.K(13, 6) -= 3.0;
  }
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const {
    const double twist = x[0]->phi - x[1]->phi;
    e.elastic += 1.5 * twist * twist;
  }
};

}  // namespace

TEST(Conformance, FindsWrongSumsOfAngles) {
  EXPECT_EQ(failures_of(Twisted{}, false), 0);
  EXPECT_GT(failures_of(Twisted{system::angle_sum(1.0, 1.0)}, false), 0);
  EXPECT_GT(failures_of(Twisted{system::no_angle}, false), 0);
}

// The members of a declaration do what their names say.
TEST(Dependence, AnglesAndUnions) {
  using namespace whirl::system;
  const std::array<double, 2> together{3.0, 3.0}, apart{3.0, 1.0}, still{0.0, 0.0};
  const std::array<double, 2> geared{0.1 * 33.0, -0.1 * 7.0};
  EXPECT_FALSE(twist_angle.changes(together));
  EXPECT_TRUE(twist_angle.changes(apart));
  EXPECT_FALSE(angle_sum(7, 33).changes(geared));
  EXPECT_TRUE(angle_sum(7, 32).changes(geared));
  EXPECT_TRUE(each_angle.changes(together));
  EXPECT_FALSE(each_angle.changes(still));
  EXPECT_FALSE(no_angle.changes(apart));
  EXPECT_EQ(twist_angle | no_angle, twist_angle);
  EXPECT_EQ(twist_angle | twist_angle, twist_angle);
  EXPECT_EQ(twist_angle | angle_sum(7, 33), each_angle);
  const Dependence both = Dependence{.spin = true} | Dependence{.time = true};
  EXPECT_TRUE(both.spin && both.time && !both.frequency && !both.weight && !both.rate);
}

namespace {
struct Silent : Twisted {
  void depends() const {}  // hides the declaration
};
}  // namespace
static_assert(system::Kernel<Twisted>);
static_assert(!system::Kernel<Silent>);
