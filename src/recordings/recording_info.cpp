// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <limits>
#include <utility>

#include "dermis/files/text.hpp"
#include "dermis/recordings/recording.hpp"
#include "recordings/recording_counts.hpp"
#include "recordings/recording_description.hpp"
#include "recordings/recording_format.hpp"

namespace dermis::recordings {
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
  info.shape = description.shape;
  return info;
}

void set_times(std::uint64_t first, std::uint64_t last, RecordingInfo& info) {
  info.start_utc = Nanos(static_cast<std::int64_t>(first));
  info.duration_s = last > first ? 1e-9 * static_cast<double>(last - first) : 0.0;
}

void set_topics(const McapReader& reader, const std::map<std::uint16_t, std::uint64_t>& counts, RecordingInfo& info) {
  for (const auto& [id, channel] : reader.channels()) {
    const auto count = counts.find(id);
    info.topics.push_back({channel.topic, channel.schema_name, count == counts.end() ? 0 : count->second});
  }
}

/// What the end of the file says of an array; of the only one it is said without its name.
const McapMetadata* totals_of(const McapReader& reader, const std::string& name, bool is_only_one) {
  const std::vector<McapMetadata>& all = reader.metadata();
  const auto found = std::find_if(all.begin(), all.end(), [&](const McapMetadata& metadata) {
    return metadata.name == kTotalsMetadata && (is_only_one || value_of(metadata.values, "name") == name);
  });
  return found == all.end() ? nullptr : &*found;
}

/// From the summary of a file of dermis alone; returns false where that does not tell.
bool read_totals(const McapReader& reader, RecordingInfo& info) {
  if (!reader.statistics()) return false;
  for (const RecordingDescription& description : descriptions_of(reader)) info.arrays.push_back(info_of(description));
  for (RecordedArrayInfo& array : info.arrays) {
    const McapMetadata* totals = totals_of(reader, array.name, info.arrays.size() == 1);
    const std::optional<std::uint64_t> frames = totals != nullptr ? number_of(totals->values, "frames") : std::nullopt;
    const std::optional<std::uint64_t> lost = totals != nullptr ? number_of(totals->values, "lost") : std::nullopt;
    if (!array.shape || !frames || !lost) return false;
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

/// Of a file of which all was read.
void take_counts(const McapReader& reader, const RecordingCounts& counts, RecordingInfo& info) {
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

Status count_all(McapReader& reader, RecordingInfo& info) {
  RecordingCounts counts;
  McapMessage message;
  while (true) {
    const Result<bool> got_message = reader.next(message);
    if (!got_message) return got_message.error();
    if (!*got_message) break;
    counts.count(message, reader.channels().at(message.channel));
  }
  take_counts(reader, counts, info);
  set_topics(reader, counts.messages(), info);
  return Done{};
}

}  // namespace

Result<RecordingInfo> recording_info(const std::string& path) {
  const Result<std::unique_ptr<McapReader>> reader = McapReader::open(path);
  if (!reader) return reader.error();
  RecordingInfo info;
  if (!read_totals(**reader, info)) {
    if (const Status counted = count_all(**reader, info); !counted) return counted.error();
  }
  info.complete = (*reader)->complete();
  info.compression = compression_text((*reader)->compressions());
  const std::vector<RecordingDescription> descriptions = descriptions_of(**reader);
  if (!descriptions.empty()) info.software_version = descriptions.front().software;
  for (const RecordedArrayInfo& array : info.arrays) {
    info.frames += array.frames;
    info.lost += array.lost;
  }
  return info;
}

}  // namespace dermis::recordings
