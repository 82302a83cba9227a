// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::proposals {

/// Describes bytes of which no frame was made, as a sentence without its full stop. The first of the proposals does so;
/// where there is none, the bytes are told as a person would see them.
[[nodiscard]] std::string look_of(std::span<const std::uint8_t> bytes, const Known& known);

/// The same of proposals, which must not be empty.
[[nodiscard]] std::string look_of(const Proposal& proposal);

/// Whether the bytes are rather frames of another size than `shape`, or of several arrays.
[[nodiscard]] bool tell_otherwise(std::span<const std::uint8_t> bytes, const FrameShape& shape, const Known& known);

}  // namespace dermis::bytes::proposals
