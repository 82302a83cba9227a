// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_readings.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::bytes::proposals {
namespace {

/// Mean difference of lines that lie so many apart.
double difference_at(const Readings& lines, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t k = lag; k < lines.size(); ++k) {
    for (std::size_t i = 0; i < std::min(lines[k].size(), lines[k - lag].size()); ++i) {
      const double difference = std::abs(static_cast<double>(lines[k][i]) - static_cast<double>(lines[k - lag][i]));
      sum += std::isfinite(difference) ? difference : 0.0;
    }
  }
  return lines.size() > lag ? sum / static_cast<double>(lines.size() - lag) : 0.0;
}

}  // namespace

Readings readings_of_lines(const std::vector<Line>& lines, const std::vector<std::size_t>& members, const Span& span,
                           std::size_t most) {
  Readings readings;
  for (const std::size_t member : members) {
    if (readings.size() == most) break;
    std::vector<float>& frame = readings.emplace_back();
    std::size_t column = 0;
    for (const Token& token : lines[member].tokens) {
      if (token.kind == Token::Kind::text) continue;
      if (span.has(column)) frame.push_back(static_cast<float>(token.value));
      ++column;
    }
  }
  return readings;
}

Readings readings_of_taxels(const std::vector<Line>& lines, const std::vector<std::size_t>& members, const Span& span,
                            std::size_t taxels, std::size_t most) {
  Readings frames;
  for (const std::vector<float>& part : readings_of_lines(lines, members, span, most * taxels / span.size())) {
    if (frames.empty() || frames.back().size() >= taxels) frames.emplace_back();
    frames.back().insert(frames.back().end(), part.begin(), part.end());
  }
  return frames;
}

double gain_of_rows(const Readings& lines, std::size_t rows) {
  const double side_by_side = difference_at(lines, 1);
  const double apart = difference_at(lines, rows);
  const double most = std::max(side_by_side, apart);
  return most > 0.0 ? 0.5 * (side_by_side - apart) / most : 0.0;
}

}  // namespace dermis::bytes::proposals
