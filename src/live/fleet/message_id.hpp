// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>

namespace dermis::live::fleet {

/// The id of a message, as far as it is read: "s12.chest-400.20" of frames, "s12.chest-d3.2596996162" of a description
/// with its checksum, "s12.chest-c7" of contacts. Messages of others have none of these.
struct MessageId {
  std::uint64_t session = 0;  ///< The process that published it: NameLease::session(); 0: not known.
  std::uint64_t first = 0;    ///< The number of its first frame in that session, of those of the array.
  std::uint64_t frames = 0;   ///< 0: of no frames, or not known.
};

/// "s12.chest-"
[[nodiscard]] std::string begin_of_id(std::uint64_t session, const std::string& array);

/// Accepts any text.
[[nodiscard]] MessageId parse_message_id(const std::string& text);

}  // namespace dermis::live::fleet
