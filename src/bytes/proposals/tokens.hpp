// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "bytes/proposals/lines.hpp"

namespace dermis::bytes::proposals {

/// Numbers, times of day, dates, and the text between them.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view line, const Numerals& numerals);

/// Whether the token is the number of a word, as of "R3: 12 14".
[[nodiscard]] bool is_part_of_word(const std::vector<Token>& tokens, std::size_t number);

/// Bytes of the escape sequences of a terminal that the text begins with.
[[nodiscard]] std::size_t escape_sequences_at(std::string_view text);

}  // namespace dermis::bytes::proposals
