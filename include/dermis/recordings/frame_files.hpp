// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/frame_sink.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recordings/hdf5_frames.hpp"

/// Files of raw frames of every format, told by the ending of their names (docs/file-formats.md). Of a recording of
/// several arrays, "rec.mcap#chest" is the one named 'chest'; the same holds of the other files that may have several.
namespace dermis::recordings {

enum class FrameFormat {
  csv,       ///< .csv: frames.csv
  mcap,      ///< .mcap: a recording
  hdf5,      ///< .h5, .hdf5
  wiresens,  ///< .wiresens.h5, .wiresens.hdf5; files of .h5 and .hdf5 that are read may be of this format too
  npy,       ///< .npy
  // Of others, and only read (dermis/importers):
  npz,          ///< .npz
  dsa,          ///< .dsa, .dsa3
  tekscan,      ///< .asf; .csv and .txt that begin as one
  xsensor,      ///< .csv and .txt that begin as one
  novel_lst,    ///< .lst
  text_matrix,  ///< .txt; .csv that begins with numbers
  png_stack,    ///< .png, or a folder of them
  packed10,     ///< .packed10
};

/// "frames.csv", "MCAP", "HDF5", "WiReSens HDF5", "NumPy", ...
[[nodiscard]] const char* to_string(FrameFormat format);

/// Else the times are those of FrameFileInput::rate_hz.
[[nodiscard]] bool has_times(FrameFormat format);

/// By the ending of the name; pipes and devices such as /dev/stdin are frames.csv. Fails on a name with another ending,
/// listing those that are known.
[[nodiscard]] Result<FrameFormat> frame_format(const std::string& path);

/// The same of a file that is to be written: fails on formats that are only read.
[[nodiscard]] Result<FrameFormat> output_format(const std::string& path);

/// Of a file that is there: HDF5 and text files are told apart by what they hold.
[[nodiscard]] Result<FrameFormat> recognise_frames(const std::string& path);

struct FrameFileInput {
  std::optional<FrameShape> shape{};  ///< That the frames must have; empty: what the file says. 1x1 ... 1024x1024.
  std::optional<double> rate_hz{};    ///< Frames a second of a file without times (has_times). > 0
  std::function<void(const std::string&)> notice{};  ///< Told in one line what a user should know of the frames.
  std::function<void(const std::string&)> loss{};    ///< Told in one line, at the end, that the file is cut off there.
};

/// The frames of a file, read one by one. Of a file that is cut off, all whole frames are given, then `loss` is told. A
/// file without a frame is bad input: next() says so.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_frames(const std::string& path,
                                                               const FrameFileInput& input = {});

/// What the file says of all of its frames.
[[nodiscard]] Result<FrameNotes> read_frame_notes(const std::string& path);

/// A file of frames of `shape`, which appears complete or not at all. Formats that have no place for `notes` leave them
/// out.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_frames(const std::string& path, FrameShape shape,
                                                               const FrameNotes& notes = {});

/// All frames that are left of a source that ends.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(FrameSource& source);

/// All frames of a file.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(const std::string& path, const FrameFileInput& input = {});

}  // namespace dermis::recordings
