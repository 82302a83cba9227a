// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/mcap.hpp"

namespace dermis::bytes::recordings {

/// An array in a file that dermis has not written.
struct BagArray {
  std::uint16_t channel = 0;
  std::string part;   ///< As BagReading::part.
  std::string topic;  ///< "/touch", with its part "/touch.thumb_matrix".
};

/// The arrays by the first message of each topic, of the first 4096 of the file. Images beside sensors of touch are of
/// cameras, and none of them. Empty for a recording of dermis. Goes back to the beginning.
[[nodiscard]] std::vector<BagArray> find_bag_arrays(McapReader& mcap);

/// "the first message of '/touch' cannot be read: ..." of the first topic that should be an array and is none; empty:
/// all are.
[[nodiscard]] std::string why_no_array(McapReader& mcap);

}  // namespace dermis::bytes::recordings
