// The conformance suite, for kernels of any size.
#include <la/dense.hpp>
#include "conformance.hpp"
#include "../core/reference.hpp"
#include <functional>
#include <map>
#include <string>

namespace whirl::test {

void place(system::NodeState& n, rotation::Director& o, const Vector<6>& q, const Vector<6>& v,
           const Vector<6>& a, const Mat3& chart) {
  rotation::director(q.tail<2>(), v.tail<2>(), a.tail<2>(), o);
  n.chart = &chart;
  n.u = q.head<3>();
  n.du = v.head<3>();
  n.ddu = a.head<3>();
  n.t = chart * o.t;
  n.dd = chart * o.rate;
  n.ddd = chart * o.accel;
  n.phi = q[3];
  n.dphi = v[3];
  n.ddphi = a[3];
}

namespace {

using Q = VecX;  ///< unknowns, 6 a node
using X = VecX;  ///< coordinates, `width` a node
using RVecX = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

VecX vector(Random& random, int n) {
  VecX v(n);
  for (double& x : v)
    x = random.number();
  return v;
}

/// The kinematics of nodes at (q, v, a), and the map from X to q.
struct Frame {
  std::vector<system::NodeState> state;
  std::vector<rotation::Director> director;
  MatX J, J1, J2;  ///< dX/dq, d(X')/dq, d(X'')/dq
  int width;

  Frame(const Q& q, const Q& v, const Q& a, const Mat3& chart, const Vec3& gravity, int width_)
      : state(static_cast<std::size_t>(q.size() / 6)),
        director(state.size()),
        width(width_) {
    J = J1 = J2 = MatX::Zero(width * q.size() / 6, q.size());
    for (std::size_t k = 0; k < state.size(); ++k) {
      const Index i = static_cast<Index>(k);
      place(state[k], director[k], q.segment<6>(6 * i), v.segment<6>(6 * i), a.segment<6>(6 * i),
            chart);
      state[k].ddu -= gravity;
      J.block<3, 3>(width * i, 6 * i).setIdentity();
      if (width < 7) continue;
      J.block<3, 2>(width * i + 3, 6 * i + 4) = chart * director[k].D;
      J1.block<3, 2>(width * i + 3, 6 * i + 4) = chart * director[k].D_rate;
      J2.block<3, 2>(width * i + 3, 6 * i + 4) = chart * director[k].D_accel;
      J(width * i + 6, 6 * i + 3) = 1.0;
    }
  }
  X rates() const {
    X r(J.rows());
    for (std::size_t k = 0; k < state.size(); ++k) {
      const Index row = width * static_cast<Index>(k);
      r.segment<3>(row) = state[k].du;
      if (width < 7) continue;
      r.segment<3>(row + 3) = state[k].dd;
      r[row + 6] = state[k].dphi;
    }
    return r;
  }
};

class Conformance {
 public:
  Conformance(const AnyKernel& kernel, const ConformanceOptions& options)
      : k_(kernel),
        o_(options),
        N(kernel.nodes),
        W(kernel.width),
        n(6 * N),
        size_(N * W),
        random_(options.seed),
        turning_(options.seed + 1000),
        q_scale_(n),
        v_scale_(n),
        a_scale_(n) {
    for (int i = 0; i < N; ++i) {
      const auto fill = [i](Q& s, double u, double phi, double tilt) {
        s.segment<3>(6 * i).setConstant(u);
        s[6 * i + 3] = phi;
        s.segment<2>(6 * i + 4).setConstant(tilt);
      };
      fill(q_scale_, o_.u, o_.phi, o_.tilt);
      fill(v_scale_, o_.du, o_.dphi, o_.dtilt);
      fill(a_scale_, o_.ddu, o_.ddphi, o_.ddtilt);
    }
    context_.gravity = o_.gravity;
    context_.time = o_.time;
    context_.frequency = o_.frequency;
  }

  void run() {
    for (int s = 0; s < o_.samples && !::testing::Test::HasFailure(); ++s) {
      draw();
      check_accumulation();
      check_tangents();
      check_power();
      check_dependence();
      if (o_.objective) check_objectivity();
    }
    check_declared_is_seen();
  }

 private:
  void draw() {
    const auto add = [this](const std::vector<double>& x) {
      return x.empty() ? Q(Q::Zero(n)) : Q(Eigen::Map<const Q>(x.data(), n));
    };
    // the length of gamma, not only its components, stays below `tilt`
    q_ = add(o_.q0) + q_scale_.cwiseProduct(vector(random_, n));
    v_ = add(o_.v0) + v_scale_.cwiseProduct(vector(random_, n));
    for (int i = 0; i < N; ++i)
      q_.segment<2>(6 * i + 4) *= std::sqrt(0.5);
    a_ = a_scale_.cwiseProduct(vector(random_, n));
  }

  Frame frame(const Q& q, const Q& v, const Q& a) const {
    return {q, v, a, o_.chart, o_.gravity, W};
  }

  X force(const Frame& x, const system::Context& c) const {
    X f = X::Zero(size_);
    k_.add_force(x.state, c, f);
    return f;
  }
  Q force_q(const Q& q, const Q& v, const Q& a) const {
    const auto x = frame(q, v, a);
    return x.J.transpose() * force(x, context_);
  }

  AnyKernel::Tangents tangent(const Frame& x, double start) const {
    AnyKernel::Tangents t;
    t.M = t.C = t.K = MatX::Constant(size_, size_, start);
    k_.add_tangent(x.state, context_, t);
    return t;
  }

  void check_accumulation() {
    const auto x = frame(q_, v_, a_);
    const X f = force(x, context_);
    const double size = f.cwiseAbs().maxCoeff();
    X g = X::Constant(size_, size);
    k_.add_force(x.state, context_, g);
    EXPECT_LE((g - X::Constant(size_, size) - f).cwiseAbs().maxCoeff(), 1e-14 * size)
        << "add_force must add";
    const auto t0 = tangent(x, 0.0), t1 = tangent(x, 1.0);
    const auto same = [](const MatX& a, const MatX& b, const char* what) {
      const double s = 1.0 + a.cwiseAbs().maxCoeff();
      EXPECT_LE((b.array() - a.array() - 1.0).abs().maxCoeff(), 1e-14 * s)
          << "add_tangent must add to " << what;
    };
    same(t0.M, t1.M, "M");
    same(t0.C, t1.C, "C");
    same(t0.K, t1.K, "K");
    const auto untouched = [](bool has, const MatX& a, const char* what) {
      if (!has) {
        EXPECT_EQ(a.cwiseAbs().maxCoeff(), 0.0)
            << "has_" << what << " is false but " << what << " was written";
      }
    };
    untouched(k_.has_M, t0.M, "M");
    untouched(k_.has_C, t0.C, "C");
    untouched(k_.has_K, t0.K, "K");
  }

  void check_tangents() {
    const auto x = frame(q_, v_, a_);
    const auto t = tangent(x, 0.0);
    const X f = force(x, context_);
    const MatX M = x.J.transpose() * t.M * x.J;
    const MatX C = x.J.transpose() * (t.C * x.J + 2.0 * t.M * x.J1);
    MatX Kq = x.J.transpose() * (t.K * x.J + t.C * x.J1 + t.M * x.J2);
    if (W == 7)
      for (int i = 0; i < N; ++i) {
        const Vec3 fd = o_.chart.transpose() * f.segment<3>(W * i + 3);
        Kq.block<2, 2>(6 * i + 4, 6 * i + 4) +=
            x.director[static_cast<std::size_t>(i)].curvature(fd);
      }
    // Terms of each row in force units, so that N/m, N/rad and N m/rad compare.
    const VecX row = (M.cwiseAbs() * a_scale_.asDiagonal())
                         .rowwise()
                         .maxCoeff()
                         .cwiseMax((C.cwiseAbs() * v_scale_.asDiagonal())
                                       .rowwise()
                                       .maxCoeff()
                                       .cwiseMax((Kq.cwiseAbs() * q_scale_.asDiagonal())
                                                     .rowwise()
                                                     .maxCoeff()
                                                     .cwiseMax((x.J.transpose() * f).cwiseAbs())));
    const double floor = 1e-6 * row.maxCoeff();  // a row of zeros has no scale of its own
    compare(
        M, [&](const Q& d) { return force_q(q_, v_, a_ + d); }, a_scale_, row, floor, "M");
    compare(
        C, [&](const Q& d) { return force_q(q_, v_ + d, a_); }, v_scale_, row, floor, "C");
    compare(
        Kq, [&](const Q& d) { return force_q(q_ + d, v_, a_); }, q_scale_, row, floor, "K");

    if (o_.symmetric_M) {
      EXPECT_LE((M - M.transpose()).cwiseAbs().maxCoeff(), 1e-13 * M.cwiseAbs().maxCoeff());
    }
    if (o_.semidefinite_M && k_.has_M) {
      const MatX S = 0.5 * (M + M.transpose());
      const VecX inertias = la::symmetric_eigenpairs(S).values;
      EXPECT_GE(inertias.minCoeff(), -1e-13 * inertias.maxCoeff()) << "negative inertia";
    }
    if (o_.symmetric_K) {
      const Frame rest(q_, Q::Zero(n), Q::Zero(n), o_.chart, Vec3::Zero(), W);
      const auto s = tangent(rest, 0.0);
      MatX H = rest.J.transpose() * s.K * rest.J;
      if (W == 7) {
        const X g = force(rest, context_);
        for (int i = 0; i < N; ++i)
          H.block<2, 2>(6 * i + 4, 6 * i + 4) +=
              rest.director[static_cast<std::size_t>(i)].curvature(o_.chart.transpose() *
                                                                   g.segment<3>(W * i + 3));
      }
      const MatX scaled = q_scale_.asDiagonal() * H * q_scale_.asDiagonal();
      EXPECT_LE((scaled - scaled.transpose()).cwiseAbs().maxCoeff(),
                1e-12 * scaled.cwiseAbs().maxCoeff())
          << "K is not symmetric at rest";
    }
  }

  void compare(const MatX& exact, const std::function<Q(const Q&)>& f, const Q& scale,
               const VecX& row, double floor, const char* what) {
    for (int j = 0; j < n; ++j) {
      // eighth order with a step of 1/100 of the amplitude: truncation 1e-16, rounding 1e-14 of the
      // row
      const Real h = 1e-2L;
      const auto g = [&](Real s) {
        Q d = Q::Zero(n);
        d[j] = static_cast<double>(s) * scale[j];
        return RVecX(f(d).cast<Real>());
      };
      const VecX slope = central(g, h).cast<double>();
      for (int i = 0; i < n; ++i)
        EXPECT_NEAR(exact(i, j) * scale[j], slope[i],
                    o_.tangent_tolerance * std::max(row[i], floor))
            << what << "_q(" << i << ", " << j << "), unknowns (u, phi, gamma) a node";
    }
  }

  // q(t) with the drawn value, rate and acceleration at t = 0 and a jerk that keeps it general.
  void check_power() {
    const Q jerk = a_scale_.cwiseProduct(vector(random_, n));
    const auto at = [&](double t) {
      return frame(q_ + v_ * t + a_ * (t * t / 2) + jerk * (t * t * t / 6),
                   v_ + a_ * t + jerk * (t * t / 2), a_ + jerk * t);
    };
    const auto energy = [&](double t) {
      system::Context c = context_;
      c.time += t;
      system::Energy e;
      k_.add_energy(at(t).state, c, e);
      return e;
    };
    // a step in which no unknown moves by more than 1/100 of its amplitude
    const double h =
        1e-2 / (1e-30 + std::max((v_.cwiseAbs().cwiseQuotient(q_scale_)).maxCoeff(),
                                 std::sqrt(a_.cwiseAbs().cwiseQuotient(q_scale_).maxCoeff())));
    const auto stored = [&](Real s) {
      const system::Energy e = energy(static_cast<double>(s));
      return Eigen::Matrix<Real, 1, 1>(Real(e.kinetic) + e.elastic + e.gravity);
    };
    const double rate = static_cast<double>(central(stored, h)[0]);
    const system::Energy now = energy(0.0);
    const auto x = at(0.0);
    X terms = force(x, context_).cwiseProduct(x.rates());
    for (const int node : o_.signals)
      terms.segment(W * node, W).setZero();
    const double size =
        std::abs(rate) + std::abs(now.supplied) + std::abs(now.dissipated) +
        terms.cwiseAbs().maxCoeff() +
        1e-6 * (std::abs(now.kinetic) + std::abs(now.elastic) + std::abs(now.gravity)) / h;
    EXPECT_NEAR(rate, terms.sum() + now.supplied - now.dissipated, o_.power_tolerance * size)
        << "power balance";
    if (o_.semidefinite_M) {
      EXPECT_GE(now.kinetic, -1e-14 * size * h);
    }
    if (o_.passive) {
      EXPECT_GE(now.dissipated, -1e-14 * size) << "a passive element generates energy";
    }
  }

  // Turns the motion by T about the origin and expects F -> T F, m -> T m, m = d x f_d + f_phi (e +
  // d)/(1 + e.d).
  void check_objectivity() {
    ASSERT_TRUE(N == 1 || static_cast<int>(o_.position.size()) == N)
        << "objectivity needs the nodes' positions";
    const Vec3 axis = 0.8 * random_.direction<3>();
    const Mat3 T = rotation::L(axis);
    Q q = q_, v = v_, a = a_;
    const auto before = frame(q_, v_, a_);
    for (int i = 0; i < N; ++i) {
      const auto& s = before.state[static_cast<std::size_t>(i)];
      const Vec3 p =
          o_.position.empty() ? Vec3(Vec3::Zero()) : o_.position[static_cast<std::size_t>(i)];
      q.segment<3>(6 * i) = T * (p + s.u) - p;
      v.segment<3>(6 * i) = T * s.du;
      a.segment<3>(6 * i) = T * (s.ddu + o_.gravity);
      const Vec2 g = q_.segment<2>(6 * i + 4), dg = v_.segment<2>(6 * i + 4);
      const Vec3 omega = rotation::omega_of_rates(g, s.dphi, dg);
      const Vec3 domega =
          rotation::omega_rate_of_rates(g, s.dphi, dg, s.ddphi, a_.segment<2>(6 * i + 4));
      // phi follows the turning continuously: d phi = (e+d).d theta/(1+e.d), all in chart axes, by
      // fine RK4
      const Vec3 c = o_.chart.transpose() * axis;
      double phi = s.phi;
      Vec2 gamma = g;
      const int steps = 400;
      for (int k = 0; k < steps; ++k) {
        const double h = 1.0 / steps;
        const auto r1 = rotation::rates_of_omega(gamma, c);
        const auto r2 = rotation::rates_of_omega(gamma + h / 2 * r1.gamma, c);
        const auto r3 = rotation::rates_of_omega(gamma + h / 2 * r2.gamma, c);
        const auto r4 = rotation::rates_of_omega(gamma + h * r3.gamma, c);
        phi += h / 6 * (r1.phi + 2 * r2.phi + 2 * r3.phi + r4.phi);
        gamma += h / 6 * (r1.gamma + 2 * r2.gamma + 2 * r3.gamma + r4.gamma);
      }
      const Mat3 Tc = o_.chart.transpose() * T * o_.chart;
      gamma = rotation::gamma_of_director(
          Tc * (Vec3::UnitX() + before.director[static_cast<std::size_t>(i)].t) - Vec3::UnitX());
      const auto rate = rotation::rates_of_omega(gamma, Tc * omega);
      const auto accel = rotation::accelerations_of_omega(gamma, rate.phi, rate.gamma, Tc * domega);
      q[6 * i + 3] = phi;
      q.segment<2>(6 * i + 4) = gamma;
      v[6 * i + 3] = rate.phi;
      v.segment<2>(6 * i + 4) = rate.gamma;
      a[6 * i + 3] = accel.phi;
      a.segment<2>(6 * i + 4) = accel.gamma;
    }
    system::Context turned = context_;
    turned.gravity = T * o_.gravity;
    const Frame after(q, v, a, o_.chart, turned.gravity, W);
    const X f0 = force(before, context_), f1 = force(after, turned);
    double force_size = 0, moment_size = 0;
    const auto count = static_cast<std::size_t>(N);
    std::vector<Vec3> F0(count), F1(count), m0(count), m1(count);
    for (int i = 0; i < N; ++i) {
      const auto k = static_cast<std::size_t>(i);
      F0[k] = f0.segment<3>(W * i);
      F1[k] = f1.segment<3>(W * i);
      m0[k] = m1[k] = Vec3::Zero();
      if (W == 7) {
        const auto moment = [&](const system::NodeState& s, const X& f) {
          const Vec3 fd = f.segment<3>(W * i + 3);
          return Vec3(s.d().cross(fd) + f[W * i + 6] * (s.e() + s.d()) / (1.0 + s.e().dot(s.d())));
        };
        m0[k] = moment(before.state[k], f0);
        m1[k] = moment(after.state[k], f1);
      }
      force_size = std::max(force_size, F0[k].norm());
      moment_size = std::max(moment_size, m0[k].norm());
    }
    for (int i = 0; i < N; ++i) {
      const auto k = static_cast<std::size_t>(i);
      // 1e-9: phi is carried round by 400 steps of RK4, error 1e-11
      EXPECT_LE((F1[k] - T * F0[k]).norm(), 1e-9 * (force_size + moment_size))
          << "force not objective, node " << i;
      EXPECT_LE((m1[k] - T * m0[k]).norm(), 1e-9 * (force_size + moment_size))
          << "moment not objective, node " << i;
    }
    system::Energy e0, e1;
    k_.add_energy(before.state, context_, e0);
    k_.add_energy(after.state, turned, e1);
    EXPECT_NEAR(e0.elastic, e1.elastic, 1e-9 * std::abs(e0.elastic));
    EXPECT_NEAR(e0.kinetic, e1.kinetic, 1e-9 * std::abs(e0.kinetic));
    EXPECT_NEAR(e0.dissipated, e1.dissipated, 1e-9 * std::abs(e0.dissipated));
  }

  /// Force and tangents, one after another.
  using Answer = Eigen::Matrix<double, Eigen::Dynamic, 1>;
  Answer answer(const Frame& x, const system::Context& c) const {
    AnyKernel::Tangents t;
    t.M = t.C = t.K = MatX::Zero(size_, size_);
    k_.add_tangent(x.state, c, t);
    Answer a(size_ + 3 * size_ * size_);
    a << force(x, c), t.M.reshaped(), t.C.reshaped(), t.K.reshaped();
    return a;
  }
  /// Parts of an answer that differ by more than rounding; what is no number in one of them
  /// differs.
  bool differ(const Answer& a, const Answer& b) const {
    bool out = false;
    for (int part = 0; part < 4; ++part) {
      const int first = part == 0 ? 0 : size_ + (part - 1) * size_ * size_;
      const int length = part == 0 ? size_ : size_ * size_;
      const auto x = a.segment(first, length), y = b.segment(first, length);
      if (x.allFinite() != y.allFinite()) return true;
      if (!x.allFinite()) continue;
      const double large = std::max(x.cwiseAbs().maxCoeff(), y.cwiseAbs().maxCoeff());
      out = out || (x - y).cwiseAbs().maxCoeff() > o_.tangent_tolerance * large;
    }
    return out;
  }

  /// An answer that changes must be declared; what is declared and changes is noted.
  void judge(const char* what, bool declared, const Answer& before, const Answer& after) {
    const bool changes = differ(before, after);
    EXPECT_TRUE(declared || !changes) << "depends on " << what << " and does not declare it";
    seen_[what].declared = seen_[what].declared || declared;
    seen_[what].changes = seen_[what].changes || changes;
  }

  void check_dependence() {
    for (const bool averaged : {false, true})
      for (const bool hysteretic : {false, true}) {
        system::Context c = context_;
        c.averaged = averaged;
        c.hysteretic = hysteretic;
        check_angle_and_spin(c);
        check_surroundings(c);
      }
  }

  void check_angle_and_spin(const system::Context& c) {
    const system::Dependence d = k_.depends(c);
    const auto x = frame(q_, v_, a_);
    const Answer before = answer(x, c);
    const auto turned = [&](const VecX& by) {
      auto y = x;
      for (int i = 0; i < N; ++i)
        y.state[static_cast<std::size_t>(i)].phi += by[i];
      return answer(y, c);
    };
    VecX by = 2.0 * vector(turning_, N);
    judge("the angle", d.angle.form != system::SeenAngle::Form::none, before, turned(by));
    if (d.angle.form == system::SeenAngle::Form::sum) {
      VecX weight(N);
      for (int i = 0; i < N; ++i)
        weight[i] = d.angle.weight[static_cast<std::size_t>(i)];
      by -= weight * (weight.dot(by) / weight.squaredNorm());
      EXPECT_FALSE(differ(before, turned(by))) << "sees more than the declared sum of the angles";
    }
    auto y = x;
    for (auto& n : y.state)
      n.dphi += (o_.dphi > 0 ? o_.dphi : 1.0) * turning_.number();
    judge("the spin", d.spin, before, answer(y, c));
  }

  void check_surroundings(const system::Context& c) {
    const system::Dependence d = k_.depends(c);
    const auto x = frame(q_, v_, a_);
    const Answer before = answer(x, c);
    for (const double w : {1.0, 60.0, 200.0, 500.0}) {
      system::Context asked = c;
      asked.frequency = w;
      judge("the frequency", d.frequency, before, answer(x, asked));
      system::Context shaken = c;
      shaken.whirl = shaken.whirl_side = w;
      shaken.growth = -0.1 * w;
      judge("the rate", d.rate, before, answer(x, shaken));
    }
    for (const double dt : {0.013, 0.31, 1.7, 20.0}) {
      system::Context later = c;
      later.time += dt;
      judge("the time", d.time, before, answer(x, later));
    }
    const Vec3 more(0.4, 1.3, -2.1);
    system::Context heavier = c;
    heavier.gravity += more;
    auto y = x;
    for (auto& n : y.state)
      n.ddu -= more;
    judge("the weight", d.weight, before, answer(y, heavier));
  }

  void check_declared_is_seen() {
    const std::map<std::string, bool> excused{
        {"the angle", o_.over_declared.angle.form != system::SeenAngle::Form::none},
        {"the spin", o_.over_declared.spin},
        {"the frequency", o_.over_declared.frequency},
        {"the rate", o_.over_declared.rate},
        {"the time", o_.over_declared.time},
        {"the weight", o_.over_declared.weight}};
    for (const auto& [what, seen] : seen_)
      EXPECT_TRUE(seen.changes || !seen.declared || excused.at(what))
          << "declares to depend on " << what << " and does not";
  }

  struct Seen {
    bool declared = false, changes = false;
  };

  const AnyKernel& k_;
  const ConformanceOptions& o_;
  const int N, W;   ///< nodes, coordinates a node
  const int n;      ///< unknowns q
  const int size_;  ///< coordinates X
  std::map<std::string, Seen> seen_;
  Random random_;
  Random turning_;  ///< its own, so that the states are those of the other checks alone
  Q q_scale_, v_scale_, a_scale_, q_, v_, a_;
  system::Context context_;
};

}  // namespace

void check_conformance(const AnyKernel& kernel, const ConformanceOptions& options) {
  Conformance(kernel, options).run();
}

}  // namespace whirl::test
