// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "describing/frame_marks.hpp"

#include <algorithm>
#include <map>

#include "describing/tokens.hpp"

namespace dermis::describing {
namespace {

constexpr std::size_t kLongest = 24;
constexpr double kMost = 0.8;
constexpr double kShareOfOther = 0.6;  // of the lines of readings begin alike at most, if it marks a frame

/// What a line begins with, up to its first number.
std::string beginning_of(const Line& line) {
  const bool has_text = !line.tokens.empty() && line.tokens.front().kind == Token::Kind::text;
  std::string_view text = has_text ? line.tokens.front().text : std::string_view();
  const std::size_t escapes = escape_sequences_at(text);
  if (escapes > 0) text = text.substr(0, escapes);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return std::string(text.substr(0, kLongest));
}

/// Lines of readings from one mark to the next.
struct Gaps {
  std::size_t last = 0;  ///< Lines of readings before the last mark.
  std::size_t marks = 0;
  std::map<std::size_t, std::size_t> sizes{};  ///< How often there are so many.

  void mark(std::size_t readings) {
    if (marks++ > 0 && readings > last) ++sizes[readings - last];
    last = readings;
  }
};

}  // namespace

std::optional<FrameMark> frame_mark_of(const std::vector<Line>& lines, const std::vector<std::size_t>& members) {
  std::map<std::string, Gaps> found;
  std::size_t readings = 0;
  auto member = members.begin();
  for (std::size_t k = members.front(); k < lines.size(); ++k) {
    const bool is_member = member != members.end() && *member == k;
    const std::string text = beginning_of(lines[k]);
    if (is_member ? !text.empty() : (lines[k].text.empty() || !text.empty())) found[text].mark(readings);
    if (!is_member) continue;
    ++readings;
    ++member;
  }
  std::optional<FrameMark> best;
  std::size_t most = 1;
  for (const auto& [text, gaps] : found) {
    std::size_t all = 0;
    auto usual = gaps.sizes.begin();
    for (auto size = gaps.sizes.begin(); size != gaps.sizes.end(); ++size) {
      all += size->second;
      if (size->second > usual->second) usual = size;
    }
    const bool is_even =
        all > 0 && usual->first >= 2 && static_cast<double>(usual->second) >= kMost * static_cast<double>(all);
    const bool is_rare = static_cast<double>(gaps.marks) <= kShareOfOther * static_cast<double>(members.size());
    if (!is_even || !is_rare || gaps.marks < most) continue;
    if (best && gaps.marks == most && best->text.size() > text.size() && !best->text.empty()) continue;
    best = FrameMark{text, usual->first};
    most = gaps.marks;
  }
  return best;
}

}  // namespace dermis::describing
