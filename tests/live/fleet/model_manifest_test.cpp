// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/model_manifest.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::live::fleet {
namespace {

PushedModel model_of(char digit) {
  return {.name = "chest.safetensors",
          .sha256 = std::string(64, digit),
          .bytes = 300'000,
          .pieces = 2,
          .time = Nanos(1'760'000'000'000'000'000)};
}

ModelManifest manifest_with(std::size_t models) {
  ModelManifest manifest{.robot = "anna", .array = "chest"};
  for (std::size_t i = 0; i < models; ++i) manifest.add(model_of("0123456789abcdef"[i % 16]));
  return manifest;
}

/// The JSON of a manifest with two models, in which a text is another.
std::string json_with(const std::string& old_text, const std::string& new_text) {
  std::string json = manifest_to_json(manifest_with(2));
  const std::size_t place = json.find(old_text);
  EXPECT_NE(place, std::string::npos) << json;
  return json.replace(place, old_text.size(), new_text);
}

TEST(ModelManifest, a_push_makes_a_model_current) {
  const ModelManifest manifest = manifest_with(3);
  EXPECT_EQ(manifest.current, 3U);
  EXPECT_EQ(manifest.current_model().sha256, std::string(64, '2'));
}

TEST(ModelManifest, has_the_last_ten_models) {
  const ModelManifest manifest = manifest_with(12);
  ASSERT_EQ(manifest.models.size(), 10U);
  EXPECT_EQ(manifest.models.front().number, 3U);
  EXPECT_EQ(manifest.current, 12U);
}

TEST(ModelManifest, goes_back_model_by_model_to_the_oldest) {
  ModelManifest manifest = manifest_with(3);
  EXPECT_TRUE(manifest.roll_back());
  EXPECT_EQ(manifest.current, 2U);
  EXPECT_TRUE(manifest.roll_back());
  EXPECT_EQ(manifest.roll_back().error().message, "anna/chest: has no model before the current one");
  EXPECT_EQ(manifest.current, 1U);
}

TEST(ModelManifest, a_push_after_a_roll_back_has_a_new_number) {
  ModelManifest manifest = manifest_with(3);
  EXPECT_TRUE(manifest.roll_back());
  manifest.add(model_of('f'));
  EXPECT_EQ(manifest.current, 4U);
  EXPECT_EQ(manifest.models.size(), 4U);
}

TEST(ModelManifest, is_the_same_after_json) {
  for (const std::size_t models : {1U, 10U}) {
    const ModelManifest manifest = manifest_with(models);
    const auto read = manifest_from_json(manifest_to_json(manifest));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, manifest);
  }
}

TEST(ManifestFromJson, refuses_texts_that_are_no_manifest) {
  for (const char* text : {"", "null", "[]", "{}", "{\"models\": 3}", "{\"models\": []}", "\xFF\xFE", "{\"models\": [",
                           R"({"robot": "anna", "array": "chest", "current": 0, "models": []})"}) {
    EXPECT_FALSE(manifest_from_json(text)) << text;
  }
  EXPECT_FALSE(manifest_from_json(std::string(1 << 20, '[')));
  EXPECT_FALSE(manifest_from_json(std::string(65'000, '[')));
}

TEST(ManifestFromJson, refuses_values_that_cannot_be) {
  const std::string digits(64, '0');
  const std::pair<std::string, std::string> wrong[] = {
      {"\"anna\"", "\"a.b\""},
      {"\"anna\"", "\"*\""},
      {"\"chest\"", "\"../chest\""},
      {"\"chest\"", "7"},
      {"\"current\":2", "\"current\":3"},
      {"\"current\":2", "\"current\":-2"},
      {"\"number\":1", "\"number\":0"},
      {"\"number\":1", "\"number\":2"},
      {"\"number\":2", "\"number\":18446744073709551615"},
      {"\"bytes\":300000", "\"bytes\":0"},
      {"\"bytes\":300000", "\"bytes\":1e9"},
      {"\"bytes\":300000", "\"bytes\":268435457"},
      {"\"pieces\":2", "\"pieces\":0"},
      {"\"pieces\":2", "\"pieces\":4097"},
      {digits, digits.substr(1)},
      {digits, "../../" + digits.substr(6)},
      {digits, "A" + digits.substr(1)},
      {"chest.safetensors", "chest\\nmodel 2 is in use"},
      {"chest.safetensors", std::string(256, 'a')},
  };
  for (const auto& [old_text, new_text] : wrong) {
    const auto read = manifest_from_json(json_with(old_text, new_text));
    ASSERT_FALSE(read) << new_text;
    EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
    EXPECT_TRUE(read.error().message.starts_with("a list of pushed models: ")) << read.error().message;
  }
}

TEST(ManifestFromJson, refuses_more_than_ten_models) {
  ModelManifest manifest = manifest_with(10);
  manifest.models.push_back(model_of('0'));
  manifest.models.back().number = 11;
  EXPECT_FALSE(manifest_from_json(manifest_to_json(manifest)));
}

}  // namespace
}  // namespace dermis::live::fleet
