#include <analysis/harmonic.hpp>

#include <system/frequency.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {
constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Size of a variation: differences of second order in it drop out by symmetry, third order is below rounding.
double variation_step(const VecXc& a) {
  const double largest = a.cwiseAbs().maxCoeff();
  return largest > 0 ? 1e-7 / largest : 0.0;
}
}  // namespace

HarmonicSolver::HarmonicSolver(Linearizer& linear, Motion motion)
    : linear_(linear), motion_(linear.system(), motion),
      solver_(la::make_direct_solver<Complex>(linear.system().pattern(), motion_.active())) {}

bool HarmonicSolver::prepare(double Omega, double w) {
  const la::MCK& m = motion_.reduce(linear_.at(Omega, Complex(0, w)));
  return solver_->factor(m, Complex(-w * w, 0), Complex(0, w), Complex(1, 0)) == la::Status::ok;
}

void HarmonicSolver::solve(VecXc& x) {
  for (Index k = 0; k < x.size(); ++k)
    if (!motion_.takes_part(k)) x[k] = 0;
  solver_->solve(x);
}

PointAmplitude amplitude_at(const Linearizer& linear, const VecXc& a, const Point& p) {
  const Eigen::Vector3cd u = local_displacement(linear, a, p.node);
  const double sense = linear.sense(p.node);
  if (p.offset == 0.0) return {u[1], u[2], sense};
  // d = e + gamma x e about a nearly straight equilibrium: gamma3 along e2, -gamma2 along e3
  return {u[1] + p.offset * a[6 * p.node + 5], u[2] - p.offset * a[6 * p.node + 4], sense};
}

VariationMeter::VariationMeter(Linearizer& linear) : linear_(linear), problem_(linear.system()), snapshot_(problem_) {}

void VariationMeter::measure(const VecXc& a, double w, const std::vector<Measurement>& what, std::vector<std::vector<Complex>>& out) {
  const system::State& s = linear_.equilibrium().state;
  problem_.frames = s.frames;
  system::Context& context = problem_.workspace().context;
  context.hysteretic = linear_.hysteretic(), context.whirl = context.whirl_side = w;
  out.resize(what.size());
  for (std::size_t m = 0; m < what.size(); ++m) out[m].assign(what[m].width(), Complex(0, 0));
  if (!a.allFinite()) {   // no response: an undamped resonance, or a motion that nothing resists at 0 Hz
    for (auto& values : out) std::fill(values.begin(), values.end(), Complex(nan, nan));
    return;
  }
  const double eps = variation_step(a);
  if (eps == 0.0) return;
  const system::FrequencyScope ask(w);
  std::vector<double> value;
  for (int part = 0; part < 2; ++part) {
    // the motion at phase 0 and a quarter period earlier: Re and Im of the amplitude
    const Complex turn = part == 0 ? Complex(1, 0) : Complex(0, -1);
    const VecX q = (turn * a).real(), v = (turn * Complex(0, w) * a).real(), acc = (turn * (-w * w) * a).real();
    for (int sign : {1, -1}) {
      const double h = sign * eps;
      const VecX q1 = s.q + h * q, v1 = s.v + h * v, a1 = s.a + h * acc;
      snapshot_.set(s.t, q1, v1, a1);
      for (std::size_t m = 0; m < what.size(); ++m) {
        value.resize(what[m].width());
        what[m].evaluate(snapshot_, value.data());
        for (std::size_t c = 0; c < value.size(); ++c) {
          const double x = sign * value[c] / (2.0 * eps);
          out[m][c] += part == 0 ? Complex(x, 0) : Complex(0, x);
        }
      }
    }
  }
}

VecXc reaction_amplitudes(Linearizer& linear, const VecXc& a, double w, const VecXc& f) {
  const system::System& system = linear.system();
  const system::State& s = linear.equilibrium().state;
  system::Workspace workspace = system.make_workspace();
  workspace.context.hysteretic = linear.hysteretic(), workspace.context.whirl = workspace.context.whirl_side = w;
  VecXc out = VecXc::Zero(a.size());
  const double eps = variation_step(a);
  VecX r(a.size());
  const system::FrequencyScope ask(w);
  if (eps > 0)
    for (int part = 0; part < 2; ++part) {
      const Complex turn = part == 0 ? Complex(1, 0) : Complex(0, -1);
      for (int sign : {1, -1}) {
        const double h = sign * eps;
        const VecX q = s.q + h * (turn * a).real(), v = s.v + h * (turn * Complex(0, w) * a).real(),
                   acc = s.a + h * (turn * (-w * w) * a).real();
        system.residual(workspace, s.frames, s.t, q, v, acc, r);
        out += (part == 0 ? Complex(1, 0) : Complex(0, 1)) * (sign / (2.0 * eps)) * r;
      }
    }
  out += f;
  for (Index k = 0; k < a.size(); ++k)
    if (system.active()[at(k)]) out[k] = 0;
  return out;
}

}  // namespace whirl::analysis
