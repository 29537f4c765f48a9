// Motions of small systems by the test's own order-14 integrator, in both forms of the equations.
#pragma once
#include <la/dense.hpp>
#include "../core/extrapolation.hpp"
#include <core/rotation.hpp>
#include <system/momentum.hpp>
#include <system/problem.hpp>
#include <gtest/gtest.h>
#include <memory>

namespace whirl::test {

using system::State;
using system::System;

/// A state that moves on in time; charts and turns taken care of after every step.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual void advance(double t1, int steps) = 0;
  virtual const State& state() = 0;
  int chart_changes = 0;
};

/// y = (r, v, phi, gamma, K): src/system/momentum.hpp.
class MomentumMotion final : public Motion {
 public:
  MomentumMotion(const System& s, const State& start) : p_(s), y_(p_.size()), t_(start.t) {
    p_.set_state(start, y_);
  }
  void advance(double t1, int steps) override {
    const double H = (t1 - t_) / steps, t0 = t_;
    const auto f = [&](double t, const VecX& y) {
      VecX dy(y.size());
      EXPECT_TRUE(p_.rate(t, y, dy));
      return dy;
    };
    for (int i = 0; i < steps; ++i) {
      const Mat3 before = p_.frames.axes(0);
      y_ = extrapolate(f, t0 + i * H, t0 + (i + 1) * H, y_, 1);
      p_.accept(y_);
      chart_changes += before != p_.frames.axes(0);
    }
    t_ = t1;
  }
  const State& state() override {
    EXPECT_TRUE(p_.get_state(t_, y_, state_));
    return state_;
  }
  const VecX& y() const { return y_; }

 private:
  system::MomentumProblem p_;
  VecX y_;
  double t_;
  State state_;
};

/// y = (q, q'), q'' = -M^-1 f of the active unknowns: the kernels' own equations.
class SecondOrderMotion final : public Motion {
 public:
  SecondOrderMotion(const System& s, const State& start)
      : s_(s),
        p_(s),
        w_(s.make_workspace()),
        m_(s.make_matrices()),
        y_(2 * s.size()),
        t_(start.t) {
    p_.frames = start.frames;
    y_ << start.q, start.v;
    for (Index k = 0; k < s.size(); ++k)
      if (s.active()[static_cast<std::size_t>(k)]) active_.push_back(static_cast<int>(k));
  }
  void advance(double t1, int steps) override {
    const double H = (t1 - t_) / steps, t0 = t_;
    const Index n = s_.size();
    const auto f = [&](double t, const VecX& y) {
      VecX dy(2 * n);
      dy << y.tail(n), acceleration(t, y);
      return dy;
    };
    for (int i = 0; i < steps; ++i) {
      y_ = extrapolate(f, t0 + i * H, t0 + (i + 1) * H, y_, 1);
      VecX q = y_.head(n), v = y_.tail(n), a = VecX::Zero(n);
      const Mat3 before = p_.frames.axes(0);
      p_.accept(t0 + (i + 1) * H, q, v, a);
      chart_changes += before != p_.frames.axes(0);
      y_ << q, v;
    }
    t_ = t1;
  }
  const State& state() override {
    const Index n = s_.size();
    state_ = {t_, y_.head(n), y_.tail(n), acceleration(t_, y_), p_.frames};
    return state_;
  }

 private:
  VecX acceleration(double t, const VecX& y) {
    const Index n = s_.size();
    VecX q = y.head(n), v = y.tail(n), a = VecX::Zero(n), r(n);
    s_.impose(p_.frames, t, q, v, a);
    EXPECT_TRUE(s_.residual(w_, p_.frames, t, q, v, a, r));
    EXPECT_TRUE(s_.tangent(w_, p_.frames, t, q, v, a, m_));
    MatX M(n, n);
    for (Index k = 0; k < n; ++k) {
      VecX e = VecX::Unit(n, k), c = VecX::Zero(n);
      m_.M.add_multiply(1.0, e, c);
      M.col(k) = c;
    }
    const MatX Ma = M(active_, active_);
    const VecX ra = r(active_);
    a(active_) = -la::DenseLu<double>(Ma).solve(ra);
    return a;
  }
  const System& s_;
  system::SystemProblem p_;
  system::Workspace w_;
  la::MCK m_;
  VecX y_;
  double t_;
  std::vector<int> active_;
  State state_;
};

/// Both forms, for tests that run twice.
inline std::vector<std::pair<const char*, std::unique_ptr<Motion>>> both_forms(const System& s,
                                                                               const State& start) {
  std::vector<std::pair<const char*, std::unique_ptr<Motion>>> m;
  m.emplace_back("momentum form", std::make_unique<MomentumMotion>(s, start));
  m.emplace_back("second-order form", std::make_unique<SecondOrderMotion>(s, start));
  return m;
}

/// Body axes of node i in a state, columns (d, b_2, b_3), global axes.
inline Mat3 attitude(const System&, const State& x, Index i) {
  const Vec2 g = x.q.segment<2>(6 * i + 4);
  return x.frames.axes(i) * rotation::L(Vec3(0, g.x(), g.y())) *
         rotation::L(Vec3(x.q[6 * i + 3], 0, 0));
}

/// Angular velocity of node i, global axes.
inline Vec3 angular_velocity(const System&, const State& x, Index i) {
  return x.frames.axes(i) * rotation::omega_of_rates(x.q.segment<2>(6 * i + 4), x.v[6 * i + 3],
                                                     x.v.segment<2>(6 * i + 4));
}

inline double energy(const System& s, const State& x) {
  system::Workspace w = s.make_workspace();
  s.evaluate_nodes(w, x.frames, x.t, x.q, x.v, x.a);
  const system::Energy e = s.energy(w);
  return e.kinetic + e.elastic + e.gravity;
}

}  // namespace whirl::test
