// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>

#include "dermis/paper/ranks.hpp"

/// The plugin of Open MPI. It is loaded where mpirun has started the process, and by nobody else.
namespace dermis::paper {

/// The function of the plugin, and its name.
using OpenMpiRanks = void (*)(std::unique_ptr<Ranks>& opened);
inline constexpr const char* kOpenMpiRanks = "dermis_open_mpi_ranks";

}  // namespace dermis::paper
