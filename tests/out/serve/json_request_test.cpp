// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/requests/json_request.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace dermis::out::serve {
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

TEST(JsonRequest, lists_hold_one_kind_of_value) {
  const auto request = JsonRequest::parse(R"({"name": ["a", "b"], "position": [1, 2.5], "mixed": ["a", 1, null]})");
  EXPECT_EQ(request->texts("name").value(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(request->numbers("position").value(), (std::vector<double>{1.0, 2.5}));
  for (const char* const field : {"mixed", "none"}) {
    EXPECT_EQ(request->texts(field).error().message, std::string(field) + ": must be a list of texts");
    EXPECT_EQ(request->numbers(field).error().message, std::string(field) + ": must be a list of numbers");
  }
}

TEST(JsonRequest, null_is_a_missing_number_where_some_may_be_missing) {
  const auto request = JsonRequest::parse(R"({"values": [1, null]})");
  const std::vector<double> values = request->numbers_or_null("values", 2).value();
  EXPECT_EQ(values[0], 1.0);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(request->numbers_or_null("values", 3).error().message,
            "values: must be a list of 3, as the examples had; null: missing");
}

TEST(JsonRequest, larger_requests_are_read_where_it_is_said) {
  const std::string large = R"({"name": ")" + std::string(5000, 'a') + R"("})";
  EXPECT_EQ(JsonRequest::parse(large).error().message, "the request is no JSON object of at most 4 KiB");
  EXPECT_TRUE(JsonRequest::parse(large, 8192));
}

}  // namespace
}  // namespace dermis::out::serve
