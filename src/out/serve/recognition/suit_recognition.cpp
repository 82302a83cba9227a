// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/suit_recognition.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recognition/recognition_publisher.hpp"

namespace dermis::out::serve {
namespace {

using learn::recognition::Classes;

constexpr std::size_t kMostRequestBytes = 65536;
constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

/// Where the arrays of the examples are in the suit.
Result<std::vector<std::size_t>> places_of(const Classes& classes, const std::vector<ServedArray>& arrays) {
  const std::vector<learn::recognition::SensedArray>& wanted = classes.layout.arrays;
  if (wanted.size() == 1 && arrays.size() == 1) return std::vector<std::size_t>{0};
  std::vector<std::size_t> places;
  for (const learn::recognition::SensedArray& array : wanted) {
    const auto found =
        std::find_if(arrays.begin(), arrays.end(), [&](const ServedArray& one) { return one.name == array.name; });
    if (found == arrays.end()) return bad_input(fmt::format("was learned with '{}', which is not served", array.name));
    places.push_back(static_cast<std::size_t>(found - arrays.begin()));
  }
  return places;
}

Result<LiveRecognition> recognition_at(const Classes& classes, const std::vector<ServedArray>& arrays,
                                       const std::vector<std::size_t>& places) {
  std::vector<learn::recognition::SensedArray> sensed;
  for (const std::size_t place : places) {
    sensed.push_back(learn::recognition::sensed_array(arrays[place].model->array, arrays[place].name));
  }
  return LiveRecognition::create(classes, std::move(sensed), classes.layout.extras);
}

FrameJoiner joiner_of(const std::vector<ServedArray>& arrays, const std::vector<std::size_t>& places) {
  std::vector<std::size_t> taxels;
  for (const std::size_t place : places) taxels.push_back(arrays[place].model->array.taxel_count());
  return FrameJoiner(taxels);
}

}  // namespace

Result<LiveRecognition> recognition_of_suit(const Classes& classes, const std::vector<ServedArray>& arrays) {
  const Result<std::vector<std::size_t>> places = places_of(classes, arrays);
  if (!places) return places.error();
  return recognition_at(classes, arrays, *places);
}

Result<std::unique_ptr<SuitRecognition>> SuitRecognition::create(const ServedSuit& suit, Topics& topics,
                                                                 SuitRecorder& recorder) {
  const Result<std::vector<std::size_t>> places = places_of(*suit.classes, suit.arrays);
  if (!places) return places.error();
  Result<LiveRecognition> recognition = recognition_at(*suit.classes, suit.arrays, *places);
  if (!recognition) return recognition.error();
  Result<EventTopic> topic = EventTopic::create({.stream = "/suit/recognition", .dds = "/suit/recognition"},
                                                bytes::ros_messages::classification_type(), topics, recorder);
  if (!topic) return topic.error();
  return std::unique_ptr<SuitRecognition>(
      new SuitRecognition(*std::move(recognition), suit.arrays, *places, *std::move(topic)));
}

SuitRecognition::SuitRecognition(LiveRecognition recognition, const std::vector<ServedArray>& arrays,
                                 std::vector<std::size_t> places, EventTopic topic)
    : recognition_(std::move(recognition)),
      places_(std::move(places)),
      joiner_(joiner_of(arrays, places_)),
      topic_(std::move(topic)),
      further_(recognition_.classes().layout.extras, kMissing) {}

void SuitRecognition::hear(const live::suits::ArrayResult& result) {
  const auto found = std::find(places_.begin(), places_.end(), result.array);
  if (found == places_.end()) return;
  if (found != places_.begin()) {
    joiner_.keep(static_cast<std::size_t>(found - places_.begin()), result.force);
    return;
  }
  read_further(result.force.time);
  const auto answer = recognition_.next(joiner_.join(result.force), further_);
  if (!answer) return;
  results_of(*answer, recognition_.classes(), order_, results_);
  bytes::ros_messages::encode_classification(results_, result.force.time, kSuitFrame, message_);
  topic_.publish(result.force.time, message_);
}

/// Takes the further readings at the time of a frame.
void SuitRecognition::read_further(Nanos time) {
  const std::lock_guard lock(readings_mutex_);
  if (pending_) {
    further_.swap(*pending_);
    pending_.reset();
    further_time_ = time;
  }
  const bool is_near = further_time_ && std::chrono::abs(time - *further_time_) <= learn::recognition::kLongestSilence;
  if (!is_near) std::fill(further_.begin(), further_.end(), kMissing);
}

std::vector<websocket::Service> SuitRecognition::services() {
  if (recognition_.classes().layout.extras == 0) return {};
  return {service("/recognition/readings", *this, &SuitRecognition::take_readings, kMostRequestBytes)};
}

Result<std::string> SuitRecognition::take_readings(const JsonRequest& request) {
  Result<std::vector<double>> readings = request.numbers_or_null("values", recognition_.classes().layout.extras);
  if (!readings) return readings.error();
  const std::lock_guard lock(readings_mutex_);
  pending_.emplace(readings->begin(), readings->end());
  return std::string("{}");
}

Result<std::unique_ptr<Part>> make_suit_recognition(Host& host) {
  if (!host.suit.classes) return std::unique_ptr<Part>();
  Result<std::unique_ptr<SuitRecognition>> part = SuitRecognition::create(host.suit, host.topics, host.recorder);
  if (!part) return part.error();
  return std::unique_ptr<Part>(*std::move(part));
}

}  // namespace dermis::out::serve
