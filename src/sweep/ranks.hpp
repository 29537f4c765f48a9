// Processes of one sweep on one or several machines, started together by mpirun or srun: rank 0
// hands out chunks of runs as the others get free and keeps the rows; the others run them.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace whirl::sweep {

class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int count() const = 0;
  /// What rank 0 says, on all of them; each must call it.
  virtual bool agree(bool yes) = 0;
  /// On rank 0: gives every run to some rank, in their order, and calls `take` with the rows that
  /// come back. Gives out no more once the program is to be interrupted (core/interrupt.hpp); what
  /// runs then is waited for.
  virtual void hand_out(std::span<const std::int64_t> runs,
                        const std::function<void(const std::string& rows)>& take) = 0;
  /// On the other ranks: calls `chunk` with runs until there are no more; it returns their rows.
  virtual void work(const std::function<std::string(std::span<const std::int64_t>)>& chunk) = 0;
};

/// Entry point of the plug-in `mpi`.
using MakeRanks = Ranks*();
inline constexpr const char* make_mpi_ranks = "whirl_make_mpi_ranks";

/// How many mpirun has started of this program, by the environment it sets; 1: it was not.
std::int64_t started_together();
/// Null where this process was started alone.
/// @throws Error (E99, Exit::usage) when the plug-in was not built.
std::unique_ptr<Ranks> join_ranks();

}  // namespace whirl::sweep
