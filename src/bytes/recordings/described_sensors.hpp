// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/bytes/recordings/frame_notes.hpp"

namespace dermis::bytes::recordings {

/// How many sensors of temperature the described array has; 0 without a description.
[[nodiscard]] std::size_t described_sensors(const FrameNotes& notes);

}  // namespace dermis::bytes::recordings
