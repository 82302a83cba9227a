// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/step_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::out::datasets {
namespace {

constexpr double kNanosPerSecond = 1e9;

}  // namespace

Nanos step_time(Nanos start, double fps, std::uint64_t step) {
  return start + Nanos(std::llround(static_cast<double>(step) * kNanosPerSecond / fps));
}

StepPlan::StepPlan(std::size_t arrays, std::size_t window, double fps) : seen_(arrays), window_(window), fps_(fps) {}

StepPlan::StepPlan(std::size_t arrays, std::vector<Nanos> times) : seen_(arrays), given_(std::move(times)) {}

void StepPlan::see(std::size_t array, Nanos time) {
  Seen& seen = seen_[array];
  if (seen.frames > 0 && time < seen.newest) return;
  if (fps_ > 0.0 && !start_ && seen.frames == window_) {
    start_ = seen.newest + std::min(time - seen.newest, step_time({}, fps_, 1)) / 2;
  }
  ++seen.frames;
  seen.newest = time;
  newest_ = std::max(newest_.value_or(time), time);
}

/// Frames to come are at this time or later, unless an array comes back.
std::optional<Nanos> StepPlan::settled_until() const {
  if (!newest_) return std::nullopt;
  Nanos until = *newest_;
  const Nanos patience_ends = *newest_ - kPatience;
  for (const Seen& seen : seen_) until = std::min(until, seen.frames > 0 ? seen.newest : patience_ends);
  return std::max(until, patience_ends);
}

std::optional<Nanos> StepPlan::next() const {
  if (start_) return step_time(*start_, fps_, taken_);
  if (taken_ < given_.size()) return given_[taken_];
  return std::nullopt;
}

std::vector<Nanos> StepPlan::take_given(bool is_over) {
  std::vector<Nanos> due;
  const std::optional<Nanos> until = settled_until();
  while (taken_ < given_.size() && (is_over || (until && given_[taken_] < *until))) due.push_back(given_[taken_++]);
  return due;
}

std::vector<Nanos> StepPlan::take_due(bool is_over) {
  if (fps_ <= 0.0) return take_given(is_over);
  std::vector<Nanos> due;
  if (!newest_) return due;
  if (is_over && !start_) start_ = newest_;
  if (!start_) return due;
  const Nanos until = is_over ? *newest_ : *settled_until();
  for (Nanos time = step_time(*start_, fps_, taken_); time < until; time = step_time(*start_, fps_, taken_)) {
    due.push_back(time);
    ++taken_;
  }
  if (is_over) due.push_back(step_time(*start_, fps_, taken_++));  // the one behind the newest frame
  return due;
}

}  // namespace dermis::out::datasets
