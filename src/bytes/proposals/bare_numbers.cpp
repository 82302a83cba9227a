// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/bare_numbers.hpp"

#include <algorithm>
#include <map>

#include "bytes/proposals/period.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kFewestMarks = 3;
constexpr std::size_t kFewestNumbers = 3;  // of a frame
constexpr std::size_t kMostNumbers = 8192;

double number_of(const Line& line) {
  const auto number = std::ranges::find(line.tokens, Token::Kind::number, &Token::kind);
  return number == line.tokens.end() ? 0.0 : number->value;
}

/// The distance of most places from the one before; 0 where it differs.
std::size_t even_distance(const std::vector<std::size_t>& places) {
  std::map<std::size_t, std::size_t> counts;
  for (std::size_t k = 1; k < places.size(); ++k) ++counts[places[k] - places[k - 1]];
  const auto most = std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
  return 10 * most->second >= 9 * (places.size() - 1) ? most->first : 0;
}

}  // namespace

std::optional<NumberMark> number_that_marks(const std::vector<Line>& lines, const std::vector<std::size_t>& members) {
  std::map<std::string_view, std::vector<std::size_t>> places;
  for (std::size_t k = 0; k < members.size(); ++k) places[lines[members[k]].text].push_back(k);
  std::optional<NumberMark> best;
  for (const auto& [text, at] : places) {
    if (at.size() < kFewestMarks) continue;
    const std::size_t distance = even_distance(at);
    const bool is_everywhere = 10 * distance * at.size() >= 9 * members.size();
    if (distance <= kFewestNumbers || !is_everywhere || (best && best->numbers + 1 <= distance)) continue;
    best = {std::string(text), distance - 1};
  }
  return best;
}

std::size_t period_of_numbers(const std::vector<Line>& lines, const std::vector<std::size_t>& members) {
  std::vector<float> numbers;
  for (const std::size_t member : members) {
    if (numbers.size() == kMostNumbers) break;
    numbers.push_back(static_cast<float>(number_of(lines[member])));
  }
  return period_of(numbers, kFewestNumbers + 1);
}

}  // namespace dermis::bytes::proposals
