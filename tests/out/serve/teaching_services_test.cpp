// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/teaching/teaching_services.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/csv_table.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "out/serve/named_touches.hpp"
#include "out/serve/part_calls.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;

/// Somebody who teaches taps and holds of "skin", the second of two arrays.
class Teaching : public testing::Test {
 protected:
  json call(const std::string& service, json request = json::object()) {
    request["array"] = "skin";
    const Result<std::string> answer = serve::call(services_, service, request.dump());
    return answer ? json::parse(*answer) : json(answer.error().message);
  }

  /// Touches of that length, each between half seconds of rest.
  void touch(double seconds, int count = 1) {
    for (int frame = 0; frame < count * static_cast<int>(100 * (seconds + 1.0)); ++frame) {
      const double place = std::fmod(0.01 * frame, seconds + 1.0);
      feed(place >= 0.5 && place < 0.5 + seconds ? random_.uniform(3.5, 4.5) : 0.0);
    }
  }

  /// A frame with a contact of that force.
  void feed(double newtons) {
    time_ += Nanos(10'000'000);
    const ForceFrame force = force_frame(time_, dermis::out::serve::touch(random_, true, newtons));
    ContactReport report;
    report.total_force_n = newtons;
    services_.hear({1, {}, {}, force, report, {}});
  }

  void teach(const std::string& name, double seconds, int count, const std::string& session = "1") {
    EXPECT_EQ(call("/recognition/listen", {{"class", name}, {"session", session}}), json::object());
    touch(seconds, count);
    EXPECT_EQ(call("/recognition/listen", {{"class", ""}}), json::object());
  }

  std::map<std::string, int> counts() {
    std::map<std::string, int> counts;
    const json answer = call("/recognition/examples");
    for (const json& example : answer["examples"]) ++counts[example["class"]];
    return counts;
  }

  const support::TemporaryFolder folder_;
  std::optional<learn::recognition::Classes> used_;
  TeachingServices services_{ServiceArrays({{"other", support::reference_array(3, 4), ""},
                                            {"skin", touched_array(), folder_.file("model.safetensors")}}),
                             [this](std::size_t array, learn::recognition::Classes classes) {
                               EXPECT_EQ(array, 1U);
                               used_ = std::move(classes);
                               return Status(Done{});
                             }};
  Random random_{11};
  Nanos time_{};
};

TEST_F(Teaching, touches_are_found_by_themselves_while_a_class_is_named) {
  touch(0.3);
  teach("tap", 0.1, 3);
  touch(0.3);
  teach("hold", 0.5, 2, "2");
  EXPECT_EQ(counts(), (std::map<std::string, int>{{"hold", 2}, {"tap", 3}}));
  const json examples = call("/recognition/examples")["examples"];
  EXPECT_EQ(examples[0]["session"], "1");
  EXPECT_EQ(examples[4]["session"], "2");
  const auto picture = examples[0]["picture"].get<std::vector<int>>();
  ASSERT_EQ(picture.size(), touched_array().taxel_count());
  EXPECT_EQ(*std::max_element(picture.begin(), picture.end()), 255);
  for (std::size_t taxel = 0; taxel < picture.size(); ++taxel) {
    EXPECT_TRUE(picture[taxel] < 10 || taxel % kTouchCols == 1)
        << "r" << taxel / kTouchCols << "c" << taxel % kTouchCols;
  }
}

TEST_F(Teaching, a_touch_that_goes_on_when_a_class_is_named_is_no_example) {
  EXPECT_EQ(call("/recognition/listen", {{"class", "tap"}}), json::object());
  for (int frame = 0; frame < 100; ++frame) feed(frame < 30 ? 4.0 : 0.0);
  EXPECT_TRUE(counts().empty());
  touch(0.1);
  EXPECT_EQ(counts()["tap"], 1);
}

TEST_F(Teaching, a_touch_of_more_than_four_seconds_is_no_example) {
  teach("hold", 5.0, 1);
  EXPECT_TRUE(counts().empty());
}

TEST_F(Teaching, pictures_that_are_known_are_not_sent_again) {
  teach("tap", 0.1, 2);
  const json examples = call("/recognition/examples", {{"known", 1}})["examples"];
  EXPECT_FALSE(examples[0].contains("picture"));
  EXPECT_TRUE(examples[1].contains("picture"));
}

TEST_F(Teaching, an_example_can_be_thrown_away) {
  teach("tap", 0.1, 3);
  EXPECT_EQ(call("/recognition/throw_away", {{"example", 2}}), json::object());
  EXPECT_EQ(counts()["tap"], 2);
  EXPECT_EQ(call("/recognition/throw_away", {{"example", 2}}), "example: there is none of that id");
}

TEST_F(Teaching, training_uses_the_classes_and_saves_what_dermis_learn_reads) {
  teach("tap", 0.1, 10);
  teach("hold", 0.5, 10, "2");
  const json answer = call("/recognition/train");
  ASSERT_TRUE(answer.is_object()) << answer;
  EXPECT_EQ(answer["classes"], (json{"hold", "tap"}));
  EXPECT_GE(answer["accuracy"], 0.9);
  ASSERT_TRUE(used_);
  EXPECT_TRUE(used_->touches) << "gestures need to know where they begin";
  const std::string path = folder_.file(answer["file"]);
  const Result<learn::recognition::Classes> saved = learn::recognition::read_classes(path);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(*saved, *used_);
  const std::string stem = path.substr(0, path.size() - std::string(".safetensors").size());
  const auto array = bytes::files::read_array(stem + ".array.toml");
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->readout.quantity, Quantity::force);
  EXPECT_EQ(array->row_pitch_m, touched_array().row_pitch_m);
  const Result<bytes::files::CsvTable> labels = bytes::files::CsvTable::read(stem + ".labels.csv");
  ASSERT_TRUE(labels) << labels.error().message;
  EXPECT_EQ(labels->rows(), 20U);
}

/// The same server another day: nothing is known of the examples.
class AnotherDay : public Teaching {
 protected:
  json call_again(const std::string& service, json request = json::object()) {
    request["array"] = "skin";
    const Result<std::string> answer = serve::call(again_, service, request.dump());
    return answer ? json::parse(*answer) : json(answer.error().message);
  }

  TeachingServices again_{ServiceArrays({{"skin", touched_array(), folder_.file("model.safetensors")}}),
                          [](std::size_t, const learn::recognition::Classes&) { return Status(Done{}); }};
};

TEST_F(AnotherDay, goes_on_with_what_was_saved) {
  teach("tap", 0.1, 10);
  teach("hold", 0.5, 9, "2");
  const std::string file = call("/recognition/train")["file"];
  const std::string name = file.substr(0, file.find('.'));
  EXPECT_EQ(call("/recognition/saved"), (json{{"files", json::array()}})) << "its examples are here already";
  EXPECT_EQ(call("/recognition/load", {{"file", name}}), "file: is among the examples already");
  EXPECT_EQ(call_again("/recognition/saved"), (json{{"files", {name}}}));
  EXPECT_EQ(call_again("/recognition/load", {{"file", name}}), (json{{"examples", 19}}));
  const json before = call("/recognition/examples")["examples"];
  const json after = call_again("/recognition/examples")["examples"];
  ASSERT_EQ(after.size(), 19U);
  for (std::size_t k = 0; k < after.size(); ++k) {
    EXPECT_EQ(after[k]["class"], before[k]["class"]);
    EXPECT_EQ(after[k]["session"], before[k]["session"]);
  }
  const json trained = call_again("/recognition/train");
  ASSERT_TRUE(trained.is_object()) << trained;
  EXPECT_GE(trained["accuracy"], 0.9);
}

TEST_F(AnotherDay, loads_nothing_but_touches_of_the_array_beside_its_model) {
  for (const char* name : {"../skin-touches-1", "skin-touches-1", "model", ""}) {
    EXPECT_EQ(call("/recognition/load", {{"file", name}}), "file: there are no saved touches of that name") << name;
  }
  std::ofstream(folder_.file("skin-touches-1.labels.csv")) << "id,first,last,class,session\nt1,5,9,tap,1\n";
  const std::string missing = call("/recognition/load", {{"file", "skin-touches-1"}});
  EXPECT_NE(missing.find("skin-touches-1.frames.csv"), std::string::npos) << missing;
  EXPECT_TRUE(counts().empty());
}

TEST_F(Teaching, advice_warns_of_few_examples_and_of_one_session) {
  teach("tap", 0.1, 10);
  teach("hold", 0.5, 4);
  const std::string advice = call("/recognition/train")["advice"].dump();
  EXPECT_NE(advice.find("hold needs more examples"), std::string::npos) << advice;
  EXPECT_NE(advice.find("one subject or session"), std::string::npos) << advice;
}

TEST_F(Teaching, what_cannot_be_done_gives_a_line) {
  EXPECT_EQ(call("/recognition/train"), "nothing was taught yet");
  EXPECT_EQ(call("/recognition/listen", {{"class", "unknown"}}), "class: 'unknown' is what is none of the classes");
  EXPECT_EQ(call("/recognition/listen", {{"class", "a,b"}}),
            "class: must have at most 60 bytes, without commas and quotes");
  EXPECT_EQ(call("/recognition/listen", {{"class", 7}}), "class: must be a text");
  EXPECT_EQ(call("/recognition/examples", {{"known", -1}}), "known: must be the id of an example, or 0");
  EXPECT_EQ(serve::call(services_, "/recognition/train", "[]").error().message,
            "the request is no JSON object of at most 4 KiB");
  EXPECT_EQ(serve::call(services_, "/recognition/train", R"({"array": "none"})").error().message,
            "array: there is none of that name");
  teach("tap", 0.1, 3);
  EXPECT_TRUE(call("/recognition/train").is_string()) << "a single class";
  EXPECT_TRUE(std::filesystem::is_empty(folder_.file("")));
}

}  // namespace
}  // namespace dermis::out::serve
