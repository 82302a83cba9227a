// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// How long a device may take to send its first frame.
inline constexpr std::chrono::seconds kPatience{8};

/// The traffic of a source, as far as it shows the array.
struct FirstLook {
  bool has_frames = false;
  std::optional<FrameShape> shape{};  ///< Shape of the frames; without frames the likely one.
  std::string message{};              ///< Describes the bytes, or what they lack.
  std::vector<std::uint8_t> bytes{};  ///< The first of those of which no frame was made, at most 64 KiB.
};

/// Reads the first frame, for at most kPatience. Bytes that make no frame are described and are no error.
[[nodiscard]] Result<FirstLook> first_look(const live::sources::SourceName& name, live::sources::SourceOptions options);

}  // namespace dermis::out::serve
