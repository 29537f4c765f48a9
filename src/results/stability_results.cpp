#include <results/stability_results.hpp>

#include <run/diagnose.hpp>
#include <core/error.hpp>
#include <core/rotation.hpp>

#include <fmt/format.h>

#include <cmath>

namespace whirl::results {

analysis::Definiteness judge_state(analysis::SteadySystem& running, const system::State& state,
                                   double Omega, std::span<const Index> holds, bool shape) {
  const system::System& system = running.system();
  la::MCK m = system.make_matrices();
  if (!running.tangent(state.frames, Omega, state.q, m))
    throw run_error("E76", "the tangent of the equilibrium cannot be evaluated");
  return analysis::judge_tangent(m.K, analysis::free_unknowns(system, holds), system,
                                 analysis::model_length(system), shape);
}

namespace {
std::string pairs_of_negative_part(Index n) {
  return fmt::format(
      "{} pair{} of eigenvalues of the unsymmetric static tangent {} a negative real part", n,
      n == 1 ? "" : "s", n == 1 ? "has" : "have");
}
}  // namespace

std::string stability_line(const analysis::Definiteness& d, double Omega) {
  if (d.undecided())
    return "whether the equilibrium is stable depends on masses and damping: " +
           pairs_of_negative_part(d.open);
  if (d.stable()) return {};
  std::string out =
      fmt::format("unstable equilibrium, {} direction{}", d.negative, d.negative == 1 ? "" : "s");
  if (!d.symmetric)
    out += d.certain ? ": it diverges at any mass and damping"
                     : " found among the eigenvalues of least size";
  if (Omega != 0.0)
    out +=
        " (of the static tangent at this speed; whether gyroscopic moments hold it is for a modal "
        "step)";
  return out;
}

void warn_of_unstable(run::Job& job, const std::string& step, const analysis::Definiteness& d,
                      double Omega) {
  if (d.stable() && !d.undecided()) return;
  Diagnostic w;
  w.severity = Diagnostic::Severity::warning;
  w.code = "W08";
  w.message = fmt::format("step '{}': {}", step, stability_line(d, Omega));
  w.hint = d.undecided()
               ? "a modal or stability step about this state says what grows"
               : "a real structure leaves this state; a path with 'branch', or an imperfection, "
                 "leads to where it goes";
  job.report.warnings.push_back(w.message);
  job.summary["warnings"].push(w.code + ": " + w.message);
  if (!job.options.quiet) run::print_diagnostics({w});
}

void add_stability(io::Value& v, const analysis::Definiteness& d, double Omega) {
  io::Value& s = v["stability"];
  if (!d.judged) {
    s["stable"] = "not judged: " + left_to_controllers;
    return;
  }
  if (d.undecided())
    s["stable"] = "not decided: " + pairs_of_negative_part(d.open);
  else
    s["stable"] = d.stable();
  s["unstable directions"] = static_cast<int>(d.negative);
  s["tangent"] = d.symmetric ? "symmetric" : "unsymmetric";
  s["proved"] = d.certain;
  s["means"] = d.symmetric ? "negative eigenvalues of the static tangent: directions in which the "
                             "potential energy falls"
                           : "negative real eigenvalues of the static tangent: divergence; whirl "
                             "and flutter are for a modal step";
  if (Omega != 0.0)
    s["at speed"] =
        "gyroscopic moments are not counted; they may hold an even number of directions (modal "
        "step)";
  if (!d.stable() && d.shape.size() > 0) s["lowest eigenvalue [N/m]"] = d.lowest;
}

io::Table shape_table(const run::Job& job, const std::string& title, const system::Frames& frames,
                      const VecX& q, const VecX& unknowns) {
  const system::System& system = job.system();
  system::State state = system.make_state();
  state.frames = frames;
  state.q = q;
  VecX shape = unknowns;
  system.complete(state, shape);
  io::Table t;
  t.title = title;
  t.columns = {{"node", "-", ""},
               {"x", "m", "at rest"},
               {"y", "m", ""},
               {"z", "m", ""},
               {"u_x", "-", "largest displacement 1"},
               {"u_y", "-", ""},
               {"u_z", "-", ""},
               {"phi", "1/m", "turn about the axis"},
               {"d_x", "1/m", "change of the section's normal"},
               {"d_y", "1/m", ""},
               {"d_z", "1/m", ""}};
  for (Index i = 0; i < system.nodes(); ++i) {
    const system::NodeDef& node = system.node(i);
    if (node.scalar) continue;
    rotation::Director d;
    rotation::director(q.segment<2>(6 * i + 4), d);
    const Mat3& chart = frames.axes(i);
    const Vec3 tilt = chart * (d.D * shape.segment<2>(6 * i + 4));
    const auto u = shape.segment<3>(6 * i);
    t.add({node.name, node.position.x(), node.position.y(), node.position.z(), u.x(), u.y(), u.z(),
           shape[6 * i + system::spin_phi], tilt.x(), tilt.y(), tilt.z()});
  }
  return t;
}

io::Table critical_table(const analysis::LoadPathResult& path) {
  io::Table t;
  t.title = "Critical points of the path";
  t.columns = {{"point", "-", "limit: the load turns; bifurcation: other equilibria branch off"},
               {"number", "-", "of the bifurcation"},
               {"load factor", "-", ""},
               {"unstable directions before", "-", ""},
               {"unstable directions after", "-", ""},
               {"followed", "-", "1: the path went on along the branch"}};
  int number = 0;
  for (std::size_t k = 0; k < path.critical.size(); ++k) {
    const analysis::CriticalPoint& c = path.critical[k];
    const int followed = path.branched_at == static_cast<int>(k) ? 1 : 0;
    t.add({c.limit ? "limit" : "bifurcation", c.limit ? 0 : ++number, c.load,
           static_cast<int>(c.before), static_cast<int>(c.after), followed});
  }
  return t;
}

}  // namespace whirl::results
