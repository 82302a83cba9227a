// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/recognition_publisher.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {
namespace {

std::string topic_of(const ServedArray& array) {
  return "/" + array.name + "/recognition";
}

}  // namespace

Result<std::unique_ptr<RecognitionPublisher>> RecognitionPublisher::create(const ServedSuit& suit, Topics& topics,
                                                                           SuitRecorder& recorder) {
  std::unique_ptr<RecognitionPublisher> part(new RecognitionPublisher(topics, recorder));
  for (const ServedArray& array : suit.arrays) {
    Named& named = part->arrays_.emplace_back();
    named.array = &array;
    const Result<Topic> nodes = topics.add({.dds = topic_of(array)}, bytes::ros_messages::classification_type());
    if (!nodes) return nodes.error();
    named.nodes = *nodes;
  }
  return part;
}

Status RecognitionPublisher::prepare() {
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    const std::optional<learn::recognition::Classes>& classes = arrays_[k].array->classes;
    if (!classes) continue;
    if (Status used = use_classes(k, *classes); !used) return used;
  }
  return Done{};
}

Status RecognitionPublisher::use_classes(std::size_t array, const learn::recognition::Classes& classes) {
  Named& named = arrays_[array];
  const std::string& name = named.array->name;
  Result<LiveRecognition> made =
      LiveRecognition::create(classes, {learn::recognition::sensed_array(named.array->model->array, name)});
  if (!made) return bad_input(fmt::format("array '{}': {}", name, made.error().message));
  if (!named.topic) {
    Result<EventTopic> topic = EventTopic::create({.stream = topic_of(*named.array)},
                                                  bytes::ros_messages::classification_type(), topics_, recorder_);
    if (!topic) return topic.error();
    named.topic.emplace(*std::move(topic));
  }
  const std::lock_guard lock(named.next_mutex);
  named.next = std::make_unique<LiveRecognition>(*std::move(made));
  named.has_next = true;
  return Done{};
}

void RecognitionPublisher::hear(const live::suits::ArrayResult& result) {
  Named& named = arrays_[result.array];
  if (named.has_next.load(std::memory_order_acquire)) {
    const std::lock_guard lock(named.next_mutex);
    named.recognition = std::move(named.next);
    named.has_next = false;
  }
  if (!named.recognition) return;
  const std::optional<learn::recognition::Answer> answer = named.recognition->next(result.force);
  if (!answer) return;
  results_of(*answer, named.recognition->classes(), named.order, named.results);
  bytes::ros_messages::encode_classification(named.results, result.force.time, named.array->name, named.message);
  named.nodes.publish(result.force.time, named.message, Ends::dds);
  named.topic->publish(result.force.time, named.message);
}

void results_of(const learn::recognition::Answer& answer, const learn::recognition::Classes& classes,
                std::vector<std::size_t>& order, std::vector<bytes::ros_messages::Hypothesis>& results) {
  results.clear();
  if (answer.verdict != learn::recognition::Verdict::known) {
    results.push_back({"unknown", 1.0});
    results.push_back({learn::recognition::to_string(answer.verdict), 0.0});
  }
  order.resize(classes.names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double more = answer.probabilities[a];
    const double less = answer.probabilities[b];
    return more != less ? more > less : a < b;
  });
  for (const std::size_t label : order) results.push_back({classes.names[label], answer.probabilities[label]});
}

Result<std::unique_ptr<Part>> make_recognition(Host& host) {
  Result<std::unique_ptr<RecognitionPublisher>> part =
      RecognitionPublisher::create(host.suit, host.topics, host.recorder);
  if (!part) return part.error();
  return std::unique_ptr<Part>(*std::move(part));
}

}  // namespace dermis::out::serve
