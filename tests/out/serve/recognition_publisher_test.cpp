// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/recognition_publisher.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace dermis::out::serve {
namespace {

using learn::recognition::Verdict;
using Results = std::vector<std::pair<std::string, double>>;

Results told(Verdict verdict) {
  learn::recognition::Classes classes;
  classes.names = {"grab", "hug", "tap"};
  const std::vector<double> probabilities = {0.25, 0.125, 0.625};
  learn::recognition::Answer answer{probabilities, 2, 0, 0.0, verdict};
  std::vector<std::size_t> order;
  std::vector<bytes::ros_messages::Hypothesis> results;
  results_of(answer, classes, order, results);
  Results all;
  for (const bytes::ros_messages::Hypothesis& result : results) all.emplace_back(result.class_id, result.score);
  return all;
}

TEST(RecognitionPublisher, the_likeliest_class_comes_first) {
  EXPECT_EQ(told(Verdict::known), (Results{{"tap", 0.625}, {"grab", 0.25}, {"hug", 0.125}}));
}

TEST(RecognitionPublisher, unknown_comes_before_all_classes_and_its_reason_second) {
  const std::string reason = learn::recognition::to_string(Verdict::between_classes);
  EXPECT_EQ(told(Verdict::between_classes),
            (Results{{"unknown", 1.0}, {reason, 0.0}, {"tap", 0.625}, {"grab", 0.25}, {"hug", 0.125}}));
  EXPECT_NE(told(Verdict::unlike_examples)[1].first, reason);
}

}  // namespace
}  // namespace dermis::out::serve
