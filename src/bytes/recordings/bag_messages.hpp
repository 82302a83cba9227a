// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Messages of nodes of others that hold readings.
namespace dermis::bytes::recordings {

/// The readings of one array in a message.
struct BagReading {
  std::string part;  ///< "thumb_matrix"; empty: the message holds one array.
  FrameShape shape{};
  RawFrame frame{};
  bool has_times = false;  ///< The message is a frame of another dermis, with its times.
};

/// Images, arrays of numbers, hands and texts.
[[nodiscard]] bool may_be_readings(const McapChannel& channel);

/// Replaces `readings` by those of a message. Errors name the problem, but no place.
[[nodiscard]] Status read_readings(const McapChannel& channel, std::span<const std::uint8_t> message,
                                   std::vector<BagReading>& readings);

/// The matrices of numbers in a text of JSON, wherever they stand in it, or else the lists: "fingers[0].rows". Rows of
/// a matrix are as long; null is no reading.
[[nodiscard]] std::vector<BagReading> readings_of_json(std::string_view text);

}  // namespace dermis::bytes::recordings
