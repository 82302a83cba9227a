// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/dataset.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "dermis/bytes/files/npy.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::learn::recognition {
namespace {

using dermis::support::write_bytes;

/// Six frames of two arrays of 1 x 2 and 2 x 1 taxels.
class Dataset : public testing::Test {
 protected:
  Dataset() {
    files_.frames = folder_.file("frames.npy");
    files_.arrays = folder_.file("arrays.csv");
    files_.labels = folder_.file("labels.csv");
    write_numbers(files_.frames, 6, 4);
    write_bytes(files_.arrays, "array,rows,cols,first_column\nthumb,1,2,0\nindex,2,1,2\n");
    write_bytes(files_.labels, "id,first,last,class,subject,session\na,0,1,cup,7,x\nb,2,2,pen,7,y\nc,4,5,cup,8,x\n");
  }

  static void write_numbers(const std::string& path, std::size_t rows, std::size_t cols) {
    auto writer = bytes::files::NpyWriter::create(path, {1, cols});
    ASSERT_TRUE(writer);
    for (std::size_t row = 0; row < rows; ++row) {
      RawFrame frame;
      for (std::size_t col = 0; col < cols; ++col) frame.counts.push_back(static_cast<float>(row * cols + col));
      ASSERT_TRUE((*writer)->write(frame));
    }
    ASSERT_TRUE((*writer)->commit());
  }

  [[nodiscard]] std::string error() const {
    const Result<LabelledFrames> data = read_dataset(files_);
    if (data) return "no error";
    EXPECT_EQ(data.error().kind, ErrorKind::bad_input);
    return data.error().message;
  }

  dermis::support::TemporaryFolder folder_;
  DatasetFiles files_;
};

TEST_F(Dataset, is_read) {
  files_.extras = folder_.file("extra.npy");
  write_numbers(files_.extras, 6, 3);
  files_.rate_hz = 30.0;
  const Result<LabelledFrames> data = read_dataset(files_);
  ASSERT_TRUE(data) << data.error().message;
  ASSERT_EQ(data->layout.arrays.size(), 2U);
  EXPECT_EQ(data->layout.arrays[1], (SensedArray{"index", 2, 1, 2, 0.0, 0.0}));
  EXPECT_EQ(data->layout.readings, 4U);
  EXPECT_EQ(data->layout.extras, 3U);
  EXPECT_EQ(data->layout.rate_hz, 30.0);
  ASSERT_EQ(data->labels.size(), 3U);
  EXPECT_EQ(data->labels[2].name, "cup");
  EXPECT_EQ(data->labels[2].group, "8");
  EXPECT_EQ(data->labels[2].order, 4.0);
  const Segment segment = data->segment(data->labels[1]);
  EXPECT_EQ(std::vector<float>(segment.frames.begin(), segment.frames.end()), (std::vector<float>{8, 9, 10, 11}));
  EXPECT_EQ(std::vector<float>(segment.extras.begin(), segment.extras.end()), (std::vector<float>{6, 7, 8}));
}

TEST_F(Dataset, knows_a_pitch_that_the_arrays_name) {
  write_bytes(files_.arrays, "array,rows,cols,first_column,row_pitch_mm,col_pitch_mm\nskin,2,2,0,3.5,4\n");
  const Result<LabelledFrames> data = read_dataset(files_);
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->layout.arrays[0].row_pitch_mm, 3.5);
  EXPECT_EQ(data->layout.arrays[0].col_pitch_mm, 4.0);
}

TEST_F(Dataset, takes_the_class_from_another_column) {
  files_.label = "session";
  const Result<LabelledFrames> data = read_dataset(files_);
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->labels[1].name, "y");
  files_.label = "posture";
  EXPECT_EQ(error(), files_.labels + ": has no column 'posture'; its header is 'id,first,last,class,subject,session'");
}

TEST_F(Dataset, names_the_file_that_is_wrong) {
  files_.extras = folder_.file("extra.npy");
  write_numbers(files_.extras, 5, 3);
  EXPECT_EQ(error(), files_.extras + ": has 5 lines, " + files_.frames + " 6 frames");
  files_.extras.clear();
  write_bytes(files_.labels, "id,first,last,class\na,0,1,cup\nb,1,2,pen\n");
  EXPECT_EQ(error(), files_.labels + ": label 'b' overlaps label 'a' at frame 1; a frame belongs to one example");
  write_bytes(files_.labels, "id,first,last,class\na,0,x,cup\n");
  EXPECT_EQ(error(), files_.labels + ":2: last 'x' is not a whole number of 0 or more");
  write_bytes(files_.arrays, "array,rows,cols,first_column\nskin,3,2,0\n");
  write_bytes(files_.labels, "id,first,last,class\na,0,1,cup\n");
  EXPECT_EQ(error(), files_.arrays + ": array 'skin': ends beyond the 4 readings of a frame");
  files_.frames = folder_.file("absent.npy");
  EXPECT_NE(error().find(files_.frames), std::string::npos);
}

TEST_F(Dataset, names_the_line_of_a_class_that_cannot_be_called_so) {
  write_bytes(files_.labels, "id,first,last,class\na,0,1,cup\nb,2,2,unknown\n");
  EXPECT_EQ(error(),
            files_.labels + ":3: class 'unknown' is the answer for what is like no class; give it another name");
  write_bytes(files_.labels,
              "id,first,last,class\na,0,1,Gr\xF6\xDF"
              "e\n");
  EXPECT_EQ(error(), files_.labels +
                         ":2: class 'Gr\xF6\xDF"
                         "e' must be UTF-8 without control characters");
}

TEST_F(Dataset, names_the_file_of_a_reading_that_is_no_number) {
  files_.extras = folder_.file("extra.npy");
  auto writer = bytes::files::NpyWriter::create(files_.extras, {1, 1});
  ASSERT_TRUE(writer);
  RawFrame frame;
  for (const float value : {0.0F, 1.0F, std::numeric_limits<float>::quiet_NaN(), 3.0F, 4.0F, 5.0F}) {
    frame.counts = {value};
    ASSERT_TRUE((*writer)->write(frame));
  }
  ASSERT_TRUE((*writer)->commit());
  EXPECT_EQ(error(),
            files_.extras + ": further reading 0 of frame 2 is not a number; write 0 where nothing was measured");
}

TEST_F(Dataset, splits_learn_from_all_that_they_do_not_name) {
  const Result<LabelledFrames> data = read_dataset(files_);
  ASSERT_TRUE(data);
  const std::string path = folder_.file("splits.csv");
  write_bytes(path, "split,id\ns1,c\ns0,b\ns1,a\n");
  const Result<std::vector<Split>> splits = read_splits(path, data->labels);
  ASSERT_TRUE(splits) << splits.error().message;
  ASSERT_EQ(splits->size(), 2U);
  EXPECT_EQ((*splits)[0].name, "s1");
  EXPECT_EQ((*splits)[0].asked, (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ((*splits)[0].taught, (std::vector<std::size_t>{1}));
  EXPECT_EQ((*splits)[1].taught, (std::vector<std::size_t>{0, 2}));
}

TEST_F(Dataset, open_splits_learn_from_what_they_name) {
  const Result<LabelledFrames> data = read_dataset(files_);
  ASSERT_TRUE(data);
  const std::string path = folder_.file("open.csv");
  write_bytes(path, "split,role,id\no0,train,a\no0,unknown,b\no0,known,c\n");
  const Result<std::vector<Split>> splits = read_open_splits(path, data->labels);
  ASSERT_TRUE(splits) << splits.error().message;
  ASSERT_EQ(splits->size(), 1U);
  EXPECT_EQ((*splits)[0].taught, (std::vector<std::size_t>{0}));
  EXPECT_EQ((*splits)[0].asked, (std::vector<std::size_t>{1, 2}));
}

TEST_F(Dataset, splits_name_the_line_that_is_wrong) {
  const Result<LabelledFrames> data = read_dataset(files_);
  ASSERT_TRUE(data);
  const std::string path = folder_.file("splits.csv");
  write_bytes(path, "split,id\ns0,a\ns0,d\n");
  EXPECT_EQ(read_splits(path, data->labels).error().message, path + ":3: id 'd' is not among the labels");
  write_bytes(path, "split,id\n");
  EXPECT_EQ(read_splits(path, data->labels).error().message, path + ": names no split");
  write_bytes(path, "split,role,id\ns0,test,a\n");
  EXPECT_EQ(read_open_splits(path, data->labels).error().message,
            path + ":2: role 'test' is unknown; write train, known or unknown");
  write_bytes(path, "split,role,id\ns0,train,a\ns1,known,a\ns0,known,a\n");
  EXPECT_EQ(read_open_splits(path, data->labels).error().message,
            path + ":4: id 'a' stands twice in split 's0'; an example is learned from or answered for");
}

/// Two recordings of three and four frames of 1 x 2 taxels.
class Recordings : public testing::Test {
 protected:
  void write_labels(const std::string& lines, const std::string& header = "id,first,last,class,recording") {
    write_bytes(labels_, header + "\n" + lines);
  }
  [[nodiscard]] Result<LabelledFrames> labelled() const {
    const Layout layout{.arrays = {{.name = "skin", .rows = 1, .cols = 2}}, .readings = 2};
    return label_recordings(
        layout, {{"a.mcap", {1, 1, 2, 2, 3, 3}, 1, {}}, {"b.mcap", {4, 4, 5, 5, 6, 6, 7, 7}, 0, {}}}, labels_, "class");
  }
  [[nodiscard]] std::string error() const {
    const Result<LabelledFrames> data = labelled();
    return data ? "no error" : data.error().message;
  }

  dermis::support::TemporaryFolder folder_;
  std::string labels_ = folder_.file("labels.csv");
};

TEST_F(Recordings, stand_one_after_the_other_and_are_the_groups) {
  write_labels("y,0,1,pen,b.mcap\nx,1,2,cup,a.mcap\nz,3,3,cup,b.mcap\n");
  const Result<LabelledFrames> data = labelled();
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->frames, (std::vector<float>{1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7}));
  ASSERT_EQ(data->labels.size(), 3U);
  EXPECT_EQ(data->labels[0].id, "x");
  EXPECT_EQ(data->labels[0].first, 1U);
  EXPECT_EQ(data->labels[0].group, "a.mcap");
  EXPECT_EQ(data->labels[1].id, "y");
  EXPECT_EQ(data->labels[1].first, 3U);
  EXPECT_EQ(data->labels[1].last, 4U);
  EXPECT_EQ(data->labels[1].order, 3.0);
  EXPECT_EQ(data->labels[2].group, "b.mcap");
}

TEST_F(Recordings, have_further_readings_one_after_the_other) {
  write_labels("x,1,1,cup,a.mcap\ny,0,0,pen,b.mcap\n");
  const Layout layout{.arrays = {{.name = "skin", .rows = 1, .cols = 1}}, .readings = 1, .extras = 2};
  const auto data = label_recordings(layout, {{"a.mcap", {1, 2}, 0, {10, 11, 20, 21}}, {"b.mcap", {3}, 0, {30, 31}}},
                                     labels_, "class");
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->extras, (std::vector<float>{10, 11, 20, 21, 30, 31}));
  EXPECT_EQ(data->segment(data->labels[1]).extras[1], 31.0F);
}

TEST_F(Recordings, are_no_groups_where_the_labels_name_some) {
  write_labels("x,1,2,cup,a.mcap,7\ny,0,1,pen,b.mcap,7\n", "id,first,last,class,recording,subject");
  const Result<LabelledFrames> data = labelled();
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_EQ(data->labels[0].group, "7");
  EXPECT_EQ(data->labels[1].group, "7");
}

TEST_F(Recordings, are_refused_with_labels_that_do_not_fit) {
  write_labels("x,1,3,cup,a.mcap\n");
  EXPECT_NE(error().find("a.mcap: label 'x' ends at frame 3; there are 3 frames"), std::string::npos) << error();
  write_labels("x,0,1,cup,b.mcap\ny,1,2,cup,b.mcap\n");
  EXPECT_NE(error().find("b.mcap: label 'y' overlaps label 'x' at frame 1"), std::string::npos) << error();
  write_labels("x,0,1,cup,c.mcap\n");
  EXPECT_NE(error().find(":2: there is no recording 'c.mcap' among those given: a.mcap, b.mcap"), std::string::npos)
      << error();
  write_labels("x,0,1,cup,a.mcap\n");
  EXPECT_NE(error().find("label 'x' begins at frame 0; the first 1 frames are the tare"), std::string::npos) << error();
  write_labels("x,1,1,cup,a.mcap\nx,1,1,cup,b.mcap\n");
  EXPECT_NE(error().find("label 'x' stands twice"), std::string::npos) << error();
  write_labels("x,1,1,cup\n", "id,first,last,class");
  EXPECT_NE(error().find("recording"), std::string::npos) << error();
}

}  // namespace
}  // namespace dermis::learn::recognition
