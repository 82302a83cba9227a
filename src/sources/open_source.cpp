// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/sources/open_source.hpp"

#include <optional>

#include "dermis/acquisition/device_source.hpp"
#include "dermis/files/taxel_text.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/recording.hpp"
#include "dermis/recordings/suit_recording.hpp"
#include "sources/simulated_source.hpp"

namespace dermis::sources {
namespace {

std::optional<FrameShape> shape_of(const ArrayDescription* array) {
  if (array == nullptr) return std::nullopt;
  return FrameShape{array->rows, array->cols};
}

/// With a rate and without a protocol, a file may be more than the bytes of a device.
bool is_file_of_frames(const acquisition::SourceUri& uri) {
  return uri.transport == acquisition::Transport::file && uri.rate_hz && uri.protocol.name == "auto" &&
         recordings::frame_format(recordings::recording_place(uri.path).path);
}

Result<std::unique_ptr<FrameSource>> open_file(const acquisition::SourceUri& uri, const SourceOptions& options) {
  const std::optional<FrameShape> given = uri.protocol.shape;
  const std::optional<FrameShape> wanted = shape_of(options.array);
  if (given && wanted && *given != *wanted) {
    return bad_input("'" + uri.text + "': rows and cols are " + files::size_text(*given) + ", the array is " +
                     files::size_text(*wanted));
  }
  const Result<recordings::FrameFormat> format = recordings::recognise_frames(uri.path);
  if (!format) return format.error();
  if (recordings::has_times(*format)) {
    return bad_input("'" + uri.text + "': the file has times of its own; write '" + uri.path +
                     "' alone, without file: and rate");
  }
  return recordings::open_frames(
      uri.path,
      {.shape = given ? given : wanted, .rate_hz = uri.rate_hz, .notice = options.notice, .loss = options.loss});
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const SourceOptions& options) {
  if (!acquisition::is_source_uri(from)) {
    return recordings::open_frames(from,
                                   {.shape = shape_of(options.array), .notice = options.notice, .loss = options.loss});
  }
  const Result<acquisition::SourceUri> uri = acquisition::parse_source_uri(from);
  if (!uri) return uri.error();
  return open_source(*uri, options);
}

Result<std::unique_ptr<FrameSource>> open_source(const acquisition::SourceUri& uri, const SourceOptions& options) {
  if (uri.transport == acquisition::Transport::simulation) return open_simulation(uri, options);
  if (is_file_of_frames(uri)) return open_file(uri, options);
  return acquisition::open_device(uri, {shape_of(options.array), options.stop, options.notice});
}

Result<std::vector<RawFrame>> read_frames(const std::string& from, const SourceOptions& options) {
  const Result<std::unique_ptr<FrameSource>> source = open_source(from, options);
  if (!source) return source.error();
  if ((*source)->is_live()) return has_no_end(from);
  return recordings::read_frames(**source);
}

Error has_no_end(const std::string& from) {
  return bad_input("'" + from + "': is a device, which has no end; 'dermis record' it first");
}

Result<std::vector<std::string>> several_arrays(const std::string& from) {
  std::vector<std::string> names;
  if (acquisition::is_source_uri(from)) return names;
  const recordings::RecordingPlace place = recordings::recording_place(from);
  const Result<recordings::FrameFormat> format = recordings::frame_format(place.path);
  if (!place.array.empty() || !format || *format != recordings::FrameFormat::mcap) return names;
  const auto recording = recordings::SuitRecordingReader::open(place.path);
  if (!recording) return recording.error();
  if ((*recording)->arrays().size() == 1) return names;
  for (const recordings::RecordedArray& array : (*recording)->arrays()) names.push_back(array.name);
  return names;
}

std::string file_of(const std::string& from) {
  const bool is_uri = acquisition::is_source_uri(from);
  const Result<acquisition::SourceUri> uri = acquisition::parse_source_uri(from);
  return recordings::recording_place(is_uri && uri ? uri->path : from).path;
}

}  // namespace dermis::sources
