// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/arrangement.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "dermis/bytes/files/array_toml.hpp"
#include "learn/arrangement/board.hpp"

namespace dermis::learn::arrangement {
namespace {

using testing::shuffled;

Press press_of(std::size_t channel, double change = 500.0) {
  return {.channel = channel, .change = change, .second = 0, .second_share = 0.2};
}

Answers answers_in(const std::vector<int>& channels) {
  Answers answers;
  for (const int channel : channels)
    answers.push_back(channel < 0 ? std::nullopt : std::optional(press_of(static_cast<std::size_t>(channel))));
  return answers;
}

Places palm(std::size_t count) {
  std::vector<bytes::files::NamedPlace> places(count);
  for (std::size_t k = 0; k < count; ++k) places[k].position = {0.004 * static_cast<double>(k), 0.001, 0.0};
  places.front().name = "thumb";
  return *places_of(std::move(places));
}

Arrangement arranged(const Places& places, const std::vector<int>& channels, FrameShape sent) {
  Result<Arrangement> made = arrange(places, answers_in(channels), sent, 1000.0, "hand");
  EXPECT_TRUE(made) << made.error().message;
  return *made;
}

/// The channels of the array's taxels, from its description as a file has it.
std::vector<std::size_t> read_back(const ArrayDescription& array, FrameShape sent) {
  const Result<ArrayDescription> read = bytes::files::array_from_toml(bytes::files::array_to_toml(array), "hand.toml");
  EXPECT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->order.sent({read->rows, read->cols}), sent);
  return read->order.sent_places(sent);
}

std::vector<std::size_t> plain(const std::vector<int>& channels) {
  return {channels.begin(), channels.end()};
}

TEST(Arrangement, orders_the_channels_of_taxels_in_no_grid) {
  const std::vector<int> channels = shuffled(17);
  const Arrangement made = arranged(palm(17), channels, {1, 17});
  EXPECT_EQ(made.array.rows, 1U);
  EXPECT_EQ(made.array.cols, 17U);
  EXPECT_EQ(read_back(made.array, {1, 17}), plain(channels));
  EXPECT_TRUE(made.remarks.empty());
  EXPECT_EQ(made.positions.size(), 17U);
  EXPECT_NEAR(made.array.col_pitch_m, 0.004, 1e-12);
  EXPECT_EQ(made.array.readout.adc_bits, 10);
}

TEST(Arrangement, picks_few_channels_of_a_board_of_many) {
  const std::vector<int> channels = {30, 3, 12, 7, 9};
  const Arrangement made = arranged(palm(5), channels, {4, 8});
  EXPECT_EQ(read_back(made.array, {4, 8}), plain(channels));
  EXPECT_EQ(made.remarks.back(), "channels 0, 1, 2, 4, 5, 6, 8, 10, 11, 13, 14, 15 and 15 more never answered");
}

TEST(Arrangement, orders_whole_lines_of_a_grid_by_rows_and_columns) {
  const Places grid = *read_press_places("3x4", 5.0);
  std::vector<int> channels;
  for (const int row : {2, 0, 1})
    for (const int col : {3, 1, 0, 2}) channels.push_back(row * 4 + col);
  const Arrangement made = arranged(grid, channels, {3, 4});
  EXPECT_EQ(made.array.order.row_order, (std::vector<std::size_t>{2, 0, 1}));
  EXPECT_EQ(made.array.order.col_order, (std::vector<std::size_t>{3, 1, 0, 2}));
  EXPECT_TRUE(made.array.order.taxel_order.empty());
  EXPECT_EQ(read_back(made.array, {3, 4}), plain(channels));
}

TEST(Arrangement, exchanges_rows_and_columns_of_a_grid) {
  std::vector<int> channels;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 4; ++col) channels.push_back(col * 3 + row);
  const Arrangement made = arranged(*read_press_places("3x4", 5.0), channels, {4, 3});
  EXPECT_TRUE(made.array.order.transpose);
  EXPECT_TRUE(made.array.order.row_order.empty());
  EXPECT_EQ(read_back(made.array, {4, 3}), plain(channels));
}

TEST(Arrangement, orders_a_grid_whose_lines_are_mixed_taxel_by_taxel) {
  const std::vector<int> channels = shuffled(54);
  const Arrangement made = arranged(*read_press_places("6x9", 5.0), channels, {1, 54});
  EXPECT_EQ(made.array.rows, 6U);
  EXPECT_EQ(read_back(made.array, {1, 54}), plain(channels));
}

TEST(Arrangement, says_nothing_of_an_order_that_is_plain) {
  std::vector<int> channels(12);
  std::iota(channels.begin(), channels.end(), 0);
  EXPECT_TRUE(arranged(*read_press_places("3x4", 5.0), channels, {3, 4}).array.order.is_plain());
}

TEST(Arrangement, leaves_places_without_a_channel_out_and_names_them) {
  const Arrangement made = arranged(palm(4), {-1, 2, 3, 2}, {1, 4});
  EXPECT_EQ(made.array.cols, 2U);
  EXPECT_EQ(made.positions.size(), 2U);
  ASSERT_EQ(made.remarks.size(), 3U);
  EXPECT_EQ(made.remarks[0], "place 1 (thumb) never answered");
  EXPECT_EQ(made.remarks[1],
            "place 2 and place 4 are both answered by channel 2: they share it, or one was pressed twice; it is that "
            "of the first");
  EXPECT_EQ(made.remarks[2], "channels 0 and 1 never answered");
}

TEST(Arrangement, keeps_a_grid_whole_by_absent_taxels) {
  const Arrangement made = arranged(*read_press_places("2x2", 5.0), {3, -1, 1, 0}, {2, 2});
  EXPECT_EQ(made.array.absent, (std::vector<std::size_t>{1}));
  EXPECT_EQ(read_back(made.array, {2, 2}), (std::vector<std::size_t>{3, 2, 1, 0}));
}

TEST(Arrangement, tells_whether_readings_fall) {
  Answers answers = answers_in({1, 0});
  for (auto& answer : answers) answer->change = -300.0;
  const Result<Arrangement> made = arrange(palm(2), answers, {1, 2}, 4000.0, "hand");
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->array.readout.pressure_raises_reading);
}

TEST(Arrangement, doubts_two_channels_that_answer_alike) {
  Answers answers = answers_in({1, 0});
  answers[0]->second_share = 0.93;
  const Result<Arrangement> made = arrange(palm(2), answers, {1, 2}, 4000.0, "hand");
  ASSERT_TRUE(made);
  EXPECT_EQ(made->remarks.front(),
            "place 1 (thumb) was answered by channel 1, and nearly as much by channel 0 (93 %): press it again, on its "
            "middle, if in doubt");
}

TEST(Arrangement, fails_where_nothing_answered) {
  EXPECT_EQ(arrange(palm(2), answers_in({-1, -1}), {1, 2}, 4000.0, "hand").error().message,
            "no channel answered at any place");
}

TEST(AnswersOf, refuses_too_few_presses) {
  const Result<RecordedAnswers> found = answers_of({press_of(3), press_of(1)}, 3);
  ASSERT_FALSE(found);
  EXPECT_EQ(
      found.error().message,
      "2 presses were found for 3 places: a place was passed over or did not answer, and nothing tells which: press "
      "all places again, a second apart, or take those that do not answer out of the list; channels that answered: "
      "3 at 0.0 s, 1 at 0.0 s");
}

TEST(AnswersOf, leaves_weak_touches_and_a_place_that_was_pressed_twice_out) {
  const Result<RecordedAnswers> found =
      answers_of({press_of(3), press_of(5, 60.0), press_of(1), press_of(1), press_of(2)}, 3);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->answers[2]->channel, 2U);
  EXPECT_EQ(found->remarks,
            (std::vector<std::string>{"a weak touch came between the presses (channel 5 at 0.0 s): it is left out",
                                      "a place was pressed twice (channel 1 at 0.0 s): it is left out"}));
}

TEST(AnswersOf, keeps_two_places_of_one_channel_where_the_count_is_right) {
  EXPECT_TRUE(answers_of({press_of(3), press_of(3)}, 2));
  EXPECT_FALSE(answers_of({press_of(3), press_of(1), press_of(3)}, 2));
}

TEST(PressPlaces, are_a_grid_or_a_file) {
  const Result<Places> grid = read_press_places("2x3", 8.0);
  ASSERT_TRUE(grid);
  EXPECT_EQ(place_words(*grid, 4), "place 5 of 6 (row 2, column 2 from the top left)");
  EXPECT_NEAR(grid->places[5].position.x, 0.016, 1e-12);
  EXPECT_EQ(read_press_places("0x3", 8.0).error().message, "a grid has 1 to 1024 places, as 6x9");
  EXPECT_EQ(read_press_places("2x3", 0.0).error().message, "pitch: must be 0.05 to 1000 mm");
  EXPECT_EQ(place_words(palm(3), 0), "place 1 of 3 (x 0 mm, y 1 mm; thumb)");
  EXPECT_FALSE(read_press_places("none.csv", 8.0));
}

TEST(PressPlaces, name_channels_of_a_board_of_rows_twice) {
  EXPECT_EQ(channel_words(7, {1, 17}), "channel 7");
  EXPECT_EQ(channel_words(12, {4, 8}), "channel 12 (r1c4)");
}

TEST(ArrangementFiles, are_written_side_by_side) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "arrangement";
  std::filesystem::create_directories(folder);
  const std::string array = (folder / "left hand.toml").string();
  const Arrangement made = arranged(palm(3), {2, 0, 1}, {1, 3});
  ASSERT_TRUE(write_arrangement(array, made, "sim:contacts"));
  const ArrangementFiles files = arrangement_files(array);
  const Result<std::vector<Vector3>> positions = bytes::files::read_positions(files.positions);
  ASSERT_TRUE(positions);
  EXPECT_NEAR((*positions)[2].x, 0.008, 1e-9);
  const Result<SuitDescription> suit = bytes::files::read_suit(files.suit);
  ASSERT_TRUE(suit) << suit.error().message;
  EXPECT_EQ(suit->arrays.front().from, "sim:contacts");
  EXPECT_EQ(suit->arrays.front().model, array);
}

}  // namespace
}  // namespace dermis::learn::arrangement
