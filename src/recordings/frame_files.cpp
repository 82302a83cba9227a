// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/recordings/frame_files.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/files/frames_csv.hpp"
#include "dermis/files/npy.hpp"
#include "dermis/files/taxel_text.hpp"
#include "dermis/files/text.hpp"
#include "dermis/recordings/recording.hpp"
#include "dermis/recordings/wiresens_hdf5.hpp"
#include "recordings/hdf5.hpp"

namespace dermis::recordings {
namespace {

template <typename Interface, typename Opened>
Result<std::unique_ptr<Interface>> as(Result<std::unique_ptr<Opened>> opened) {
  if (!opened) return opened.error();
  return std::unique_ptr<Interface>(*std::move(opened));
}

/// A pipe, a terminal, /dev/stdin.
bool is_stream(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return std::filesystem::is_fifo(status) || std::filesystem::is_character_file(status);
}

/// Which of the HDF5 formats a file has, by its datasets.
Result<FrameFormat> hdf5_format(const std::string& path) {
  const QuietHdf5 quiet;
  const Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  if (file->contains("counts")) return FrameFormat::hdf5;
  if (file->contains("pressure") && file->contains("frame_count")) return FrameFormat::wiresens;
  return bad_input(path + ": has neither the dataset 'counts' (dermis) nor 'pressure' and 'frame_count' (WiReSens)");
}

Result<std::unique_ptr<FrameSource>> open_recording(const std::string& path, std::optional<FrameShape> shape) {
  const RecordingPlace place = recording_place(path);
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::open(place.path, place.array);
  if (!reader) return reader.error();
  const std::optional<FrameShape> found = (*reader)->shape();
  if (shape && found && *found != *shape) {
    return bad_input(path + ": has " + files::size_text(*found) + " taxels, the array is " + files::size_text(*shape));
  }
  return as<FrameSource>(std::move(reader));
}

Result<std::unique_ptr<FrameSource>> open_npy(const std::string& path, const FrameFileInput& input) {
  if (!input.rate_hz) return bad_input(path + ": a .npy file has no times; 'dermis convert --rate HZ' gives them");
  return as<FrameSource>(files::NpyReader::open(path, {*input.rate_hz, input.shape}));
}

Result<std::unique_ptr<FrameSink>> create_recording(const std::string& path, FrameShape shape,
                                                    const FrameNotes& notes) {
  RecordingOptions options;
  if (!notes.name.empty()) options.name = notes.name;
  options.array_toml = notes.array_toml;
  options.model_hash = notes.model_hash;
  options.live = false;
  return as<FrameSink>(RecordingWriter::create(path, shape, options));
}

}  // namespace

const char* to_string(FrameFormat format) {
  switch (format) {
    case FrameFormat::csv: return "frames.csv";
    case FrameFormat::mcap: return "MCAP";
    case FrameFormat::hdf5: return "HDF5";
    case FrameFormat::wiresens: return "WiReSens HDF5";
    case FrameFormat::npy: return "NumPy";
  }
  return "";
}

Result<FrameFormat> frame_format(const std::string& path) {
  if (path.ends_with(".wiresens.h5") || path.ends_with(".wiresens.hdf5")) return FrameFormat::wiresens;
  if (path.ends_with(".h5") || path.ends_with(".hdf5")) return FrameFormat::hdf5;
  if (path.ends_with(".csv")) return FrameFormat::csv;
  if (path.ends_with(".mcap")) return FrameFormat::mcap;
  if (path.ends_with(".npy")) return FrameFormat::npy;
  if (is_stream(path)) return FrameFormat::csv;
  return bad_input(files::in_quotes(path) +
                   ": the ending of its name tells no format of frames; known: .csv, .mcap, .h5, .hdf5, .wiresens.h5, "
                   ".wiresens.hdf5 and .npy");
}

Result<FrameFormat> recognise_frames(const std::string& path) {
  Result<FrameFormat> format = frame_format(recording_place(path).path);
  if (!format || (*format != FrameFormat::hdf5 && *format != FrameFormat::wiresens)) return format;
  return hdf5_format(path);
}

Result<std::unique_ptr<FrameSource>> open_frames(const std::string& path, const FrameFileInput& input) {
  const Result<FrameFormat> format = recognise_frames(path);
  if (!format) return format.error();
  switch (*format) {
    case FrameFormat::mcap: return open_recording(path, input.shape);
    case FrameFormat::hdf5: return as<FrameSource>(Hdf5FramesReader::open(path, input.shape));
    case FrameFormat::wiresens: return as<FrameSource>(WiresensHdf5Reader::open(path, input.shape));
    case FrameFormat::npy: return open_npy(path, input);
    case FrameFormat::csv: break;
  }
  return as<FrameSource>(files::FramesCsvReader::open(path, input.shape));
}

Result<FrameNotes> read_frame_notes(const std::string& path) {
  const Result<FrameFormat> format = recognise_frames(path);
  if (!format) return format.error();
  if (*format == FrameFormat::mcap) {
    const RecordingPlace place = recording_place(path);
    const auto reader = RecordingReader::open(place.path, place.array);
    if (!reader) return reader.error();
    return FrameNotes{(*reader)->name(), (*reader)->array_toml(), (*reader)->model_hash()};
  }
  if (*format == FrameFormat::hdf5) {
    const auto reader = Hdf5FramesReader::open(path);
    if (!reader) return reader.error();
    return (*reader)->notes();
  }
  return FrameNotes{};
}

Result<std::unique_ptr<FrameSink>> create_frames(const std::string& path, FrameShape shape, const FrameNotes& notes) {
  const Result<FrameFormat> format = frame_format(path);
  if (!format) return format.error();
  switch (*format) {
    case FrameFormat::mcap: return create_recording(path, shape, notes);
    case FrameFormat::hdf5: return as<FrameSink>(Hdf5FramesWriter::create(path, shape, notes));
    case FrameFormat::wiresens: return as<FrameSink>(WiresensHdf5Writer::create(path, shape));
    case FrameFormat::npy: return as<FrameSink>(files::NpyWriter::create(path, shape));
    case FrameFormat::csv: break;
  }
  return as<FrameSink>(files::FramesCsvWriter::create(path, shape));
}

Result<std::vector<RawFrame>> read_frames(const std::string& path, const FrameFileInput& input) {
  const Result<std::unique_ptr<FrameSource>> source = open_frames(path, input);
  if (!source) return source.error();
  std::vector<RawFrame> frames;
  RawFrame frame;
  while (true) {
    const Result<bool> got_frame = (*source)->next(frame);
    if (!got_frame) return got_frame.error();
    if (!*got_frame) return frames;
    frames.push_back(frame);
  }
}

}  // namespace dermis::recordings
