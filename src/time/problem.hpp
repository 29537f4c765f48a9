// What every time scheme integrates: R(t, q, v, a) = M(q) a + f(q, v, t) = 0 with v = q', a = q''.
// The mechanical System implements it; tests implement it for small known equations.
#pragma once
#include <core/types.hpp>
#include <span>

namespace whirl::time {

using Ref = Eigen::Ref<VecX>;
using CRef = Eigen::Ref<const VecX>;
using RefC = Eigen::Ref<VecXc>;

/// Kinds of unknown, for error control: each kind has its own scale and absolute tolerance.
enum class Kind : unsigned char { displacement, spin_angle, tilt, internal, held };

class Problem {
 public:
  virtual ~Problem() = default;
  /// Length of q, v, a, r. Held (prescribed or fixed) entries are included; their residual is not
  /// solved for.
  virtual Index size() const = 0;
  /// Kind of every unknown; Kind::held marks entries that impose() sets and Newton leaves alone.
  virtual std::span<const Kind> kinds() const = 0;
  /// True when M, C, K are constant and R is affine in (q, v, a): one linearisation serves the run
  /// and Newton's first iteration is exact.
  virtual bool is_linear() const { return false; }
  /// True when forces have corners (contacts, gaps): matrices are then those of the start of a
  /// step, so that one that would jump over a contact fails and is shortened.
  virtual bool has_corners() const { return false; }
  /// Sets the held entries of q, v, a at time t (exactly, from their laws).
  virtual void impose(double t, Ref q, Ref v, Ref a) const = 0;
  /// r = R(t, q, v, a); entries of held unknowns are the reactions. Returns false when the
  /// configuration is outside the model's domain (a director beyond pi, a film thickness below
  /// zero): the step must be shortened.
  virtual bool residual(double t, CRef q, CRef v, CRef a, Ref r) = 0;
  /// Evaluates and keeps M = dR/da, C = dR/dv, K = dR/dq.
  virtual void linearize(double t, CRef q, CRef v, CRef a) = 0;
  /// y += s M x, s C x, s K x with the kept matrices.
  virtual void add_M(double s, CRef x, Ref y) const = 0;
  virtual void add_C(double s, CRef x, Ref y) const = 0;
  virtual void add_K(double s, CRef x, Ref y) const = 0;
  /// Factors cm M + cc C + ck K of the kept matrices (held unknowns as identity); false when
  /// singular.
  virtual bool factor(double cm, double cc, double ck) = 0;
  virtual bool factor(Complex cm, Complex cc, Complex ck) = 0;
  /// b := S^-1 b with the last real or complex factorisation (both are kept side by side).
  virtual void solve(Ref b) const = 0;
  virtual void solve(RefC b) const = 0;
  /// Power balance at a state: stored energy (kinetic + potential), power supplied from outside and
  /// power dissipated. d(stored)/dt = supplied - dissipated holds for the exact solution. reactions
  /// = r of residual() at that state.
  struct Power {
    double stored = 0.0, kinetic = 0.0, supplied = 0.0, dissipated = 0.0;
  };
  virtual Power power(double t, CRef q, CRef v, CRef a, CRef reactions) = 0;
  /// Called after an accepted step: may re-chart rotations and take whole turns out of phi (q, v, a
  /// change consistently). Returns true when it changed anything: the scheme then drops what it
  /// extrapolates from.
  virtual bool accept(double t, Ref q, Ref v, Ref a) {
    (void)t;
    (void)q;
    (void)v;
    (void)a;
    return false;
  }
};

}  // namespace whirl::time
