// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "bytes/recordings/bag_arrays.hpp"
#include "bytes/recordings/message_kind.hpp"
#include "bytes/recordings/recording_counts.hpp"
#include "bytes/recordings/recording_description.hpp"
#include "bytes/recordings/recording_format.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::bytes::recordings {
namespace {

std::string compression_text(const std::vector<McapCompression>& compressions) {
  std::string text;
  for (const McapCompression compression : compressions) {
    if (!text.empty()) text += '+';
    text += compression == McapCompression::none ? "none" : to_string(compression);
  }
  return text.empty() ? "none" : text;
}

using Values = std::map<std::string, std::string>;

std::optional<std::uint64_t> number_of(const Values& values, const char* key) {
  std::uint64_t number = 0;
  return files::parse_number(value_of(values, key), number) ? std::optional(number) : std::nullopt;
}

RecordedArrayInfo info_of(const RecordingDescription& description) {
  RecordedArrayInfo info;
  info.name = description.name;
  info.array_toml = description.array_toml;
  info.model_hash = description.model_hash;
  info.simulation = description.simulation;
  info.model_file = description.model_file;
  info.shape = description.shape;
  return info;
}

void set_times(std::uint64_t first, std::uint64_t last, RecordingInfo& info) {
  info.start_utc = Nanos(static_cast<std::int64_t>(first));
  info.duration_s = last > first ? 1e-9 * static_cast<double>(last - first) : 0.0;
}

using Counts = std::map<std::uint16_t, std::uint64_t>;

std::uint64_t count_of(const Counts& counts, std::uint16_t channel) {
  const auto found = counts.find(channel);
  return found == counts.end() ? 0 : found->second;
}

void set_topics(const McapReader& reader, const Counts& counts, RecordingInfo& info) {
  info.topics.clear();
  for (const auto& [id, channel] : reader.channels()) {
    info.topics.push_back({channel.topic, channel.schema_name, count_of(counts, id)});
  }
}

/// The end of the file about an array; for the only one it has no name.
const McapMetadata* totals_of(const McapReader& reader, const std::string& name, bool is_only_one) {
  const std::vector<McapMetadata>& all = reader.metadata();
  const auto found = std::find_if(all.begin(), all.end(), [&](const McapMetadata& metadata) {
    return metadata.name == kTotalsMetadata && (is_only_one || value_of(metadata.values, "name") == name);
  });
  return found == all.end() ? nullptr : &*found;
}

/// Whether the images that can be read are as many. Those of the only array may be in any folder.
bool has_images(const McapReader& reader, std::string_view folder, std::uint64_t frames) {
  const Counts& counts = reader.statistics()->channel_messages;
  return std::any_of(reader.channels().begin(), reader.channels().end(), [&](const auto& channel) {
    const bool is_image = kind_of(channel.second) == MessageKind::image;
    const bool is_of_array = folder.empty() || topic_folder(channel.second.topic) == folder;
    return is_image && is_of_array && count_of(counts, channel.first) == frames;
  });
}

/// From the summary of a file of dermis alone; returns false where that does not suffice.
bool read_totals(const McapReader& reader, RecordingInfo& info) {
  if (!reader.statistics()) return false;
  for (const RecordingDescription& description : descriptions_of(reader)) info.arrays.push_back(info_of(description));
  const bool is_only_one = info.arrays.size() == 1;
  for (RecordedArrayInfo& array : info.arrays) {
    const McapMetadata* totals = totals_of(reader, array.name, is_only_one);
    const std::optional<std::uint64_t> frames = totals != nullptr ? number_of(totals->values, "frames") : std::nullopt;
    const std::optional<std::uint64_t> lost = totals != nullptr ? number_of(totals->values, "lost") : std::nullopt;
    if (!array.shape || !frames || !lost) return false;
    const std::string folder = is_only_one ? std::string() : '/' + topic_part(array.name) + '/';
    if (*frames > 0 && !has_images(reader, folder, *frames)) return false;
    array.frames = *frames;
    array.lost = *lost;
  }
  if (info.arrays.empty()) return false;
  set_times(reader.statistics()->first_log_time, reader.statistics()->last_log_time, info);
  set_topics(reader, reader.statistics()->channel_messages, info);
  return true;
}

void set_counts(const FrameCounts& counts, RecordedArrayInfo& array) {
  array.frames = counts.frames;
  array.lost = counts.lost;
  array.shape = counts.shape ? counts.shape : array.shape;
}

/// Takes the counts of a file that was read whole.
void read_counts(const McapReader& reader, const RecordingCounts& counts, RecordingInfo& info) {
  const std::vector<RecordingDescription> descriptions = descriptions_of(reader);
  info.arrays.clear();
  if (descriptions.size() < 2) {
    info.arrays.push_back(descriptions.empty() ? RecordedArrayInfo{} : info_of(descriptions.front()));
    info.arrays.front().shape.reset();
    set_counts(counts.first(), info.arrays.front());
    set_times(counts.first().first_log_time, counts.first().last_log_time, info);
    return;
  }
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last = 0;
  for (const RecordingDescription& description : descriptions) {
    const FrameCounts of_array = counts.in_folder(description.folder);
    info.arrays.push_back(info_of(description));
    set_counts(of_array, info.arrays.back());
    if (of_array.frames == 0) continue;
    first = std::min(first, of_array.first_log_time);
    last = std::max(last, of_array.last_log_time);
  }
  set_times(last == 0 ? 0 : first, last, info);
}

/// Why a topic with messages gives no frames; empty where nobody expects any of it.
std::string why_unread(const McapChannel& channel) {
  const std::string image = ros_messages::image_type().name;
  if (channel.schema_name == image && channel.encoding != "cdr") {
    return "the images of " + printable(channel.topic) + " are in " + printable(channel.encoding) +
           "; frames are read in 'cdr'";
  }
  if (channel.schema_name.empty() && channel.topic.ends_with("/raw")) {
    return "the messages of " + printable(channel.topic) + " have no schema; frames are read of " + image;
  }
  return {};
}

/// The reason for arrays that should have frames and have none.
std::string why_unread(const McapReader& reader, const Counts& counts, const RecordingInfo& info) {
  for (const RecordedArrayInfo& array : info.arrays) {
    if (array.frames > 0) continue;
    const std::string folder = '/' + topic_part(array.name) + '/';
    for (const auto& [id, channel] : reader.channels()) {
      const bool is_of_array = info.arrays.size() == 1 || topic_folder(channel.topic) == folder;
      std::string why = is_of_array && count_of(counts, id) > 0 ? why_unread(channel) : std::string();
      if (!why.empty()) return why;
    }
  }
  return {};
}

/// Where the first frame cannot be read, the summary says how many messages there are.
Status count_all(McapReader& reader, const std::string& name, RecordingInfo& info) {
  RecordingCounts counts;
  McapMessage message;
  Result<bool> got_message = true;
  while ((got_message = reader.next(message)) && *got_message) {
    counts.count(message, reader.channels().at(message.channel));
  }
  const bool has_summary = reader.statistics().has_value();
  const bool has_begun = !counts.messages().empty();
  if (!got_message && (has_begun || !has_summary)) return got_message.error();
  read_counts(reader, counts, info);
  const Counts& messages = got_message ? counts.messages() : reader.statistics()->channel_messages;
  set_topics(reader, messages, info);
  info.unread = got_message ? counts.unread() : got_message.error().message.substr(name.size() + 2);
  if (info.unread.empty()) info.unread = why_unread(reader, messages, info);
  return Done{};
}

/// Arrays of a file of others that are more than one topic of images, by reading all frames.
Status count_bag(const std::string& path, RecordingInfo& info) {
  const Result<std::unique_ptr<SuitRecordingReader>> bag = SuitRecordingReader::open(path);
  if (!bag || (*bag)->arrays().front().topic.empty()) return Done{};
  const std::vector<RecordedArray>& arrays = (*bag)->arrays();
  if (arrays.size() == 1 && info.arrays.front().frames > 0) return Done{};
  info.arrays.assign(arrays.size(), {});
  for (std::size_t k = 0; k < arrays.size(); ++k) info.arrays[k].name = arrays.size() > 1 ? arrays[k].name : "";
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  RawFrame frame;
  std::size_t array = 0;
  Result<bool> more = true;
  for (bool is_first = true; (more = (*bag)->next(array, frame)) && *more; is_first = false) {
    last = static_cast<std::uint64_t>(frame.acquisition.arrival_utc.count());
    if (is_first) first = last;
    info.arrays[array].shape = arrays[array].shape;
    ++info.arrays[array].frames;
  }
  if (!more) return more.error();
  set_times(first, last, info);
  info.unread.clear();
  return Done{};
}

/// The totals may be those of a file that was written again by others.
bool begins_with_frame(McapReader& reader) {
  McapMessage message;
  RawFrame frame;
  while (true) {
    const Result<bool> got_message = reader.next(message);
    if (!got_message || !*got_message) return false;
    const McapChannel& channel = reader.channels().at(message.channel);
    if (kind_of(channel) == MessageKind::image) return decode_counts(channel, message.data, frame).has_value();
  }
}

std::uint64_t frames_of(const RecordingInfo& info) {
  std::uint64_t frames = 0;
  for (const RecordedArrayInfo& array : info.arrays) frames += array.frames;
  return frames;
}

}  // namespace

Result<RecordingInfo> recording_info(const std::string& path) {
  Result<std::unique_ptr<McapReader>> reader = McapReader::open(path);
  if (!reader) return reader.error();
  RecordingInfo info;
  const bool is_known = read_totals(**reader, info) && (frames_of(info) == 0 || begins_with_frame(**reader));
  if (!is_known) {
    reader = McapReader::open(path);
    if (!reader) return reader.error();
    if (const Status counted = count_all(**reader, path, info); !counted) return counted.error();
    if (const Status counted = count_bag(path, info); !counted) return counted.error();
    if (frames_of(info) == 0 && info.unread.empty()) {
      (*reader)->rewind();
      info.unread = why_no_array(**reader);
    }
  }
  info.complete = (*reader)->complete();
  info.compression = compression_text((*reader)->compressions());
  const std::vector<RecordingDescription> descriptions = descriptions_of(**reader);
  if (!descriptions.empty()) info.software_version = descriptions.front().software;
  info.frames = frames_of(info);
  for (const RecordedArrayInfo& array : info.arrays) info.lost += array.lost;
  return info;
}

}  // namespace dermis::bytes::recordings
