// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis::bytes::recordings {

/// Notes of a file on all of its frames; what is not known is empty.
struct FrameNotes {
  std::string name{};        ///< Of the array.
  std::string array_toml{};  ///< The array's description, as array.toml.
  std::string model_hash{};  ///< content_hash() of the model that the array was used with.
  std::string simulation{};  ///< The simulation that the frames are from, as "sim:multitouch".

  bool operator==(const FrameNotes&) const = default;
};

}  // namespace dermis::bytes::recordings
