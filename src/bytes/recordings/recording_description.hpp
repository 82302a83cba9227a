// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::recordings {

/// The description of an array in a recording; empty where there is none.
struct RecordingDescription {
  std::string name;
  std::string folder;  ///< "/chest/", of its topics
  std::optional<FrameShape> shape;
  std::string array_toml;
  std::string model_hash;
  std::string simulation;
  std::string model_file;
  std::string software;
};

/// The description of each array in the part that was read so far; at most 4096, each name once.
[[nodiscard]] std::vector<RecordingDescription> descriptions_of(const McapReader& mcap);

/// "/left/raw" -> "/left/"
[[nodiscard]] std::string_view topic_folder(std::string_view topic);

/// In quotes. The name may be anything that a file says.
[[nodiscard]] std::string printable(std::string name);

/// The value of a key, or an empty one.
[[nodiscard]] std::string value_of(const std::map<std::string, std::string>& values, const char* key);

}  // namespace dermis::bytes::recordings
