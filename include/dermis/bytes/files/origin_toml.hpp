// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The origin of the frames beside origin.toml (docs/file-formats.md).
struct FramesOrigin {
  std::string source;  ///< "sim:multitouch?seed=2"
  std::string hash;    ///< content_hash() of the file of frames; origin.toml holds for no other frames.
};

[[nodiscard]] std::string to_toml(const FramesOrigin& origin);

/// From memory; `name` stands for the path in messages. Both keys are required, others are errors.
[[nodiscard]] Result<FramesOrigin> origin_from_toml(std::string_view text, const std::string& name);

/// Writes origin.toml into the folder of the frames.
[[nodiscard]] Status write_origin(const std::string& frames_path, const std::string& source);

/// The source of the frames, if an origin.toml beside them names it for these very bytes; else empty.
[[nodiscard]] std::string simulated_source(const std::string& frames_path);

}  // namespace dermis::bytes::files
