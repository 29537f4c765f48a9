#include <steps/savings.hpp>

#include <algorithm>
#include <ctime>

namespace whirl::steps {

namespace {

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double evaluation(const system::System& s) {
  const system::State x = s.make_state();
  system::Workspace w = s.make_workspace();
  la::MCK m = s.make_matrices();
  VecX r(s.size());
  double best = infinity;
  for (int i = 0; i < 8; ++i) {  // the first ones fill the caches
    const double t0 = cpu_seconds();
    s.residual(w, x.frames, 0.0, x.q, x.v, x.a, r);
    s.tangent(w, x.frames, 0.0, x.q, x.v, x.a, m);
    best = std::min(best, cpu_seconds() - t0);
  }
  return best;
}

}  // namespace

Savings measure_savings(const run::Job& job) {
  model::Model general = job.model;
  general.keep_everything = true;
  try {
    const assembly::Built built = assembly::build_system(
        general, job.mesh, job.built_for.empty() ? "" : job.built_for.substr(1));
    return {evaluation(job.system()), evaluation(built.system)};
  } catch (const Error&) {
    return {};  // only the measurement is lost
  }
}

}  // namespace whirl::steps
