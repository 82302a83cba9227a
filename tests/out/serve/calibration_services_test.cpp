// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/calibration/calibration_services.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "learn/calibration/simulated_user.hpp"
#include "out/serve/part_calls.hpp"
#include "support/hand_made_model.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using learn::calibration::GuideStage;

constexpr std::uint64_t kSeed = 3;
constexpr std::size_t kMostFrames = 100'000;
constexpr const char* kNoCalibration = "no calibration is going on; begin with /calibration/start";

ArrayDescription array_of(std::size_t rows, std::size_t cols) {
  return support::hand_made_model(rows, cols).array;
}

Status use_none(std::size_t, const std::shared_ptr<const touch::pipeline::Model>&) {
  return Done{};
}

/// The services of the arrays "left" and "right", with a person at the right one.
class Calibrations : public testing::Test {
 protected:
  /// The answer, or the line of the error.
  std::string call(const std::string& service, const std::string& request = "{}") {
    const Result<std::string> answer = serve::call(services_, "/calibration/" + service, request);
    return answer ? *answer : answer.error().message;
  }

  GuideStage stage() const { return services_.progress()->state.stage; }

  /// Presses as told, until there is nothing to press.
  void press() {
    learn::calibration::HandledArray handled(right_, {}, kSeed);
    learn::calibration::SimulatedUser user(right_, {}, kSeed);
    for (std::size_t frame = 0; frame < kMostFrames; ++frame) {
      const learn::calibration::GuideState state = services_.progress()->state;
      if (state.stage != GuideStage::unloaded && state.stage != GuideStage::pressing) return;
      services_.feed(1, handled.frame(user.react(state)));
    }
    ADD_FAILURE() << "never came to an end: " << services_.progress()->state.message;
  }

  void wait_for_fit() {
    while (stage() == GuideStage::fitting) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  const support::TemporaryFolder folder_;
  const ArrayDescription left_ = array_of(2, 2);
  const ArrayDescription right_ = array_of(3, 4);
  std::optional<std::size_t> array_in_use_;
  std::shared_ptr<const touch::pipeline::Model> model_in_use_;
  Status use_ = Done{};
  CalibrationServices services_{
      ServiceArrays({{"left", left_, folder_.file("left.toml")}, {"right", right_, folder_.file("right.toml")}}),
      [this](std::size_t array, std::shared_ptr<const touch::pipeline::Model> model) {
        array_in_use_ = array;
        model_in_use_ = std::move(model);
        return use_;
      },
      std::make_shared<live::sources::GuideVoice>()};
};

TEST_F(Calibrations, have_nothing_to_tell_before_the_first) {
  EXPECT_FALSE(services_.progress());
  services_.feed(0, {});
  for (const char* const service : {"skip", "repeat", "finish", "save", "cancel"}) {
    EXPECT_EQ(call(service), kNoCalibration) << service;
  }
}

TEST_F(Calibrations, refuse_requests_that_are_wrong) {
  EXPECT_EQ(call("start", "no JSON"), "the request is not a JSON object");
  EXPECT_EQ(call("start", R"({"array": "back"})"), "array: there is none of that name");
  EXPECT_EQ(call("start"), "array: there is none of that name") << "which of two?";
  EXPECT_EQ(call("start", R"({"array": "left", "weights_n": [0]})"), "weights_n: 0 is not 0.01 to 1000 N");
  EXPECT_EQ(call("start", R"({"array": "left", "weight_n": [1]})"),
            "'weight_n' is not known; did you mean 'weights_n'?");
  EXPECT_FALSE(services_.progress());
  EXPECT_EQ(call("start", R"({"array": "left"})"), "{}");
  EXPECT_EQ(call("dance"), "there is no such service");
}

TEST_F(Calibrations, follow_the_plan_that_was_asked_for) {
  EXPECT_EQ(call("start", R"({"array": "left", "weights_n": [2, 5, 1], "taxels": [3, 0]})"), "{}");
  EXPECT_EQ(services_.progress()->array, "left");
  EXPECT_EQ(services_.progress()->state.presses_total, 6U);
  EXPECT_EQ(stage(), GuideStage::unloaded);
}

TEST_F(Calibrations, go_on_one_at_a_time_until_they_are_cancelled) {
  EXPECT_EQ(call("start", R"({"array": "left"})"), "{}");
  EXPECT_EQ(call("start", R"({"array": "right"})"), "a calibration is going on; cancel it first");
  EXPECT_EQ(call("save"), "the model is not ready; finish first");
  EXPECT_EQ(call("cancel"), "{}");
  EXPECT_EQ(stage(), GuideStage::none);
  EXPECT_EQ(call("cancel"), kNoCalibration);
  EXPECT_EQ(call("start", R"({"array": "right"})"), "{}");
  EXPECT_EQ(services_.progress()->array, "right");
}

TEST_F(Calibrations, pass_over_the_frames_of_other_arrays) {
  EXPECT_EQ(call("start", R"({"array": "right", "unloaded_s": 0.2})"), "{}");
  learn::calibration::HandledArray handled(left_, {}, kSeed);
  for (int k = 0; k < 100; ++k) services_.feed(0, handled.frame(std::vector<double>(left_.taxel_count())));
  EXPECT_EQ(services_.progress()->state.hold_share, 0.0);
}

TEST_F(Calibrations, save_the_model_with_what_was_measured_and_take_it_into_use) {
  const std::string request =
      R"({"array": "right", "weights_n": [2, 5, 10], "taxels": "all", "unloaded_s": 0.5, "hold_s": 0.2})";
  EXPECT_EQ(call("start", request), "{}");
  press();
  wait_for_fit();
  ASSERT_EQ(stage(), GuideStage::done) << services_.progress()->state.message;
  const std::string file = nlohmann::json::parse(call("save"))["file"];
  EXPECT_TRUE(file.starts_with("right-") && file.ends_with(".safetensors")) << file;
  EXPECT_TRUE(services_.progress()->state.message.ends_with(" Saved as " + file + " and in use."));
  EXPECT_EQ(array_in_use_, 1U);
  const Result<touch::pipeline::Model> saved = bytes::models::read_model(folder_.file(file));
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(saved->networks.parameters, model_in_use_->networks.parameters);

  const std::string path = folder_.file(file.substr(0, file.find('.')));
  EXPECT_EQ(bytes::files::read_array(path + ".array.toml")->taxel_count(), right_.taxel_count());
  const auto frames = bytes::recordings::open_frames(path + ".frames.csv", {.shape = FrameShape{3, 4}});
  ASSERT_TRUE(frames) << frames.error().message;
  RawFrame frame;
  const Result<bool> more = (*frames)->next(frame);
  EXPECT_TRUE(more && *more);
  EXPECT_GT(std::filesystem::file_size(path + ".loads.csv"), 0U);
}

TEST_F(Calibrations, say_when_the_new_model_cannot_be_used) {
  use_ = bad_input("array 'right': the new model is of another size or pitch");
  EXPECT_EQ(call("start", R"({"array": "right", "weights_n": [2, 5, 10], "unloaded_s": 0.5, "hold_s": 0.2})"), "{}");
  press();
  wait_for_fit();
  EXPECT_EQ(call("save"), use_.error().message);
  EXPECT_EQ(services_.progress()->state.message.find("Saved"), std::string::npos);
}

TEST(CalibrationServices, the_only_array_needs_no_name) {
  CalibrationServices services(ServiceArrays({{"chest", array_of(2, 2), ""}}), use_none,
                               std::make_shared<live::sources::GuideVoice>());
  EXPECT_TRUE(call(services, "/calibration/start", "{}"));
  EXPECT_EQ(services.progress()->array, "chest");
}

TEST(CalibrationServices, a_hand_that_listens_is_told_what_to_press) {
  const auto voice = std::make_shared<live::sources::GuideVoice>();
  voice->listen();
  CalibrationServices services(ServiceArrays({{"chest", array_of(2, 2), ""}}), use_none, voice);
  ASSERT_TRUE(
      call(services, "/calibration/start", R"({"taxels": [3], "weights_n": [2], "unloaded_s": 0.2, "hold_s": 0.25})"));
  EXPECT_FALSE(voice->words().press);
  EXPECT_EQ(voice->words().hold_time, std::chrono::milliseconds(250));
  learn::calibration::HandledArray handled(array_of(2, 2), {}, kSeed);
  for (std::size_t frame = 0; frame < kMostFrames && !voice->words().press; ++frame) {
    services.feed(0, handled.frame(std::vector<double>(4)));
  }
  EXPECT_EQ(voice->words().taxel, 3U);
  EXPECT_EQ(voice->words().weight_n, 2.0);
  ASSERT_TRUE(call(services, "/calibration/cancel", "{}"));
  EXPECT_FALSE(voice->words().press);
}

}  // namespace
}  // namespace dermis::out::serve
