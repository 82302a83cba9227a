// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/live_recognition.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

namespace dermis::out::serve {
namespace {

using learn::recognition::Answer;
using learn::recognition::Classes;
using learn::recognition::Layout;
using learn::recognition::StreamRecogniser;

constexpr double kPosesHz = 30.0;
constexpr double kMostHz = 1000.0;
constexpr Nanos kRepeatPeriod = std::chrono::milliseconds(100);

/// 0: every frame is looked at, as the rate of the examples is not known.
double rate_for(const Classes& classes) {
  return classes.moving ? std::min(classes.layout.rate_hz, kMostHz) : kPosesHz;
}

/// The layout of newtons of these arrays, side by side.
Layout layout_of(std::vector<learn::recognition::SensedArray> arrays, std::size_t further, const Classes& classes) {
  Layout layout;
  for (learn::recognition::SensedArray& array : arrays) {
    array.first_column = layout.readings;
    layout.readings += array.taxel_count();
  }
  layout.arrays = std::move(arrays);
  layout.extras = further;
  layout.rate_hz = rate_for(classes);
  layout.quantity = Quantity::force;
  return layout;
}

}  // namespace

Result<LiveRecognition> LiveRecognition::create(Classes classes, std::vector<learn::recognition::SensedArray> arrays,
                                                std::size_t further) {
  const Layout layout = layout_of(std::move(arrays), further, classes);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(std::move(classes), layout);
  if (!recogniser) return recogniser.error();
  return LiveRecognition(*std::move(recogniser), layout.rate_hz, layout.readings);
}

LiveRecognition::LiveRecognition(StreamRecogniser recogniser, double rate_hz, std::size_t taxels)
    : recogniser_(std::move(recogniser)), resampler_(rate_hz, taxels) {}

std::optional<Answer> LiveRecognition::next(const ForceFrame& force, std::span<const float> further) {
  if (has(force.status, FrameStatus::rejected)) return std::nullopt;
  if (resampler_.leaps_to(force)) {
    // A touch that was going on then gets no answer.
    static_cast<void>(recogniser_.finish());
    published_.reset();
  }
  std::optional<Answer> answer;
  resampler_.take(force, [&](std::span<const float> newtons) {
    if (const auto recognition = recogniser_.next(newtons, further)) answer = recognition->answer;
  });
  if (!answer || !is_news(*answer, force.time)) return std::nullopt;
  return answer;
}

bool LiveRecognition::is_news(const Answer& answer, Nanos time) {
  if (classes().moving) return true;
  const bool is_same = published_ && published_->likeliest == answer.likeliest && published_->verdict == answer.verdict;
  if (is_same && time - published_->time < kRepeatPeriod) return false;
  published_ = Published{answer.likeliest, answer.verdict, time};
  return true;
}

}  // namespace dermis::out::serve
