// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/array_recognition.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <utility>

namespace dermis::serve {
namespace {

using recognition::Answer;
using recognition::Classes;
using recognition::Layout;
using recognition::StreamRecogniser;

constexpr double kPosesHz = 30.0;
constexpr double kMostHz = 1000.0;
constexpr double kMillimetresPerMetre = 1000.0;
constexpr Nanos kTellPeriod = std::chrono::milliseconds(100);
constexpr Nanos kLongestGap = std::chrono::milliseconds(500);  // longer ones are not bridged

/// 0: every frame is looked at, as the rate of the examples is not known.
double rate_for(const Classes& classes) {
  return classes.moving ? std::min(classes.layout.rate_hz, kMostHz) : kPosesHz;
}

Layout layout_of(const std::string& name, const ArrayDescription& array, double rate_hz) {
  Layout layout;
  layout.arrays = {{name, array.rows, array.cols, 0, kMillimetresPerMetre * array.row_pitch_m,
                    kMillimetresPerMetre * array.col_pitch_m}};
  layout.readings = array.taxel_count();
  layout.rate_hz = rate_hz;
  return layout;
}

}  // namespace

Result<ArrayRecognition> ArrayRecognition::create(Classes classes, const std::string& name,
                                                  const ArrayDescription& array) {
  const double rate_hz = rate_for(classes);
  Layout layout = layout_of(name, array, rate_hz);
  layout.least_reading = classes.layout.least_reading;
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(std::move(classes), layout);
  if (!recogniser) return recogniser.error();
  return ArrayRecognition(*std::move(recogniser), rate_hz, array.taxel_count());
}

ArrayRecognition::ArrayRecognition(StreamRecogniser recogniser, double rate_hz, std::size_t taxels)
    : recogniser_(std::move(recogniser)),
      period_(rate_hz > 0.0 ? static_cast<std::int64_t>(1e9 / rate_hz) : 0),
      last_newtons_(taxels),
      between_(taxels) {}

std::optional<Answer> ArrayRecognition::next(const ForceFrame& force) {
  if (has(force.status, FrameStatus::rejected)) return std::nullopt;
  assert(force.newtons.size() == last_newtons_.size());
  if (!last_ || force.time < *last_ || force.time - *last_ > kLongestGap) begin_anew(force);
  std::optional<Answer> answer;
  if (period_ == Nanos{}) answer = follow(force.newtons);
  while (period_ > Nanos{} && due_ <= force.time) {
    const auto span = static_cast<double>((force.time - *last_).count());
    interpolate(force, span > 0.0 ? static_cast<double>((due_ - *last_).count()) / span : 1.0);
    if (const std::optional<Answer> found = follow(between_)) answer = found;
    due_ += period_;
  }
  last_ = force.time;
  std::copy(force.newtons.begin(), force.newtons.end(), last_newtons_.begin());
  if (!answer || !is_news(*answer, force.time)) return std::nullopt;
  return answer;
}

/// A recording was sought, or the device was away: what was going on then is not answered for.
void ArrayRecognition::begin_anew(const ForceFrame& force) {
  static_cast<void>(recogniser_.finish());
  last_ = due_ = force.time;
  told_.reset();
}

std::optional<Answer> ArrayRecognition::follow(std::span<const float> newtons) {
  const std::optional<recognition::Recognition> recognition = recogniser_.next(newtons);
  if (!recognition) return std::nullopt;
  return recognition->answer;
}

void ArrayRecognition::interpolate(const ForceFrame& force, double share) {
  const auto weight = static_cast<float>(share);
  for (std::size_t k = 0; k < between_.size(); ++k) {
    between_[k] = last_newtons_[k] + weight * (force.newtons[k] - last_newtons_[k]);
  }
}

bool ArrayRecognition::is_news(const Answer& answer, Nanos time) {
  if (classes().moving) return true;
  const bool is_same = told_ && told_->likeliest == answer.likeliest && told_->verdict == answer.verdict;
  if (is_same && time - told_->time < kTellPeriod) return false;
  told_ = Told{answer.likeliest, answer.verdict, time};
  return true;
}

}  // namespace dermis::serve
