// Precompiled for what works on a run: steps, their results, studies.
#include "system.hpp"
#include <run/job.hpp>
