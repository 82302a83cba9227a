// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/sources/open_source.hpp"

#include <optional>

#include "dermis/acquisition/device_source.hpp"
#include "dermis/files/taxel_text.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/suit_recording.hpp"
#include "sources/simulated_source.hpp"

namespace dermis::sources {
namespace {

std::optional<FrameShape> shape_of(const ArrayDescription* array) {
  if (array == nullptr) return std::nullopt;
  return FrameShape{array->rows, array->cols};
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

Result<std::unique_ptr<FrameSource>> open_source(const SourceName& from, const SourceOptions& options) {
  if (!from.uri) {
    return recordings::open_frames(from.text,
                                   {.shape = shape_of(options.array), .notice = options.notice, .loss = options.loss});
  }
  if (from.kind == SourceKind::simulation) return open_simulation(*from.uri, options);
  if (from.kind == SourceKind::file) return open_file(*from.uri, options);
  return acquisition::open_device(*from.uri, {shape_of(options.array), options.stop, options.notice});
}

Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const SourceOptions& options) {
  const Result<SourceName> name = SourceName::parse(from);
  if (!name) return name.error();
  return open_source(*name, options);
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

Result<std::vector<std::string>> several_arrays(const SourceName& from) {
  std::vector<std::string> names;
  if (from.kind != SourceKind::recording || !from.array.empty()) return names;
  const auto recording = recordings::SuitRecordingReader::open(from.file);
  if (!recording) return recording.error();
  if ((*recording)->arrays().size() == 1) return names;
  for (const recordings::RecordedArray& array : (*recording)->arrays()) names.push_back(array.name);
  return names;
}

}  // namespace dermis::sources
