// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_files.hpp"

#include <utility>

#include "bytes/recordings/described_sensors.hpp"
#include "bytes/recordings/hdf5_plugin.hpp"
#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/npy.hpp"
#include "dermis/bytes/files/origin_toml.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/formats/dsa.hpp"
#include "dermis/bytes/formats/matlab.hpp"
#include "dermis/bytes/formats/novel_asc.hpp"
#include "dermis/bytes/formats/novel_lst.hpp"
#include "dermis/bytes/formats/npz.hpp"
#include "dermis/bytes/formats/packed10.hpp"
#include "dermis/bytes/formats/png_stack.hpp"
#include "dermis/bytes/formats/tekscan.hpp"
#include "dermis/bytes/formats/text_matrix.hpp"
#include "dermis/bytes/formats/xsensor.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

template <typename Interface, typename Opened>
Result<std::unique_ptr<Interface>> as(Result<std::unique_ptr<Opened>> opened) {
  if (!opened) return opened.error();
  return std::unique_ptr<Interface>(*std::move(opened));
}

/// ": the images of ... are in 'json'", where the file has it.
std::string why_not(const std::string& path) {
  const RecordingPlace place = recording_place(path);
  const Result<FrameFormat> format = frame_format(place.path);
  if (!format || *format != FrameFormat::mcap) return {};
  const Result<RecordingInfo> info = recording_info(place.path);
  return info && !info->unread.empty() ? ": " + info->unread : std::string();
}

/// A file that may have no frame, or not all that it was to have.
class FrameFile final : public FrameSource {
 public:
  /// `loss`: called at the end of a recording that was not written to its own end. Empty: it was.
  FrameFile(std::string path, std::unique_ptr<FrameSource> frames, std::function<void(const std::string&)> loss)
      : path_(std::move(path)), frames_(std::move(frames)), loss_(std::move(loss)) {}

  Result<bool> next(RawFrame& frame) override {
    Result<bool> more = frames_->next(frame);
    if (!more) return more;
    has_frame_ = has_frame_ || *more;
    if (*more || std::exchange(has_ended_, true)) return more;
    if (!has_frame_) return bad_input(path_ + ": has no frame" + why_not(path_));
    if (loss_) {
      loss_(path_ + ": was not written to its end, so that its last frames may be missing; recovery makes it " +
            "complete");
    }
    return more;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return frames_->shape(); }
  [[nodiscard]] SourceStatistics statistics() const override { return frames_->statistics(); }
  [[nodiscard]] bool is_live() const override { return frames_->is_live(); }
  [[nodiscard]] std::string place() const override { return frames_->place(); }

 private:
  std::string path_;
  std::unique_ptr<FrameSource> frames_;
  std::function<void(const std::string&)> loss_;
  bool has_frame_ = false;
  bool has_ended_ = false;
};

Result<std::unique_ptr<FrameSource>> open_recording(const std::string& path, const FrameFileInput& input) {
  const RecordingPlace place = recording_place(path);
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::open(place.path, place.array);
  if (!reader) return reader.error();
  const std::optional<FrameShape> found = (*reader)->shape();
  if (input.shape && found && *found != *input.shape) {
    return bad_input(path + ": has " + files::size_text(*found) + " taxels, the array is " +
                     files::size_text(*input.shape));
  }
  const bool is_complete = (*reader)->complete();
  return std::unique_ptr<FrameSource>(
      std::make_unique<FrameFile>(path, *std::move(reader), is_complete ? nullptr : input.loss));
}

Result<std::unique_ptr<FrameSource>> open_hdf5_dataset(const std::string& path, const FrameFileInput& input) {
  const RecordingPlace place = recording_place(path);
  return by_hdf5(&Hdf5Plugin::open_dataset, place.path, place.array, input.shape, input.rate_hz);
}

/// A file of MATLAB 7.3, which is HDF5.
bool is_matlab_hdf5(const std::string& path) {
  constexpr std::string_view kBeginning = "MATLAB 7.3";
  return files::first_bytes_of(path, kBeginning.size()) == kBeginning;
}

Result<std::unique_ptr<FrameSource>> open_matlab_hdf5(const std::string& path, const formats::ImportOptions& options) {
  const Result<std::unique_ptr<formats::MatlabFile>> file = by_hdf5(&Hdf5Plugin::open_matlab, path);
  if (!file) return file.error();
  return formats::open_matlab(**file, path, options);
}

/// Files of other systems.
Result<std::unique_ptr<FrameSource>> open_import(const std::string& path, FrameFormat format,
                                                 const FrameFileInput& input) {
  const RecordingPlace place = recording_place(path);
  const formats::ImportOptions options{input.shape, input.rate_hz, place.array, input.notice, input.loss};
  if (format == FrameFormat::matlab && is_matlab_hdf5(place.path)) return open_matlab_hdf5(place.path, options);
  if (format == FrameFormat::png_stack) return formats::open_png_stack(place.path, options);
  Result<std::unique_ptr<std::istream>> in = files::open_input(place.path);
  if (!in) return in.error();
  switch (format) {
    case FrameFormat::matlab: return formats::open_matlab(*std::move(in), place.path, options);
    case FrameFormat::npz: return formats::open_npz(*std::move(in), place.path, options);
    case FrameFormat::dsa: return formats::open_dsa(*std::move(in), place.path, options);
    case FrameFormat::tekscan: return formats::open_tekscan(*std::move(in), place.path, options);
    case FrameFormat::xsensor: return formats::open_xsensor(*std::move(in), place.path, options);
    case FrameFormat::packed10: return formats::open_packed10(*std::move(in), place.path, options);
    case FrameFormat::novel_asc: return formats::open_novel_asc(*std::move(in), place.path, options);
    case FrameFormat::novel_lst: return formats::open_novel_lst(*std::move(in), place.path, options);
    default: return formats::open_text_matrix(*std::move(in), place.path, options);
  }
}

Status check_rate(const std::string& path, FrameFormat format, const std::optional<double>& rate_hz) {
  if (has_times(format) || may_have_times(format) || rate_hz) return Done{};
  const std::string nor = format == FrameFormat::text_matrix ? ", nor a header time_s,r0c0,..." : "";
  return bad_input(path + ": has no times" + nor + ": give a rate, when it is converted or as 'file:" + path +
                   "?rate=HZ'");
}

Result<std::unique_ptr<FrameSink>> create_recording(const std::string& path, FrameShape shape,
                                                    const FrameNotes& notes) {
  RecordingOptions options;
  if (!notes.name.empty()) options.name = notes.name;
  options.array_toml = notes.array_toml;
  options.model_hash = notes.model_hash;
  options.simulation = notes.simulation;
  options.live = false;
  return as<FrameSink>(RecordingWriter::create(path, shape, options));
}

Result<std::unique_ptr<FrameSource>> open_format(const std::string& path, FrameFormat format,
                                                 const FrameFileInput& input) {
  switch (format) {
    case FrameFormat::hdf5: return as<FrameSource>(by_hdf5(&Hdf5Plugin::open_frames, path, input.shape));
    case FrameFormat::hdf5_dataset: return open_hdf5_dataset(path, input);
    case FrameFormat::wiresens: return by_hdf5(&Hdf5Plugin::open_wiresens, path, input.shape);
    case FrameFormat::npy: return as<FrameSource>(files::NpyReader::open(path, {*input.rate_hz, input.shape}));
    case FrameFormat::csv: return as<FrameSource>(files::FramesCsvReader::open(path, input.shape, input.loss));
    default: return open_import(path, format, input);
  }
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_frames(const std::string& path, const FrameFileInput& input) {
  const Result<FrameFormat> format = recognise_frames(path);
  if (!format) return format.error();
  if (const Status valid = check_rate(path, *format, input.rate_hz); !valid) return valid.error();
  if (*format == FrameFormat::mcap) return open_recording(path, input);
  Result<std::unique_ptr<FrameSource>> frames = open_format(path, *format, input);
  if (!frames) return frames.error();
  return std::unique_ptr<FrameSource>(std::make_unique<FrameFile>(path, *std::move(frames), nullptr));
}

Result<FrameNotes> read_frame_notes(const std::string& path) {
  const Result<FrameFormat> format = recognise_frames(path);
  if (!format) return format.error();
  if (*format == FrameFormat::mcap) {
    const RecordingPlace place = recording_place(path);
    const auto reader = RecordingReader::open(place.path, place.array);
    if (!reader) return reader.error();
    return (*reader)->notes();
  }
  if (*format == FrameFormat::hdf5) {
    const auto reader = by_hdf5(&Hdf5Plugin::open_frames, path, std::optional<FrameShape>());
    if (!reader) return reader.error();
    return (*reader)->notes();
  }
  return FrameNotes{.simulation = files::simulated_source(path)};
}

Result<std::unique_ptr<FrameSink>> create_frames(const std::string& path, FrameShape shape, const FrameNotes& notes) {
  const Result<FrameFormat> format = output_format(path);
  if (!format) return format.error();
  switch (*format) {
    case FrameFormat::mcap: return create_recording(path, shape, notes);
    case FrameFormat::hdf5: return by_hdf5(&Hdf5Plugin::create_frames, path, shape, notes);
    case FrameFormat::wiresens: return by_hdf5(&Hdf5Plugin::create_wiresens, path, shape);
    case FrameFormat::npy: return as<FrameSink>(files::NpyWriter::create(path, shape));
    default: return as<FrameSink>(files::FramesCsvWriter::create(path, shape, {.sensors = described_sensors(notes)}));
  }
}

Result<std::vector<RawFrame>> read_frames(FrameSource& source) {
  std::vector<RawFrame> frames;
  RawFrame frame;
  while (true) {
    const Result<bool> got_frame = source.next(frame);
    if (!got_frame) return got_frame.error();
    if (!*got_frame) return frames;
    frames.push_back(frame);
  }
}

Result<std::vector<RawFrame>> read_frames(const std::string& path, const FrameFileInput& input) {
  const Result<std::unique_ptr<FrameSource>> source = open_frames(path, input);
  if (!source) return source.error();
  return read_frames(**source);
}

}  // namespace dermis::bytes::recordings
