// A sweep as it was asked for, and its folder: plan.json, and one folder of rows for each shard.
#pragma once
#include <sweep/design.hpp>
#include <sweep/rows.hpp>
#include <sweep/sweep.hpp>
#include <model/model.hpp>
#include <run/run_lock.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace whirl::sweep {

/// Which runs a process does: those whose number leaves `index` when divided by `count`.
struct Shard {
  std::int64_t index = 0, count = 1;
  std::string folder() const;
};
/// "2/7" -> index 1 of 7; empty: the only one; "auto": the element of a Slurm array, or the rank of
/// Slurm's srun or of Open MPI's or MPICH's mpirun that this process is.
/// @throws Error (E99, Exit::usage)
Shard read_shard(const std::string& text);

/// How probable it is that a response lies beyond a value, in the unit of the response.
struct Limit {
  std::size_t response = 0;
  bool above = true;
  double value = 0;
};

/// The runs that are made again with everything they can show.
struct Worst {
  std::size_t response = 0;
  bool least = false;
  std::size_t count = 10;
};

struct Plan {
  Design design;
  std::vector<Response> responses;
  std::vector<Limit> limits;
  std::vector<Worst> worst;
  Shard shard;
  std::filesystem::path root;
  std::string text;  ///< of plan.json: the same for the same sweep
};
/// @throws Error (E99, Exit::usage)
Plan make_plan(const SweepOptions& options, const model::Model& model);

/// Makes the folder ready and holds it. Rows of an earlier sweep go, unless they are of this plan and
/// it is resumed or one of several shards; nothing goes that a sweep has not written, and nothing of a
/// sweep that is still running.
/// @throws Error (E99, Exit::usage) when the folder holds another plan that others may still be at;
/// (E97, Exit::io) when another process is at this shard, or at one that would go.
std::unique_ptr<run::RunLock> prepare_folder(const Plan& plan, bool resume);

/// Numbers of the worst runs in the order of their badness, each once; ties by their number.
std::vector<std::int64_t> worst_runs(const Plan& plan, const std::map<std::int64_t, Row>& rows);
/// Below the sweep's folder.
std::string worst_folder(std::int64_t run);
/// Takes the worst runs of an earlier sweep away.
void remove_worst_runs(const Plan& plan);

/// The rows of all shards.
std::map<std::int64_t, Row> all_rows(const Plan& plan);

}  // namespace whirl::sweep
