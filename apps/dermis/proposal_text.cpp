// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "proposal_text.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

namespace dermis::app {
namespace {

constexpr std::size_t kMostRows = 24;
constexpr std::size_t kMostNumbers = 16;  // in a row
constexpr std::size_t kMostSigns = 48;
constexpr std::string_view kSigns = " .:-=+*#%@";

/// The numbers of a row, then its readings as signs between those of the least and the greatest of the frame.
std::string row_text(const bytes::proposals::Proposal& proposal, std::size_t row, float least, float most) {
  const std::size_t cols = proposal.shape.cols;
  const float* const readings = proposal.example.data() + row * cols;
  std::string numbers;
  for (std::size_t col = 0; col < std::min(cols, kMostNumbers); ++col)
    numbers += fmt::format(" {:>6.5g}", readings[col]);
  if (cols > kMostNumbers) numbers += " ...";
  std::string signs;
  for (std::size_t col = 0; col < std::min(cols, kMostSigns); ++col) {
    const float share = most > least ? (readings[col] - least) / (most - least) : 0.0F;
    signs +=
        std::isfinite(share) ? kSigns[static_cast<std::size_t>(share * static_cast<float>(kSigns.size() - 1))] : '?';
  }
  return fmt::format("  {}   |{}|\n", numbers, signs);
}

std::string example_text(const bytes::proposals::Proposal& proposal) {
  float least = INFINITY;
  float most = -INFINITY;
  for (const float reading : proposal.example) {
    if (!std::isfinite(reading)) continue;
    least = std::min(least, reading);
    most = std::max(most, reading);
  }
  std::string text;
  for (std::size_t row = 0; row < std::min(proposal.shape.rows, kMostRows); ++row)
    text += row_text(proposal, row, least, most);
  if (proposal.shape.rows > kMostRows) text += "   ...\n";
  return text;
}

}  // namespace

std::string proposal_text(const bytes::proposals::Proposal& proposal, std::size_t place) {
  std::string text = fmt::format("{}. {}\n   {} frames, {:.1f} % of the bytes left over\n", place, proposal.summary,
                                 proposal.frames, 100.0 * proposal.left_share);
  for (const std::string& reason : proposal.reasons) text += "   + " + reason + "\n";
  for (const std::string& doubt : proposal.doubts) text += "   ? " + doubt + "\n";
  for (const std::string& left : proposal.left_over) text += "   - " + left + "\n";
  if (!proposal.open.empty()) text += fmt::format("   ? {}: not in the bytes\n", fmt::join(proposal.open, ", "));
  text += "\n";
  std::istringstream toml(proposal.toml);
  for (std::string line; std::getline(toml, line);) text += line.empty() ? "\n" : "   " + line + "\n";
  return text + "\n" + example_text(proposal);
}

}  // namespace dermis::app
