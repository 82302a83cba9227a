// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

/// The content of MCAP files of dermis besides the messages.
namespace dermis::bytes::recordings {

/// At the beginning: what is recorded, one for each array.
inline constexpr const char* kRecordingMetadata = "dermis";
/// At the end of a complete file: how much it was, one for each array; with its name where there are several.
inline constexpr const char* kTotalsMetadata = "dermis.totals";
/// Description of the array, and the file of its model; where there are several, each has its own: attachment_name().
inline constexpr const char* kArrayAttachment = "array.toml";
inline constexpr const char* kModelAttachment = "model.safetensors";

/// The name of an array as a part of a ROS 2 topic: letters, digits and '_', with a letter at the beginning.
[[nodiscard]] std::string topic_part(const std::string& name);

/// "chest/array.toml"; of the only array, whose name is left out, "array.toml".
[[nodiscard]] std::string attachment_name(const char* of, const std::string& array);

}  // namespace dermis::bytes::recordings
