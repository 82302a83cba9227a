// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/served_suit.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "out/serve/named_touches.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/suit/models_in_use.hpp"
#include "out/serve/suit/suit_json.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using support::TemporaryFolder;
using support::write_bytes;

const std::atomic<bool> kNever = false;

/// A folder with the model file "model.safetensors" of the small array.
struct ModelFolder : TemporaryFolder {
  ModelFolder() {
    const Status written = bytes::models::write_model(model(), support::hand_made_model(kRows, kCols));
    EXPECT_TRUE(written) << written.error().message;
  }
  std::string model() const { return file("model.safetensors"); }
};

std::string refusal(const SuitPlace& place) {
  const Result<ServedSuit> suit = open_suit(place);
  return suit ? "" : suit.error().message;
}

TEST(ServedSuit, of_one_array_has_its_name_as_topics_may_have_it) {
  const auto name_of = [](const std::string& name) {
    touch::pipeline::Model model = support::hand_made_model(kRows, kCols);
    model.array.name = name;
    auto source = std::make_unique<UntouchedArray>(model.array, kNever);
    const Result<ServedSuit> suit = suit_of_one(std::move(source), std::move(model));
    EXPECT_TRUE(suit && suit->arrays.size() == 1);
    return suit->arrays.front().name;
  };
  EXPECT_EQ(name_of("chest"), "chest");
  EXPECT_EQ(name_of("left hand/2"), "left_hand_2");
  EXPECT_EQ(name_of("2nd"), "array_2nd");
  EXPECT_EQ(name_of(""), "array_");
}

TEST(ServedSuit, opens_a_source_with_its_model) {
  const ModelFolder folder;
  const Result<ServedSuit> suit = open_suit({.from = "sim:contacts?rate=100", .model = folder.model()});
  ASSERT_TRUE(suit) << suit.error().message;
  ASSERT_EQ(suit->arrays.size(), 1U);
  EXPECT_EQ(suit->name, "suit");
  EXPECT_EQ(suit->arrays[0].name, "hand_made");
  EXPECT_EQ(suit->arrays[0].model_path, folder.model());
  EXPECT_EQ(suit->arrays[0].description.rows, kRows);
  EXPECT_NE(suit->arrays[0].source, nullptr);
  EXPECT_EQ(suit->playback, nullptr);
}

TEST(ServedSuit, opens_an_array_that_is_still_to_be_calibrated) {
  const TemporaryFolder folder;
  ASSERT_TRUE(bytes::files::write_array(folder.file("array.toml"), support::hand_made_model(kRows, kCols).array));
  const Result<ServedSuit> suit = open_suit({.from = "sim:contacts?rate=100", .model = folder.file("array.toml")});
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays[0].model->networks.dead, std::vector<std::uint8_t>(kRows * kCols, 1));
}

TEST(ServedSuit, calibrates_the_array_of_the_simulator_where_no_model_is_named) {
  std::vector<std::string> told;
  const Result<ServedSuit> suit = open_suit({.from = "sim:contacts?rate=100&rows=3&cols=4"},
                                            {.notice = [&](const std::string& line) { told.push_back(line); }});
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays[0].model->networks.dead, std::vector<std::uint8_t>(12, 0));
  EXPECT_EQ(told, std::vector<std::string>{"sim:contacts?rate=100&rows=3&cols=4: the simulator loads its array to "
                                           "calibrate it"});
}

TEST(ServedSuit, asks_for_the_model_of_a_device_and_of_a_simulated_calibration) {
  for (const std::string from : {"tcp://127.0.0.1:7000", "sim:rehearsal?rate=100"}) {
    EXPECT_EQ(refusal({.from = from}), "'" + from + "': name its model, too, or its array.toml");
  }
}

TEST(ServedSuit, opens_all_arrays_of_a_suit_where_they_sit) {
  const ModelFolder folder;
  write_bytes(folder.file("suit.toml"),
              "[suit]\nname = \"jacket\"\n"
              "[[array]]\nname = \"left\"\nfrom = \"sim:contacts?rate=50\"\nmodel = \"model.safetensors\"\n"
              "[[array]]\nname = \"right\"\nfrom = \"sim:contacts?rate=100\"\nmodel = \"model.safetensors\"\n"
              "base_from_array = {translation_mm = [100, 0, 0]}\n");
  const Result<ServedSuit> suit = open_suit({.suit = folder.file("suit.toml")});
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->name, "jacket");
  ASSERT_EQ(suit->arrays.size(), 2U);
  EXPECT_EQ(suit->arrays[0].name, "left");
  EXPECT_EQ(suit->arrays[1].surface.taxels()[0].position, (Vector3{0.1, 0.0, 0.0}));
  EXPECT_EQ(suit->arrays[0].model, suit->arrays[1].model) << "a file that two arrays name is read once";
}

TEST(ServedSuit, names_the_first_of_several_sources_that_cannot_be_opened) {
  const ModelFolder folder;
  write_bytes(folder.file("suit.toml"),
              "[[array]]\nname = \"sound\"\nfrom = \"sim:contacts?rate=50\"\nmodel = \"model.safetensors\"\n"
              "[[array]]\nname = \"first\"\nfrom = \"sim:contacts\"\nmodel = \"model.safetensors\"\n"
              "[[array]]\nname = \"second\"\nfrom = \"frames.csv\"\nmodel = \"model.safetensors\"\n");
  EXPECT_EQ(refusal({.suit = folder.file("suit.toml")}),
            "'sim:contacts': say how many frames a second it sends, such as sim:contacts?rate=100");
}

TEST(ServedSuit, puts_arrays_on_the_links_of_a_body) {
  const ModelFolder folder;
  write_bytes(folder.file("robot.urdf"),
              "<robot name=\"r\"><link name=\"trunk\"/><link name=\"arm\"/><joint name=\"j\" type=\"revolute\">"
              "<parent link=\"trunk\"/><child link=\"arm\"/><origin xyz=\"0 0 1\"/></joint></robot>");
  const auto suit_on = [&](const std::string& link) {
    write_bytes(folder.file("suit.toml"),
                "[suit]\nbody = \"robot.urdf\"\n[[array]]\nname = \"sleeve\"\n"
                "from = \"sim:contacts?rate=50\"\nmodel = \"model.safetensors\"\nlink = \"" +
                    link + "\"\nbase_from_array = {translation_mm = [100, 0, 0]}\n");
    return folder.file("suit.toml");
  };
  const Result<ServedSuit> suit = open_suit({.suit = suit_on("arm")});
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays[0].surface.taxels()[0].position, (Vector3{0.1, 0.0, 1.0}));
  ASSERT_NE(suit->body, nullptr);
  EXPECT_EQ(suit->body->link_of(0), "arm");
  EXPECT_EQ(refusal({.suit = suit_on("leg")}), "array 'sleeve': link: the body 'r' has no 'leg'");
}

TEST(ServedSuit, opens_the_arrays_of_a_recording_by_their_names) {
  const ModelFolder folder;
  const auto writer = bytes::recordings::SuitRecordingWriter::create(
      folder.file("rec.mcap"), {{.name = "other", .shape = {2, 2}}, {.name = "chest", .shape = {kRows, kCols}}});
  ASSERT_TRUE(writer);
  RawFrame frame;
  frame.time = Nanos(1);
  frame.counts.assign(kRows * kCols, 1.0F);
  ASSERT_TRUE((*writer)->write(1, frame));
  ASSERT_TRUE((*writer)->commit());
  write_bytes(folder.file("suit.toml"),
              "[[array]]\nname = \"chest\"\nfrom = \"sim:contacts?rate=50\"\nmodel = \"model.safetensors\"\n");
  const Result<ServedSuit> suit = open_suit({.from = folder.file("rec.mcap"), .suit = folder.file("suit.toml")});
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_NE(suit->playback, nullptr);
  EXPECT_EQ(suit->arrays[0].source->shape(), (FrameShape{kRows, kCols}));

  const std::string rec = folder.file("rec.mcap");
  EXPECT_EQ(refusal({.from = rec, .model = folder.model()}),
            rec + ": has no array 'hand_made'; it has: 'other', 'chest'");
  EXPECT_EQ(refusal({.from = rec + "#other", .model = folder.model()}),
            "'" + rec + "#other': array 'hand_made' has 2x2 taxels, its model 3x4");
}

TEST(ServedSuit, refuses_what_cannot_be_served) {
  const ModelFolder folder;
  EXPECT_NE(
      refusal({.from = "sim:contacts?rate=100", .model = folder.file("none.safetensors")}).find("none.safetensors"),
      std::string::npos);
  EXPECT_NE(refusal({.suit = folder.file("none.toml")}).find("none.toml"), std::string::npos);
  EXPECT_EQ(refusal({.from = "frames.csv", .model = folder.model()}),
            "'frames.csv': only devices and recordings are served; make a recording of it first: convert frames.csv to "
            ".mcap");
  EXPECT_EQ(refusal({.from = "sim:contacts?seed=2", .model = folder.model()}),
            "'sim:contacts?seed=2': say how many frames a second it sends, such as sim:contacts?seed=2&rate=100");
  EXPECT_NE(refusal({.from = "sim:contacts?rate=100&bogus=1", .model = folder.model()}).find("bogus"),
            std::string::npos);
}

TEST(ServedSuit, opens_classes_and_limits_and_says_which_file_does_not_fit) {
  const ModelFolder folder;
  const std::string classes = folder.file("classes.safetensors");
  const std::string limits = folder.file("threats.toml");
  ASSERT_TRUE(learn::recognition::write_classes(classes, left_and_right()));
  write_bytes(limits,
              "[[zone]]\nname = \"tip\"\narray = \"hand made\"\nrows = [0, 1]\ncols = [0, 1]\n"
              "[[threat]]\nname = \"tip\"\nquantity = \"taxel_force\"\nlimit_n = 5\nzone = \"tip\"\n");
  SuitPlace place{
      .from = "sim:contacts?rate=100", .model = folder.model(), .suit = "", .classes = classes, .threats = limits};
  const Result<ServedSuit> suit = open_suit(place);
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays[0].classes->names, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(suit->threats->zones[0].array, suit->arrays[0].name) << "as topics have it";

  learn::recognition::Classes unlike = left_and_right();
  unlike.layout.arrays[0].row_pitch_mm = unlike.layout.arrays[0].col_pitch_mm = 0.0;
  ASSERT_TRUE(learn::recognition::write_classes(classes, unlike));
  EXPECT_TRUE(refusal(place).starts_with(classes + ": array 'hand_made' has 3x4 taxels")) << refusal(place);
  place.classes.clear();
  write_bytes(limits,
              "[[zone]]\nname = \"tip\"\narray = \"chset\"\nrows = [0, 1]\ncols = [0, 1]\n"
              "[[threat]]\nname = \"tip\"\nquantity = \"taxel_force\"\nlimit_n = 5\nzone = \"tip\"\n");
  EXPECT_EQ(refusal(place), limits + ": no threat is for what is served; its zones are of other arrays");
}

TEST(SuitJson, tells_the_classes_of_an_array_and_the_limits_that_hold_there) {
  ServedSuit suit = small_suit({"left", "right"}, kNever);
  suit.arrays[0].classes = left_and_right();
  suit.threats = live::threats::ThreatLimits{
      {{"palm", "right", 0, 1, 2, 3}},
      {{.name = "pushed", .quantity = live::threats::ThreatQuantity::total_force, .limit = 50.0},
       {.name = "palm", .quantity = live::threats::ThreatQuantity::taxel_pressure, .limit = 2e5, .zone = "palm"}}};
  const nlohmann::json arrays = nlohmann::json::parse(suit_json(suit, ModelsInUse(suit)))["arrays"];
  EXPECT_EQ(arrays[0]["classes"], (nlohmann::json{"left", "right"}));
  EXPECT_FALSE(arrays[1].contains("classes"));
  const nlohmann::json pushed = {
      {"name", "pushed"}, {"quantity", "total_force"}, {"limit", 50.0}, {"unit", "N"}, {"zone", nullptr}};
  const nlohmann::json zone = {{"name", "palm"}, {"rows", {0, 1}}, {"cols", {2, 3}}};
  const nlohmann::json palm = {
      {"name", "palm"}, {"quantity", "taxel_pressure"}, {"limit", 2e5}, {"unit", "Pa"}, {"zone", zone}};
  EXPECT_EQ(arrays[0]["limits"], nlohmann::json::array({pushed}));
  EXPECT_EQ(arrays[1]["limits"], nlohmann::json::array({pushed, palm}));
}

TEST(SuitJson, tells_clients_what_the_arrays_are) {
  const ServedSuit suit = small_suit({"left", "right"}, kNever);
  ModelsInUse models(suit);
  const auto json = [&] { return nlohmann::json::parse(suit_json(suit, models)); };
  EXPECT_EQ(json()["name"], "suit");
  EXPECT_EQ(json()["arrays"].size(), 2U);
  const nlohmann::json left = json()["arrays"][0];
  EXPECT_EQ(left["name"], "left");
  EXPECT_EQ(left["rows"], kRows);
  EXPECT_EQ(left["cols"], kCols);
  EXPECT_EQ(left["full_scale_counts"], (1 << 24) - 1);
  EXPECT_EQ(left["full_scale_n"], 50.0) << "the model does not say how much it was loaded";
  EXPECT_EQ(left["positions"].size(), kRows * kCols);
  EXPECT_EQ(left["normals"][0], (std::vector<double>{0.0, 0.0, 1.0}));

  auto calibrated = std::make_shared<touch::pipeline::Model>(*models.of(1));
  calibrated->networks.heaviest_newtons.assign(kRows * kCols, 20.0F);
  models.replace(1, calibrated);
  EXPECT_TRUE(models.is_new(1));
  EXPECT_FALSE(models.is_new(0));
  EXPECT_EQ(json()["arrays"][1]["full_scale_n"], 20.0);
}

}  // namespace
}  // namespace dermis::out::serve
