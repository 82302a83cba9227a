// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/recordings/hdf5_tables.hpp"

namespace dermis::bytes::recordings {

[[nodiscard]] Result<std::unique_ptr<Hdf5Tables>> create_tables(const std::string& path);

}  // namespace dermis::bytes::recordings
