// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dermis/learn/arrangement/arrangement.hpp"
#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::arrangement {
namespace {

constexpr double kWeak = 0.25;  // of the usual press
constexpr std::size_t kMostListed = 40;

std::string at_time(const Press& press) {
  return fmt::format("{} at {:.1f} s", press.channel, std::chrono::duration<double>(press.begin).count());
}

bool is_weak(const Press& press, double usual) {
  return std::abs(press.change) < kWeak * usual;
}

/// Leaves those out for which `is_out(press, the one before it)` holds.
template <typename IsOut>
void leave_out(std::vector<Press>& presses, const IsOut& is_out, const std::string& why,
               std::vector<std::string>& remarks) {
  std::vector<Press> kept;
  for (const Press& press : presses) {
    const bool is_kept = !is_out(press, kept.empty() ? nullptr : &kept.back());
    if (is_kept) kept.push_back(press);
    if (!is_kept) remarks.push_back(why + " (channel " + at_time(press) + "): it is left out");
  }
  presses = std::move(kept);
}

double usual_change(const std::vector<Press>& presses) {
  std::vector<double> changes;
  for (const Press& press : presses) changes.push_back(std::abs(press.change));
  return changes.empty() ? 0.0 : upper_median(changes);
}

/// Says what was found.
Error miscounted(const std::vector<Press>& presses, std::size_t places) {
  std::string list;
  for (std::size_t k = 0; k < std::min(presses.size(), kMostListed); ++k)
    list += (k > 0 ? ", " : "; channels that answered: ") + at_time(presses[k]);
  const char* const mend = presses.size() < places
                               ? "a place was passed over or did not answer, and nothing tells which: press all places "
                                 "again, a second apart, or take those that do not answer out of the list"
                               : "a place was pressed twice, and nothing tells which: press each place once";
  return bad_input(fmt::format("{} presses were found for {} places: {}{}", presses.size(), places, mend, list));
}

}  // namespace

Result<RecordedAnswers> answers_of(std::vector<Press> presses, std::size_t places) {
  RecordedAnswers found;
  if (presses.size() > places) {
    const double usual = usual_change(presses);
    const auto is_out = [usual](const Press& press, const Press*) { return is_weak(press, usual); };
    leave_out(presses, is_out, "a weak touch came between the presses", found.remarks);
  }
  if (presses.size() > places) {
    std::vector<Press> all = presses;
    const auto is_out = [](const Press& press, const Press* before) {
      return before != nullptr && before->channel == press.channel;
    };
    leave_out(presses, is_out, "a place was pressed twice", found.remarks);
    if (presses.size() != places) presses = std::move(all);
  }
  if (presses.size() != places) return miscounted(presses, places);
  found.answers.assign(presses.begin(), presses.end());
  return found;
}

}  // namespace dermis::learn::arrangement
