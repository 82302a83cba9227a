// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_groups.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <utility>

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostGroups = 3;
constexpr std::size_t kMostNames = 16;

std::size_t numbers_in(const Line& line) {
  return static_cast<std::size_t>(std::count_if(line.tokens.begin(), line.tokens.end(),
                                                [](const Token& token) { return token.kind == Token::Kind::number; }));
}

/// The texts of a skeleton; the counts of numbers between them are left out.
std::vector<std::string_view> texts_of(std::string_view skeleton) {
  std::vector<std::string_view> texts;
  for (std::size_t at = 0;;) {
    const std::size_t run = skeleton.find('\x01', at);
    texts.push_back(skeleton.substr(at, run - at));
    if (run == std::string_view::npos) return texts;
    at = skeleton.find('\x02', run) + 1;
  }
}

bool is_part_of_word(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

/// The words that differ in two texts, where nothing else does.
std::optional<std::pair<std::string, std::string>> different_words(std::string_view a, std::string_view b) {
  std::size_t begin = 0;
  while (begin < std::min(a.size(), b.size()) && a[begin] == b[begin]) ++begin;
  while (begin > 0 && is_part_of_word(a[begin - 1])) --begin;
  std::size_t end = 0;
  while (end < std::min(a.size(), b.size()) - begin && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  while (end > 0 && is_part_of_word(a[a.size() - end])) --end;
  const std::string_view one = a.substr(begin, a.size() - begin - end);
  const std::string_view other = b.substr(begin, b.size() - begin - end);
  const auto is_word = [](std::string_view word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), is_part_of_word);
  };
  if (!is_word(one) || !is_word(other)) return std::nullopt;
  return std::pair(std::string(one), std::string(other));
}

/// The words by which two groups of lines differ.
std::optional<std::pair<std::string, std::string>> names_in(const Line& a, const Line& b) {
  const std::vector<std::string_view> ours = texts_of(a.skeleton);
  const std::vector<std::string_view> theirs = texts_of(b.skeleton);
  if (ours.size() != theirs.size()) return std::nullopt;
  std::optional<std::pair<std::string, std::string>> names;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    if (ours[k] == theirs[k]) continue;
    if (names) return std::nullopt;
    names = different_words(ours[k], theirs[k]);
    if (!names) return std::nullopt;
  }
  return names;
}

/// Joins to the first group those whose lines differ in a name alone.
void join_named(const std::vector<Line>& lines, std::vector<LineGroup>& groups) {
  LineGroup& first = groups.front();
  const Line& ours = lines[first.members.front()];
  std::size_t most = first.members.size();
  std::vector<std::size_t> joined;
  for (std::size_t k = 1; k < std::min(groups.size(), kMostNames); ++k) {
    const Line& theirs = lines[groups[k].members.front()];
    const auto names = names_in(ours, theirs);
    const bool comes_as_often = 2 * groups[k].members.size() >= most && groups[k].members.size() <= 2 * most;
    if (!names || !comes_as_often || (!first.names.empty() && first.names.front() != names->first)) continue;
    if (first.names.empty()) {
      first.names.push_back(names->first);
      first.numbers.push_back(numbers_in(ours));
      first.word_at = ours.text.find(names->first);
    }
    first.names.push_back(names->second);
    first.numbers.push_back(numbers_in(theirs));
    joined.push_back(k);
  }
  for (const std::size_t k : joined) {
    first.members.insert(first.members.end(), groups[k].members.begin(), groups[k].members.end());
  }
  std::sort(first.members.begin(), first.members.end());
}

}  // namespace

std::vector<LineGroup> groups_of(const std::vector<Line>& lines) {
  std::map<std::string_view, std::pair<std::size_t, LineGroup>> found;  // numbers in it, its lines
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t numbers = numbers_in(lines[k]);
    if (numbers == 0) continue;
    auto& [size, group] = found[lines[k].skeleton];
    size += numbers;
    group.members.push_back(k);
  }
  std::vector<std::pair<std::size_t, LineGroup>> sorted;
  for (auto& [skeleton, group] : found) {
    if (group.second.members.size() >= 2) sorted.push_back(std::move(group));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<LineGroup> groups;
  for (auto& [size, group] : sorted) groups.push_back(std::move(group));
  if (!groups.empty()) join_named(lines, groups);
  groups.resize(std::min(groups.size(), kMostGroups));
  return groups;
}

}  // namespace dermis::bytes::proposals
