// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>

#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

/// Frames that every format can hold but for what it leaves out: 100 a second from 0 on.
std::vector<RawFrame> plain_frames(std::size_t count, std::size_t taxels) {
  std::vector<RawFrame> frames = support::random_frames(1, count, taxels);
  for (std::size_t i = 0; i < count; ++i) frames[i].time = std::chrono::milliseconds(10 * i);
  return frames;
}

/// What is left of a frame in a format.
RawFrame kept_by(FrameFormat format, RawFrame frame) {
  if (format == FrameFormat::mcap || format == FrameFormat::hdf5) return frame;
  frame.acquisition = {};
  if (format == FrameFormat::csv) return frame;
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  return frame;
}

class EveryFormat : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(FrameFiles, EveryFormat,
                         testing::Values("f.csv", "f.mcap", "f.h5", "f.hdf5", "f.wiresens.h5", "f.npy"),
                         [](const auto& info) {
                           std::string name = info.param + 2;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST_P(EveryFormat, gives_back_all_that_it_holds_of_a_frame) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  const FrameFormat format = *frame_format(path);
  std::vector<RawFrame> frames = plain_frames(300, 12);
  const auto sink = create_frames(path, {3, 4});
  ASSERT_TRUE(sink) << sink.error().message;
  const Status written = support::write_all(**sink, frames);
  ASSERT_TRUE(written) << written.error().message;
  const auto source = open_frames(path, {.rate_hz = 100.0});
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->shape(), (FrameShape{3, 4}));
  for (RawFrame& frame : frames) frame = kept_by(format, std::move(frame));
  support::expect_same_frames(**source, frames);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST_P(EveryFormat, leaves_nothing_behind_and_nothing_changed_without_commit) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  support::write_bytes(path, "old");
  {
    const auto sink = create_frames(path, {3, 4});
    ASSERT_TRUE(sink);
    for (const RawFrame& frame : plain_frames(2000, 12)) ASSERT_TRUE((*sink)->write(frame));
  }
  EXPECT_EQ(support::read_bytes(path), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST_P(EveryFormat, refuses_frames_of_another_shape) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  const auto sink = create_frames(path, {3, 4});
  ASSERT_TRUE(sink);
  ASSERT_TRUE(support::write_all(**sink, plain_frames(3, 12)));
  const auto source = open_frames(path, {.shape = FrameShape{16, 16}, .rate_hz = 100.0});
  ASSERT_FALSE(source);
  const std::string line = path.ends_with(".csv") ? ":1" : "";
  EXPECT_EQ(source.error().message, path + line + ": has 3x4 taxels, the array is 16x16");
  EXPECT_TRUE(open_frames(path, {.shape = FrameShape{3, 4}, .rate_hz = 100.0}));
}

TEST_P(EveryFormat, names_a_file_that_is_not_there) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  const auto source = open_frames(path, {.rate_hz = 100.0});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(source.error().message, "cannot open '" + path + "': No such file or directory");
  const std::string place = folder.file(std::string("none/") + GetParam());
  const auto sink = create_frames(place, {3, 4});
  ASSERT_FALSE(sink);
  EXPECT_EQ(sink.error().message, "cannot write '" + place + "': No such file or directory");
}

TEST_P(EveryFormat, names_a_file_that_is_empty_or_of_another_format) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  for (const char* const bytes :
       {"", "a\n", "0123456789012345678901234567890123456789012345678901234567890123456789"}) {
    support::write_bytes(path, bytes);
    const auto source = open_frames(path, {.rate_hz = 100.0});
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().kind, ErrorKind::bad_input);
    EXPECT_TRUE(source.error().message.starts_with(path + ":")) << source.error().message;
  }
}

TEST_P(EveryFormat, is_read_at_once) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  const auto sink = create_frames(path, {3, 4});
  ASSERT_TRUE(sink);
  ASSERT_TRUE(support::write_all(**sink, plain_frames(30, 12)));
  const auto frames = read_frames(path, {.rate_hz = 100.0});
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->size(), 30U);
}

TEST_P(EveryFormat, without_a_frame_is_bad_input) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file(GetParam());
  const auto sink = create_frames(path, {3, 4});
  ASSERT_TRUE(sink && (*sink)->commit());
  const auto frames = read_frames(path, {.rate_hz = 100.0});
  ASSERT_FALSE(frames);
  EXPECT_EQ(frames.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(frames.error().message, path + ": has no frame");
}

TEST(FrameFiles, of_a_file_that_is_cut_all_whole_frames_are_given_and_the_loss_is_told_once) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("f.csv"), "time_s,r0c0,r0c1\n0,1,2\n1,3,4\n2,5");
  std::vector<std::string> losses;
  const auto source =
      open_frames(folder.file("f.csv"), {.loss = [&](const std::string& text) { losses.push_back(text); }});
  ASSERT_TRUE(source);
  EXPECT_EQ(read_frames(**source)->size(), 2U);
  EXPECT_EQ(losses, std::vector<std::string>{folder.file("f.csv") + ":4: is cut off; the frames before are read"});
}

TEST(FrameFiles, names_what_a_file_with_a_wrong_ending_is) {
  const support::TemporaryFolder folder;
  const auto sink = create_frames(folder.file("f.mcap"), {3, 4});
  ASSERT_TRUE(sink && (*sink)->commit());
  const std::string recording = support::read_bytes(folder.file("f.mcap"));
  for (const auto& [name, wanted] : {std::pair{"f.h5", "an HDF5 file"},
                                     {"f.npy", "a NumPy array (.npy)"},
                                     {"f.npz", "a zip archive (.npz)"},
                                     {"f.txt", "a table (CSV)"}}) {
    support::write_bytes(folder.file(name), recording);
    const auto source = open_frames(folder.file(name), {.rate_hz = 100.0});
    ASSERT_FALSE(source) << name;
    EXPECT_EQ(source.error().message, folder.file(name) + ": is an MCAP recording, not " + wanted);
  }
}

TEST(FrameFiles, keep_notes_where_the_format_has_a_place_for_them) {
  const support::TemporaryFolder folder;
  const FrameNotes notes{"hand", "[array]\nname = \"hand\"\n", "0123456789abcdef"};
  for (const char* const name : {"f.mcap", "f.h5"}) {
    const auto sink = create_frames(folder.file(name), {3, 4}, notes);
    ASSERT_TRUE(sink);
    ASSERT_TRUE(support::write_all(**sink, plain_frames(3, 12)));
    const auto read = read_frame_notes(folder.file(name));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, notes) << name;
  }
  ASSERT_TRUE(support::write_all(**create_frames(folder.file("f.csv"), {1, 1}, notes), plain_frames(3, 1)));
  EXPECT_EQ(*read_frame_notes(folder.file("f.csv")), FrameNotes{});
}

TEST(FrameFiles, list_the_known_endings_where_the_name_has_another) {
  for (const std::string name : {"frames.xyz", "frames", "mcap", "f.csv.gz", ""}) {
    const auto source = open_frames(name);
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(source.error().message,
              "'" + name +
                  "': the ending of its name tells no format of frames; known: .csv, .mcap, .h5, .hdf5, "
                  ".wiresens.h5, .wiresens.hdf5 and .npy, and to read .npz, .dsa, .dsa3, .asf, .lst, .asc, .mat, .txt, "
                  ".png and "
                  ".packed10");
    EXPECT_FALSE(create_frames(name, {1, 1}));
  }
}

TEST(FrameFiles, have_endings_in_any_case) {
  EXPECT_EQ(*frame_format("SENSORLOG.CSV"), FrameFormat::csv);
  EXPECT_EQ(*frame_format("run.WiReSens.H5"), FrameFormat::wiresens);
}

TEST(FrameFiles, of_a_pipe_are_csv) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::thread writer([&] { support::write_bytes(path, "time_s,r0c0\n0,1\n"); });
  const auto frames = read_frames(path);
  writer.join();
  ASSERT_TRUE(frames) << frames.error().message;
  EXPECT_EQ(frames->size(), 1U);
}

TEST(FrameFiles, of_numpy_need_a_rate) {
  const auto source = open_frames("f.npy");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().message,
            "f.npy: has no times: give a rate, when it is converted or as 'file:f.npy?rate=HZ'");
}

TEST(FrameFiles, of_other_systems_are_told_by_what_they_hold) {
  const support::TemporaryFolder folder;
  const auto format = [&](const std::string& name, const std::string& text) {
    support::write_bytes(folder.file(name), text);
    return *recognise_frames(folder.file(name));
  };
  for (const std::string ending : {".csv", ".txt"}) {
    EXPECT_EQ(format("a" + ending, "DATA_TYPE MOVIE\nROWS 2\n"), FrameFormat::tekscan);
    EXPECT_EQ(format("b" + ending, "\"File:\",\"C:\\a.XSN\"\n"), FrameFormat::xsensor);
    EXPECT_EQ(format("c" + ending, "1.5,2\n3,4\n"), FrameFormat::text_matrix);
  }
  EXPECT_EQ(format("d.csv", "time_s,r0c0\n"), FrameFormat::csv);
  EXPECT_EQ(*recognise_frames(folder.file("")), FrameFormat::png_stack);
  EXPECT_EQ(*recognise_frames("hand.dsa#3"), FrameFormat::dsa);
}

TEST(FrameFiles, of_other_systems_are_read_and_not_written) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("a.txt"), "1,2\n3,4\n\n5,6\n7,8\n\n9");
  std::vector<std::string> losses;
  const auto frames = read_frames(folder.file("a.txt"),
                                  {.rate_hz = 10.0, .loss = [&](const std::string& line) { losses.push_back(line); }});
  ASSERT_TRUE(frames) << frames.error().message;
  EXPECT_EQ(frames->size(), 2U);
  EXPECT_EQ(losses.size(), 1U);
  const auto sink = create_frames(folder.file("b.txt"), {2, 2});
  ASSERT_FALSE(sink);
  EXPECT_EQ(sink.error().message,
            "'" + folder.file("b.txt") +
                "': files of this ending are only read; to write, there are .csv, .mcap, .h5, .hdf5, .wiresens.h5, "
                ".wiresens.hdf5 and .npy");
}

}  // namespace
}  // namespace dermis::bytes::recordings
