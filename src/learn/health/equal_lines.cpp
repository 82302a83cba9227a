// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/equal_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestLines = 4;     // two pairs, and others between them
constexpr std::size_t kFewestPresses = 20;  // readings
constexpr float kEqual = 0.1F;              // of the change by the press
constexpr std::size_t kPairsNamed = 3;

}  // namespace

void EqualLines::Pairs::add(const Agreement& both) noexcept {
  if (both.presses == 0) return;
  const std::size_t differ = both.presses - both.equal;
  const bool is_different = 10 * differ > 3 * both.presses;
  ++pressed;
  equal += 20 * both.equal >= 19 * both.presses ? 1 : 0;
  different += is_different ? 1 : 0;
  const bool falls = is_different && 10 * both.stronger >= differ;
  const bool rises = is_different && 10 * (differ - both.stronger) >= differ;
  falling += falls ? 1 : 0;
  rising += rises ? 1 : 0;
  both_ways += falls && rises ? 1 : 0;
  presses += both.presses;
}

bool EqualLines::Pairs::are_equal() const noexcept {
  return pressed >= 2 && equal == pressed && presses >= kFewestPresses;
}

/// A gradient, which goes one way, is no difference.
bool EqualLines::Pairs::are_different() const noexcept {
  return 3 * different >= pressed && falling > 0 && rising > 0;
}

EqualLines::EqualLines(const ArrayDescription& array, Axis axis) : array_(&array), axis_(axis) {
  const std::size_t lines = line_count(array, axis);
  if (lines < kFewestLines) return;
  agreements_.resize(static_cast<std::size_t>(std::bit_width(lines - 1)));
  for (std::size_t bit = 0; bit < agreements_.size(); ++bit) agreements_[bit].resize(lines - (std::size_t{1} << bit));
}

void EqualLines::add(std::span<const float> counts, std::span<const float> change, float strong) {
  for (std::size_t bit = 0; bit < agreements_.size(); ++bit) {
    for (std::size_t line = 0; line < agreements_[bit].size(); ++line) {
      compare(line, line + (std::size_t{1} << bit), counts, change, strong, agreements_[bit][line]);
    }
  }
}

void EqualLines::compare(std::size_t line, std::size_t other, std::span<const float> counts,
                         std::span<const float> change, float strong, Agreement& agreement) const {
  for (std::size_t place = 0; place < line_length(*array_, axis_); ++place) {
    const std::size_t a = taxel_on_line(*array_, axis_, line, place);
    const std::size_t b = taxel_on_line(*array_, axis_, other, place);
    const float press = std::max(change[a], change[b]);
    if (press < strong) continue;
    ++agreement.presses;
    const bool is_equal = std::abs(counts[a] - counts[b]) <= kEqual * press;
    agreement.equal += is_equal ? 1 : 0;
    agreement.stronger += !is_equal && change[a] > change[b] ? 1 : 0;
  }
}

/// Adds those whose first line has this bit set, or not set.
void EqualLines::add_pairs(std::size_t bit, bool is_set, Pairs& pairs) const {
  for (std::size_t line = 0; line < agreements_[bit].size(); ++line) {
    if (((line >> bit) % 2 != 0) == is_set) pairs.add(agreements_[bit][line]);
  }
}

EqualLines::Pairs EqualLines::neighbours() const {
  Pairs pairs;
  if (agreements_.empty()) return pairs;
  add_pairs(0, false, pairs);
  add_pairs(0, true, pairs);
  return pairs;
}

/// Other lines that are as far from each other, or neighbours, must not be equal.
bool EqualLines::does_not_switch(std::size_t bit) const {
  Pairs same_address;
  Pairs others;
  add_pairs(bit, false, same_address);
  add_pairs(bit, true, others);
  return same_address.are_equal() && (others.are_different() || neighbours().are_different());
}

/// "0 and 4, 1 and 5, 2 and 6, ..."
std::string EqualLines::name_pairs(std::size_t bit) const {
  std::string names;
  std::size_t named = 0;
  for (std::size_t line = 0; line < agreements_[bit].size(); ++line) {
    if ((line >> bit) % 2 != 0) continue;
    if (named > 0) names += ", ";
    if (named++ == kPairsNamed) return names + "...";
    names += fmt::format("{} and {}", line, line + (std::size_t{1} << bit));
  }
  return names;
}

std::vector<std::string> EqualLines::findings(const EqualLines& crossing) const {
  const char* const name = to_string(axis_);
  const Pairs across = crossing.neighbours();
  if (neighbours().are_equal() && across.are_different() && across.both_ways >= 2) {
    return {fmt::format(
        "all {}s read the same: their multiplexer does not switch; check its supply, its enable pin and its address "
        "lines",
        name)};
  }
  std::vector<std::string> found;
  for (std::size_t bit = 0; bit < agreements_.size(); ++bit) {
    if (!does_not_switch(bit)) continue;
    found.push_back(fmt::format(
        "{}s {} read the same: address line {} of the {} multiplexer (S{}) does not switch; check its wire and pin",
        name, name_pairs(bit), bit, name, bit));
  }
  return found;
}

}  // namespace dermis::learn::health
