// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What is particular to 3dvitac, csv and json; what holds for all protocols is in protocol_test.cpp.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "bytes/devices/decoding.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::devices {
namespace {

using Counts = std::vector<std::vector<float>>;

Counts decode_text(const ProtocolOptions& options, std::string_view text) {
  return counts_of(decode_all(*decoder_for(options), bytes_of(text)));
}

Counts random_counts(std::size_t frames, std::size_t taxels, std::uint64_t seed) {
  Random random(seed);
  Counts counts(frames, std::vector<float>(taxels));
  for (std::vector<float>& frame : counts) {
    for (float& count : frame) count = static_cast<float>(random.below(1024));
  }
  return counts;
}

struct Dialect {
  std::string name;
  std::string divider;
  std::string row_end;
  std::string before_frame;
  std::string after_frame;
};

std::string write(const Counts& frames, std::size_t cols, const Dialect& dialect) {
  std::string text;
  for (const std::vector<float>& frame : frames) {
    text += dialect.before_frame;
    for (std::size_t i = 0; i < frame.size(); ++i) {
      text += std::to_string(static_cast<int>(frame[i])) + ((i + 1) % cols == 0 ? dialect.row_end : dialect.divider);
    }
    text += dialect.after_frame;
  }
  return text;
}

/// `start`, and 20 more for each `lines_per_frame` lines, before each line that is not empty.
std::string with_time(const std::string& text, std::size_t lines_per_frame, std::uint64_t start) {
  std::string timed;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t k = 0; std::getline(lines, line); ++k) {
    if (!line.empty()) timed += std::to_string(start + 20 * (k / lines_per_frame)) + ",";
    timed += line + "\n";
  }
  return timed;
}

std::string repeated(const std::string& line, std::size_t times) {
  std::string text;
  for (std::size_t k = 0; k < times; ++k) text.append(line).append("\n");
  return text;
}

const std::vector<Dialect> kDialects = {
    {"comma and rule", ",", "\r\n", "", "-----\r\n"},
    {"comma, trailing, and empty line", ",", ",\r\n", "", "\r\n"},
    {"semicolon", ";", "\n", "", "====\n"},
    {"comma and space", ", ", "\n", "", "\n"},
    {"spaces of a table", "   ", "\n", "", "***\n"},
    {"tabs, trailing", "\t", "\t\r\n", "", "\r\n\r\n"},
    {"label before the frame", ",", "\n", "Frame 17:\n", ""},
    {"rule before the frame", " ", "\n", "-----\n", ""},
};

TEST(Csv, learns_rows_and_columns_of_every_dialect_and_delivers_the_first_frames_too) {
  for (const Dialect& dialect : kDialects) {
    for (const FrameShape shape : {FrameShape{16, 16}, FrameShape{6, 4}, FrameShape{12, 32}, FrameShape{2, 1}}) {
      SCOPED_TRACE(dialect.name + ", " + std::to_string(shape.rows) + "x" + std::to_string(shape.cols));
      const Counts frames = random_counts(5, shape.taxel_count(), 7);
      const std::string text = write(frames, shape.cols, dialect) + dialect.before_frame;
      const auto decoder = decoder_for({.name = "csv"});
      EXPECT_EQ(counts_of(push_all(*decoder, bytes_of(text))), frames);
      EXPECT_EQ(decoder->shape(), shape);
      EXPECT_EQ(decoder->counts().damaged_frames, 0U);
      EXPECT_EQ(counts_of(decode_all(*decoder_for({.name = "csv", .shape = shape}), bytes_of(text))), frames);
    }
  }
}

TEST(Csv, takes_a_line_for_a_frame_where_the_shape_is_given_announced_or_square) {
  const Dialect lines = {"", ",", ",", "", "\n"};
  const Counts frames = random_counts(200, 48, 3);
  const std::string text = write(frames, 48, lines);
  EXPECT_EQ(decode_text({.name = "csv", .shape = FrameShape{6, 8}}, text), frames);
  EXPECT_EQ(decode_text({.name = "csv"}, "hello\nCFG,6,8\n" + text), frames);
  EXPECT_TRUE(decode_text({.name = "csv"}, text).empty());

  const Counts squares = random_counts(200, 64, 4);
  const auto decoder = decoder_for({.name = "csv"});
  EXPECT_EQ(counts_of(push_all(*decoder, bytes_of(write(squares, 64, lines)))), squares);
  EXPECT_EQ(decoder->shape(), (FrameShape{8, 8}));
}

TEST(Csv, takes_few_lines_for_frames_where_the_device_pauses_or_ends) {
  const Counts frames = random_counts(6, 64, 4);
  const std::string text = write(frames, 64, {"", ",", "\n", "", ""});
  EXPECT_EQ(decode_text({.name = "csv"}, text), frames);

  const Counts small = random_counts(6, 4, 4);
  for (const std::string name : {"csv", "auto"}) {
    const auto decoder = decoder_for({.name = name});
    RawFrame frame;
    Counts decoded;
    for (const std::vector<float>& counts : small) {
      decoder->push(bytes_of(write({counts}, 4, {"", ",", "\n", "", ""})));
      while (decoder->next(frame)) decoded.push_back(frame.counts);
      decoder->idle();
      while (decoder->next(frame)) decoded.push_back(frame.counts);
    }
    EXPECT_EQ(decoded, small);
    EXPECT_EQ(decoder->shape(), (FrameShape{2, 2}));
  }
}

TEST(Csv, keeps_to_rows_where_the_device_pauses_between_frames) {
  const Counts frames = random_counts(6, 16, 4);
  const auto decoder = decoder_for({.name = "csv"});
  Counts decoded;
  for (const std::vector<float>& counts : frames) {
    const Counts more = counts_of(push_all(*decoder, bytes_of(write({counts}, 4, kDialects[0]))));
    decoded.insert(decoded.end(), more.begin(), more.end());
    decoder->idle();
  }
  EXPECT_EQ(decoded, frames);
}

TEST(Csv, delivers_a_frame_with_its_last_row) {
  const auto decoder = decoder_for({.name = "csv", .shape = FrameShape{2, 2}});
  EXPECT_TRUE(push_all(*decoder, bytes_of("---\n1,2\n3,4")).empty());
  EXPECT_EQ(counts_of(push_all(*decoder, bytes_of("\n"))), (Counts{{1, 2, 3, 4}}));
  EXPECT_EQ(decoder->frame_end(), 12U);
  EXPECT_TRUE(push_all(*decoder, bytes_of("---\n5,6\n7,")).empty());
}

TEST(Csv, does_not_take_the_end_of_a_line_for_a_row) {
  EXPECT_EQ(decode_text({.name = "csv", .shape = FrameShape{2, 2}}, "8,9\n1,2,3,4\n5,6,7,8\n"),
            (Counts{{1, 2, 3, 4}, {5, 6, 7, 8}}));
}

TEST(Csv, reads_decimals_and_the_widest_converters) {
  EXPECT_EQ(decode_text({.name = "csv", .shape = FrameShape{1, 4}}, "0.5,12.25 16777215;00000007\n"),
            (Counts{{0.5F, 12.25F, 16777215.0F, 7.0F}}));
}

TEST(Csv, drops_frames_with_a_line_that_cannot_be) {
  for (const std::string line : {"1,2", "1,2,3,4", "1,,3", "1,2,x", "1,2,3x", "1,-2,3", "1,2,nan", "1,2,16777216",
                                 "1,2,123456789", "1,2,3.", "1,2,3.4.5", "1,2\r,3", "-1,2,3"}) {
    SCOPED_TRACE(line);
    const std::string text = "1,2,3\n4,5,6\n\n1,2,3\n" + line + "\n\n7,8,9\n1,2,3\n\n";
    const auto decoder = decoder_for({.name = "csv", .shape = FrameShape{2, 3}});
    EXPECT_EQ(counts_of(decode_all(*decoder, bytes_of(text))), (Counts{{1, 2, 3, 4, 5, 6}, {7, 8, 9, 1, 2, 3}}));
    EXPECT_EQ(decoder->counts().damaged_frames, 1U);
  }
}

TEST(Csv, after_a_lost_separator_waits_for_the_next_one) {
  const std::string text = "1,1\n2,2\n\n3,3\n4,4\n5,5\n6,6\n\n7,7\n8,8\n\n";
  EXPECT_EQ(decode_text({.name = "csv", .shape = FrameShape{2, 2}}, text),
            (Counts{{1, 1, 2, 2}, {3, 3, 4, 4}, {7, 7, 8, 8}}));
}

TEST(Csv, skips_boot_messages) {
  const Counts frames = random_counts(6, 16, 5);
  const std::string boot = "ets Jul 29 2019 12:21:46\r\nrst:0x1 (POWERON_RESET)\r\n40 mV\r\nready\r\n";
  const auto decoder = decoder_for({.name = "csv"});
  EXPECT_EQ(counts_of(decode_all(*decoder, bytes_of(boot + write(frames, 4, kDialects[0])))), frames);
  EXPECT_EQ(decoder->counts().skipped_bytes, boot.size());
}

TEST(Csv, ignores_a_first_frame_of_which_it_saw_only_the_end) {
  const Counts frames = random_counts(6, 32, 6);
  const std::string text = write(frames, 4, kDialects[0]);
  const auto decoder = decoder_for({.name = "csv"});
  EXPECT_EQ(counts_of(decode_all(*decoder, bytes_of(text.substr(20)))), Counts(frames.begin() + 1, frames.end()));
  EXPECT_EQ(decoder->shape(), (FrameShape{8, 4}));
}

TEST(Csv, takes_a_number_that_rises_from_frame_to_frame_for_a_time_and_not_for_a_reading) {
  for (const std::uint64_t start : {0ULL, 4'294'000'000ULL, 1'732'512'345'000ULL}) {
    SCOPED_TRACE(start);
    const Counts frames = random_counts(12, 120, 5);
    const std::string lines = with_time(write(frames, 120, {"", ",", "\n", "", ""}), 1, start);
    EXPECT_EQ(decode_text({.name = "csv", .shape = FrameShape{12, 10}}, lines), frames);
    EXPECT_TRUE(decode_text({.name = "csv"}, lines).empty()) << "121 values are not 11x11";

    const std::string rows = with_time(write(frames, 10, {"", ",", "\n", "", "\n"}), 13, start);
    EXPECT_EQ(decode_text({.name = "csv", .shape = FrameShape{12, 10}}, rows), frames);
    EXPECT_EQ(decode_text({.name = "csv"}, rows), frames);

    const Counts squares = random_counts(12, 64, 5);
    EXPECT_EQ(decode_text({.name = "csv"}, with_time(write(squares, 64, {"", ",", "\n", "", ""}), 1, start)), squares);
  }
}

TEST(Csv, takes_a_first_number_that_stops_rising_for_a_reading) {
  Counts frames = random_counts(200, 16, 5);
  for (std::size_t k = 0; k < 60; ++k) frames[k][0] = static_cast<float>(10 * k);
  EXPECT_EQ(decode_text({.name = "csv"}, write(frames, 16, {"", ",", "\n", "", ""})), frames);
}

TEST(Csv, does_not_take_rows_without_a_separator_for_frames) {
  Counts frames = random_counts(1, 256, 5);
  frames.resize(50, frames[0]);
  const std::string text = write(frames, 16, {"", ",", "\n", "", ""});
  const auto unknown = decoder_for({.name = "csv"});
  EXPECT_TRUE(decode_all(*unknown, bytes_of(text)).empty());
  for (const std::string boot : {"", "ready\n"}) {
    const auto given = decoder_for({.name = "csv", .shape = FrameShape{16, 16}});
    EXPECT_TRUE(push_all(*given, bytes_of(boot + text)).empty());
    EXPECT_NE(given->advice().find("print an empty line between frames"), std::string::npos) << given->advice();
  }
}

TEST(Csv, says_that_separators_are_missing_where_only_the_first_came) {
  const std::string text = "\n" + write(random_counts(9, 6, 5), 3, {"", ",", "\n", "", ""});
  const auto decoder = decoder_for({.name = "csv", .shape = FrameShape{2, 3}});
  push_all(*decoder, bytes_of(text));
  EXPECT_NE(decoder->advice().find("print an empty line between frames"), std::string::npos) << decoder->advice();
  push_all(*decoder, bytes_of("\n1,2,3\n4,5,6\n\n"));
  EXPECT_EQ(decoder->advice(), "");
}

TEST(Csv, asks_for_rows_and_cols_where_a_line_is_no_square) {
  const auto decoder = decoder_for({.name = "csv"});
  EXPECT_TRUE(push_all(*decoder, bytes_of(write(random_counts(30, 120, 5), 120, {"", ",", "\n", "", ""}))).empty());
  EXPECT_NE(decoder->advice().find("rows=12&cols=10"), std::string::npos) << decoder->advice();
}

TEST(Json, reads_the_only_array_of_a_line) {
  for (const std::string line :
       {"[[1,2],[3,4],[5,6.5]]", R"({"t":17,"data":[[1,2],[3,4],[5,6.5]]})", R"({"d" : [[1, 2], [3, 4], [5, 6.5]] } )",
        R"({"a":{"name":"m\"]","on":true},"data":[[1,2],[3,4],[5,6.5]],"v":-1.5e3})"}) {
    SCOPED_TRACE(line);
    const auto decoder = decoder_for({.name = "json"});
    EXPECT_EQ(counts_of(push_all(*decoder, bytes_of("boot\n" + repeated(line, 3)))), Counts(3, {1, 2, 3, 4, 5, 6.5F}));
    EXPECT_EQ(decoder->shape(), (FrameShape{3, 2}));
  }
}

TEST(Json, drops_lines_that_cannot_be) {
  for (const std::string line :
       {"[1,2,3,4,5]", "[1,2,3,4,5,6", "[1,2,3,4,5,6]]", "[[1,2],[3,4],[5,6]]", "[1,2,3,4,5,-6]", "[1,2,3,4,5,null]",
        R"({"a":[1,2,3,4,5,6],"b":[1]})", R"({"a":[1,2,3,4,5,6])", "{}", "[]", "[[1,2],[3]]", "[1,2,3,4,5,16777216]",
        "[16777216,2,3,4,5,6]"}) {
    SCOPED_TRACE(line);
    const auto decoder = decoder_for({.name = "json", .shape = FrameShape{2, 3}});
    EXPECT_EQ(counts_of(decode_all(*decoder, bytes_of(repeated("[1,2,3,4,5,6]\n" + line, 2)))),
              Counts(2, {1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(decoder->counts().damaged_frames, 2U);
  }
}

TEST(Json, asks_for_rows_and_cols_where_a_list_is_no_square) {
  const auto decoder = decoder_for({.name = "json"});
  EXPECT_TRUE(push_all(*decoder, bytes_of("[1,2,3,4,5,6]\n[1,2,3,4,5,6]\n[1,2,3,4,5,6]\n[1,2,3,4,5,6]\n")).empty());
  EXPECT_NE(decoder->advice().find("rows=3&cols=2"), std::string::npos) << decoder->advice();
}

TEST(ThreeDViTac, reads_what_the_sketch_prints) {
  const std::string text = "0 1 2 \r\n3 40 500 \r\n\r\n65535 1 2 \r\n3 4 5 \r\n\r\n0 0 0 \r\n1 1 1 \r\n\r\n";
  const auto decoder = decoder_for({.name = "3dvitac"});
  EXPECT_EQ(counts_of(push_all(*decoder, bytes_of(text))),
            (Counts{{0, 1, 2, 3, 40, 500}, {65535, 1, 2, 3, 4, 5}, {0, 0, 0, 1, 1, 1}}));
  EXPECT_EQ(decoder->shape(), (FrameShape{2, 3}));
  EXPECT_EQ(decoder->counts().skipped_bytes, 0U);
}

TEST(ThreeDViTac, drops_frames_that_are_not_as_the_sketch_prints_them) {
  for (const std::string rows : {"1 2 \r\n", "1 2 \r\n3 4 \r\n5 6 \r\n"}) {
    const auto decoder = decoder_for({.name = "3dvitac", .shape = FrameShape{2, 2}});
    push_all(*decoder, bytes_of("9 9 \r\n9 9 \r\n\r\n" + rows + "\r\n"));
    EXPECT_EQ(decoder->counts().damaged_frames, 1U) << rows;
  }
  for (const std::string row : {"1 ", "1 2 3 ", "1  2 ", "1,2 ", "1 x ", "1 65536 ", "1 000001 ", " 1 2", "-1 2 "}) {
    SCOPED_TRACE(row);
    const auto decoder = decoder_for({.name = "3dvitac", .shape = FrameShape{2, 2}});
    const std::string text = "9 9 \r\n9 9 \r\n\r\n1 2 \r\n" + row + "\r\n\r\n5 6 \r\n7 8 \r\n\r\n";
    EXPECT_EQ(counts_of(push_all(*decoder, bytes_of(text))), (Counts{{9, 9, 9, 9}, {5, 6, 7, 8}}));
    EXPECT_EQ(decoder->counts().damaged_frames, 1U);
  }
}

}  // namespace
}  // namespace dermis::bytes::devices
