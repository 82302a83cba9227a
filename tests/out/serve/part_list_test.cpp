// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/parts/part_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "out/serve/health/live_settings.hpp"
#include "out/serve/health/tares.hpp"
#include "out/serve/recording/recording_services.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/topics/frame_topics.hpp"
#include "out/serve/topics/topics.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using websocket::ParameterValue;

/// The parameters of two arrays, "left" and "right".
class Parameters : public testing::Test {
 protected:
  void SetUp() override {
    std::vector<live::suits::LiveArray> arrays;
    for (ServedArray& array : suit_.arrays) {
      arrays.push_back({array.name, std::move(array.source), array.model, array.surface});
    }
    live_ = live::suits::LiveSuit::create(std::move(arrays), {}).value();
    websocket::ServerOptions options;
    options.port = 0;
    server_ = websocket::Server::create(options, {}).value();
    topics_ = Topics::create(*server_, {}).value();
    parts_.add(std::make_unique<LiveSettingsPart>(*live_));
    auto tares = std::make_unique<Tares>(suit_, *live_);
    tares_ = tares.get();
    parts_.add(std::move(tares));
    parts_.add(FrameTopics::create(suit_, *topics_).value());
    parts_.add(std::make_unique<RecordingServices>(
        suit_, options_, [] { return std::vector<bytes::recordings::RecordedArray>(); }, models_, recorder_, *server_,
        std::nullopt));
  }

  std::map<std::string, ParameterValue> all() const {
    std::map<std::string, ParameterValue> values;
    for (const websocket::Parameter& parameter : parts_.parameters()) values[parameter.name] = parameter.value;
    return values;
  }

  /// The line of the error; empty where there is none.
  std::string set(const std::string& name, const ParameterValue& value) {
    const Status set = parts_.set({name, value}, "1.2.3.4:5");
    return set ? "" : set.error().message;
  }

  const support::TemporaryFolder folder_;
  const std::atomic<bool> stop_ = true;
  ServedSuit suit_ = small_suit({"left", "right"}, stop_);
  SuitRecorder recorder_{
      folder_.file("rec.mcap"),
      [] {
        return std::vector<bytes::recordings::RecordedArray>{{.name = "left", .shape = {kRows, kCols}}};
      },
      [](const std::string& why) { ADD_FAILURE() << why; }};
  std::unique_ptr<live::suits::LiveSuit> live_;
  std::unique_ptr<websocket::Server> server_;
  std::unique_ptr<Topics> topics_;
  const SessionOptions options_;
  const ModelsInUse models_{suit_};
  PartList parts_;
  Tares* tares_ = nullptr;
};

/// Says its name where it is asked.
class Saying final : public Part {
 public:
  explicit Saying(std::string name) : name_(std::move(name)) {}
  void diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const override {
    diagnoses.emplace_back().name = name_;
  }

 private:
  std::string name_;
};

TEST(PartList, threats_that_hear_a_frame_first_are_diagnosed_after_the_arrays) {
  PartList parts;
  parts.add(std::make_unique<Saying>("threat"));
  parts.add(std::make_unique<Saying>("array"));
  const std::vector<bytes::ros_messages::Diagnosis> diagnoses = parts.diagnoses();
  ASSERT_EQ(diagnoses.size(), 2U);
  EXPECT_EQ(diagnoses[0].name, "array");
  EXPECT_EQ(diagnoses[1].name, "threat");
}

TEST_F(Parameters, begin_with_the_defaults) {
  const touch::contacts::ContactOptions contacts;
  const std::map<std::string, ParameterValue> expected = {{"/contacts/onset_sigma", contacts.onset_sigma},
                                                          {"/contacts/onset_force_n", contacts.onset_force_n},
                                                          {"/contacts/release_share", contacts.release_share},
                                                          {"/drift/track", true},
                                                          {"/left/tare", false},
                                                          {"/recording", false},
                                                          {"/recording/file", std::string()},
                                                          {"/right/tare", false},
                                                          {"/stream/rate_hz", 60.0},
                                                          {"/tare", false},
                                                          {"/tare/force", false},
                                                          {"/tare/log", std::string()},
                                                          {"/tare/refused", std::string()},
                                                          {"/tare/taken", false},
                                                          {"/tare/undo", false}};
  EXPECT_EQ(all(), expected);
}

TEST_F(Parameters, are_as_they_were_set) {
  const std::map<std::string, ParameterValue> wanted = {{"/contacts/onset_sigma", 7.0},
                                                        {"/contacts/onset_force_n", 1.5},
                                                        {"/contacts/release_share", 0.25},
                                                        {"/drift/track", false},
                                                        {"/stream/rate_hz", 30.0}};
  for (const auto& [name, value] : wanted) EXPECT_EQ(set(name, value), "");
  const auto now = all();
  for (const auto& [name, value] : wanted) EXPECT_EQ(now.at(name), value) << name;
  EXPECT_EQ(live_->settings().contacts.onset_force_n, 1.5);
  EXPECT_FALSE(live_->settings().drift.track);
}

TEST_F(Parameters, that_are_wrong_are_refused_in_one_line_and_change_nothing) {
  const auto before = all();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<websocket::Parameter, std::string>> wrong = {
      {{"/stream/rate_hz", 0.5}, "/stream/rate_hz: must be 1 to 1000"},
      {{"/stream/rate_hz", 1001.0}, "/stream/rate_hz: must be 1 to 1000"},
      {{"/stream/rate_hz", kNaN}, "/stream/rate_hz: must be 1 to 1000"},
      {{"/contacts/onset_sigma", 0.0}, "contacts.onset_sigma: "},
      {{"/contacts/onset_force_n", -1.0}, "contacts.onset_force_n: "},
      {{"/contacts/release_share", 1.5}, "contacts.release_share: "},
      {{"/contacts/release_share", kNaN}, "contacts.release_share: "},
      {{"/contacts/onset", 1.0}, "/contacts/onset: there is no such parameter that takes a number"},
      {{"/tare", 1.0}, "/tare: there is no such parameter that takes a number"},
      {{"/back/tare", true}, "/back/tare: there is no such parameter that is true or false"},
      {{"/stream/rate_hz", true}, "/stream/rate_hz: there is no such parameter that is true or false"},
      {{"/recording/file", std::string("x.mcap")}, "/recording/file: takes a number or true and false"},
      {{"/tare", {}}, "/tare: takes a number or true and false"},
      {{"/tare", std::vector<double>{1.0}}, "/tare: takes a number or true and false"}};
  for (const auto& [parameter, message] : wrong) {
    const std::string refused = set(parameter.name, parameter.value);
    EXPECT_TRUE(!refused.empty() && refused.starts_with(message)) << parameter.name << ": " << refused;
    EXPECT_EQ(refused.find('\n'), std::string::npos);
  }
  EXPECT_EQ(all(), before);
}

TEST_F(Parameters, the_tare_of_the_suit_is_that_of_all_its_arrays) {
  EXPECT_EQ(set("/left/tare", true), "");
  EXPECT_EQ(all().at("/left/tare"), ParameterValue(true));
  EXPECT_EQ(all().at("/right/tare"), ParameterValue(false));
  EXPECT_EQ(all().at("/tare"), ParameterValue(false));
  EXPECT_EQ(set("/right/tare", true), "");
  EXPECT_EQ(all().at("/tare"), ParameterValue(true));
  EXPECT_EQ(all().at("/tare/taken"), ParameterValue(false)) << "no frame has come of which it could be";
  EXPECT_EQ(set("/tare", false), "");
  EXPECT_EQ(all().at("/left/tare"), ParameterValue(false));
}

TEST_F(Parameters, say_who_has_reset_a_tare) {
  EXPECT_EQ(set("/left/tare", false), "");
  const std::vector<std::string> news = tares_->follow();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_TRUE(news[0].ends_with(" UTC: left got back the zero of its calibration by 1.2.3.4:5")) << news[0];
  EXPECT_EQ(all().at("/tare/log"), ParameterValue(news[0]));
  EXPECT_TRUE(tares_->follow().empty()) << "each line is told once";
}

TEST_F(Parameters, keep_the_last_twenty_lines_of_the_log) {
  for (int i = 0; i < 30; ++i) set("/left/tare", false);
  const auto text = std::get<std::string>(all().at("/tare/log"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), Tares::kMostLines - 1);
}

TEST_F(Parameters, an_array_with_another_model_is_not_tared) {
  EXPECT_EQ(set("/tare", true), "");
  parts_.model_changed(1);
  EXPECT_EQ(all().at("/left/tare"), ParameterValue(true));
  EXPECT_EQ(all().at("/right/tare"), ParameterValue(false));
}

TEST_F(Parameters, begin_and_end_recordings) {
  EXPECT_EQ(set("/recording", false), "") << "there is none";
  EXPECT_EQ(set("/recording", true), "");
  EXPECT_EQ(set("/recording", true), "") << "it goes on";
  EXPECT_EQ(all().at("/recording"), ParameterValue(true));
  EXPECT_EQ(all().at("/recording/file"), ParameterValue(folder_.file("rec.mcap")));
  EXPECT_EQ(set("/recording", false), "");
  EXPECT_EQ(all().at("/recording"), ParameterValue(false));
  EXPECT_EQ(set("/recording", true), "");
  EXPECT_NE(all().at("/recording/file"), ParameterValue(folder_.file("rec.mcap")));
}

}  // namespace
}  // namespace dermis::out::serve
