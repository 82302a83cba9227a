// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_end.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

namespace dermis::bytes::proposals {
namespace {

/// How often `pattern` ends what the single byte `end` ends, 0 to 1.
double share_of(std::string_view text, std::string_view pattern) {
  std::size_t all = 0;
  std::size_t with = 0;
  for (std::size_t at = text.find(pattern.back()); at != std::string_view::npos;
       at = text.find(pattern.back(), at + 1)) {
    ++all;
    if (at + 1 >= pattern.size() && text.substr(at + 1 - pattern.size(), pattern.size()) == pattern) ++with;
  }
  return all > 0 ? static_cast<double>(with) / static_cast<double>(all) : 0.0;
}

std::size_t numbers_in(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    if (is_digit && (i == 0 || std::isdigit(static_cast<unsigned char>(text[i - 1])) == 0)) ++count;
  }
  return count;
}

/// The sign that stands after every so many numbers, where no control character ends lines.
std::string sign_that_ends_lines(std::string_view text) {
  constexpr std::string_view kSigns = ">;#|$!*@&/~";
  std::string best;
  double best_evenness = 0.8;
  for (const char sign : kSigns) {
    std::array<std::size_t, 256> counts{};
    std::size_t lines = 0;
    std::size_t from = text.find(sign);
    for (std::size_t end = text.find(sign, from + 1); from != std::string_view::npos && end != std::string_view::npos;
         from = end, end = text.find(sign, end + 1)) {
      ++counts[std::min(numbers_in(text.substr(from, end - from)), counts.size() - 1)];
      ++lines;
    }
    const auto* const most = std::max_element(counts.begin() + 2, counts.end());
    const double evenness = lines >= 3 ? static_cast<double>(*most) / static_cast<double>(lines) : 0.0;
    if (evenness > best_evenness) {
      best_evenness = evenness;
      best = sign;
    }
  }
  return best;
}

}  // namespace

std::string line_end_of(std::string_view text) {
  const auto lines = std::count(text.begin(), text.end(), '\n');
  const auto returns = std::count(text.begin(), text.end(), '\r');
  const auto nuls = std::count(text.begin(), text.end(), '\0');
  constexpr double kNearlyAll = 0.9;
  if (lines > 0 && returns > 0 && text.find("\n\r") + 1 == text.find('\r') && share_of(text, "\n\r") > kNearlyAll)
    return "\n\r";
  if (lines >= 2) return {};
  const std::string nul_return{'\0', '\r'};
  if (returns >= 2) return share_of(text, nul_return) > kNearlyAll ? nul_return : "\r";
  if (nuls >= 2) return std::string(1, '\0');
  if (lines > 0) return {};
  return sign_that_ends_lines(text);
}

}  // namespace dermis::bytes::proposals
