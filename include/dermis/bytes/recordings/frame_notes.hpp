// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>

namespace dermis::bytes::recordings {

/// A larger model is not kept in a recording, but its hash.
inline constexpr std::size_t kMostModelBytes = std::size_t{8} << 20U;

/// Notes of a file on all of its frames; what is not known is empty.
struct FrameNotes {
  std::string name{};        ///< Of the array.
  std::string array_toml{};  ///< The array's description, as array.toml.
  std::string model_hash{};  ///< content_hash() of the model that the array was used with.
  std::string simulation{};  ///< The simulation that the frames are from, as "sim:multitouch".
  std::string model_file{};  ///< The bytes of that model's file, of at most kMostModelBytes.

  bool operator==(const FrameNotes&) const = default;
};

}  // namespace dermis::bytes::recordings
