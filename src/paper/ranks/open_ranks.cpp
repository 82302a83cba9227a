// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "paper/ranks/mpi_plugin.hpp"
#include "paper/ranks/one_process.hpp"

namespace dermis::paper {
namespace {

constexpr const char* kPlugin = "libdermis_mpi.so";

/// By Open MPI's mpirun, or by a scheduler that speaks PMIx.
bool is_started_by_mpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
}

Error failed_to_load() {
  const char* const why = dlerror();
  return bad_input(std::string("mpirun needs ") + kPlugin +
                   " of a build with DERMIS_BUILD_MPI, and Open MPI (Debian: " + "libopenmpi3): " +
                   (why != nullptr ? why : "cannot be loaded"));
}

}  // namespace

Result<std::unique_ptr<Ranks>> open_ranks() {
  if (!is_started_by_mpirun()) return std::unique_ptr<Ranks>(std::make_unique<OneProcess>());
  // Never closed: threads of Open MPI live as long as the process.
  void* const plugin = dlopen(kPlugin, RTLD_NOW | RTLD_LOCAL);
  if (plugin == nullptr) return failed_to_load();
  const auto open = reinterpret_cast<OpenMpiRanks>(dlsym(plugin, kOpenMpiRanks));
  if (open == nullptr) return failed_to_load();
  std::unique_ptr<Ranks> opened;
  open(opened);
  return opened;
}

}  // namespace dermis::paper
