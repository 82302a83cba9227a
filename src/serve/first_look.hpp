// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/sources/open_source.hpp"

namespace dermis::serve {

/// What a source sends, as far as that tells the array.
struct FirstLook {
  std::optional<FrameShape> shape{};
  std::string message{};  ///< What the bytes are, or what they lack.
};

/// Reads the first frame, for at most 8 s. Bytes of which no frame can be made are told, and no error.
[[nodiscard]] Result<FirstLook> first_look(const sources::SourceName& name, sources::SourceOptions options);

}  // namespace dermis::serve
