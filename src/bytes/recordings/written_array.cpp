// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/written_array.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "bytes/recordings/recording_format.hpp"
#include "dermis/touch/frames/version.hpp"

namespace dermis::bytes::recordings {

std::uint64_t log_time_of(Nanos time) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(time.count(), 0));
}

McapMetadata metadata_of(const RecordedArray& array) {
  McapMetadata metadata = {kRecordingMetadata,
                           {{"name", array.name},
                            {"rows", std::to_string(array.shape.rows)},
                            {"cols", std::to_string(array.shape.cols)},
                            {"model_hash", array.model_hash},
                            {"software", "dermis " DERMIS_VERSION}}};
  if (!array.simulation.empty()) metadata.values["simulation"] = array.simulation;
  return metadata;
}

WrittenArray::WrittenArray(RecordedArray description)
    : description_(std::move(description)), frame_id_(topic_part(description_.name)) {}

void WrittenArray::encode(const RawFrame& frame, const ForceFrame* force) {
  assert(frame.counts.size() == description_.shape.taxel_count());
  log_time_ = std::max(log_time_, log_time_of(frame.time));
  temperature_.is_in_frame = frame.temperature_celsius.has_value();
  if (frame.temperature_celsius) {
    ros_messages::encode_temperature(*frame.temperature_celsius, frame.time, frame_id_, temperature_.message);
  }
  encode_sensors(frame);
  ros_messages::encode_acquisition(frame, acquisition_.message);
  acquisition_.is_in_frame = true;
  force_status_.is_in_frame = force_.is_in_frame = force != nullptr;
  if (force != nullptr) {
    ros_messages::encode_frame_status(*force, force_status_.message);
    ros_messages::encode_grid(*force, description_.shape, description_.pitch, frame_id_, force_.message);
  }
  ros_messages::encode_image(frame, description_.shape, frame_id_, raw_.message);
  raw_.is_in_frame = true;
}

/// As an image of one row. With one sensor a taxel it has the shape of the array, since a row is no longer than
/// kMaxLines.
void WrittenArray::encode_sensors(const RawFrame& frame) {
  const std::size_t count = frame.sensor_celsius.size();
  sensors_.is_in_frame = count > 0;
  if (!sensors_.is_in_frame) return;
  const FrameShape& taxels = description_.shape;
  const FrameShape shape = count == taxels.taxel_count() ? taxels : FrameShape{1, count};
  ros_messages::encode_value_image(frame.sensor_celsius, frame.time, shape, frame_id_, sensors_.message);
}

}  // namespace dermis::bytes::recordings
