// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/frame_output.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/recordings/frame_file_info.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/pipeline/direct_model.hpp"
#include "support/force_mat.hpp"

namespace dermis::live::forces {
namespace {

using support::error_of;
using support::force_mat;
using support::kShape;
using support::MatFiles;
using support::pressed;

TEST(CreateRecording, of_a_model_keeps_frames_forces_and_what_is_known_of_the_array) {
  const MatFiles mat;
  const ArrayDescription array = force_mat();
  const touch::pipeline::Model model = touch::pipeline::direct_model(array);
  const FrameOutput output{mat.file("rec.mcap"), &array, &model, mat.model(), {}};
  const std::vector<RawFrame> frames = pressed({1.0F, 2.0F});
  ASSERT_TRUE(check_output(output));
  const auto sink = create_recording(output, kShape);
  ASSERT_TRUE(sink) << error_of(sink);
  ASSERT_TRUE(support::write_all(**sink, frames));

  const auto source = bytes::recordings::open_frames(output.path);
  ASSERT_TRUE(source);
  support::expect_same_frames(**source, frames);
  const bytes::recordings::FrameNotes notes = sources::notes_of_source(**source, output.path);
  EXPECT_EQ(notes.name, "mat");
  EXPECT_EQ(notes.array_toml, bytes::files::array_to_toml(array));
  EXPECT_EQ(notes.model_hash, bytes::files::content_hash(mat.model()).value());
  const auto info = bytes::recordings::frame_file_info(output.path, {});
  ASSERT_TRUE(info);
  EXPECT_TRUE(std::any_of(info->topics.begin(), info->topics.end(),
                          [](const auto& topic) { return topic.name == "/mat/force" && topic.messages == 2; }));
}

TEST(CreateRecording, takes_the_notes_of_the_source_where_no_array_is_given) {
  const MatFiles mat;
  const FrameOutput output{mat.file("frames.h5"), nullptr, nullptr, "", {"sole", "", "", "sim:multitouch"}};
  const auto sink = create_recording(output, kShape);
  ASSERT_TRUE(sink && support::write_all(**sink, pressed({1.0F}))) << error_of(sink);
  EXPECT_EQ(*bytes::recordings::read_frame_notes(output.path), output.notes);
}

TEST(CreateKeptRecording, keeps_the_frames_of_a_table_beside_it_until_it_is_complete) {
  for (const char* const name : {"frames.csv", "frames.h5", "frames.npy"}) {
    const MatFiles mat;
    const FrameOutput output{mat.file(name), nullptr, nullptr, "", {}};
    const std::string beside = recording_beside(output.path);
    EXPECT_EQ(beside, mat.file(name) + std::string(".mcap"));
    const std::vector<RawFrame> frames = pressed({1.0F, 2.0F});
    auto sink = create_kept_recording(output, kShape);
    ASSERT_TRUE(sink) << error_of(sink);
    for (const RawFrame& frame : frames) ASSERT_TRUE((*sink)->write(frame));
    sink->reset();  // as where the process dies
    EXPECT_FALSE(std::filesystem::exists(output.path));
    const auto kept = bytes::recordings::open_frames(beside);
    ASSERT_TRUE(kept) << error_of(kept);
    support::expect_same_frames(**kept, frames);
    std::filesystem::remove(beside);

    const auto whole = create_kept_recording(output, kShape);
    ASSERT_TRUE(whole && support::write_all(**whole, frames)) << error_of(whole);
    EXPECT_TRUE(std::filesystem::exists(output.path));
    EXPECT_FALSE(std::filesystem::exists(beside));
  }
}

TEST(CreateKeptRecording, needs_no_other_for_a_recording_or_a_stream) {
  EXPECT_EQ(recording_beside("rec.mcap"), "");
  EXPECT_EQ(recording_beside("/dev/stdout"), "");
  EXPECT_EQ(recording_beside("frames.unknown"), "");
}

TEST(CheckOutput, tells_before_the_first_frame_what_cannot_be_written) {
  const MatFiles mat;
  const ArrayDescription array = force_mat();
  const touch::pipeline::Model model = touch::pipeline::direct_model(array);
  const Status table = check_output({mat.file("frames.csv"), &array, &model, mat.model(), {}});
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().message.find("has no place for forces"), std::string::npos);
  EXPECT_FALSE(check_output({mat.file("frames.unknown"), &array, nullptr, "", {}}));
  EXPECT_FALSE(check_output({mat.file("nowhere/rec.mcap"), &array, nullptr, "", {}}));
}

TEST(CreateForces, writes_the_forces_of_the_model_alone) {
  const MatFiles mat;
  const ArrayDescription array = force_mat();
  const touch::pipeline::Model model = touch::pipeline::direct_model(array);
  const auto sink = create_forces({mat.file("forces.csv"), &array, &model, mat.model(), {}});
  ASSERT_TRUE(sink && support::write_all(**sink, pressed({2.5F}))) << error_of(sink);
  EXPECT_NE(mat.text_of("forces.csv").find("\n1,ok,0,0,0,0,0,2."), std::string::npos) << mat.text_of("forces.csv");
}

TEST(NotesOfSource, are_empty_of_a_device) {
  const auto source = sources::open_source("sim:idle?frames=1");
  ASSERT_TRUE(source);
  EXPECT_EQ(sources::notes_of_source(**source, "sim:idle?frames=1"),
            bytes::recordings::FrameNotes{.simulation = "sim:idle?frames=1"});
}

}  // namespace
}  // namespace dermis::live::forces
