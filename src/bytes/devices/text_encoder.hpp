// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string_view>

#include "bytes/devices/row_syntax.hpp"
#include "dermis/bytes/devices/encoder.hpp"
#include "dermis/bytes/devices/protocol.hpp"

namespace dermis::bytes::devices {

/// The text around the readings of a frame, and the most that one can be.
struct TextForm {
  std::string_view frame_begin{};
  std::string_view row_begin{};
  std::string_view between{};  ///< Two readings of a row.
  std::string_view row_end{};
  std::string_view between_rows{};
  std::string_view frame_end{};
  std::uint32_t most = kMaxTextReading;
};

/// Sends frames as whole numbers in text.
[[nodiscard]] std::unique_ptr<Encoder> make_text_encoder(const TextForm& form, const ProtocolOptions& options);

}  // namespace dermis::bytes::devices
