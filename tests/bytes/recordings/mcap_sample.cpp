// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What the readers and writers of others are held against (npm_mcap_test.mjs):
//   mcap_sample write FOLDER     none.mcap, lz4.mcap and zstd.mcap, and the same frames as expected.json
//   mcap_sample frames FILE      the frames of a file as JSON, a line a frame
//   mcap_sample times FILE       sequence, arrival and lost frames of each frame, a line a frame
//   mcap_sample messages FILE    the messages of a file as JSON, a line a message
//   mcap_sample recover IN OUT
// Numbers of 32 bits are written as their bits: JSON has no NaN.
#include <fmt/core.h>

#include <bit>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::recordings {
namespace {

using Json = nlohmann::ordered_json;

constexpr FrameShape kShape{7, 9};

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

template <typename T>
Json optional_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// 64-bit numbers as texts: those of JavaScript are doubles.
Json frame_json(const RawFrame& frame) {
  const Acquisition& acquisition = frame.acquisition;
  Json json;
  json["time"] = std::to_string(frame.time.count());
  json["temperature"] = optional_json(frame.temperature_celsius);
  json["supply"] = optional_json(frame.supply_v);
  json["sequence"] = acquisition.sequence ? Json(std::to_string(*acquisition.sequence)) : Json(nullptr);
  json["device_time"] =
      acquisition.device_time ? Json(std::to_string(acquisition.device_time->count())) : Json(nullptr);
  json["arrival_steady"] = std::to_string(acquisition.arrival_steady.count());
  json["arrival_utc"] = std::to_string(acquisition.arrival_utc.count());
  json["lost_before"] = acquisition.lost_before;
  json["held_taxels"] = acquisition.held_taxels;
  json["counts"] = bits_of(frame.counts);
  return json;
}

RawFrame random_frame(Random& random, int number) {
  RawFrame frame;
  const Nanos arrival(1'760'000'000'000'000'000 + number * 1'000'000LL);
  frame.time = arrival - Nanos(static_cast<std::int64_t>(random.below(500'000)));
  frame.acquisition.arrival_utc = arrival;
  frame.acquisition.arrival_steady = Nanos(number * 1'000'000LL + 17);
  if (random.below(2) == 0) frame.temperature_celsius = random.uniform(15.0, 40.0);
  if (random.below(2) == 0) frame.supply_v = random.uniform(3.0, 5.0);
  if (random.below(2) == 0) frame.acquisition.sequence = random.bits();
  if (random.below(2) == 0) frame.acquisition.device_time = Nanos(static_cast<std::int64_t>(random.bits()));
  frame.acquisition.lost_before = static_cast<std::uint32_t>(random.below(2));
  frame.acquisition.held_taxels = static_cast<std::uint32_t>(random.below(3));
  const bool is_fractional = random.below(4) == 0;
  for (std::size_t i = 0; i < kShape.taxel_count(); ++i) {
    frame.counts.push_back(static_cast<float>(random.below(65536)) + (is_fractional ? 0.5F : 0.0F));
  }
  if (is_fractional) frame.counts[3] = std::numeric_limits<float>::quiet_NaN();
  return frame;
}

ForceFrame random_forces(Random& random, const RawFrame& frame) {
  ForceFrame forces;
  forces.time = frame.time;
  forces.status = static_cast<FrameStatus>(random.below(1024));
  for (std::size_t i = 0; i < kShape.taxel_count(); ++i) {
    forces.newtons.push_back(static_cast<float>(random.uniform(0.0, 40.0)));
    forces.sigma_newtons.push_back(random.below(9) == 0 ? std::numeric_limits<float>::infinity() : 0.25F);
    forces.taxels.push_back(static_cast<TaxelStatus>(random.below(6)));
  }
  return forces;
}

bool write_sample(const std::string& folder, McapCompression compression, const std::string& name, Json& expected) {
  RecordingOptions options;
  options.name = "left hand";
  options.array_toml = "[array]\nname = \"left hand\"\n";
  options.model_hash = "fnv1a64:0123456789abcdef";
  options.pitch = {0.004, 0.005};
  options.compression = compression;
  const auto writer = RecordingWriter::create(folder + "/" + name + ".mcap", kShape, options);
  if (!writer) return false;
  Random random(7);
  expected = Json::array();
  for (int i = 0; i < 300; ++i) {
    const RawFrame frame = random_frame(random, i);
    const ForceFrame forces = random_forces(random, frame);
    expected.push_back(frame_json(frame));
    if (i % 3 == 0) {
      expected.back()["force_status"] = static_cast<unsigned>(forces.status);
      expected.back()["newtons"] = bits_of(forces.newtons);
      expected.back()["sigma_newtons"] = bits_of(forces.sigma_newtons);
      for (const TaxelStatus status : forces.taxels) {
        expected.back()["status"].push_back(static_cast<unsigned>(status));
      }
    }
    const Status written = i % 3 == 0 ? (*writer)->write(frame, forces) : (*writer)->write(frame);
    if (!written) return false;
  }
  return (*writer)->commit().has_value();
}

bool write_samples(const std::string& folder) {
  Json expected;
  const bool written = write_sample(folder, McapCompression::none, "none", expected) &&
                       write_sample(folder, McapCompression::lz4, "lz4", expected) &&
                       write_sample(folder, McapCompression::zstd, "zstd", expected);
  std::ofstream(folder + "/expected.json") << expected.dump();
  return written;
}

bool say(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return false;
}

std::string times_of(const RawFrame& frame) {
  const Acquisition& acquisition = frame.acquisition;
  return fmt::format("{} {} {}", acquisition.sequence.value_or(0), acquisition.arrival_utc.count(),
                     acquisition.lost_before);
}

template <typename Text>
bool print_frames(const std::string& path, const Text& text_of) {
  const RecordingPlace place = recording_place(path);
  const auto reader = RecordingReader::open(place.path, place.array);
  if (!reader) return say(reader.error());
  RawFrame frame;
  while (true) {
    const Result<bool> got_frame = (*reader)->next(frame);
    if (!got_frame) return say(got_frame.error());
    if (!*got_frame) return true;
    fmt::print("{}\n", text_of(frame));
  }
}

bool print_messages(const std::string& path) {
  const auto reader = McapReader::open(path);
  if (!reader) return say(reader.error());
  McapMessage message;
  while (true) {
    const Result<bool> got_message = (*reader)->next(message);
    if (!got_message) return say(got_message.error());
    if (!*got_message) return true;
    const McapChannel& channel = (*reader)->channels().at(message.channel);
    Json json;
    json["topic"] = channel.topic;
    json["schema"] = channel.schema_name;
    json["sequence"] = message.sequence;
    json["log_time"] = std::to_string(message.log_time);
    json["publish_time"] = std::to_string(message.publish_time);
    json["data"] = std::vector<unsigned>(message.data.begin(), message.data.end());
    fmt::print("{}\n", json.dump());
  }
}

bool recover(const std::string& in, const std::string& out) {
  const Result<Recovery> recovery = recover_recording(in, out);
  if (!recovery) return say(recovery.error());
  Json json;
  json["frames"] = recovery->frames;
  json["messages"] = recovery->messages;
  json["lost_bytes"] = recovery->lost_bytes;
  fmt::print("{}\n", json.dump());
  return true;
}

bool run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 2 && arguments[0] == "write") return write_samples(arguments[1]);
  if (arguments.size() == 2 && arguments[0] == "frames") {
    return print_frames(arguments[1], [](const RawFrame& frame) { return frame_json(frame).dump(); });
  }
  if (arguments.size() == 2 && arguments[0] == "times") return print_frames(arguments[1], times_of);
  if (arguments.size() == 2 && arguments[0] == "messages") return print_messages(arguments[1]);
  if (arguments.size() == 3 && arguments[0] == "recover") return recover(arguments[1], arguments[2]);
  fmt::print(stderr, "usage: mcap_sample write FOLDER | frames FILE | times FILE | messages FILE | recover IN OUT\n");
  return false;
}

}  // namespace
}  // namespace dermis::bytes::recordings

int main(int argc, char** argv) {
  return dermis::bytes::recordings::run({argv + 1, argv + argc}) ? 0 : 1;
}
