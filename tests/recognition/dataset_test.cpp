// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/recognition/dataset.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "dermis/files/npy.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::recognition {
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
    auto writer = files::NpyWriter::create(path, {1, cols});
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
  auto writer = files::NpyWriter::create(files_.extras, {1, 1});
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

}  // namespace
}  // namespace dermis::recognition
