// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/press_guide.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace dermis::learn::arrangement {
namespace {

constexpr std::chrono::seconds kRest{1};
constexpr std::size_t kFewest = 15;  // frames of the rest,
constexpr std::size_t kMost = 200;   // however fast they come

}  // namespace

void PressGuide::learn(std::span<const float> counts, Nanos time) {
  if (rest_.empty()) first_ = time;
  if (rest_.size() < kMost) rest_.emplace_back(counts.begin(), counts.end());
  if (rest_.size() < kFewest || time - first_ < kRest) return;
  finder_.emplace(rest_of(rest_));
  rest_.clear();
}

bool PressGuide::add(std::span<const float> counts, Nanos time) {
  for (const float count : counts)
    if (std::isfinite(count)) most_counts_ = std::max(most_counts_, static_cast<double>(count));
  if (!finder_) {
    learn(counts, time);
    return false;
  }
  const std::optional<Press> press = finder_->add(counts, time);
  if (press && !is_done()) take(*press);
  return press.has_value();
}

void PressGuide::take(const Press& press) {
  const auto same = std::find_if(answers_.begin(), answers_.end(), [&](const std::optional<Press>& answer) {
    return answer && answer->channel == press.channel;
  });
  if (same != answers_.end() && repeated_channel_ != press.channel) {
    repeated_ = static_cast<std::size_t>(same - answers_.begin());
    repeated_channel_ = press.channel;
    return;
  }
  answers_[place_] = press;
  skip();
}

void PressGuide::skip() {
  if (!is_done()) ++place_;
  repeated_.reset();
  repeated_channel_.reset();
}

void PressGuide::back() {
  if (place_ > 0) --place_;
  answers_[place_].reset();
  repeated_.reset();
  repeated_channel_.reset();
}

}  // namespace dermis::learn::arrangement
