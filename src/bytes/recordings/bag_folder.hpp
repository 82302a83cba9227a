// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

namespace dermis::bytes::recordings {

/// A folder of rosbag2.
struct BagFolder {
  std::string file;       ///< Its recording; empty: it cannot be read, and
  std::string objection;  ///< why, with the mend.
};

/// Empty where `path` is no folder with files of rosbag2.
[[nodiscard]] std::optional<BagFolder> bag_folder(const std::string& path);

}  // namespace dermis::bytes::recordings
