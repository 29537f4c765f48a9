#include <sweep/ranks.hpp>
#include <core/error.hpp>
#include <core/plugin.hpp>

#include <algorithm>
#include <cstdlib>

namespace whirl::sweep {

std::int64_t started_together() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* text = std::getenv(name)) return std::max(1L, std::atol(text));
  return 1;
}

std::unique_ptr<Ranks> join_ranks() {
  if (started_together() <= 1) return nullptr;
  if (!Plugin::available("mpi"))
    throw Error(
        Exit::usage,
        Diagnostic{Diagnostic::Severity::error, "E99",
                   "started by mpirun, but the component 'mpi' was not built",
                   "build with MPI (package libopenmpi-dev), or let every rank take a fixed "
                   "share: --shard auto",
                   Where{}});
  return std::unique_ptr<Ranks>(Plugin::load("mpi").function<MakeRanks>(make_mpi_ranks)());
}

}  // namespace whirl::sweep
