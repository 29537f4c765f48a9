#include <time/sundials/context.hpp>
#include <time/sundials/entry.hpp>

WHIRL_DEFINE_PLUGIN

whirl::time::Integrator* whirl_sundials_make_ida(whirl::time::Problem& problem,
                                                 const whirl::time::Options& options) {
  return whirl::time::sundials::make_ida(problem, options).release();
}

whirl::time::ExplicitIntegrator* whirl_sundials_make_erk(whirl::time::FirstOrderProblem& problem,
                                                         const whirl::time::Options& options,
                                                         int order) {
  return whirl::time::sundials::make_erk(problem, options, order).release();
}
