// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/frame_marks.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "bytes/proposals/tokens.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kLongest = 24;
constexpr std::size_t kMostMarks = 4;
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
  std::size_t last = 0;                        ///< Lines of readings before the last mark.
  std::vector<std::size_t> marks{};            ///< Places of the lines.
  std::map<std::size_t, std::size_t> sizes{};  ///< How often there are so many.
  bool is_of_readings = false;                 ///< Lines of readings begin so.

  void mark(std::size_t line, std::size_t readings) {
    if (!marks.empty() && readings > last) ++sizes[readings - last];
    marks.push_back(line);
    last = readings;
  }
};

/// How many lines of readings nearly all gaps have; 0 where they differ.
std::size_t usual_size(const Gaps& gaps) {
  std::size_t all = 0;
  auto usual = gaps.sizes.begin();
  for (auto size = gaps.sizes.begin(); size != gaps.sizes.end(); ++size) {
    all += size->second;
    if (size->second > usual->second) usual = size;
  }
  return all > 0 && static_cast<double>(usual->second) >= kMost * static_cast<double>(all) ? usual->first : 0;
}

}  // namespace

std::vector<FrameMark> frame_marks_of(const std::vector<Line>& lines, const std::vector<std::size_t>& members) {
  std::map<std::string, Gaps> found;
  std::size_t readings = 0;
  auto member = members.begin();
  for (std::size_t k = members.front(); k < lines.size(); ++k) {
    const bool is_member = member != members.end() && *member == k;
    const std::string text = beginning_of(lines[k]);
    if (!text.empty() || (!is_member && lines[k].text.empty())) {
      found[text].mark(k, readings);
      found[text].is_of_readings = is_member;
    }
    if (!is_member) continue;
    ++readings;
    ++member;
  }
  std::vector<FrameMark> marks;
  for (auto& [text, gaps] : found) {
    const std::size_t rows = usual_size(gaps);
    const bool is_rare = static_cast<double>(gaps.marks.size()) <= kShareOfOther * static_cast<double>(members.size());
    if (rows < 2 || !is_rare) continue;
    if (gaps.is_of_readings) gaps.marks.clear();
    marks.push_back({text, rows, std::move(gaps.marks)});
  }
  std::stable_sort(marks.begin(), marks.end(),
                   [](const FrameMark& a, const FrameMark& b) { return a.lines.size() > b.lines.size(); });
  marks.resize(std::min(marks.size(), kMostMarks));
  return marks;
}

}  // namespace dermis::bytes::proposals
