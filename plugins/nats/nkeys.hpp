// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"

/// Keys of users as NATS writes them: base32 of one or two bytes of kind, 32 bytes of key and their checksum.
namespace dermis::live::fleet {

using KeyBytes = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;

/// "SU...", the secret of a user.
[[nodiscard]] std::string seed_text(const KeyBytes& seed);
/// "U...", the name of the user of a seed. Fails on a text that is no seed of a user, and does not show it.
[[nodiscard]] Result<std::string> user_of_seed(const std::string& seed);
/// The signature of a text (Ed25519, RFC 8032) by the user of a seed.
[[nodiscard]] Result<Signature> sign(const std::string& seed, std::string_view text);

}  // namespace dermis::live::fleet
