// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <mpi.h>

#include <algorithm>
#include <exception>

#include "paper/ranks/mpi_plugin.hpp"

/// The plugin that dermis::paper loads. Where MPI fails, it ends the job and says why.
namespace dermis::paper {
namespace {

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    int level = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;
  /// A rank that fails alone must not wait for the others, who wait for it: mpirun ends them when it has gone.
  ~MpiRanks() override {
    if (std::uncaught_exceptions() == 0) MPI_Finalize();
  }

  [[nodiscard]] std::size_t rank() const noexcept override { return static_cast<std::size_t>(rank_); }
  [[nodiscard]] std::size_t count() const noexcept override { return static_cast<std::size_t>(count_); }

  void broadcast(std::span<std::byte> bytes, std::size_t root) override {
    constexpr std::size_t kMostBytes = std::size_t{1} << 30U;  // MPI counts in int
    while (!bytes.empty()) {
      const std::size_t size = std::min(bytes.size(), kMostBytes);
      MPI_Bcast(bytes.data(), static_cast<int>(size), MPI_BYTE, static_cast<int>(root), MPI_COMM_WORLD);
      bytes = bytes.subspan(size);
    }
  }

 private:
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace
}  // namespace dermis::paper

extern "C" __attribute__((visibility("default"))) void dermis_open_mpi_ranks(
    std::unique_ptr<dermis::paper::Ranks>& opened) {
  opened = std::make_unique<dermis::paper::MpiRanks>();
}
