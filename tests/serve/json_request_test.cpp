// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/requests/json_request.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::serve {
namespace {

std::string text_error(const std::string& request, std::size_t most_bytes = JsonRequest::kMostNameBytes) {
  const auto text = JsonRequest::parse(request)->text("name", most_bytes);
  return text ? "" : text.error().message;
}

TEST(JsonRequest, is_an_object_of_at_most_4_kib) {
  EXPECT_TRUE(JsonRequest::parse("{}"));
  for (const std::string& text : {std::string("[]"), std::string("{"), std::string(), std::string(5000, ' ') + "{}"}) {
    EXPECT_EQ(JsonRequest::parse(text).error().message, "the request is no JSON object of at most 4 KiB");
  }
}

TEST(JsonRequest, a_field_that_is_not_there_is_empty) {
  const auto request = JsonRequest::parse("{}");
  EXPECT_EQ(request->text("name").value(), "");
  EXPECT_FALSE(request->number("id", "one").value());
}

TEST(JsonRequest, a_text_is_short_and_fits_into_a_csv_file) {
  EXPECT_EQ(JsonRequest::parse(R"({"name": "Käfer 7"})")->text("name").value(), "Käfer 7");
  EXPECT_EQ(text_error(R"({"name": 7})"), "name: must be a text");
  EXPECT_EQ(text_error(R"({"name": "abc"})", 2), "name: must have at most 2 bytes, without commas and quotes");
  for (const char* const text : {R"({"name": "a,b"})", R"({"name": "a\"b"})", R"({"name": "a\nb"})"}) {
    EXPECT_EQ(text_error(text), "name: must have at most 60 bytes, without commas and quotes") << text;
  }
}

TEST(JsonRequest, a_name_for_a_file_leads_to_no_other_folder) {
  EXPECT_EQ(JsonRequest::parse(R"({"name": "walk-2_b"})")->file_name("name").value(), "walk-2_b");
  for (const char* const name : {"", "../x", "a/b", "a.mcap", ".", "a b", "\u00e4"}) {
    const auto request = JsonRequest::parse(std::string(R"({"name": ")") + name + "\"}");
    EXPECT_EQ(request->file_name("name").error().message, "name: must be letters, digits, '_' and '-'") << name;
  }
}

TEST(JsonRequest, a_switch_is_true_or_false) {
  EXPECT_TRUE(JsonRequest::parse(R"({"on": true})")->flag("on").value());
  EXPECT_FALSE(JsonRequest::parse("{}")->flag("on").value());
  EXPECT_EQ(JsonRequest::parse(R"({"on": 1})")->flag("on").error().message, "on: must be true or false");
}

TEST(JsonRequest, a_number_is_whole_and_not_below_0) {
  EXPECT_EQ(JsonRequest::parse(R"({"id": 7})")->number("id", "one").value(), 7U);
  for (const char* const text : {R"({"id": -1})", R"({"id": 0.5})", R"({"id": "7"})"}) {
    EXPECT_EQ(JsonRequest::parse(text)->number("id", "one").error().message, "id: must be one") << text;
  }
}

}  // namespace
}  // namespace dermis::serve
