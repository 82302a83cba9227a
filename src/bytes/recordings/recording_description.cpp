// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/recording_description.hpp"

#include <algorithm>
#include <set>

#include "bytes/recordings/recording_format.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::recordings {
namespace {

using Values = std::map<std::string, std::string>;

std::optional<FrameShape> shape_of(const Values& values) {
  FrameShape shape;
  const bool has_both = files::parse_number(value_of(values, "rows"), shape.rows) &&
                        files::parse_number(value_of(values, "cols"), shape.cols);
  const bool is_possible =
      has_both && shape.rows >= 1 && shape.rows <= kMaxLines && shape.cols >= 1 && shape.cols <= kMaxLines;
  return is_possible ? std::optional(shape) : std::nullopt;
}

RecordingDescription description_of(const Values& values) {
  RecordingDescription description;
  description.name = value_of(values, "name");
  description.folder = '/' + topic_part(description.name) + '/';
  description.shape = shape_of(values);
  description.model_hash = value_of(values, "model_hash");
  description.simulation = value_of(values, "simulation");
  description.software = value_of(values, "software");
  return description;
}

}  // namespace

std::string_view topic_folder(std::string_view topic) {
  return topic.substr(0, topic.rfind('/') + 1);
}

std::string value_of(const std::map<std::string, std::string>& values, const char* key) {
  const auto found = values.find(key);
  return found == values.end() ? std::string() : found->second;
}

std::string printable(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return files::in_quotes(name);
}

std::vector<RecordingDescription> descriptions_of(const McapReader& mcap) {
  constexpr std::size_t kMostArrays = 4096;
  std::vector<RecordingDescription> descriptions;
  std::set<std::string> folders;
  for (const McapMetadata& metadata : mcap.metadata()) {
    if (metadata.name != kRecordingMetadata || descriptions.size() == kMostArrays) continue;
    RecordingDescription description = description_of(metadata.values);
    if (folders.insert(description.folder).second) descriptions.push_back(std::move(description));
  }
  std::map<std::string, const McapAttachment*> attachments;
  for (const McapAttachment& attachment : mcap.attachments()) attachments[attachment.name] = &attachment;
  for (RecordingDescription& description : descriptions) {
    const std::string array = descriptions.size() == 1 ? "" : description.name;
    const auto data = [&](const char* of) {
      const auto found = attachments.find(attachment_name(of, array));
      return found == attachments.end() ? std::string() : found->second->data;
    };
    description.array_toml = data(kArrayAttachment);
    description.model_file = data(kModelAttachment);
  }
  return descriptions;
}

}  // namespace dermis::bytes::recordings
