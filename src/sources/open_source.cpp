// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/sources/open_source.hpp"

#include <optional>

#include "dermis/acquisition/device_source.hpp"
#include "dermis/files/taxel_text.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/suit_recording.hpp"
#include "dermis/sources/recorded_order.hpp"
#include "sources/simulated_source.hpp"
#include "sources/turned_source.hpp"

namespace dermis::sources {
namespace {

std::optional<FrameShape> shape_of(const ArrayDescription* array) {
  if (array == nullptr) return std::nullopt;
  return FrameShape{array->rows, array->cols};
}

/// Shape of the frames before the order of the URI turns them.
std::optional<FrameShape> sent_shape(const acquisition::SourceUri& uri, std::optional<FrameShape> turned) {
  if (!turned) return std::nullopt;
  return uri.order.sent(*turned);
}

Result<std::unique_ptr<FrameSource>> open_file(const acquisition::SourceUri& uri, const SourceOptions& options) {
  const std::optional<FrameShape> given = uri.protocol.shape;
  const std::optional<FrameShape> wanted = sent_shape(uri, shape_of(options.array));
  if (given && wanted && *given != *wanted) {
    return bad_input("'" + uri.text + "': rows and cols are " + files::size_text(*given) + ", the array is " +
                     files::size_text(*wanted));
  }
  const Result<recordings::FrameFormat> format = recordings::recognise_frames(uri.path);
  if (!format) return format.error();
  if (uri.rate_hz && recordings::has_times(*format)) {
    return bad_input("'" + uri.text + "': the file has times of its own; write '" + uri.path +
                     "' alone, without file: and rate");
  }
  return recordings::open_frames(
      uri.path,
      {.shape = given ? given : wanted, .rate_hz = uri.rate_hz, .notice = options.notice, .loss = options.loss});
}

/// Costs a second look at the file where its array is turned, and nothing else.
Status check_order(const std::string& path, const ArrayDescription* array) {
  if (array == nullptr || array->order.is_plain()) return Done{};
  const Result<recordings::FrameNotes> notes = recordings::read_frame_notes(path);
  return notes ? check_recorded_order(path, notes->array_toml, *array) : Status(Done{});
}

/// Its frames as they are sent are turned by the array's description. Those of files were turned when they were
/// written.
Result<std::unique_ptr<FrameSource>> open_device(const acquisition::SourceUri& uri, const SourceOptions& options) {
  std::optional<FrameShape> shape = shape_of(options.array);
  if (shape) shape = options.array->order.sent(*shape);
  return acquisition::open_device(uri, {sent_shape(uri, shape), options.stop, options.notice});
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_source(const SourceName& from, const SourceOptions& options) {
  if (!from.uri) {
    if (Status order = check_order(from.text, options.array); !order) return order.error();
    return recordings::open_frames(from.text,
                                   {.shape = shape_of(options.array), .notice = options.notice, .loss = options.loss});
  }
  if (from.kind == SourceKind::simulation) return open_simulation(*from.uri, options);
  const bool is_file = from.kind == SourceKind::file;
  Result<std::unique_ptr<FrameSource>> source =
      is_file ? open_file(*from.uri, options) : open_device(*from.uri, options);
  if (!source) return source.error();
  std::unique_ptr<FrameSource> turned = turned_source(*std::move(source), from.uri->order, from.text);
  return is_file || options.array == nullptr ? std::move(turned)
                                             : turned_source(std::move(turned), options.array->order, from.text);
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
