// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/open_source.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "live/sources/small_array.hpp"
#include "support/random_frames.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::live::sources {
namespace {

using support::TemporaryFolder;

constexpr FrameShape kShape{4, 5};

std::unique_ptr<FrameSource> opened(const std::string& from, const SourceOptions& options = {}) {
  Result<std::unique_ptr<FrameSource>> source = open_source(from, options);
  EXPECT_TRUE(source) << (source ? "" : source.error().message);
  return source ? *std::move(source) : nullptr;
}

std::string refusal(const std::string& from, const SourceOptions& options = {}) {
  const Result<std::unique_ptr<FrameSource>> source = open_source(from, options);
  return source ? "opened" : source.error().message;
}

bool has_next(FrameSource& source, RawFrame& frame) {
  const Result<bool> more = source.next(frame);
  EXPECT_TRUE(more) << (more ? "" : more.error().message);
  return more && *more;
}

/// Frames with whole counts, a millisecond apart.
std::vector<RawFrame> some_frames(std::size_t count) {
  std::vector<RawFrame> frames(count);
  for (std::size_t i = 0; i < count; ++i) {
    frames[i].time = static_cast<std::int64_t>(i) * Nanos(1'000'000);
    frames[i].counts.assign(kShape.taxel_count(), static_cast<float>(i));
  }
  return frames;
}

void write_file(const std::string& path, const std::vector<RawFrame>& frames) {
  const auto sink = bytes::recordings::create_frames(path, kShape);
  ASSERT_TRUE(sink) << sink.error().message;
  ASSERT_TRUE(support::write_all(**sink, frames));
}

void write_device_bytes(const std::string& path, const std::vector<RawFrame>& frames) {
  const auto encoder = *bytes::devices::make_encoder({.name = "dermis", .shape = kShape});
  std::vector<std::uint8_t> bytes;
  for (const RawFrame& frame : frames) encoder->encode(frame, bytes);
  support::write_bytes(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

TEST(OpenSource, reads_a_file_and_tells_where_each_frame_stands) {
  const TemporaryFolder folder;
  const std::string path = folder.file("frames.csv");
  write_file(path, some_frames(2));
  const auto source = opened(path);
  ASSERT_TRUE(source);
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->shape(), kShape);
  RawFrame frame;
  ASSERT_TRUE(has_next(*source, frame));
  ASSERT_TRUE(has_next(*source, frame));
  EXPECT_EQ(frame.counts.front(), 1.0F);
  EXPECT_EQ(source->place(), path + ":3");
  EXPECT_FALSE(has_next(*source, frame));
}

TEST(OpenSource, reads_one_array_of_a_recording_by_its_name) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  const auto writer = bytes::recordings::SuitRecordingWriter::create(
      path, {{.name = "chest", .shape = kShape}, {.name = "back", .shape = {1, 2}}});
  ASSERT_TRUE(writer);
  for (const RawFrame& frame : some_frames(3)) ASSERT_TRUE((*writer)->write(0, frame));
  ASSERT_TRUE((*writer)->commit());

  const auto source = opened(path + "#chest");
  ASSERT_TRUE(source);
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(support::read_all(*source)->size(), 3U);
  EXPECT_EQ(source->place(), "");
  EXPECT_NE(refusal(path + "#arm").find("has no array 'arm'"), std::string::npos) << refusal(path + "#arm");
}

TEST(OpenSource, reads_a_device) {
  const TemporaryFolder folder;
  write_device_bytes(folder.file("device.bin"), some_frames(3));
  const auto source = opened("file:" + folder.file("device.bin") + "?protocol=dermis");
  ASSERT_TRUE(source);
  EXPECT_TRUE(source->is_live());
  const auto frames = support::read_all(*source);
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 3U);
  EXPECT_EQ(frames->back().counts, some_frames(3).back().counts);
}

TEST(OpenSource, a_name_that_was_parsed_opens_the_same) {
  const Result<SourceName> name = SourceName::parse("sim:idle?frames=2&rows=3&cols=2");
  ASSERT_TRUE(name);
  const Result<std::unique_ptr<FrameSource>> source = open_source(*name);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->shape(), (FrameShape{3, 2}));
  EXPECT_EQ(support::read_all(**source)->size(), 2U);
}

TEST(OpenSource, simulates_a_scene_once_as_the_simulator_does) {
  const ArrayDescription array = small_array();
  const auto source = opened("sim:multitouch?frames=4&seed=7", {.array = &array});
  ASSERT_TRUE(source);
  EXPECT_TRUE(source->is_live());
  const auto simulator = learn::simulation::Simulator::create(array, {}, "multitouch", 7, 4);
  ASSERT_TRUE(simulator);
  support::expect_same_frames(*source, *support::read_all(**simulator));
}

TEST(OpenSource, sends_the_frames_of_a_scene_over_and_over_at_a_rate) {
  const ArrayDescription array = small_array();
  const auto scene = support::read_all(*opened("sim:multitouch?frames=3&seed=7", {.array = &array}));
  ASSERT_TRUE(scene);
  const auto source = opened("sim:multitouch?frames=3&seed=7&rate=1000", {.array = &array});
  ASSERT_TRUE(source);
  RawFrame frame;
  for (int i = 0; i < 12; ++i) {
    ASSERT_TRUE(has_next(*source, frame));
    const RawFrame& same = (*scene)[*frame.acquisition.sequence % 3];
    EXPECT_EQ(frame.counts, same.counts);
    EXPECT_EQ(frame.supply_v, same.supply_v);
    EXPECT_EQ(frame.temperature_celsius, same.temperature_celsius);
  }
}

/// The frames of a scene of touches on rubber that remembers, as the simulator gives them.
std::vector<RawFrame> touches(const ArrayDescription& array, double rate_hz, std::size_t frames) {
  learn::simulation::SimulationOptions options;
  options.rubber.memory.emplace();
  options.scene.rate_hz = rate_hz;
  const auto simulator = learn::simulation::Simulator::create(array, options, "touches", 3, frames);
  EXPECT_TRUE(simulator);
  return *support::read_all(**simulator);
}

TEST(OpenSource, touches_are_simulated_at_the_rate_with_the_memory_asked) {
  const ArrayDescription array = small_array();
  const std::vector<RawFrame> scene = touches(array, 1000.0, 4000);
  const auto source = opened("sim:touches?rate=1000&frames=4000&seed=3&memory=rubber", {.array = &array});
  ASSERT_TRUE(source);
  RawFrame frame;
  for (int i = 0; i < 2200; ++i) {
    ASSERT_TRUE(has_next(*source, frame));
    const RawFrame& same = scene[*frame.acquisition.sequence % 4000];
    ASSERT_EQ(frame.counts, same.counts) << "frame " << *frame.acquisition.sequence;
    EXPECT_EQ(frame.supply_v, same.supply_v);
  }
}

TEST(OpenSource, touches_begin_again_on_rested_rubber) {
  const ArrayDescription array = small_array();
  const std::vector<RawFrame> scene = touches(array, 1000.0, 3);
  const auto source = opened("sim:touches?rate=1000&frames=3&seed=3&memory=rubber", {.array = &array});
  ASSERT_TRUE(source);
  RawFrame frame;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(has_next(*source, frame));
    EXPECT_EQ(frame.counts, scene[*frame.acquisition.sequence % 3].counts);
  }
}

TEST(OpenSource, an_aged_sheet_reads_more_where_it_is_pressed) {
  const ArrayDescription array = small_array();
  const auto fresh = support::read_all(*opened("sim:multitouch?frames=20", {.array = &array}));
  const auto aged = support::read_all(*opened("sim:multitouch?frames=20&gain=1.5", {.array = &array}));
  const auto sum = [](const std::vector<RawFrame>& frames) {
    double counts = 0.0;
    for (const RawFrame& frame : frames) counts += std::accumulate(frame.counts.begin(), frame.counts.end(), 0.0);
    return counts;
  };
  EXPECT_GT(sum(*aged), 1.1 * sum(*fresh));
}

TEST(OpenSource, every_scene_takes_a_memory) {
  const ArrayDescription array = small_array();
  for (const char* scene : {"sim:multitouch?frames=20", "sim:touches?frames=600"}) {
    const auto simple = support::read_all(*opened(scene, {.array = &array}));
    const auto rubber = support::read_all(*opened(std::string(scene) + "&memory=rubber", {.array = &array}));
    EXPECT_EQ(simple->front().supply_v, rubber->front().supply_v);
    EXPECT_NE(simple->back().counts, rubber->back().counts) << scene;
  }
  for (const char* scene : {"sim:contacts?frames=100", "sim:rehearsal", "sim:idle"}) {
    RawFrame frame;
    const std::string uri = std::string(scene) + (std::string(scene).find('?') == std::string::npos ? "?" : "&");
    EXPECT_TRUE(has_next(*opened(uri + "rate=1000&memory=rubber", {.array = &array}), frame)) << scene;
  }
}

TEST(OpenSource, simulates_the_reference_array_where_none_is_named) {
  const auto source = opened("sim:idle?frames=1");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->shape(), (FrameShape{16, 16}));
}

TEST(OpenSource, the_array_of_the_uri_goes_before_that_of_the_options) {
  const TemporaryFolder folder;
  const std::string path = folder.file("array.toml");
  ArrayDescription named = small_array();
  named.readout.load_ohm.assign(5, 1000.0);
  ASSERT_TRUE(bytes::files::write_array(path, named));
  const ArrayDescription given = small_array();
  const auto of_uri = support::read_all(*opened("sim:multitouch?frames=2&array=" + path, {.array = &given}));
  const auto of_named = support::read_all(*opened("sim:multitouch?frames=2", {.array = &named}));
  const auto of_given = support::read_all(*opened("sim:multitouch?frames=2", {.array = &given}));
  EXPECT_EQ(of_uri->back().counts, of_named->back().counts);
  EXPECT_NE(of_uri->back().counts, of_given->back().counts);
}

TEST(OpenSource, a_simulated_source_ends_where_the_stop_flag_is_set) {
  const ArrayDescription array = small_array();
  for (const char* uri : {"sim:idle", "sim:idle?rate=1000", "sim:contacts?frames=10&rate=1000"}) {
    std::atomic<bool> stop = false;
    const auto source = opened(uri, {.array = &array, .stop = &stop});
    ASSERT_TRUE(source);
    RawFrame frame;
    EXPECT_TRUE(has_next(*source, frame)) << uri;
    stop = true;
    EXPECT_FALSE(has_next(*source, frame)) << uri;
  }
}

TEST(OpenSource, the_hand_of_a_rehearsal_listens_to_the_guide) {
  const ArrayDescription array = small_array();
  const auto guide = std::make_shared<GuideVoice>();
  const auto source = opened("sim:rehearsal?rate=1000", {.array = &array, .guide = guide});
  ASSERT_TRUE(source);
  EXPECT_TRUE(guide->has_listener());
  RawFrame frame;
  EXPECT_TRUE(has_next(*source, frame));
  EXPECT_TRUE(has_next(*opened("sim:rehearsal?rate=1000", {.array = &array}), frame)) << "without a guide, too";
}

/// 4x5 taxels with a number each, as a device would send them.
std::vector<RawFrame> numbered_taxels() {
  std::vector<RawFrame> frames = some_frames(2);
  for (RawFrame& frame : frames) {
    for (std::size_t i = 0; i < frame.counts.size(); ++i) frame.counts[i] = static_cast<float>(i);
  }
  return frames;
}

/// 4x4 taxels: those of the device but the first column, columns as rows and the last of them first.
ArrayDescription turned_array() {
  ArrayDescription array;
  array.rows = 4;
  array.cols = 4;
  array.readout.circuit = Circuit::none;
  array.order.skip_columns = 1;
  array.order.transpose = true;
  array.order.flip_rows = true;
  return array;
}

const std::vector<float> kTurnedCounts = {4, 9, 14, 19, 3, 8, 13, 18, 2, 7, 12, 17, 1, 6, 11, 16};

TEST(OpenSource, turns_the_frames_of_a_device_as_its_array_says) {
  const TemporaryFolder folder;
  write_device_bytes(folder.file("device.bin"), numbered_taxels());
  const ArrayDescription array = turned_array();
  const auto source = opened("file:" + folder.file("device.bin") + "?protocol=dermis", {.array = &array});
  ASSERT_TRUE(source);
  EXPECT_EQ(source->shape(), (FrameShape{4, 4}));
  EXPECT_TRUE(source->is_live());
  RawFrame frame;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(has_next(*source, frame));
    EXPECT_EQ(frame.counts, kTurnedCounts);
  }
  EXPECT_EQ(source->statistics().frames, 2U);
}

TEST(OpenSource, turns_the_frames_of_a_device_as_its_uri_says) {
  const TemporaryFolder folder;
  write_device_bytes(folder.file("device.bin"), numbered_taxels());
  const std::string uri = "file:" + folder.file("device.bin") + "?protocol=dermis&skip_columns=1&transpose=1";
  RawFrame frame;
  ASSERT_TRUE(has_next(*opened(uri + "&flip_rows=1"), frame));
  EXPECT_EQ(frame.counts, kTurnedCounts);
  ArrayDescription array = turned_array();
  array.order = {.flip_rows = true};
  ASSERT_TRUE(has_next(*opened(uri, {.array = &array}), frame)) << "first the URI, then the array";
  EXPECT_EQ(frame.counts, kTurnedCounts);
}

TEST(OpenSource, a_recording_of_a_turned_array_is_not_turned_again) {
  const TemporaryFolder folder;
  write_device_bytes(folder.file("device.bin"), numbered_taxels());
  const ArrayDescription array = turned_array();
  const auto frames =
      support::read_all(*opened("file:" + folder.file("device.bin") + "?protocol=dermis", {.array = &array}));
  ASSERT_TRUE(frames);
  for (const char* name : {"rec.mcap", "rec.csv", "rec.h5"}) {
    const auto sink =
        bytes::recordings::create_frames(folder.file(name), {4, 4}, {"turned", bytes::files::array_to_toml(array), ""});
    ASSERT_TRUE(sink) << sink.error().message;
    ASSERT_TRUE(support::write_all(**sink, *frames));
    RawFrame frame;
    ASSERT_TRUE(has_next(*opened(folder.file(name), {.array = &array}), frame));
    EXPECT_EQ(frame.counts, kTurnedCounts) << name;
  }
}

TEST(OpenSource, a_recording_from_before_its_array_was_turned_is_refused) {
  const TemporaryFolder folder;
  ArrayDescription array = turned_array();
  array.rows = kShape.rows;
  array.cols = kShape.cols;
  array.order = {};
  const auto sink = bytes::recordings::create_frames(folder.file("rec.mcap"), kShape,
                                                     {"mat", bytes::files::array_to_toml(array), ""});
  ASSERT_TRUE(sink) << sink.error().message;
  ASSERT_TRUE(support::write_all(**sink, numbered_taxels()));
  EXPECT_TRUE(opened(folder.file("rec.mcap"), {.array = &array}));
  array.order.flip_rows = true;
  EXPECT_NE(refusal(folder.file("rec.mcap"), {.array = &array}).find("rec.mcap?flip_rows=1"), std::string::npos);
}

TEST(OpenSource, a_file_that_was_written_the_wrong_way_round_is_turned_by_its_uri) {
  const TemporaryFolder folder;
  const ArrayDescription array = turned_array();
  for (const char* name : {"rec.mcap", "rec.csv"}) {
    write_file(folder.file(name), numbered_taxels());
    const auto source =
        opened("file:" + folder.file(name) + "?skip_columns=1&transpose=1&flip_rows=1", {.array = &array});
    ASSERT_TRUE(source);
    EXPECT_FALSE(source->is_live());
    RawFrame frame;
    ASSERT_TRUE(has_next(*source, frame));
    EXPECT_EQ(frame.counts, kTurnedCounts) << name;
    ASSERT_TRUE(has_next(*source, frame));
    EXPECT_EQ(frame.time, std::chrono::milliseconds(1)) << "the times of the file";
  }
}

TEST(OpenSource, names_an_order_of_lines_that_does_not_fit_the_frames) {
  const TemporaryFolder folder;
  write_device_bytes(folder.file("device.bin"), numbered_taxels());
  const std::string uri = "file:" + folder.file("device.bin") + "?protocol=dermis&row_order=1,0";
  RawFrame frame;
  const Result<bool> more = opened(uri)->next(frame);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().message, "'" + uri + "': row_order: has 2 lines, the array 4");
}

TEST(OpenSource, a_rate_gives_times_to_a_file_that_has_none) {
  const TemporaryFolder folder;
  write_file(folder.file("a.npy"), some_frames(3));
  write_device_bytes(folder.file("device.bin"), some_frames(3));
  for (const std::string& uri :
       {"file:" + folder.file("a.npy") + "?rate=4", "file:" + folder.file("a.npy") + "?rate=4&rows=4&cols=5",
        "file:" + folder.file("device.bin") + "?protocol=dermis&rate=4"}) {
    const auto source = opened(uri);
    ASSERT_TRUE(source);
    EXPECT_FALSE(source->is_live()) << uri;
    RawFrame frame;
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(has_next(*source, frame)) << uri;
      EXPECT_EQ(frame.time, k * std::chrono::milliseconds(250)) << uri;
    }
    EXPECT_FALSE(has_next(*source, frame));
  }
  const std::string other = "file:" + folder.file("a.npy") + "?rate=4&rows=2&cols=2";
  EXPECT_EQ(refusal(other), folder.file("a.npy") + ": has 4x5 taxels, the array is 2x2");
  write_file(folder.file("a.csv"), some_frames(3));
  const std::string timed = "file:" + folder.file("a.csv") + "?rate=4";
  EXPECT_EQ(refusal(timed), "'" + timed + "': the file has times of its own; write '" + folder.file("a.csv") +
                                "' alone, without file: and rate");
}

TEST(OpenSource, refuses_shapes_that_disagree) {
  const TemporaryFolder folder;
  const ArrayDescription array = small_array();
  ASSERT_TRUE(bytes::files::write_array(folder.file("array.toml"), array));
  ArrayDescription other = array;
  other.rows = 2;
  other.readout.drive_ohm.assign(2, 20.0);
  write_file(folder.file("frames.csv"), some_frames(1));
  write_file(folder.file("rec.mcap"), some_frames(1));
  const std::string of_uri = "sim:idle?rows=3&cols=3";
  EXPECT_EQ(refusal(of_uri, {.array = &array}), "'" + of_uri + "': has 3x3 taxels, the array 4x5");
  const std::string of_both = of_uri + "&array=" + folder.file("array.toml");
  EXPECT_EQ(refusal(of_both), "'" + of_both + "': the array of " + folder.file("array.toml") + " has 4x5 taxels");
  const std::string of_file = "sim:idle?rate=100&array=" + folder.file("array.toml");
  EXPECT_EQ(refusal(of_file, {.array = &other}), "'" + of_file + "': has 4x5 taxels, the array 2x5");
  EXPECT_EQ(refusal(folder.file("frames.csv"), {.array = &other}),
            folder.file("frames.csv") + ":1: has 4x5 taxels, the array is 2x5");
  EXPECT_EQ(refusal(folder.file("rec.mcap"), {.array = &other}),
            folder.file("rec.mcap") + ": has 4x5 taxels, the array is 2x5");
  EXPECT_EQ(refusal("file:/dev/null?protocol=dermis&rows=1&cols=1", {.array = &other}),
            "'file:/dev/null?protocol=dermis&rows=1&cols=1': rows and cols are 1x1, expected are 2x5");
}

TEST(OpenSource, refuses_what_cannot_be_simulated) {
  ArrayDescription unknown = small_array();
  unknown.readout.drive_ohm.front() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal("sim:rehearsal"), "'sim:rehearsal': needs a rate, as in sim:rehearsal?rate=100");
  EXPECT_EQ(refusal("sim:idle", {.array = &unknown}),
            "'sim:idle': a circuit that is to be fitted cannot be simulated; name it in array.toml");
  for (const char* uri :
       {"sim:walk", "sim:walk?rate=10", "sim:touches?rate=5", "sim:idle?memory=elephant", "sim:idle?rate=9&memory=x"}) {
    EXPECT_EQ(refusal(uri).find("'" + std::string(uri) + "': "), 0U) << refusal(uri);
  }
}

TEST(OpenSource, refuses_what_is_not_there) {
  EXPECT_NE(refusal("/nowhere/frames.csv").find("/nowhere/frames.csv"), std::string::npos);
  EXPECT_NE(refusal("http://x").find("begins with none of"), std::string::npos) << refusal("http://x");
  EXPECT_NE(refusal("sim:idle?speed=3").find("speed"), std::string::npos) << refusal("sim:idle?speed=3");
}

TEST(ReadFrames, gives_all_frames_of_a_file_and_none_of_a_device) {
  const TemporaryFolder folder;
  write_file(folder.file("frames.csv"), some_frames(3));
  const ArrayDescription array = small_array();
  const Result<std::vector<RawFrame>> frames = read_frames(folder.file("frames.csv"), {.array = &array});
  ASSERT_TRUE(frames) << frames.error().message;
  ASSERT_EQ(frames->size(), 3U);
  EXPECT_EQ(frames->back().counts, some_frames(3).back().counts);
  const Result<std::vector<RawFrame>> endless = read_frames("sim:idle");
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().message, "'sim:idle': is a device, which has no end; record it first");
}

TEST(SeveralArrays, are_those_of_a_recording_where_none_is_named) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  const auto writer = bytes::recordings::SuitRecordingWriter::create(
      path, {{.name = "chest", .shape = kShape}, {.name = "back", .shape = {1, 2}}});
  ASSERT_TRUE(writer);
  ASSERT_TRUE((*writer)->commit());
  const auto arrays = several_arrays(*SourceName::parse(path));
  ASSERT_TRUE(arrays) << arrays.error().message;
  EXPECT_EQ(*arrays, (std::vector<std::string>{"chest", "back"}));
  const std::string one = folder.file("one.mcap");
  write_file(one, some_frames(1));
  for (const std::string& from : {path + "#chest", one, folder.file("frames.csv"), std::string("sim:idle?rate=10")}) {
    const auto none = several_arrays(*SourceName::parse(from));
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none->empty()) << from;
  }
  EXPECT_FALSE(several_arrays(*SourceName::parse(folder.file("absent.mcap"))));
}

}  // namespace
}  // namespace dermis::live::sources
