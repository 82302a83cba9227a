// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/array_recognition.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

namespace dermis::serve {
namespace {

using recognition::Answer;
using recognition::Classes;
using recognition::Layout;
using recognition::StreamRecogniser;

constexpr double kPosesHz = 30.0;
constexpr double kMostHz = 1000.0;
constexpr Nanos kTellPeriod = std::chrono::milliseconds(100);

/// 0: every frame is looked at, as the rate of the examples is not known.
double rate_for(const Classes& classes) {
  return classes.moving ? std::min(classes.layout.rate_hz, kMostHz) : kPosesHz;
}

Layout layout_of(const std::string& name, const ArrayDescription& array, double rate_hz) {
  Layout layout;
  layout.arrays = {recognition::sensed_array(array, name)};
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
    : recogniser_(std::move(recogniser)), resampler_(rate_hz, taxels) {}

std::optional<Answer> ArrayRecognition::next(const ForceFrame& force) {
  if (has(force.status, FrameStatus::rejected)) return std::nullopt;
  if (resampler_.leaps_to(force)) {
    // What was going on then is not answered for.
    static_cast<void>(recogniser_.finish());
    told_.reset();
  }
  std::optional<Answer> answer;
  resampler_.take(force, [&](std::span<const float> newtons) {
    if (const auto recognition = recogniser_.next(newtons)) answer = recognition->answer;
  });
  if (!answer || !is_news(*answer, force.time)) return std::nullopt;
  return answer;
}

bool ArrayRecognition::is_news(const Answer& answer, Nanos time) {
  if (classes().moving) return true;
  const bool is_same = told_ && told_->likeliest == answer.likeliest && told_->verdict == answer.verdict;
  if (is_same && time - told_->time < kTellPeriod) return false;
  told_ = Told{answer.likeliest, answer.verdict, time};
  return true;
}

}  // namespace dermis::serve
