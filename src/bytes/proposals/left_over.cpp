// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/left_over.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostSentences = 4;
constexpr std::size_t kLongestWord = 24;

/// The first word of a line, or what it looks like.
std::string look_of(const Line& line) {
  const std::size_t begin = line.text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return "is empty";
  std::string_view word = line.text.substr(begin);
  const std::size_t end = word.find_first_of(" \t:=,;0123456789", 1);
  word = word.substr(0, std::min(end, kLongestWord));
  std::string text(word);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return "begins with '" + text + "'";
}

/// How far each place is from the one before, where this is always the same; 0 otherwise.
std::size_t distance_of(const std::vector<std::size_t>& places) {
  if (places.size() < 3) return 0;
  const std::size_t distance = places[1] - places[0];
  for (std::size_t k = 2; k < places.size(); ++k) {
    if (places[k] - places[k - 1] != distance) return 0;
  }
  return distance;
}

}  // namespace

std::vector<std::string> left_over_lines(const std::vector<Line>& lines, const std::vector<std::size_t>& members) {
  std::vector<std::string> sentences;
  const std::size_t head = members.front();
  if (head > 0)
    sentences.push_back(head == 1 ? "the first line is none of readings"
                                  : "the first " + std::to_string(head) + " lines are none of readings");
  std::map<std::string, std::vector<std::size_t>> others;
  auto member = members.begin();
  for (std::size_t k = head; k < lines.size(); ++k) {
    const bool is_member = member != members.end() && *member == k;
    if (is_member) ++member;
    if (!is_member) others[look_of(lines[k])].push_back(k);
  }
  std::vector<std::pair<std::string, std::vector<std::size_t>>> sorted(others.begin(), others.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  for (const auto& [look, places] : sorted) {
    if (sentences.size() == kMostSentences) break;
    const std::size_t distance = distance_of(places);
    const bool is_last = places.size() == 1 && places.front() + 1 == lines.size();
    if (distance > 1) {
      sentences.push_back("every " + ordinal(distance) + " line " + look);
    } else if (is_last) {
      sentences.emplace_back("the last line is cut or none of readings");
    } else {
      sentences.push_back(std::to_string(places.size()) + " of " + std::to_string(lines.size()) + " lines: each " +
                          look);
    }
  }
  return sentences;
}

std::string ordinal(std::size_t number) {
  constexpr std::array kWords = {"",      "",        "second", "third", "fourth", "fifth",
                                 "sixth", "seventh", "eighth", "ninth", "tenth"};
  if (number >= 2 && number < kWords.size()) return kWords[number];
  constexpr std::array kEndings = {"th", "st", "nd", "rd"};
  const std::size_t last = number % 10;
  const bool is_regular = last >= kEndings.size() || number / 10 % 10 == 1;
  return std::to_string(number) + kEndings[is_regular ? 0 : last];
}

}  // namespace dermis::bytes::proposals
