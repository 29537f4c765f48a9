// What every bearing law says of itself against what the assembled system does.
#include <assembly/build_system.hpp>
#include "../meshes/models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <typeinfo>

using namespace whirl;
using namespace whirl::test;

namespace {

struct Sample {
  const char* name;
  model::BearingLaw law;
  friend std::ostream& operator<<(std::ostream& out, const Sample& s) { return out << s.name; }
};

Matrix<6> diagonal(double x, double y, double z, double rx, double ry, double rz) {
  return Vector<6>(x, y, z, rx, ry, rz).asDiagonal();
}

model::LinearBearing linear() {
  model::LinearBearing b;
  b.K = diagonal(0, 2e6, 3e6, 0, 4e3, 0);
  b.K(1, 2) = 5e5;
  b.C = diagonal(0, 2e3, 3e3, 0, 0, 0);
  return b;
}
/// No stiffness of its own direction along x.
model::LinearBearing coupled() {
  model::LinearBearing b;
  b.K = diagonal(0, 2e6, 2e6, 0, 0, 0);
  b.K(0, 1) = 1e5;
  return b;
}
model::TableBearing table() {
  model::TableBearing b;
  b.speed = {-500, 500};
  b.K = {diagonal(1e6, 2e6, 3e6, 0, 0, 5e3), diagonal(1e6, 3e6, 4e6, 0, 0, 5e3)};
  b.C = {diagonal(0, 2e3, 3e3, 0, 0, 0), diagonal(0, 2e3, 3e3, 0, 0, 0)};
  return b;
}
model::NonlinearSpring spring_along(model::NonlinearSpring::Along along) {
  model::NonlinearSpring b;
  b.along = along;
  b.force.coefficients = {0, 1e6, 0, 1e14};
  return b;
}
model::NonlinearSpring play(double smooth) {
  model::NonlinearSpring b;
  b.along = model::NonlinearSpring::Along::radial;
  b.force.shape = model::ForceLaw::Shape::clearance;
  b.force.gap_minus = b.force.gap_plus = 5e-6;
  b.force.stiffness = 1e7;
  b.force.smooth = smooth;
  return b;
}
template <class Film>
Film film() {
  Film b;
  b.diameter = 0.05;
  b.length = 0.02;
  b.clearance = 1e-4;
  b.oil.viscosity = 0.02;
  return b;
}
model::FloatingRing ring(bool pinned, double stiffness) {
  model::FloatingRing b;
  b.inner = {0.05, 0.02, 1e-4, 0.02, 0};
  b.outer = {0.07, 0.02, 1.5e-4, 0.02, 0};
  b.pinned = pinned;
  b.stiffness = stiffness;
  return b;
}
model::SqueezeFilm damper(double stiffness) {
  auto b = film<model::SqueezeFilm>();
  b.stiffness = stiffness;
  return b;
}
model::BallBearing balls(double clearance) {
  model::BallBearing b;
  b.balls = 8;
  b.ball_diameter = 0.0119;
  b.pitch_diameter = 0.052;
  b.clearance = clearance;
  return b;
}
model::RollerBearing rollers(double clearance) {
  model::RollerBearing b;
  b.rollers = 12;
  b.roller_diameter = 0.01;
  b.roller_length = 0.012;
  b.pitch_diameter = 0.065;
  b.clearance = clearance;
  return b;
}
model::Rub rub(double friction) {
  model::Rub b;
  b.gap = 5e-6;
  b.stiffness = 1e7;
  b.friction = friction;
  return b;
}
model::AnnularSeal seal() {
  model::AnnularSeal b;
  b.diameter = 0.1;
  b.length = 0.04;
  b.clearance = 2e-4;
  b.pressure_drop = 1e6;
  b.density = 1000;
  b.viscosity = 1e-3;
  return b;
}
model::MagneticBearing magnetic() {
  model::MagneticBearing b;
  b.per_current = 200;
  b.per_displacement = 1.1e6;
  b.bias = 3;
  b.gap = 0.5e-3;
  b.angle = 0.3;
  b.amplifier_bandwidth = 1e4;
  b.control = {model::Pid{.kp = 1.4e4, .ki = 0, .kd = 20, .lag = 5e-5}};
  return b;
}
model::CrossCoupling cross_coupling() {
  model::CrossCoupling b;
  b.k = 1e6;
  return b;
}
model::RollingEstimate estimate(bool roller) {
  model::RollingEstimate b;
  b.roller = roller;
  b.elements = 8;
  b.size = 0.03;
  b.load = 500;
  b.load_angle = 0.4;
  b.contact_angle = pi / 6;
  b.kxx = roller ? 0 : 1e6;
  return b;
}
model::Coupling coupling() {
  model::Coupling b;
  b.K = diagonal(1e6, 2e6, 2e6, 1e4, 3e3, 3e3);
  b.C = diagonal(0, 1e3, 1e3, 0, 0, 0);
  return b;
}
model::GearPair gears(double helix, double backlash) {
  model::GearPair b;
  b.teeth = 20;
  b.other_teeth = 40;
  b.pitch_diameter = 0.1;
  b.helix = helix;
  b.centre_angle = 0.3;
  b.stiffness = 1e8;
  b.backlash = backlash;
  return b;
}

const std::vector<Sample>& samples() {
  using Along = model::NonlinearSpring::Along;
  static const std::vector<Sample> list{
      {"linear", linear()},
      {"linear_coupled", coupled()},
      {"spring_block", model::SpringBlock{1e6, 1e3}},
      {"table", table()},
      {"rigid", model::RigidSupport{{false, true, true, false, true, false}}},
      {"spring_y", spring_along(Along::y)},
      {"spring_z", spring_along(Along::z)},
      {"spring_radial", spring_along(Along::radial)},
      {"spring_x", spring_along(Along::x)},
      {"spring_ry", spring_along(Along::ry)},
      {"spring_rz", spring_along(Along::rz)},
      {"spring_rx", spring_along(Along::rx)},
      {"clearance", play(0)},
      {"smooth_clearance", play(2e-6)},
      {"short_journal", film<model::ShortJournal>()},
      {"journal", film<model::FiniteJournal>()},
      {"tilting_pad", film<model::TiltingPadJournal>()},
      {"floating_ring", ring(false, 0)},
      {"floating_ring_pinned", ring(true, 1e6)},
      {"floating_ring_pinned_alone", ring(true, 0)},
      {"squeeze_film", damper(1e6)},
      {"squeeze_film_alone", damper(0)},
      {"ball", balls(-5e-6)},
      {"ball_with_play", balls(5e-6)},
      {"roller", rollers(-5e-6)},
      {"roller_with_play", rollers(5e-6)},
      {"ball_estimate", estimate(false)},
      {"roller_estimate", estimate(true)},
      {"rub", rub(0)},
      {"rub_with_friction", rub(0.1)},
      {"annular_seal", seal()},
      {"magnetic", magnetic()},
      {"cross_coupling", cross_coupling()},
      {"coupling", coupling()},
      {"gears", gears(0, -1)},
      {"helical_gears", gears(0.3, -1)},
      {"gears_with_backlash", gears(0, 1e-6)},
  };
  return list;
}

/// A shaft whose middle the law supports: against the ground, or a second shaft of the same form.
class Supported {
 public:
  explicit Supported(const model::BearingLaw& law)
      : traits_(model::traits_of(law)),
        with_(rotor(&law)),
        mesh_(meshes::make_mesh(with_)),
        built_(assembly::build_system(with_, mesh_)) {
    // shafts come before supports: what their system has more is the law
    const model::Model bare = rotor(nullptr);
    const assembly::Built shafts = assembly::build_system(bare, meshes::make_mesh(bare));
    for (std::size_t k = shafts.system.terms().size(); k < built_.system.terms().size(); ++k)
      terms_.push_back(k);
  }

  struct Tangent {
    Matrix<6> K, C;
    Vec3 force;
  };
  /// K and C of the law alone at its node, and its force on the shaft, with the shaft at r, m, and
  /// turning at spin, rad/s.
  Tangent at(const Vec3& r, double spin) const {
    const system::System& s = built_.system;
    system::State x = s.make_state();
    const Index n = node();
    for (Index i = 0; i < s.nodes(); ++i) {
      const bool second = traits_.pair->has_value() && s.node(i).line == 1;
      const double ratio = second ? (*traits_.pair)->speed_ratio : 1.0;
      if (mesh_.nodes[static_cast<std::size_t>(i)].line >= 0) x.v[6 * i + 3] = ratio * spin;
    }
    x.q.segment<3>(6 * n) = r;
    system::Workspace w = s.make_workspace();
    w.context.averaged = true;  // rolling elements: the mean over a pass
    la::MCK m = s.make_matrices();
    EXPECT_TRUE(s.tangent(w, x.frames, x.t, x.q, x.v, x.a, m, &terms_));
    const Index slot = m.K.pattern().slot(n, n);
    return {m.K.block(slot), m.C.block(slot),
            built_.support_forces[0].force(
                [&](Index i) -> const system::NodeState& {
                  return w.nodes[static_cast<std::size_t>(i)];
                },
                w.context, [](Index) { return 0.0; })};
  }
  const model::SupportTraits& traits() const { return traits_; }
  const assembly::Built& built() const { return built_; }
  const meshes::BearingNodes& nodes() const { return mesh_.bearings[0]; }
  Index node() const { return mesh_.bearings[0].shaft.node; }

 private:
  model::Model rotor(const model::BearingLaw* law) const {
    model::Model m = one_shaft({cylinder("a", 0.2, 0.04), cylinder("b", 0.2, 0.04)});
    if (traits_.pair->has_value()) {
      m.shafts.push_back(m.shafts[0]);
      m.shafts[1].name = "second";
      m.shafts[1].speed_ratio = (*traits_.pair)->speed_ratio;
    }
    if (!law) return m;
    auto b = named<model::Bearing>("support", 0.2);
    b.law = *law;
    if (traits_.pair->has_value()) b.to = place(0.2, 1);
    m.bearings = {b};
    return m;
  }
  model::SupportTraits traits_;
  model::Model with_;
  meshes::Mesh mesh_;
  assembly::Built built_;
  std::vector<std::size_t> terms_;
};

const Vec3 displaced(2e-6, 1.1e-5, -0.7e-5);  // m, beyond every gap of the samples
constexpr double spin = 300;                  // rad/s
constexpr double arm = 0.1;                   // m: turns are compared as displacements at this arm

/// Entries beside the largest of the law, rotations as displacements at the arm.
Matrix<6> relative(Matrix<6> m, double largest) {
  m.bottomRows<3>() /= arm;
  m.rightCols<3>() /= arm;
  return m / largest;
}
double largest(const Matrix<6>& m) { return relative(m, 1.0).cwiseAbs().maxCoeff(); }

constexpr double some = 1e-6;  // of the largest entry

class SupportTraits : public ::testing::TestWithParam<Sample> {
 protected:
  const model::BearingLaw& law() const { return GetParam().law; }
  bool is_constraint() const { return model::traits_of(law()).acts == model::Acts::as_constraint; }
};

}  // namespace

TEST(SupportTraitsOf, EveryLawHasASample) {
  model::for_each_law([]<class Law>(std::type_identity<Law>) {
    EXPECT_TRUE(std::any_of(samples().begin(), samples().end(), [](const Sample& s) {
      return std::holds_alternative<Law>(s.law);
    })) << typeid(Law).name();
  });
}

TEST(SupportTraitsOf, AnAnswerLeftOutDoesNotCompile) {
  EXPECT_FALSE(std::is_default_constructible_v<model::SupportTraits>);
  EXPECT_FALSE(std::is_default_constructible_v<model::Given<bool>>);
  const auto made_of_one = []<class Traits>(std::type_identity<Traits>) {
    return requires { Traits{.held = model::no_direction}; };
  };
  EXPECT_FALSE(made_of_one(std::type_identity<model::SupportTraits>{}));
}

// Directions that are held: the static tangent of the support alone has stiffness there and none
// elsewhere.
TEST_P(SupportTraits, HoldsWhatItSays) {
  const Supported s(law());
  const model::Directions& held = s.traits().held;
  for (std::size_t c = 0; c < 6; ++c)
    if (is_constraint()) {
      EXPECT_EQ(!s.built().system.active()[6 * static_cast<std::size_t>(s.node()) + c], held[c]);
    }
  if (is_constraint()) return;
  const Matrix<6> K = s.at(displaced, spin).K;
  const bool mesh = s.traits().pair->has_value() && (*s.traits().pair)->mesh;
  for (Index c = 0; c < 6; ++c) {
    // teeth push along one line in space, with its moments: y, z and turns are not counted as held
    if (mesh && c != 0) continue;
    EXPECT_EQ(std::abs(relative(K, largest(K))(c, c)) > some, held[static_cast<std::size_t>(c)])
        << "direction " << c << "\n"
        << K;
  }
}

TEST_P(SupportTraits, LoadsItsNodeAsItSays) {
  if (is_constraint() || std::holds_alternative<model::Rub>(law())) {
    const model::NodeLoads none = model::traits_of(law()).loads;
    EXPECT_FALSE(none.lateral || none.tilting || none.torque);
    return;
  }
  const Supported s(law());
  const auto t = s.at(displaced, spin);
  const Matrix<6> K = relative(t.K, largest(t.K)), C = relative(t.C, std::max(largest(t.C), 1e-30));
  const auto acts = [](const auto& rows) { return rows.cwiseAbs().maxCoeff() > some; };
  const model::NodeLoads& loads = s.traits().loads;
  EXPECT_EQ(acts(K.middleRows<2>(1)) || acts(C.middleRows<2>(1)), loads.lateral) << K;
  EXPECT_EQ(K(4, 4) + K(5, 5) > some, loads.tilting) << K;
  EXPECT_EQ(K(3, 3) > some, loads.torque) << K;
}

TEST_P(SupportTraits, ActsWhereItSays) {
  const Supported s(law());
  const model::Acts acts = s.traits().acts;
  EXPECT_EQ(s.nodes().other.node >= 0, acts == model::Acts::between_nodes);
  const Index first = 6 * s.node();
  bool holds = false;
  for (Index c = 0; c < 6; ++c)
    holds = holds || !s.built().system.active()[static_cast<std::size_t>(first + c)];
  EXPECT_EQ(holds, acts == model::Acts::as_constraint);
}

TEST_P(SupportTraits, HasTheGapItSays) {
  if (is_constraint()) return;
  const Supported s(law());
  const auto centre = s.at(Vec3::Zero(), spin);
  const bool nothing = largest(centre.K) == 0 && largest(centre.C) == 0 && centre.force.isZero(0);
  EXPECT_EQ(nothing, *s.traits().gap) << centre.K;
}

TEST_P(SupportTraits, FollowsTheSpinAsItSays) {
  if (is_constraint()) return;
  const Supported s(law());
  const auto one = s.at(displaced, spin), other = s.at(displaced, -spin);
  const double K = std::max(largest(one.K), 1e-30), change = largest(one.K - other.K),
               force = (one.force - other.force).norm();
  EXPECT_EQ(change > some * K || force > some * one.force.norm(), *s.traits().follows_spin)
      << one.K << "\n"
      << other.K;
}

TEST_P(SupportTraits, IsLinearOrNotAsItSays) {
  if (is_constraint()) return;
  const Supported s(law());
  const auto change = [](const Matrix<6>& a, const Matrix<6>& b) {
    return (a - b).block<2, 2>(1, 1).norm() > some * std::max(largest(a), largest(b));
  };
  const auto centre = s.at(Vec3::Zero(), spin), off = s.at(displaced, spin);
  EXPECT_EQ(change(centre.K, off.K) || change(centre.C, off.C), *s.traits().nonlinear)
      << centre.K << "\n"
      << off.K;
}

TEST_P(SupportTraits, HasTheConstantStiffnessItSays) {
  if (is_constraint()) return;
  const Supported s(law());
  const model::SupportTraits& t = s.traits();
  const Matrix<6> K = s.at(Vec3::Zero(), spin).K;
  const auto& stated = *t.stiffness;
  if (stated) {
    EXPECT_LE(largest(K - *stated), 1e-12 * largest(K)) << K;
  }
  const bool holds = (*t.held)[1] || (*t.held)[2];
  if (holds && !t.nonlinear && !t.follows_spin && !t.pair->has_value()) {
    EXPECT_TRUE(stated.has_value()) << "a constant lateral stiffness is not stated";
  }
}

TEST_P(SupportTraits, NeedsItsLoadAsItSays) {
  if (is_constraint()) return;
  const Supported s(law());
  const Matrix<6> K = s.at(Vec3::Zero(), 0.0).K;
  const bool stiff = K(1, 1) != 0 || K(2, 2) != 0;
  if (s.traits().needs_load) {
    EXPECT_FALSE(stiff) << K;
  } else if (s.traits().mapped) {
    EXPECT_TRUE(stiff) << K;
  }
  if (s.traits().mapped) {
    EXPECT_TRUE((*s.traits().held)[1] || (*s.traits().held)[2]);
  }
}

TEST_P(SupportTraits, FilmsAndRollingElementsAreBuiltAsSuch) {
  const Supported s(law());
  const system::System& system = s.built().system;
  const system::State x = system.make_state();
  system::Workspace w = system.make_workspace();
  ASSERT_TRUE(system.evaluate_nodes(w, x.frames, x.t, x.q, x.v, x.a));
  const auto node = [&](Index i) -> const system::NodeState& {
    return w.nodes[static_cast<std::size_t>(i)];
  };
  bool film = false;
  for (const assembly::SupportCondition& c : s.built().conditions)
    film = film || c.state(node).film;
  EXPECT_EQ(film, *s.traits().film);
  EXPECT_EQ(!s.built().fine.empty(), *s.traits().film);
  EXPECT_EQ(!s.built().rolling_loads.empty(), *s.traits().rolling);
  EXPECT_EQ(s.built().support_forces.size(), 1u);
  ASSERT_EQ(s.built().support_terms.size(), 1u);
  if (s.traits().nonlinear || s.traits().follows_spin) {
    EXPECT_FALSE(s.built().support_terms[0].empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, SupportTraits, ::testing::ValuesIn(samples()),
                         [](const auto& info) { return std::string(info.param.name); });

namespace {

model::EstimatedStiffness stiffness(bool roller, int elements, double contact_angle) {
  model::RollingEstimate b = estimate(roller);
  b.elements = elements;
  b.contact_angle = contact_angle;
  return model::estimate_stiffness(b);
}

}  // namespace

TEST(RollingEstimate, NumbersOfFriswell) {
  const auto ball = stiffness(false, 8, pi / 6);
  EXPECT_NEAR(ball.across, 46416883.8, 1e-8 * 4.6e7);
  EXPECT_NEAR(ball.along, 100906269, 1e-8 * 1e8);
  const auto roller = stiffness(true, 8, pi / 6);
  EXPECT_NEAR(roller.across, 272821927, 1e-8 * 2.7e8);
  EXPECT_NEAR(roller.along, 556779444, 1e-8 * 5.5e8);
  // stiffness across the load over that along it, for 8, 12 and 16 elements (ibid.); between them
  // linear
  const double balls[] = {0.46, 0.64, 0.73}, rollers[] = {0.49, 0.66, 0.74};
  for (int k = 0; k < 3; ++k) {
    const auto b = stiffness(false, 8 + 4 * k, 0.0), r = stiffness(true, 8 + 4 * k, 0.0);
    EXPECT_NEAR(b.across / b.along, balls[k], 1e-12);
    EXPECT_NEAR(r.across / r.along, rollers[k], 1e-12);
  }
  const auto ten = stiffness(false, 10, 0.0);
  EXPECT_NEAR(ten.across / ten.along, 0.55, 1e-12);
}
