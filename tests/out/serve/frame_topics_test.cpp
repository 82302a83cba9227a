// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/frame_topics.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "out/serve/small_suit.hpp"
#include "out/serve/stream_client.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kTaxels = kRows * kCols;
constexpr Nanos kMillisecond{1'000'000};

/// A frame of an array with all that was made of it.
struct Frame {
  RawFrame raw;
  ConductanceFrame conductance;
  ForceFrame force;
  ContactReport report;
  std::vector<SuitContact> contacts;

  explicit Frame(Nanos time) {
    raw.time = time;
    raw.counts.assign(kTaxels, 1.0F);
    conductance.time = time;
    conductance.siemens.assign(kTaxels, 1e-6);
    conductance.sigma_siemens.assign(kTaxels, 1e-7);
    conductance.taxels.assign(kTaxels, TaxelStatus::ok);
    force.time = time;
    force.newtons.assign(kTaxels, 0.5F);
    force.sigma_newtons.assign(kTaxels, 0.1F);
    force.taxels.assign(kTaxels, TaxelStatus::ok);
  }
  void add_contact(ContactPhase phase) {
    Contact contact;
    contact.phase = phase;
    report.contacts.push_back(contact);
    contacts.push_back({0, contact, {}, {}});
  }
  [[nodiscard]] live::suits::ArrayResult result(Nanos latency = {}) const {
    return {0, raw, conductance, force, report, contacts, latency};
  }
};

/// The topics of one array, and the channel "/end" behind all that it publishes.
class TopicsOfFrames : public testing::Test {
 protected:
  void SetUp() override {
    websocket::ServerOptions options;
    options.port = 0;
    Result<std::unique_ptr<websocket::Server>> created = websocket::Server::create(options, {});
    ASSERT_TRUE(created) << created.error().message;
    server_ = *std::move(created);
    topics_ = Topics::create(*server_, {}).value();
    frame_topics_ = FrameTopics::create(suit_, *topics_).value();
    end_ = server_->add_channel("/end", "none", "");
    server_->start({[] { return std::vector<websocket::Parameter>{}; },
                    [](const websocket::Parameter&, const std::string&) { return Done{}; }});
  }

  void listen_to(std::vector<std::string> topics) {
    client_ = std::make_unique<StreamClient>(server_->port());
    topics.emplace_back("/end");
    client_->subscribe(topics);
  }

  /// The times of the messages of each topic since the last call, in milliseconds.
  std::map<std::string, std::vector<std::int64_t>> heard() {
    server_->publish(end_, {}, std::vector<std::uint8_t>{1});
    std::map<std::string, std::vector<std::int64_t>> times;
    for (StreamClient::Message message = client_->next_message(); message.topic != "/end";
         message = client_->next_message()) {
      times[message.topic].push_back(message.time / kMillisecond);
    }
    return times;
  }

  const std::atomic<bool> stop_ = false;
  const ServedSuit suit_ = small_suit({"chest"}, stop_);
  std::unique_ptr<websocket::Server> server_;
  std::unique_ptr<Topics> topics_;
  std::unique_ptr<FrameTopics> frame_topics_;
  websocket::ChannelId end_ = 0;
  std::unique_ptr<StreamClient> client_;
};

TEST_F(TopicsOfFrames, frames_that_are_late_already_are_thinned_and_counted) {
  listen_to({"/chest/force"});
  for (std::int64_t k = 0; k < 100; ++k) frame_topics_->hear(Frame(k * 100 * kMillisecond).result(Nanos(1'000'000)));
  EXPECT_EQ(heard()["/chest/force"].size(), 100U);
  EXPECT_EQ(topics_->frames_not_streamed(), 0U);
  for (std::int64_t k = 100; k < 200; ++k) {
    frame_topics_->hear(Frame(k * 100 * kMillisecond).result(Nanos(50'000'000)));
  }
  EXPECT_EQ(heard()["/chest/force"].size(), 10U);
  EXPECT_EQ(topics_->frames_not_streamed(), 90U);
}

TEST_F(TopicsOfFrames, a_fast_array_is_streamed_evenly_at_the_rate_that_is_set) {
  listen_to({"/chest/force"});
  ASSERT_TRUE(frame_topics_->parameters().front().set_number(100.0));
  for (std::int64_t k = 0; k < 1000; ++k) frame_topics_->hear(Frame(k * kMillisecond).result());
  const std::vector<std::int64_t> times = heard()["/chest/force"];
  ASSERT_EQ(times.size(), 100U);
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_EQ(times[k], static_cast<std::int64_t>(10 * k));
}

TEST_F(TopicsOfFrames, every_frame_of_a_slow_array_is_streamed) {
  listen_to({"/chest/force"});
  for (std::int64_t k = 0; k < 20; ++k) frame_topics_->hear(Frame(k * 40 * kMillisecond).result());
  EXPECT_EQ(heard()["/chest/force"].size(), 20U);
}

TEST_F(TopicsOfFrames, a_frame_that_was_late_does_not_make_the_next_one_late) {
  listen_to({"/chest/force"});
  ASSERT_TRUE(frame_topics_->parameters().front().set_number(100.0));
  for (const std::int64_t time : {0, 10, 23, 30, 40}) frame_topics_->hear(Frame(time * kMillisecond).result());
  EXPECT_EQ(heard()["/chest/force"], (std::vector<std::int64_t>{0, 10, 23, 30, 40}));
}

TEST_F(TopicsOfFrames, a_recording_that_was_sought_back_goes_on_at_once) {
  listen_to({"/chest/force"});
  for (const std::int64_t time : {10'000, 10'001, 500, 501}) frame_topics_->hear(Frame(time * kMillisecond).result());
  EXPECT_EQ(heard()["/chest/force"], (std::vector<std::int64_t>{10'000, 500}));
}

TEST_F(TopicsOfFrames, a_frame_that_comes_again_is_streamed_again) {
  listen_to({"/chest/force"});
  for (const std::int64_t time : {10'000, 10'001, 10'001}) frame_topics_->hear(Frame(time * kMillisecond).result());
  EXPECT_EQ(heard()["/chest/force"], (std::vector<std::int64_t>{10'000, 10'001}));
}

TEST_F(TopicsOfFrames, the_beginning_and_the_end_of_a_contact_are_never_left_out) {
  listen_to({"/contacts", "/chest/force"});
  const std::vector<ContactPhase> phases = {ContactPhase::held, ContactPhase::onset, ContactPhase::held,
                                            ContactPhase::release, ContactPhase::held};
  for (std::size_t k = 0; k < phases.size(); ++k) {
    Frame frame(static_cast<std::int64_t>(k) * kMillisecond);
    frame.add_contact(phases[k]);
    frame_topics_->hear(frame.result());
  }
  auto times = heard();
  EXPECT_EQ(times["/contacts"], (std::vector<std::int64_t>{0, 1, 3}));
  EXPECT_EQ(times["/chest/force"], (std::vector<std::int64_t>{0}));
}

TEST_F(TopicsOfFrames, a_client_gets_the_topics_that_it_asked_for) {
  listen_to({"/chest/raw", "/chest/conductance"});
  frame_topics_->hear(Frame(kMillisecond).result());
  frame_topics_->tick(0);
  const auto times = heard();
  EXPECT_EQ(times.size(), 2U);
  EXPECT_EQ(times.at("/chest/raw"), (std::vector<std::int64_t>{1}));
  EXPECT_EQ(times.at("/chest/conductance"), (std::vector<std::int64_t>{1}));
}

TEST_F(TopicsOfFrames, frames_without_the_right_number_of_taxels_are_not_shown) {
  listen_to({"/chest/raw", "/chest/conductance"});
  Frame damaged(kMillisecond);
  damaged.raw.counts.pop_back();
  damaged.conductance.taxels.clear();
  frame_topics_->hear(damaged.result());
  EXPECT_TRUE(heard().empty());
}

TEST(RawFrameBytes, are_those_of_a_frame_with_a_temperature_of_each_taxel) {
  ArrayDescription array;
  array.rows = 32;
  array.cols = 16;
  array.temperature_sensors = sensors_on_each_taxel(array.rows, array.cols);
  RawFrame frame;
  frame.counts.assign(array.taxel_count(), 1.0F);
  frame.sensor_celsius.assign(array.taxel_count(), 25.0F);
  std::vector<std::uint8_t> message;
  bytes::ros_messages::encode_raw_frame(frame, {array.rows, array.cols}, "left_palm_of_the_hand", message);
  EXPECT_GE(raw_frame_bytes(array), message.size());
  EXPECT_LE(raw_frame_bytes(array), message.size() + 256);
}

TEST_F(TopicsOfFrames, the_points_are_those_of_the_last_frame_that_was_streamed) {
  listen_to({"/suit/points"});
  frame_topics_->hear(Frame(5 * kMillisecond).result());
  frame_topics_->hear(Frame(6 * kMillisecond).result());
  frame_topics_->tick(0);
  EXPECT_EQ(heard()["/suit/points"], (std::vector<std::int64_t>{5}));
}

TEST_F(TopicsOfFrames, what_nobody_asked_for_is_not_even_encoded) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  std::vector<Frame> frames;
  for (std::int64_t k = 0; k < 100; ++k) frames.emplace_back(k * 20 * kMillisecond);
  const support::AllocationGuard guard;
  for (const Frame& frame : frames) frame_topics_->hear(frame.result());
  frame_topics_->tick(0);
  EXPECT_EQ(guard.count(), 0U) << "no message was made";
}

}  // namespace
}  // namespace dermis::out::serve
