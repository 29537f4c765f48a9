// Entry points of the SUNDIALS plug-in. The caller owns what they return.
#pragma once
#include <core/plugin.hpp>
#include <time/first_order.hpp>

WHIRL_PLUGIN_EXPORT whirl::time::Integrator* whirl_sundials_make_ida(
    whirl::time::Problem& problem, const whirl::time::Options& options);
WHIRL_PLUGIN_EXPORT whirl::time::ExplicitIntegrator* whirl_sundials_make_erk(
    whirl::time::FirstOrderProblem& problem, const whirl::time::Options& options, int order);
