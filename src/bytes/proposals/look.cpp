// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/proposals/look.hpp"

#include <algorithm>
#include <string_view>

#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/line_end.hpp"
#include "bytes/proposals/lines.hpp"
#include "bytes/proposals/shapes.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostLetters = 40;  // of a line that is shown
constexpr double kAsGood = 0.1;           // difference of merits

/// How many numbers a line has; 0 where it holds anything else.
std::size_t numbers_in(const Line& line, const Numerals& numerals) {
  std::size_t numbers = 0;
  for (const Token& token : line.tokens) {
    const bool is_other =
        token.kind != Token::Kind::number && !(token.kind == Token::Kind::text && is_separator(token.text, numerals));
    if (is_other) return 0;
    numbers += token.kind == Token::Kind::number ? 1 : 0;
  }
  return numbers;
}

std::string look_of_text(std::string_view text) {
  std::vector<Line> lines = lines_of(text, line_end_of(text));
  if (lines.size() == 1) return "They are text, but no line of it ends";
  if (lines.back().size == lines.back().text.size()) lines.pop_back();  // neither the first nor the last need be whole
  if (lines.size() > 1) lines.erase(lines.begin());
  std::erase_if(lines, [](const Line& line) { return line.text.empty(); });
  Numerals numerals;
  tokenise(lines, numerals);
  std::vector<std::size_t> counts;
  const Line* other = nullptr;
  for (const Line& line : lines) {
    const std::size_t numbers = numbers_in(line, numerals);
    if (numbers > 0) counts.push_back(numbers);
    if (numbers == 0 && other == nullptr) other = &line;
  }
  if (other != nullptr && 2 * counts.size() < lines.size()) {
    return "They are text whose lines are not numbers alone, such as '" +
           printable(other->text.substr(0, kMostLetters)) + "'";
  }
  if (counts.empty()) return "They are text without numbers";
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
  if (*most == 1) return "Each line has one number: print a row or a frame in a line";
  if (*least == *most) return "Their lines have " + std::to_string(*most) + " numbers: check rows and cols";
  return "Their lines have " + std::to_string(*least) + " to " + std::to_string(*most) +
         " numbers: print as many in each";
}

}  // namespace

std::string look_of(const Proposal& proposal) {
  std::string text = "The bytes look like " + proposal.summary;
  const auto is_regular = [](const std::string& left) { return left.starts_with("every "); };
  const auto left = std::find_if(proposal.left_over.begin(), proposal.left_over.end(), is_regular);
  if (left != proposal.left_over.end()) text += "; " + *left;
  return text;
}

std::string look_of(std::span<const std::uint8_t> bytes, const Known& known) {
  if (bytes.empty()) return "There is not a single byte";
  const auto is_first = [&](std::uint8_t byte) { return byte == bytes.front(); };
  if (std::ranges::all_of(bytes, is_first)) return "Each of them is 0x" + layouts::hexadecimal(bytes.first(1));
  if (const std::vector<Proposal> proposals = propose(bytes, known); !proposals.empty())
    return look_of(proposals.front());
  if (!is_text(bytes)) return "They are not text, and no frame of a known protocol comes again in them";
  return look_of_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

bool tell_otherwise(std::span<const std::uint8_t> bytes, const FrameShape& shape, const Known& known) {
  const std::vector<Proposal> proposals = propose(bytes, known);
  return !proposals.empty() && std::ranges::none_of(proposals, [&](const Proposal& one) {
    const bool is_as_good = one.merit >= proposals.front().merit - kAsGood;
    return is_as_good && one.arrays == 1 && one.shape.taxel_count() == shape.taxel_count();
  });
}

}  // namespace dermis::bytes::proposals
