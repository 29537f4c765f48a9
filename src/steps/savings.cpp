#include <steps/savings.hpp>

#include <algorithm>

namespace whirl::steps {

namespace {

double evaluation(const system::System& s) {
  const system::State x = s.make_state();
  system::Workspace w = s.make_workspace();
  la::MCK m = s.make_matrices();
  VecX r(s.size());
  double best = infinity;
  for (int i = 0; i < 8; ++i) {  // the first ones fill the caches
    const double t0 = thread_cpu_seconds();
    s.residual(w, x.frames, 0.0, x.q, x.v, x.a, r);
    s.tangent(w, x.frames, 0.0, x.q, x.v, x.a, m);
    best = std::min(best, thread_cpu_seconds() - t0);
  }
  return best;
}

}  // namespace

Savings measure_savings(const run::Job& job) {
  model::Model general = job.model;
  general.keep_everything = true;
  try {
    const assembly::Built built = assembly::build_system(general, job.mesh, job.built_for);
    return {evaluation(job.system()), evaluation(built.system)};
  } catch (const Error&) {
    return {};  // only the measurement is lost
  }
}

}  // namespace whirl::steps
