// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <cmath>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

std::string header(const std::string& units = "RAW", const std::string& seconds = "0.01") {
  return "DATA_TYPE MOVIE\r\nVERSION I-Scan 7.60\r\nFILENAME C:\\a,b.fsx\r\nROWS 2\r\nCOLS 3\r\nROW_SPACING 1.27 mm\r\n"
         "SECONDS_PER_FRAME " +
         seconds + "\r\nSCALE_FACTOR 1\r\nSTART_FRAME 5\r\nEND_FRAME 7\r\nUNITS " + units +
         "\r\nMIRROR_ROW 0\r\nASCII_DATA @@\r\n\r\n";
}

const std::string kTwo = "Frame 5\r\n0,1,2\r\n3,4,5\r\n\r\nFrame 7\r\n6,7,8\r\n9,10,11\r\n\r\n@@\r\n";
const Frames kCounts = {{0, 1, 2, 3, 4, 5}, {6, 7, 8, 9, 10, 11}};

TEST(Tekscan, reads_a_movie) {
  Importer importer(open_tekscan);
  EXPECT_EQ(importer.counts(header() + kTwo), kCounts);
  EXPECT_EQ(importer.shape(), (FrameShape{2, 3}));
  EXPECT_EQ(importer.seconds(header() + kTwo), (std::vector<double>{0.0, 0.02})) << "by the numbers of the frames";
  EXPECT_EQ((*importer.read(header() + kTwo))[1].acquisition.sequence, 7U);
  EXPECT_TRUE(importer.losses().empty());
}

TEST(Tekscan, reads_what_a_spreadsheet_has_made_of_it) {
  Importer importer(open_tekscan);
  EXPECT_EQ(
      importer.counts(
          "DATA_TYPE MOVIE,,\nROWS 2,,\nCOLS 3,,\nSECONDS_PER_FRAME 0.01,,\nUNITS RAW,,\n\"ASCII_DATA @@\",,\n,,\n"
          "Frame 5,,\n0,1,2\n3,4,5\n,,\nFrame 7,,\n6,7,8\n9,10,11\n,,\n@@,,\n"),
      kCounts);
}

TEST(Tekscan, gives_pressures_as_kilopascals) {
  Importer importer(open_tekscan);
  const std::vector<std::pair<std::string, float>> factors = {{"kPa", 1.0F},    {"PSI", 6.894757F},
                                                              {"MPa", 1000.0F}, {"mm Hg", 0.13332239F},
                                                              {"N/cm²", 10.0F}, {"kg/cm^2", 98.0665F}};
  for (const auto& [unit, factor] : factors) {
    const Frames frames = importer.counts(header(unit) + kTwo);
    ASSERT_EQ(frames.size(), 2U) << unit;
    EXPECT_FLOAT_EQ(frames[1][5], 11.0F * factor) << unit;
  }
  EXPECT_EQ(importer.error(header("furlongs") + kTwo),
            "f:11: UNITS 'furlongs' is no unit that is known: raw, kpa, pa, mpa, n/mm2, n/cm2, bar, mbar, psi, mmhg, "
            "kg/cm2, kgf/cm2, g/cm2, atm, n, newtons, kg, g, lb, lbs");
}

TEST(Tekscan, has_no_reading_outside_of_the_sensor) {
  const Frames frames = Importer(open_tekscan).counts(header() + "Frame 5\n0,B,2\n3,4,b\n");
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(std::isnan(frames[0][1]) && std::isnan(frames[0][5]));
  EXPECT_EQ(frames[0][4], 4.0F);
}

TEST(Tekscan, loses_only_the_frame_that_is_cut) {
  Importer importer(open_tekscan);
  const std::string whole = header() + kTwo;
  const std::size_t begin = whole.find("Frame 7");
  const std::size_t end = whole.find("10,11");
  for (std::size_t size = begin + 8; size < end + 4; ++size) {
    const Frames frames = importer.counts(whole.substr(0, size));
    EXPECT_EQ(frames, Frames{kCounts[0]}) << size;
    EXPECT_EQ(importer.losses().size(), 1U) << size;
  }
}

TEST(Tekscan, names_the_line_that_is_wrong) {
  Importer importer(open_tekscan);
  EXPECT_EQ(importer.error(header() + "Frame 5\n0,1\n3,4,5\n"), "f:16: has 2 values instead of 3");
  EXPECT_EQ(importer.error(header() + "Frame 5\n0,1,x\n3,4,5\n"), "f:16: 'x' is not a number");
  EXPECT_EQ(importer.error(header() + "Frame 5\n0,1,2\n3,4,5\nFrame 4\n6,7,8\n9,10,11\n"),
            "f:18: frame 4 follows frame 5");
  EXPECT_EQ(importer.error(header() + kTwo + "Frame 6\n6,7,8\n9,10,11\n"), "f:24: frame 6 follows frame 7");
  EXPECT_EQ(importer.error(header("RAW", "9e9") + kTwo),
            "f:19: frame 7 would be later than 9e9 seconds, by its SECONDS_PER_FRAME");
  EXPECT_EQ(importer.error("DATA_TYPE MOVIE\nCOLS 3\nFrame 1\n0,1,2\n"), "f:3: there is no ROWS above the first frame");
  EXPECT_EQ(importer.error(header("RAW", "0") + kTwo), "f:19: frame 7 has no SECONDS_PER_FRAME above it");
  EXPECT_EQ(importer.error(header("RAW", "soon") + kTwo),
            "f:7: SECONDS_PER_FRAME 'soon' is not a number that it can be");
  EXPECT_EQ(importer.error(header()), "f:14: the file ends before its first frame");
  EXPECT_EQ(importer.error("DATA_TYPE MOVIE\nROWS 9999\nCOLS 3\nFrame 1\n"),
            "f: has frames of 9999x3 taxels; 1x1 to 1024x1024 can be read");
  EXPECT_EQ(Importer(open_tekscan, {.shape = FrameShape{3, 2}}).error(header() + kTwo),
            "f: has 2x3 taxels, the array is 3x2");
}

TEST(Tekscan, gives_a_value_or_a_one_line_error_for_mutations) {
  Importer(open_tekscan).expect_value_or_one_line_error(header("kPa") + kTwo, 20000);
}

}  // namespace
}  // namespace dermis::bytes::formats
