// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdlib>

#include "dermis/bytes/system/plugin.hpp"
#include "paper/ranks/mpi_plugin.hpp"
#include "paper/ranks/one_process.hpp"

namespace dermis::paper {
namespace {

bool is_started_by_mpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
}

}  // namespace

Result<std::unique_ptr<Ranks>> open_ranks() {
  if (!is_started_by_mpirun()) return std::unique_ptr<Ranks>(std::make_unique<OneProcess>());
  const Result<void*> function = find_plugin_function(
      {"mpirun", "libdermis_mpi.so", "of a build with DERMIS_BUILD_MPI, and Open MPI (Debian: libopenmpi3)"},
      kOpenMpiRanks);
  if (!function) return function.error();
  std::unique_ptr<Ranks> opened;
  reinterpret_cast<OpenMpiRanks>(*function)(opened);
  return opened;
}

}  // namespace dermis::paper
