// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "bytes/recordings/bag_arrays.hpp"
#include "bytes/recordings/bag_messages.hpp"
#include "bytes/recordings/message_kind.hpp"
#include "bytes/recordings/recording_description.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"

namespace dermis::bytes::recordings {
namespace {

/// Log times of the files of others may have 64 bits.
Nanos time_of(std::uint64_t log_time) {
  return Nanos(static_cast<std::int64_t>(log_time & std::numeric_limits<std::int64_t>::max()));
}

/// An array that is being read.
struct ReadArray {
  std::optional<FrameShape> shape;

  // The messages before the image, of the same frame and so of the same log time.
  RawFrame acquisition;
  std::optional<std::uint64_t> acquisition_time;
  double celsius = 0.0;
  std::optional<std::uint64_t> temperature_time;
  RawFrame sensors;  // as counts
  std::optional<std::uint64_t> sensors_time;

  void add_to(RawFrame& frame, std::uint64_t log_time);
};

void ReadArray::add_to(RawFrame& frame, std::uint64_t log_time) {
  frame.time = time_of(log_time);
  frame.acquisition = {};
  frame.acquisition.arrival_utc = frame.time;
  frame.supply_v.reset();
  frame.temperature_celsius.reset();
  if (acquisition_time == log_time) {
    frame.time = acquisition.time;
    frame.acquisition = acquisition.acquisition;
    frame.supply_v = acquisition.supply_v;
  }
  if (temperature_time == log_time) frame.temperature_celsius = celsius;
  frame.sensor_celsius.clear();
  if (sensors_time == log_time) frame.sensor_celsius = sensors.counts;
  acquisition_time.reset();
  temperature_time.reset();
  sensors_time.reset();
}

/// The meaning of a channel's messages for the frames.
struct Use {
  MessageKind kind = MessageKind::none;
  std::size_t array = 0;  ///< The first, where a message holds several.
};

}  // namespace

/// Many members: what is known of the arrays, and where the reading stands.
class SuitRecordingReader::Implementation {
 public:
  Implementation(std::unique_ptr<McapReader> mcap, std::string path) : mcap_(std::move(mcap)), path_(std::move(path)) {}

  [[nodiscard]] Status begin();
  [[nodiscard]] const std::vector<RecordedArray>& arrays() const noexcept { return arrays_; }
  void read_only(std::size_t array) { only_ = array; }
  [[nodiscard]] Result<bool> next(std::size_t& array, RawFrame& frame);
  void hear_results(std::function<void(const RecordedResult&)> hear) { hear_ = std::move(hear); }
  void seek(Nanos time);
  [[nodiscard]] bool complete() const noexcept { return mcap_->complete(); }

 private:
  void describe();
  [[nodiscard]] Use use_of(const McapMessage& message);
  [[nodiscard]] Use find_use(std::uint16_t id, const McapChannel& channel);
  void describe_bag();
  [[nodiscard]] Status read_bag_message(const McapMessage& message);
  [[nodiscard]] Use find_use_in_bag(std::uint16_t id, const McapChannel& channel) const;
  [[nodiscard]] Result<bool> read_frame(std::size_t& array, RawFrame& frame);
  [[nodiscard]] Result<bool> take_reading(std::size_t& array, RawFrame& frame);
  [[nodiscard]] std::optional<std::size_t> bag_array(std::uint16_t channel, const std::string& part) const;
  [[nodiscard]] Status read_other(const Use& use, const McapMessage& message);
  [[nodiscard]] Status read_image(const Use& use, const McapMessage& message, RawFrame& frame);
  [[nodiscard]] Status check_shape(const McapMessage& message, std::size_t array, FrameShape shape);
  [[nodiscard]] Error error(const McapMessage& message, const Error& what) const;

  std::unique_ptr<McapReader> mcap_;
  std::string path_;
  std::vector<RecordedArray> arrays_;
  std::vector<ReadArray> read_;
  std::map<std::string, std::size_t, std::less<>> folders_;  ///< Folders of the arrays' topics; empty: not known yet.
  std::map<std::uint16_t, Use> uses_;
  std::vector<BagArray> bag_;         ///< Of a file of others.
  McapMessage bag_message_;           ///< Without its data.
  std::vector<BagReading> readings_;  ///< Of that message.
  std::size_t next_reading_ = 0;
  std::optional<std::size_t> only_;
  std::function<void(const RecordedResult&)> hear_;
  std::uint64_t begin_time_ = 0;  ///< Frames of earlier log times are left out.

  RawFrame first_;  ///< Read by begin().
  std::size_t first_array_ = 0;
  bool has_first_ = false;
};

Status SuitRecordingReader::Implementation::begin() {
  bag_ = find_bag_arrays(*mcap_);
  if (mcap_->complete() && descriptions_of(*mcap_).size() > 1) mcap_->read_as_written();
  const Result<bool> got_first = read_frame(first_array_, first_);
  if (!got_first) return got_first.error();
  has_first_ = *got_first;
  if (arrays_.empty()) describe();
  return Done{};
}

/// A recording of one array is not asked for the name of its topics: it may have been made by others.
void SuitRecordingReader::Implementation::describe() {
  if (!bag_.empty()) return describe_bag();
  const std::vector<RecordingDescription> descriptions = descriptions_of(*mcap_);
  const std::size_t count = std::max<std::size_t>(descriptions.size(), 1);
  arrays_.resize(count);
  read_.resize(count);
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    const RecordingDescription& description = descriptions[i];
    arrays_[i].name = description.name;
    arrays_[i].array_toml = description.array_toml;
    arrays_[i].model_hash = description.model_hash;
    arrays_[i].simulation = description.simulation;
    arrays_[i].model_file = description.model_file;
    if (count > 1) read_[i].shape = description.shape;
    if (count > 1) folders_.emplace(description.folder, i);
  }
  for (std::size_t i = 0; i < count; ++i) arrays_[i].shape = read_[i].shape.value_or(FrameShape{});
}

/// Each has its topic as its name, but for an only one.
void SuitRecordingReader::Implementation::describe_bag() {
  arrays_.resize(bag_.size());
  read_.resize(bag_.size());
  std::map<std::string, std::set<std::uint16_t>, std::less<>> channels;
  for (std::size_t i = 0; i < bag_.size(); ++i) {
    arrays_[i].topic = bag_[i].topic;
    if (bag_.size() > 1) arrays_[i].name = bag_[i].topic;
    const std::string folder(topic_folder(mcap_->channels().at(bag_[i].channel).topic));
    channels[folder].insert(bag_[i].channel);
    folders_.emplace(folder, i);
  }
  std::erase_if(folders_, [&](const auto& folder) { return channels[folder.first].size() > 1; });
}

std::optional<std::size_t> SuitRecordingReader::Implementation::bag_array(std::uint16_t channel,
                                                                          const std::string& part) const {
  const auto found =
      std::ranges::find_if(bag_, [&](const BagArray& array) { return array.channel == channel && array.part == part; });
  if (found == bag_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - bag_.begin());
}

/// Times and temperatures of a frame stand in the folder of its topic.
Use SuitRecordingReader::Implementation::find_use_in_bag(std::uint16_t id, const McapChannel& channel) const {
  const auto array = std::ranges::find(bag_, id, &BagArray::channel);
  if (array != bag_.end()) return {MessageKind::image, static_cast<std::size_t>(array - bag_.begin())};
  const Use use{kind_of(channel), 0};
  const auto folder = folders_.find(topic_folder(channel.topic));
  if (use.kind == MessageKind::image || folder == folders_.end()) return {};
  return {use.kind, folder->second};
}

/// The first topic of images is taken where the arrays are not said; images beside sensors of touch are of cameras.
Use SuitRecordingReader::Implementation::find_use(std::uint16_t id, const McapChannel& channel) {
  if (!bag_.empty()) return find_use_in_bag(id, channel);
  Use use{kind_of(channel), 0};
  const std::string_view folder = topic_folder(channel.topic);
  if (folders_.empty()) {
    if (use.kind != MessageKind::image) return use;
    const auto is_touch = [](const auto& known) { return is_tactile_state(known.second); };
    const bool is_camera = !is_touch(std::pair(id, channel)) && std::ranges::any_of(mcap_->channels(), is_touch);
    if (is_camera) return {};
    uses_.clear();
    folders_.emplace(folder, 0);
  } else {
    const auto found = folders_.find(folder);
    if (found == folders_.end()) return {};
    use.array = found->second;
    const bool has_images = std::any_of(uses_.begin(), uses_.end(), [&](const auto& known) {
      return known.first != id && known.second.kind == MessageKind::image && known.second.array == use.array;
    });
    if (use.kind == MessageKind::image && has_images) return {};
  }
  return use;
}

Use SuitRecordingReader::Implementation::use_of(const McapMessage& message) {
  const auto known = uses_.find(message.channel);
  if (known != uses_.end()) return known->second;
  const Use use = find_use(message.channel, mcap_->channels().at(message.channel));
  uses_[message.channel] = use;
  return use;
}

Error SuitRecordingReader::Implementation::error(const McapMessage& message, const Error& what) const {
  return bad_input(path_ + ": message " + std::to_string(message.sequence) + " of " +
                   mcap_->channels().at(message.channel).topic + ": " + what.message);
}

Status SuitRecordingReader::Implementation::read_other(const Use& use, const McapMessage& message) {
  ReadArray& array = read_[use.array];
  if (use.kind == MessageKind::acquisition) {
    const Status taken = ros_messages::decode_acquisition(message.data, array.acquisition);
    if (!taken) return error(message, taken.error());
    array.acquisition_time = message.log_time;
  } else if (use.kind == MessageKind::temperature) {
    const Result<double> taken = ros_messages::decode_temperature(message.data);
    if (!taken) return error(message, taken.error());
    array.celsius = *taken;
    array.temperature_time = message.log_time;
  } else if (use.kind == MessageKind::sensors) {
    const Result<FrameShape> taken = ros_messages::decode_image(message.data, array.sensors);
    if (!taken) return error(message, taken.error());
    array.sensors_time = message.log_time;
  } else if (hear_) {
    const bool is_force = use.kind == MessageKind::force;
    hear_({is_force ? RecordedResult::Kind::force : RecordedResult::Kind::contacts, use.array,
           time_of(message.log_time), message.data});
  }
  return Done{};
}

Status SuitRecordingReader::Implementation::read_image(const Use& use, const McapMessage& message, RawFrame& frame) {
  ReadArray& array = read_[use.array];
  const Result<FrameShape> decoded = decode_counts(mcap_->channels().at(message.channel), message.data, frame);
  if (!decoded) return error(message, decoded.error());
  if (Status same = check_shape(message, use.array, *decoded); !same) return same;
  array.add_to(frame, message.log_time);
  return Done{};
}

Status SuitRecordingReader::Implementation::check_shape(const McapMessage& message, std::size_t array,
                                                        FrameShape shape) {
  std::optional<FrameShape>& first = read_[array].shape;
  if (first && shape != *first) {
    return error(message,
                 bad_input("the image is " + files::size_text(shape) + ", the first " + files::size_text(*first)));
  }
  first = shape;
  arrays_[array].shape = shape;
  return Done{};
}

/// The next array of the message that was read last; false: there is none.
Result<bool> SuitRecordingReader::Implementation::take_reading(std::size_t& array, RawFrame& frame) {
  while (next_reading_ < readings_.size()) {
    const BagReading& reading = readings_[next_reading_++];
    const std::optional<std::size_t> found = bag_array(bag_message_.channel, reading.part);
    if (!found || (only_ && *only_ != *found)) continue;
    array = *found;
    if (const Status same = check_shape(bag_message_, array, reading.shape); !same) return same.error();
    frame = reading.frame;
    if (kind_of(mcap_->channels().at(bag_message_.channel)) == MessageKind::image) {
      read_[array].add_to(frame, bag_message_.log_time);
    } else if (!reading.has_times) {
      frame.time = time_of(bag_message_.log_time);
      frame.acquisition = {};
      frame.acquisition.arrival_utc = frame.time;
    }
    return true;
  }
  return false;
}

/// Topics of which no array is wanted are passed over unread.
Status SuitRecordingReader::Implementation::read_bag_message(const McapMessage& message) {
  if (only_ && bag_[*only_].channel != message.channel) return Done{};
  bag_message_ = message;
  next_reading_ = 0;
  const Status read = read_readings(mcap_->channels().at(message.channel), message.data, readings_);
  if (!read) return error(message, read.error());
  return Done{};
}

Result<bool> SuitRecordingReader::Implementation::read_frame(std::size_t& array, RawFrame& frame) {
  McapMessage message;
  while (true) {
    Result<bool> next_reading = take_reading(array, frame);
    if (!next_reading || *next_reading) return next_reading;
    Result<bool> got_message = mcap_->next(message);
    if (!got_message || !*got_message) return got_message;
    if (arrays_.empty()) describe();
    const Use use = use_of(message);
    const bool is_wanted = !only_ || *only_ == use.array || !bag_.empty();
    if (use.kind == MessageKind::none || !is_wanted || message.log_time < begin_time_) continue;
    if (use.kind == MessageKind::image && !bag_.empty()) {
      if (const Status read = read_bag_message(message); !read) return read.error();
    } else if (use.kind == MessageKind::image) {
      if (const Status taken = read_image(use, message, frame); !taken) return taken.error();
      array = use.array;
      return true;
    } else if (const Status other = read_other(use, message); !other) {
      return other.error();
    }
  }
}

Result<bool> SuitRecordingReader::Implementation::next(std::size_t& array, RawFrame& frame) {
  const bool is_first = std::exchange(has_first_, false);
  if (!is_first || (only_ && *only_ != first_array_)) return read_frame(array, frame);
  std::swap(frame, first_);
  array = first_array_;
  return true;
}

void SuitRecordingReader::Implementation::seek(Nanos time) {
  begin_time_ = static_cast<std::uint64_t>(std::max<std::int64_t>(time.count(), 0));
  has_first_ = false;
  readings_.clear();
  mcap_->seek(begin_time_);
  for (ReadArray& array : read_) {
    array.acquisition_time.reset();
    array.temperature_time.reset();
    array.sensors_time.reset();
  }
}

SuitRecordingReader::SuitRecordingReader(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

SuitRecordingReader::~SuitRecordingReader() = default;

Result<std::unique_ptr<SuitRecordingReader>> SuitRecordingReader::open(const std::string& path) {
  Result<std::unique_ptr<std::istream>> in = files::open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path);
}

Result<std::unique_ptr<SuitRecordingReader>> SuitRecordingReader::open(std::unique_ptr<std::istream> in,
                                                                       const std::string& name) {
  Result<std::unique_ptr<McapReader>> mcap = McapReader::open(std::move(in), name);
  if (!mcap) return mcap.error();
  auto implementation = std::make_unique<Implementation>(*std::move(mcap), name);
  if (const Status begun = implementation->begin(); !begun) return begun.error();
  return std::unique_ptr<SuitRecordingReader>(new SuitRecordingReader(std::move(implementation)));
}

const std::vector<RecordedArray>& SuitRecordingReader::arrays() const noexcept {
  return implementation_->arrays();
}

void SuitRecordingReader::read_only(std::size_t array) {
  assert(array < arrays().size());
  implementation_->read_only(array);
}

Result<bool> SuitRecordingReader::next(std::size_t& array, RawFrame& frame) {
  return implementation_->next(array, frame);
}

void SuitRecordingReader::hear_results(std::function<void(const RecordedResult&)> hear) {
  implementation_->hear_results(std::move(hear));
}

void SuitRecordingReader::seek(Nanos time) {
  implementation_->seek(time);
}

bool SuitRecordingReader::complete() const noexcept {
  return implementation_->complete();
}

}  // namespace dermis::bytes::recordings
