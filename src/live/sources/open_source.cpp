// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/open_source.hpp"

#include <optional>

#include "dermis/bytes/devices/device_source.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/live/buses/open_bus.hpp"
#include "dermis/live/fleet/frame_stream.hpp"
#include "dermis/live/sources/recorded_order.hpp"
#include "dermis/touch/frames/turned_source.hpp"
#include "live/sources/simulated_source.hpp"

namespace dermis::live::sources {
namespace {

std::optional<FrameShape> shape_of(const ArrayDescription* array) {
  if (array == nullptr) return std::nullopt;
  return FrameShape{array->rows, array->cols};
}

Result<std::unique_ptr<FrameSource>> open_file(const bytes::devices::SourceUri& uri, const SourceOptions& options) {
  const std::optional<FrameShape> given = uri.protocol.shape;
  std::optional<FrameShape> wanted = shape_of(options.array);
  if (wanted) wanted = uri.order.sent(*wanted);
  if (given && wanted && *given != *wanted) {
    return bad_input("'" + uri.text + "': rows and cols are " + bytes::files::size_text(*given) + ", the array is " +
                     bytes::files::size_text(*wanted));
  }
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::recognise_frames(uri.path);
  if (!format) return format.error();
  if (uri.rate_hz && bytes::recordings::has_times(*format)) {
    return bad_input("'" + uri.text + "': the file has times of its own; write '" + uri.path +
                     "' alone, without file: and rate");
  }
  Result<std::unique_ptr<FrameSource>> frames = bytes::recordings::open_frames(
      uri.path,
      {.shape = given ? given : wanted, .rate_hz = uri.rate_hz, .notice = options.notice, .loss = options.loss});
  if (!frames) return frames.error();
  return turned_source(*std::move(frames), uri.order, uri.text);
}

/// Costs a second look at the file where its array is turned, and nothing else.
Status check_order(const std::string& path, const ArrayDescription* array) {
  if (array == nullptr || array->order.is_plain()) return Done{};
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(path);
  return notes ? check_recorded_order(path, notes->array_toml, *array) : Status(Done{});
}

/// The circuit in array.toml of readings in such a unit; empty: there is none.
std::string circuit_of(const std::string& unit) {
  if (unit == "kPa") return "pressure";
  return unit == "newtons" ? "force" : "";
}

/// The readings of a layout must be what the description of the array says.
Status check_unit(const bytes::devices::SourceUri& uri, const ArrayDescription& array) {
  if (!uri.protocol.has_layout()) return Done{};
  const Result<std::string> unit = bytes::devices::unit_of(uri.protocol);
  if (!unit) return bad_input("'" + uri.text + "': " + unit.error().message);
  const Readout& readout = array.readout;
  const std::string is = readout.quantity == Quantity::pressure ? "kPa"
                         : readout.quantity == Quantity::force  ? "newtons"
                                                                : "counts";
  if (*unit == is) return Done{};
  const std::string place =
      "'" + uri.text + "': readings are " + *unit + " by the layout and " + is + " by the description of the array";
  const std::string circuit = circuit_of(*unit);
  if (!circuit.empty()) return bad_input(place + ": write circuit = \"" + circuit + "\" in it");
  const std::optional<double> full_scale_v = readout.adc_reference_v ? readout.adc_reference_v : readout.supply_v;
  if (*unit != "volts" || is != "counts" || !full_scale_v) return bad_input(place);
  return bad_input(place + ": counts are volts times " + std::to_string(readout.full_scale_counts() / *full_scale_v) +
                   ", by scale in the layout");
}

/// Its frames are turned as the array's description says. Those of files were turned when they were written.
Result<std::unique_ptr<FrameSource>> open_device(const bytes::devices::SourceUri& uri, const SourceOptions& options) {
  bytes::devices::DeviceOptions device_options{{}, options.stop, options.notice, options.received};
  if (options.array == nullptr) return bytes::devices::open_device(uri, device_options);
  if (Status same = check_unit(uri, *options.array); !same) return same.error();
  const LineOrder& order = options.array->order;
  device_options.shape = order.sent(*shape_of(options.array));
  Result<std::unique_ptr<FrameSource>> device = bytes::devices::open_device(uri, device_options);
  if (!device) return device.error();
  return turned_source(*std::move(device), order, uri.text);
}

/// Its frames are turned as the array's description says, unless another dermis has done so.
Result<std::unique_ptr<FrameSource>> open_bus(const buses::BusAddress& address, const SourceOptions& options) {
  buses::BusOptions bus_options{{}, options.stop, options.notice};
  if (options.array == nullptr) return buses::open_bus(address, bus_options);
  const LineOrder order = buses::sends_turned_frames(address) ? LineOrder{} : options.array->order;
  bus_options.shape = order.sent(*shape_of(options.array));
  Result<std::unique_ptr<FrameSource>> bus = buses::open_bus(address, bus_options);
  if (!bus) return bus.error();
  return turned_source(*std::move(bus), order, address.text);
}

/// Its frames were turned before they were published.
Result<std::unique_ptr<FrameSource>> open_stream(const fleet::StreamAddress& address, const SourceOptions& options) {
  Result<std::unique_ptr<fleet::FrameStream>> stream =
      fleet::FrameStream::open(address, {.stop = options.stop, .notice = options.notice});
  if (!stream) return stream.error();
  const std::optional<FrameShape> wanted = shape_of(options.array);
  const FrameShape shape = *(*stream)->shape();
  if (wanted && *wanted != shape) {
    return bad_input("'" + address.text + "': frames are " + bytes::files::size_text(shape) + ", the array is " +
                     bytes::files::size_text(*wanted));
  }
  return std::unique_ptr<FrameSource>(*std::move(stream));
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_source(const SourceName& from, const SourceOptions& options) {
  if (from.stream) return open_stream(*from.stream, options);
  if (from.bus) return open_bus(*from.bus, options);
  if (!from.uri) {
    if (Status order = check_order(from.text, options.array); !order) return order.error();
    return bytes::recordings::open_frames(
        from.text, {.shape = shape_of(options.array), .notice = options.notice, .loss = options.loss});
  }
  if (from.kind == SourceKind::simulation) return open_simulation(*from.uri, options);
  if (from.kind == SourceKind::file) return open_file(*from.uri, options);
  return open_device(*from.uri, options);
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
  return bytes::recordings::read_frames(**source);
}

Error has_no_end(const std::string& from) {
  return bad_input("'" + from + "': is a device, which has no end; record it first");
}

Result<std::vector<std::string>> several_arrays(const SourceName& from) {
  std::vector<std::string> names;
  if (from.kind != SourceKind::recording || !from.array.empty()) return names;
  const auto recording = bytes::recordings::SuitRecordingReader::open(from.file);
  if (!recording) return recording.error();
  if ((*recording)->arrays().size() == 1) return names;
  for (const bytes::recordings::RecordedArray& array : (*recording)->arrays()) names.push_back(array.name);
  return names;
}

bytes::recordings::FrameNotes notes_of_source(const FrameSource& source, const std::string& from) {
  const Result<SourceName> name = SourceName::parse(from);
  if (name && name->kind == SourceKind::simulation) return {.simulation = from};
  if (const auto* const stream = dynamic_cast<const fleet::FrameStream*>(&source)) return stream->notes();
  if (source.is_live()) return {};
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(from);
  return notes ? *notes : bytes::recordings::FrameNotes{};
}

}  // namespace dermis::live::sources
