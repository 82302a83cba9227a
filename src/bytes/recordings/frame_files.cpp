// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_files.hpp"

#include <utility>

#include "bytes/recordings/format_rows.hpp"
#include "bytes/recordings/hdf5_plugin.hpp"
#include "dermis/bytes/files/origin_toml.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

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

Status check_rate(const std::string& path, FrameFormat format, const std::optional<double>& rate_hz) {
  if (has_times(format) || may_have_times(format) || rate_hz) return Done{};
  const std::string nor = format == FrameFormat::text_matrix ? ", nor a header time_s,r0c0,..." : "";
  return bad_input(path + ": has no times" + nor + ": give a rate, when it is converted or as 'file:" + path +
                   "?rate=HZ'");
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_frames(const std::string& path, const FrameFileInput& input) {
  const Result<FrameFormat> format = recognise_frames(path);
  if (!format) return format.error();
  if (const Status valid = check_rate(path, *format, input.rate_hz); !valid) return valid.error();
  Result<std::unique_ptr<FrameSource>> frames = row_of(*format).open(path, input);
  if (!frames) return frames.error();
  const auto* const recording = dynamic_cast<const RecordingReader*>(frames->get());
  const bool is_complete = recording == nullptr || recording->complete();
  return std::unique_ptr<FrameSource>(
      std::make_unique<FrameFile>(path, *std::move(frames), is_complete ? nullptr : input.loss));
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
  return row_of(*format).create(path, shape, notes);
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
