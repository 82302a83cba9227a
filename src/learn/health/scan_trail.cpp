// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/scan_trail.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "dermis/touch/frames/neighbours.hpp"

namespace dermis::learn::health {
namespace {

constexpr double kLeastShare = 0.08;
constexpr double kMostShare = 0.6;
constexpr double kAlike = 2.0;            // of the quartiles of the lines' shares: the electronics are the same
constexpr std::size_t kFewestTrails = 3;  // with a trail
constexpr std::size_t kFewestTaxels = 4;  // of a line whose ends are far from each other

/// It reads more than each neighbour, by `times` at least.
bool stands_out(const ArrayDescription& array, std::span<const float> change, std::size_t taxel, float times) {
  for (const std::size_t near : Neighbours(array.rows, array.cols, taxel)) {
    if (near != taxel && times * change[near] > change[taxel]) return false;
  }
  return true;
}

}  // namespace

ScanTrail::ScanTrail(const ArrayDescription& array, Axis lines, bool backwards)
    : array_(&array), lines_(lines), backwards_(backwards), turns_(line_count(array, lines)) {}

void ScanTrail::add(std::span<const float> change, float strong) {
  const std::size_t end = line_length(*array_, lines_) - 1;
  if (end + 1 < kFewestTaxels) return;
  for (std::size_t line = 1; line < turns_.size(); ++line) {
    std::size_t last = taxel_on_line(*array_, lines_, line - 1, end);
    std::size_t next = taxel_on_line(*array_, lines_, line, 0);
    if (backwards_) std::swap(last, next);
    if (change[last] >= strong) add(last, next, change, turns_[line]);
  }
}

void ScanTrail::add(std::size_t last, std::size_t next, std::span<const float> change, Turn& turn) const {
  const auto share = static_cast<double>(change[next] / change[last]);
  const bool has_trail = share >= kLeastShare;
  if (has_trail && !stands_out(*array_, change, next, 2.0F)) return;  // something presses there
  ++turn.frames;
  if (!has_trail) return;
  turn.share = turn.with_trail++ == 0 ? share : std::min(turn.share, share);
}

std::optional<std::string> ScanTrail::finding() const {
  std::vector<double> shares;
  std::size_t frames = 0;
  std::size_t with_trail = 0;
  for (const Turn& turn : turns_) {
    frames += turn.frames;
    with_trail += turn.with_trail;
    if (turn.with_trail > 0) shares.push_back(turn.share);
  }
  if (shares.size() < kFewestTrails || 10 * with_trail < 9 * frames) return std::nullopt;
  std::sort(shares.begin(), shares.end());
  const double median = shares[shares.size() / 2];
  const double lower = shares[shares.size() / 4];
  const double upper = shares[3 * shares.size() / 4];
  if (upper > kAlike * lower || median > kMostShare) return std::nullopt;
  return fmt::format(
      "readings keep about {:.0f} % of the one scanned before them, along {}s{}: the ADC samples before its input has "
      "settled; wait longer after the multiplexer switches or read twice, or set adc_settling",
      100.0 * median, to_string(lines_), backwards_ ? " from the last to the first" : "");
}

}  // namespace dermis::learn::health
