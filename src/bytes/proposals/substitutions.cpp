// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/substitutions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <numeric>
#include <optional>

#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kFewest = 3;  // escapes, packets
constexpr std::size_t kSmallest = 6;
constexpr std::uint8_t kMostCodes = 4;
constexpr std::size_t kMostDelimiters = 8;
constexpr std::size_t kPieces = 64;  // of which the sizes are compared

/// Bytes that are always followed by a small code.
Bytes escapes_in(std::span<const std::uint8_t> bytes) {
  std::array<std::size_t, 256> count{};
  std::array<std::size_t, 256> others{};
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    ++count[bytes[i]];
    others[bytes[i]] += bytes[i + 1] >= kMostCodes ? 1 : 0;
  }
  Bytes escapes;
  for (std::size_t byte = kMostCodes; byte < count.size(); ++byte) {
    if (count[byte] >= kFewest && others[byte] == 0) escapes.push_back(static_cast<std::uint8_t>(byte));
  }
  return escapes;
}

/// Bytes that stand nearly, but not always, as far apart.
Bytes delimiters_in(std::span<const std::uint8_t> bytes) {
  std::array<std::vector<std::size_t>, 256> gaps;
  std::array<std::size_t, 256> last{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (last[bytes[i]] > 0) gaps[bytes[i]].push_back(i + 1 - last[bytes[i]]);
    last[bytes[i]] = i + 1;
  }
  Bytes delimiters;
  for (std::size_t byte = 0; byte < gaps.size() && delimiters.size() < kMostDelimiters; ++byte) {
    std::vector<std::size_t>& all = gaps[byte];
    if (all.size() < kFewest) continue;
    std::ranges::sort(all);
    const std::size_t least = all[all.size() / 20];
    const std::size_t most = all[all.size() - 1 - all.size() / 20];
    if (least >= kSmallest && all.front() < all.back() && 2 * most <= 3 * least + 8)
      delimiters.push_back(static_cast<std::uint8_t>(byte));
  }
  return delimiters;
}

/// Without the escapes, the first pieces are as large as each other.
bool explains_sizes(std::span<const std::uint8_t> bytes, std::uint8_t delimiter, std::uint8_t escape) {
  std::map<std::size_t, std::size_t> sizes;
  std::size_t pieces = 0;
  for (auto from = std::ranges::find(bytes, delimiter); from != bytes.end() && pieces < kPieces; ++pieces) {
    const auto to = std::find(from + 1, bytes.end(), delimiter);
    if (to == bytes.end()) break;
    ++sizes[static_cast<std::size_t>(to - from - std::count(from, to, escape))];
    from = to;
  }
  return std::ranges::any_of(sizes, [&](const auto& size) { return 10 * size.second >= 8 * pieces; });
}

/// Between two delimiters; a code keeps its place, and `codes` has it there, of other bytes kMostCodes.
struct Piece {
  Bytes plain{};
  Bytes codes{};
};

std::vector<Piece> pieces_between(std::span<const std::uint8_t> bytes, std::uint8_t delimiter, std::uint8_t escape) {
  std::vector<Piece> pieces(1);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == delimiter) {
      pieces.emplace_back();
      continue;
    }
    const bool is_code = bytes[i] == escape && i + 1 < bytes.size();
    pieces.back().plain.push_back(bytes[i]);
    pieces.back().codes.push_back(is_code ? bytes[++i] : kMostCodes);
  }
  pieces.pop_back();
  if (!pieces.empty()) pieces.erase(pieces.begin());
  std::map<std::size_t, std::size_t> sizes;
  for (const Piece& piece : pieces) ++sizes[piece.plain.size()];
  const auto usual = std::ranges::max_element(sizes, {}, [](const auto& size) { return size.second; });
  const bool are_equal = usual != sizes.end() && usual->second >= kFewest && usual->first >= kSmallest &&
                         10 * usual->second >= 9 * pieces.size();
  if (!are_equal) return {};
  std::erase_if(pieces, [&](const Piece& piece) { return piece.plain.size() != usual->first; });
  return pieces;
}

/// How much a byte in the place of the code differs from its neighbours in time.
long difference_of(const std::vector<Piece>& pieces, std::uint8_t code, std::uint8_t byte) {
  long sum = 0;
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    for (std::size_t i = 0; i < pieces[k].codes.size(); ++i) {
      const bool is_other = pieces[k].codes[i] != code || pieces[k - 1].codes[i] != kMostCodes;
      if (!is_other) sum += std::abs(long{byte} - long{pieces[k - 1].plain[i]});
    }
  }
  return sum;
}

/// The bytes that never stand unescaped inside of a packet: escape, a mark at its beginning, delimiter.
Bytes special_bytes(const std::vector<Piece>& pieces, std::uint8_t delimiter, std::uint8_t escape) {
  Bytes special = {escape, delimiter};
  const std::uint8_t mark = pieces.front().plain.front();
  const bool is_mark = std::ranges::all_of(pieces, [&](const Piece& piece) {
    return piece.plain.front() == mark && std::ranges::count(piece.plain, mark) == 1;
  });
  if (is_mark) special.insert(special.begin() + 1, mark);
  return special;
}

/// The bytes of the codes in their order: as in `special`, unless another order fits much better.
Bytes bytes_of_codes(const std::vector<Piece>& pieces, const Bytes& codes, const Bytes& special) {
  const auto difference = [&](const std::vector<std::size_t>& order) {
    long sum = 0;
    for (std::size_t k = 0; k < codes.size(); ++k) sum += difference_of(pieces, codes[k], special[order[k]]);
    return sum;
  };
  std::vector<std::size_t> order(special.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::size_t> best = order;
  long least = 2 * difference(order) / 3;
  while (std::ranges::next_permutation(order).found) {
    const long sum = difference(order);
    if (sum < least) least = sum, best = order;
  }
  Bytes bytes;
  for (std::size_t k = 0; k < codes.size(); ++k) bytes.push_back(special[best[k]]);
  return bytes;
}

std::optional<std::string> escape_of(const std::vector<Piece>& pieces, std::uint8_t delimiter, std::uint8_t escape) {
  const Bytes special = special_bytes(pieces, delimiter, escape);
  Bytes codes;
  for (std::uint8_t code = 0; code < kMostCodes; ++code) {
    const auto has_code = [&](const Piece& piece) { return std::ranges::count(piece.codes, code) > 0; };
    if (std::ranges::any_of(pieces, has_code)) codes.push_back(code);
  }
  if (codes.size() < 2 || codes.size() > special.size()) return std::nullopt;
  const std::array marks = {delimiter, escape};
  std::string text = layouts::hexadecimal(marks);
  const Bytes bytes = bytes_of_codes(pieces, codes, special);
  for (std::size_t k = 0; k < codes.size(); ++k) {
    text += " " + layouts::hexadecimal(std::span(codes).subspan(k, 1)) + "=" +
            layouts::hexadecimal(std::span(bytes).subspan(k, 1));
  }
  return text;
}

}  // namespace

std::vector<std::string> substitutions_in(std::span<const std::uint8_t> bytes) {
  const Bytes escapes = escapes_in(bytes);
  std::vector<std::string> found;
  for (const std::uint8_t delimiter : escapes.empty() ? Bytes() : delimiters_in(bytes)) {
    for (const std::uint8_t escape : escapes) {
      if (delimiter == escape || !explains_sizes(bytes, delimiter, escape)) continue;
      const std::vector<Piece> pieces = pieces_between(bytes, delimiter, escape);
      if (pieces.empty()) continue;
      if (std::optional<std::string> text = escape_of(pieces, delimiter, escape)) found.push_back(*std::move(text));
    }
  }
  return found;
}

}  // namespace dermis::bytes::proposals
