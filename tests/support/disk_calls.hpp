// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

namespace dermis::support {

/// What this process has asked of the disk since it was asked last: "bytes" (fsync or fdatasync of a file), "names"
/// (fsync of a folder) and "rename", in their order.
std::vector<std::string> take_disk_calls();

}  // namespace dermis::support
