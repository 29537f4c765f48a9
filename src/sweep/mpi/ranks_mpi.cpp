// Ranks by MPI. The only file that sees the library (C API, MPI 3).
// The C interface alone.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <core/interrupt.hpp>
#include <core/plugin.hpp>
#include <sweep/ranks.hpp>
#include <mpi.h>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

namespace whirl::sweep {
namespace {

constexpr int rows_tag = 1;            // to rank 0: rows of a chunk; empty: ready for the first one
constexpr int chunk_tag = 2;           // from rank 0: numbers of runs; none: there are no more
constexpr std::size_t most_runs = 64;  // a chunk

/// MPI's own waiting takes a whole processor.
MPI_Status wait_for(int source, int tag) {
  MPI_Status status;
  for (int found = 0, rounds = 0;; ++rounds) {
    MPI_Iprobe(source, tag, MPI_COMM_WORLD, &found, &status);
    if (found) return status;
    std::this_thread::sleep_for(std::chrono::microseconds(std::min(20 + rounds, 500)));
  }
}

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    // Runs are in processes of their own, forked from this one; they do not touch the library.
    ::setenv("OMPI_MCA_mpi_warn_on_fork", "0", 0);
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }
  ~MpiRanks() override { MPI_Finalize(); }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int count() const override { return count_; }

  bool agree(bool yes) override {
    int word = yes ? 1 : 0;
    MPI_Bcast(&word, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return word != 0;
  }

  void hand_out(std::span<const std::int64_t> runs,
                const std::function<void(const std::string&)>& take) override {
    int working = count_ - 1;
    std::string rows;
    while (working > 0) {
      const MPI_Status status = wait_for(MPI_ANY_SOURCE, rows_tag);
      int bytes = 0;
      MPI_Get_count(&status, MPI_CHAR, &bytes);
      rows.resize(static_cast<std::size_t>(bytes));
      MPI_Recv(rows.data(), bytes, MPI_CHAR, status.MPI_SOURCE, rows_tag, MPI_COMM_WORLD,
               MPI_STATUS_IGNORE);
      if (!rows.empty()) take(rows);
      const std::size_t share = runs.size() / (8 * static_cast<std::size_t>(count_ - 1));
      std::size_t size = std::min(std::clamp<std::size_t>(share, 1, most_runs), runs.size());
      if (interrupt::flag) size = 0;
      MPI_Send(runs.data(), static_cast<int>(size), MPI_INT64_T, status.MPI_SOURCE, chunk_tag,
               MPI_COMM_WORLD);
      runs = runs.subspan(size);
      if (size == 0) --working;
    }
  }

  void work(const std::function<std::string(std::span<const std::int64_t>)>& chunk) override {
    std::string rows;
    std::vector<std::int64_t> runs;
    while (true) {
      MPI_Send(rows.data(), static_cast<int>(rows.size()), MPI_CHAR, 0, rows_tag, MPI_COMM_WORLD);
      const MPI_Status status = wait_for(0, chunk_tag);
      int size = 0;
      MPI_Get_count(&status, MPI_INT64_T, &size);
      runs.resize(static_cast<std::size_t>(size));
      MPI_Recv(runs.data(), size, MPI_INT64_T, 0, chunk_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      if (runs.empty()) return;
      rows = chunk(runs);
    }
  }

 private:
  int rank_ = 0, count_ = 1;
};

}  // namespace
}  // namespace whirl::sweep

WHIRL_DEFINE_PLUGIN

WHIRL_PLUGIN_EXPORT whirl::sweep::Ranks* whirl_make_mpi_ranks() {
  return new whirl::sweep::MpiRanks();
}
