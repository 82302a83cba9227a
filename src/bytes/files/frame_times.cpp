// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/frame_times.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/quantile.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMostBlocks = 512;
constexpr std::size_t kMostNamed = 4;      // restarts
constexpr std::size_t kMostRestarts = 32;  // that are kept
constexpr std::size_t kFewestSteps = 16;
constexpr double kClearlyBack = 0.5;         // of a step: less is jitter
constexpr double kSurelySlow = 1.05;         // s: no tactile array is read so seldom,
constexpr double kSlowerThanAnything = 600;  // not even one that is logged for days
constexpr double kRound = 0.5;               // s: the steps of who logs slowly are multiples,
constexpr double kLate = 0.03;               // s, but for what a timer is late
constexpr double kScatter = 0.02;            // of a step
constexpr double kJump = 1.3;                // times as long steps
constexpr double kSteady = 1.12;             // between neighbouring blocks at most
constexpr std::size_t kSide = 2;             // blocks on each side of a jump

/// Whether the larger is no more than so many times the smaller.
bool are_within(double a, double b, double times) {
  return std::max(a, b) <= times * std::min(a, b);
}

}  // namespace

void FrameTimes::Block::add(double step_s) {
  shortest_s = steps == 0 ? step_s : std::min(shortest_s, step_s);
  ++steps;
  if (step_s > longest_s) std::swap(step_s, longest_s);
  if (step_s > second_s) std::swap(step_s, second_s);
  sum_s += step_s;
}

void FrameTimes::Block::append(const Block& next) {
  sum_s += next.sum_s;
  shortest_s = std::min(shortest_s, next.shortest_s);
  const std::size_t all = steps + next.steps;
  for (const double step : {next.longest_s, next.second_s}) add(step);
  steps = all;
}

double FrameTimes::Block::mean_s() const {
  return steps > 2 ? sum_s / static_cast<double>(steps - 2) : longest_s;
}

void FrameTimes::add(Nanos time) {
  if (last_) {
    const double from = seconds_of(*last_);
    const double step = seconds_of(time - *last_);
    if (step < 0.0 && step < -kClearlyBack * step_s().value_or(0.0)) {
      if (first_restarts_.size() < kMostRestarts) first_restarts_.push_back({frames_, from, seconds_of(time)});
      ++restarts_;
    } else {
      forward_ += time - *last_;
      add_step(std::max(step, 0.0), from);
    }
  }
  last_ = time;
  ++frames_;
}

void FrameTimes::add_step(double step_s, double from_s) {
  if (blocks_.empty() || blocks_.back().steps >= block_steps_) {
    if (blocks_.size() == kMostBlocks) halve();
    blocks_.push_back({.first_frame = frames_ - 1, .begin_s = from_s});
  }
  blocks_.back().add(step_s);
}

void FrameTimes::halve() {
  for (std::size_t k = 0; k < kMostBlocks / 2; ++k) {
    Block joined = blocks_[2 * k];
    joined.append(blocks_[2 * k + 1]);
    blocks_[k] = joined;
  }
  blocks_.resize(kMostBlocks / 2);
  block_steps_ *= 2;
}

std::vector<double> FrameTimes::block_means() const {
  std::vector<double> means;
  for (const Block& block : blocks_) {
    if (block.steps >= kFewestSteps) means.push_back(block.mean_s());
  }
  return means;
}

std::optional<double> FrameTimes::step_s() const {
  const std::vector<double> means = block_means();
  if (means.empty()) return std::nullopt;
  return upper_median(means);
}

double FrameTimes::seconds() const {
  return std::chrono::duration<double>(forward_).count() + static_cast<double>(restarts_) * step_s().value_or(0.0);
}

bool FrameTimes::has_odd_steps() const {
  const double step = step_s().value_or(0.0);
  std::vector<double> scatter;
  for (const Block& block : blocks_) scatter.push_back(block.second_s - block.shortest_s);
  if (scatter.empty()) return false;
  const double off = std::abs(step - std::round(step / kRound) * kRound);
  return upper_median(scatter) > std::max(kScatter * step, kLate) || off > kLate;
}

std::optional<std::string> FrameTimes::wrong_unit(bool is_smooth) const {
  const std::optional<double> step = step_s();
  if (!step || *step < kSurelySlow) return std::nullopt;
  const bool is_micro = *step > kSlowerThanAnything;
  if (!is_micro && !is_smooth && !has_odd_steps()) return std::nullopt;
  return fmt::format(
      "a frame comes every {:.4g} s by its time, {} frames in {:.3g} hours: the times look like {}, divide them by {}",
      *step, frames_, seconds() / 3600.0, is_micro ? "microseconds" : "milliseconds", is_micro ? "1e6" : "1000");
}

/// The first place where the blocks before and those behind are steady, and differ. The jump may lie within a block.
std::optional<std::string> FrameTimes::rate_jump() const {
  const std::vector<double> means = block_means();
  for (std::size_t k = kSide; k + kSide + 1 <= means.size(); ++k) {
    const double before = means[k - 1];
    const double after = means[k + 1];
    const bool is_steady_before = are_within(means[k - 2], before, kSteady);
    const bool is_steady_after = are_within(after, means[k + kSide], kSteady);
    if (!is_steady_before || !is_steady_after || before <= 0.0 || after <= 0.0) continue;
    if (are_within(before, after, kJump)) continue;
    return fmt::format(
        "the rate jumps from {:.3g} to {:.3g} frames a second near frame {} ({:.2f} s): the device was slowed, or two "
        "recordings were joined; cut there",
        1.0 / means[k - kSide], 1.0 / means[k + kSide], blocks_[k].first_frame, blocks_[k].begin_s);
  }
  return std::nullopt;
}

std::vector<std::string> FrameTimes::findings() const {
  std::vector<std::string> found;
  std::vector<Restart> named = first_restarts_;
  const double jitter = kClearlyBack * step_s().value_or(0.0);
  std::erase_if(named, [&](const Restart& restart) { return restart.before_s - restart.after_s <= jitter; });
  const std::size_t count = restarts_ - (first_restarts_.size() - named.size());
  named.resize(std::min(named.size(), kMostNamed));
  for (const Restart& restart : named) {
    found.push_back(
        fmt::format("the clock restarts at frame {}: from {:.3f} s back to {:.3f} s; the device or its logger was "
                    "switched off, or two recordings were joined",
                    restart.frame, restart.before_s, restart.after_s));
  }
  if (count > named.size()) {
    found.push_back(fmt::format("the clock restarts {} times in all", count));
  }
  if (auto jump = rate_jump()) found.push_back(*std::move(jump));
  return found;
}

}  // namespace dermis::bytes::files
