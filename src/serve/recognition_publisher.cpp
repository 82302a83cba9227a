// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/recognition_publisher.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace dermis::serve {

Result<RecognitionPublisher> RecognitionPublisher::create(const ServedSuit& suit, stream::Server& server,
                                                          SuitRecorder& recorder) {
  RecognitionPublisher publisher;
  for (const ServedArray& array : suit.arrays) {
    std::optional<Named>& named = publisher.arrays_.emplace_back();
    if (!array.classes) continue;
    Result<ArrayRecognition> recognition = ArrayRecognition::create(*array.classes, array.name, array.model->array);
    if (!recognition) return bad_input(fmt::format("array '{}': {}", array.name, recognition.error().message));
    named.emplace(
        Named{*std::move(recognition), array.name,
              EventTopic("/" + array.name + "/recognition", messages::classification_type(), server, recorder)});
  }
  return publisher;
}

void RecognitionPublisher::publish(const live::ArrayResult& result) {
  std::optional<Named>& named = arrays_[result.array];
  if (!named) return;
  const std::optional<recognition::Answer> answer = named->recognition.next(result.force);
  if (!answer) return;
  results_of(*answer, named->recognition.classes(), named->order, named->results);
  messages::encode_classification(named->results, result.force.time, named->frame_id, named->message);
  named->topic.publish(result.force.time, named->message);
}

void results_of(const recognition::Answer& answer, const recognition::Classes& classes, std::vector<std::size_t>& order,
                std::vector<messages::Hypothesis>& results) {
  results.clear();
  if (answer.verdict != recognition::Verdict::known) {
    results.push_back({"unknown", 1.0});
    results.push_back({recognition::to_string(answer.verdict), 0.0});
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

}  // namespace dermis::serve
