// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bytes/formats/imported.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

std::string sensor(const std::string& name, const std::string& rows) {
  return "\"SENSOR\",\"" + name + "\"\n\"Rows\",\"2\"\n\"Columns\",\"3\"\n\"Sensel Width (cm)\",\"0.86\"\n" +
         "\"Peak Pressure (kPa)\",\"12\"\n\n\"SENSELS\"\n" + rows + "\n";
}

std::string frame(const std::string& number, const std::string& time, const std::string& sensors) {
  return "\"FRAME\",\"" + number + "\"\n\"Date\",\" 2022 Aug 16\"\n\"Time\",\" " + time + "\"\n\n" + sensors +
         "\"GROUP\",\"1\"\n\"Name\",\"Heel\"\n\"Cells\",\"2\"\n\"SENSELS\"\n\"77\",\"78\"\n\n";
}

std::string file(const std::string& frames, const std::string& unit = "kPa") {
  return "\"File:\",\"C:\\a,08,16-4km.XSN\"\n\"Units:\",\"" + unit + "\"\n\"Threshold:\",\"1\"\n\n" + frames;
}

const std::string kFirst = "\"0\",\"1\",\"2\"\n\"3\",\"4\",\"5\"\n";
const std::string kSecond = "\"6\",\"7\",\"8\"\n\"9\",\"10\",\"11\"\n";
const Frames kCounts = {{0, 1, 2, 3, 4, 5}, {6, 7, 8, 9, 10, 11}};

std::string two_frames() {
  return file(frame("1", "08:21:17.982", sensor("mat", kFirst)) + frame("2", "08:21:18", sensor("mat", kSecond)));
}

std::string feet() {
  return file(frame("1", "0.5", sensor("left foot", kFirst) + sensor("right foot", kSecond)) +
              frame("2", "0.75", sensor("left foot", kSecond) + sensor("right foot", kFirst)));
}

TEST(Xsensor, reads_the_frames_of_a_mat) {
  Importer importer(open_xsensor);
  EXPECT_EQ(importer.counts(two_frames()), kCounts);
  EXPECT_EQ(importer.shape(), (FrameShape{2, 3}));
  const double midnight = 1660608000.0;  // 2022-08-16
  const std::vector<double> seconds = importer.seconds(two_frames());
  ASSERT_EQ(seconds.size(), 2U);
  EXPECT_DOUBLE_EQ(seconds[0], midnight + 30077.982);
  EXPECT_DOUBLE_EQ(seconds[1], midnight + 30078.0);
}

TEST(Xsensor, reads_what_a_spreadsheet_has_made_of_it) {
  std::string text;
  for (const char c : two_frames()) {
    if (c == '\n') {
      text += ",,,,\r\n,,,,\r\n";
    } else if (c != '"') {
      text += c;
    }
  }
  const std::size_t path = text.find("C:\\a,08,16-4km.XSN");
  text.replace(path, 18, "\"C:\\a,08,16-4km.XSN\"");
  EXPECT_EQ(Importer(open_xsensor).counts(text), kCounts);
}

TEST(Xsensor, gives_pressures_as_kilopascals) {
  Importer importer(open_xsensor);
  const auto frames = importer.counts(file(frame("1", "0", sensor("mat", kFirst)), "mmHg"));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_FLOAT_EQ(frames[0][5], 0.66661195F);
  EXPECT_EQ(importer.error(file("", "parsecs")),
            "f:2: Units 'parsecs' are none that are known: raw, kpa, pa, mpa, n/mm2, n/cm2, bar, mbar, psi, mmhg, "
            "kg/cm2, kgf/cm2, g/cm2, atm, n, newtons, kg, g, lb, lbs");
}

TEST(Xsensor, reads_one_of_several_sensors) {
  EXPECT_EQ(Importer(open_xsensor, {.array = "left foot"}).counts(feet()), kCounts);
  EXPECT_EQ(Importer(open_xsensor, {.array = "right foot"}).counts(feet()), (Frames{kCounts[1], kCounts[0]}));
  EXPECT_EQ(Importer(open_xsensor).error(feet()), "f: name one, as 'f#left foot'; it has: 'left foot', 'right foot'");
  EXPECT_EQ(Importer(open_xsensor, {.array = "nose"}).error(feet()),
            "f: has no sensor 'nose', as 'f#left foot'; it has: 'left foot', 'right foot'");
}

TEST(Xsensor, loses_only_the_frame_that_is_cut) {
  Importer importer(open_xsensor);
  const std::string whole = two_frames();
  for (std::size_t size = whole.find("\"6\""); size < whole.find("\"11\"") + 1; ++size) {
    EXPECT_EQ(importer.counts(whole.substr(0, size)), Frames{kCounts[0]}) << size;
    EXPECT_EQ(importer.losses().size(), 1U) << size;
  }
}

TEST(Xsensor, names_the_line_that_is_wrong) {
  Importer importer(open_xsensor);
  EXPECT_EQ(importer.error(file(frame("1", "0", sensor("mat", "0,1\n3,4,5\n")))), "f:16: has 2 values instead of 3");
  EXPECT_EQ(importer.error(file(frame("1", "late", sensor("mat", kFirst)))),
            "f:7: Time 'late' is not one that is known");
  for (const std::string time : {"9000000000", "86401", "-1"}) {
    EXPECT_EQ(importer.error(file(frame("1", time, sensor("mat", kFirst)))),
              "f:15: the Time of the frame is not in the day of its Date");
  }
  EXPECT_EQ(importer.error(file(frame("1", "2", sensor("mat", kFirst)) + frame("2", "1", sensor("mat", kFirst)))),
            "f:35: the Time of the frame is before that of the last one");
  EXPECT_EQ(importer.error(file("\"FRAME\",\"1\"\n\"Date\",\"16.8.22\"\n")),
            "f:6: Date '16.8.22' is none like '2022 Aug 16'");
  EXPECT_EQ(importer.error(file(sensor(std::string(201, 'n'), kFirst))),
            "f:5: the name of the sensor is longer than 200 bytes");
  EXPECT_EQ(importer.error(file("")), "f:4: the file ends before its first SENSELS");
  EXPECT_EQ(Importer(open_xsensor, {.shape = FrameShape{3, 2}}).error(two_frames()),
            "f: has 2x3 taxels, the array is 3x2");
}

TEST(Xsensor, tells_a_file_that_cannot_be_read_or_is_a_pipe) {
  Importer importer(open_xsensor);
  EXPECT_EQ(importer.fault(two_frames(), BadFile::Fault::read).message, "cannot read 'f': Input/output error");
  EXPECT_EQ(importer.fault(two_frames(), BadFile::Fault::seek).message,
            "f: cannot be read from a pipe; save it as a file");
}

TEST(Xsensor, gives_a_value_or_a_one_line_error_for_mutations) {
  Importer(open_xsensor).expect_value_or_one_line_error(two_frames(), 20000);
}

}  // namespace
}  // namespace dermis::bytes::formats
