// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/episode_options.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>

#include "dermis/bytes/files/text.hpp"

namespace dermis::out::datasets {
namespace {

constexpr std::array kQuantities = {"forces", "sigma",    "valid",       "raw",   "age",
                                    "fresh",  "contacts", "temperature", "supply"};

bool is_rising(const std::vector<Nanos>& times) {
  return std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
}

/// "age, fresh, ... or valid"
Status check_quantities(const std::vector<std::string>& quantities) {
  for (const std::string& name : quantities) {
    if (std::find(kQuantities.begin(), kQuantities.end(), name) == kQuantities.end()) {
      return bad_field("columns",
                       fmt::format("{} is none of {}", bytes::files::in_quotes(name), fmt::join(kQuantities, ", ")));
    }
  }
  return Done{};
}

}  // namespace

bool are_split(const std::vector<std::vector<Nanos>>& times, std::size_t recordings) {
  return recordings == 1 && times.size() > 1;
}

std::vector<std::pair<std::string, std::string>> described(const EpisodeOptions& options, bool are_recorded) {
  const std::string none = are_recorded ? "by the models in the recordings" : "none: without a model";
  std::vector<std::pair<std::string, std::string>> how = {
      {"forces", options.model.empty() ? none : "by " + options.model}};
  if (are_recorded || !options.model.empty()) {
    const bool is_tared = options.tare || options.tare_force;
    const std::string zero = is_tared ? "the first second of each recording" : "that of the calibration";
    how.emplace_back("zero", zero + (options.follow_drift ? "; drift is followed" : ""));
  }
  how.emplace_back("steps", options.times.empty() ? fmt::format("{} a second", options.fps) : "at given times");
  if (options.cut) how.emplace_back("episodes", "cut by the labels of the recordings");
  how.emplace_back("window", fmt::format("{} frame{}", options.window, options.window == 1 ? "" : "s"));
  return how;
}

std::vector<Nanos> joined(const std::vector<std::vector<Nanos>>& times) {
  std::vector<Nanos> all;
  for (const std::vector<Nanos>& some : times) all.insert(all.end(), some.begin(), some.end());
  return all;
}

Status check_times(const std::vector<std::vector<Nanos>>& times, std::size_t recordings) {
  if (times.empty()) return Done{};
  const bool is_split = are_split(times, recordings);
  if (!is_split && times.size() != recordings) {
    return bad_field("times", fmt::format("are of {} recordings in place of {}", times.size(), recordings));
  }
  if (std::ranges::any_of(times, [](const auto& some) { return some.empty(); })) {
    return bad_field("times", "leave an episode without steps");
  }
  const bool rise = is_split ? is_rising(joined(times)) : std::ranges::all_of(times, is_rising);
  return rise ? Status(Done{}) : bad_field("times", "must rise, also from one episode of a recording to the next");
}

Status EpisodeOptions::validate() const {
  constexpr double kSlowest = 0.001;
  constexpr double kFastest = 10'000.0;
  constexpr std::size_t kLongest = 1000;
  if (!(fps >= kSlowest && fps <= kFastest)) return bad_field("fps", "must be 0.001 to 10000 steps a second");
  if (window < 1 || window > kLongest) return bad_field("window", "must be 1 to 1000 frames");
  if (cut && !times.empty()) return bad_field("cut", "takes the steps of a clock: give no times of steps");
  return check_quantities(quantities);
}

}  // namespace dermis::out::datasets
