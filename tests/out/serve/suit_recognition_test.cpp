// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/suit_recognition.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bytes/ros_messages/read_by_definition.hpp"
#include "out/serve/named_touches.hpp"
#include "out/serve/part_calls.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/stream_client.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;

constexpr std::size_t kTaxels = kRows * kCols;
constexpr Nanos kFrame{10'000'000};
const std::atomic<bool> kNever = false;

/// A press in the middle of an array, or none, and noise.
std::vector<float> frame_of(Random& random, bool is_pressed) {
  std::vector<float> newtons(kTaxels);
  for (float& force : newtons) force = static_cast<float>(0.005 * random.normal());
  if (is_pressed) newtons[kTaxels / 2] += static_cast<float>(random.uniform(2.0, 6.0));
  return newtons;
}

/// Poses of the arrays "left" and "right", beside which an elbow is bent or straight; `named(is_left, is_bent)`.
learn::recognition::Classes classes_named(const std::function<std::string(bool, bool)>& named) {
  const ArrayDescription array = support::hand_made_model(kRows, kCols).array;
  Random random(1);
  learn::recognition::LabelledFrames data;
  data.layout.arrays = {learn::recognition::sensed_array(array, "left"),
                        learn::recognition::sensed_array(array, "right")};
  data.layout.arrays[1].first_column = kTaxels;
  data.layout.readings = 2 * kTaxels;
  data.layout.extras = 1;
  data.layout.quantity = Quantity::force;
  for (std::size_t k = 0; k < 48; ++k) {
    const bool is_left = k % 2 == 0;
    const bool is_bent = k % 4 < 2;
    append(data, frame_of(random, is_left));
    append(data, frame_of(random, !is_left));
    data.extras.push_back(static_cast<float>((is_bent ? 90.0 : 10.0) + random.normal()));
    data.labels.push_back({std::to_string(k), k, k, named(is_left, is_bent), "", static_cast<double>(k)});
  }
  std::vector<std::size_t> all(data.labels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Result<learn::recognition::Learned> learned = learn::recognition::LearningSet::create(data)->learn(all);
  EXPECT_TRUE(learned) << learned.error().message;
  return std::move(learned->classes);
}

learn::recognition::Classes by_place() {
  return classes_named([](bool is_left, bool) { return is_left ? "left" : "right"; });
}

learn::recognition::Classes by_elbow() {
  return classes_named([](bool, bool is_bent) { return is_bent ? "bent" : "straight"; });
}

constexpr const char* kReadings = "/recognition/readings";

/// A suit whose arrays come in another order than in the examples, and a client that listens.
class NamedSuit : public testing::Test {
 protected:
  void name_by(learn::recognition::Classes classes) {
    suit_ = small_suit({"right", "left"}, kNever);
    suit_.classes = std::move(classes);
    websocket::ServerOptions options;
    options.port = 0;
    Result<std::unique_ptr<websocket::Server>> created = websocket::Server::create(options, {});
    ASSERT_TRUE(created) << created.error().message;
    server_ = *std::move(created);
    topics_ = Topics::create(*server_, {}).value();
    auto made = SuitRecognition::create(suit_, *topics_, recorder_);
    ASSERT_TRUE(made) << made.error().message;
    recognition_ = *std::move(made);
    end_ = server_->add_channel("/end", "none", "");
    server_->start();
    client_ = std::make_unique<StreamClient>(server_->port());
    client_->subscribe({"/suit/recognition", "/end"});
  }

  void see(std::size_t array, bool is_pressed) {
    const ForceFrame force = force_frame(time_, frame_of(random_, is_pressed));
    recognition_->hear({array, {}, {}, force, {}, {}});
  }

  /// What is told last while one array is pressed for so long.
  std::string told(bool is_left, Nanos length = std::chrono::seconds(1)) {
    for (const Nanos until = time_ + length; time_ < until; time_ += kFrame) {
      see(0, !is_left);
      see(1, is_left);
    }
    server_->publish(end_, {}, std::vector<std::uint8_t>{1});
    std::string last;
    for (auto message = client_->next_message(); message.topic != "/end"; message = client_->next_message()) {
      last = bytes::ros_messages::read_by_definition(bytes::ros_messages::classification_type(),
                                                     message.bytes)["results"][0]["class_id"];
    }
    return last;
  }

  std::unique_ptr<SuitRecognition> recognition_;

 private:
  Random random_{2};
  Nanos time_{};
  ServedSuit suit_;
  std::unique_ptr<websocket::Server> server_;
  std::unique_ptr<Topics> topics_;
  SuitRecorder recorder_{"", [] { return std::vector<bytes::recordings::RecordedArray>{}; },
                         [](const std::string& why) { ADD_FAILURE() << why; }};
  websocket::ChannelId end_ = 0;
  std::unique_ptr<StreamClient> client_;
};

TEST_F(NamedSuit, is_named_by_all_its_arrays_in_the_order_of_the_examples) {
  name_by(by_place());
  EXPECT_EQ(told(true), "left");
  EXPECT_EQ(told(false), "right");
}

TEST_F(NamedSuit, is_named_by_the_further_readings_that_a_client_tells) {
  name_by(by_elbow());
  EXPECT_TRUE(call(*recognition_, kReadings, R"({"values": [90]})"));
  EXPECT_EQ(told(true, std::chrono::milliseconds(400)), "bent");
  EXPECT_TRUE(call(*recognition_, kReadings, R"({"values": [10]})"));
  EXPECT_EQ(told(true, std::chrono::milliseconds(400)), "straight");
  EXPECT_EQ(told(true), "unknown") << "half a second later nobody knows";
}

TEST_F(NamedSuit, refuses_readings_that_are_not_those_of_the_examples) {
  name_by(by_elbow());
  for (const char* const request : {"{}", R"({"values": 90})", R"({"values": [90, 10]})"}) {
    const Result<std::string> taken = call(*recognition_, kReadings, request);
    ASSERT_FALSE(taken) << request;
    EXPECT_EQ(taken.error().message, "values: must be a list of 1, as the examples had; null: missing") << request;
  }
  const Result<std::string> taken = call(*recognition_, kReadings, R"({"values": ["bent"]})");
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().message, "values: must be numbers, or null where one is missing");
  EXPECT_TRUE(call(*recognition_, kReadings, R"({"values": [null]})"));
}

TEST(SuitRecognition, refuses_classes_of_an_array_that_is_not_served) {
  const ServedSuit suit = small_suit({"left", "chest"}, kNever);
  const Result<LiveRecognition> made = recognition_of_suit(by_place(), suit.arrays);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "was learned with 'right', which is not served");
}

}  // namespace
}  // namespace dermis::out::serve
