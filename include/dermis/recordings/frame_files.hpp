// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

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
/// several arrays, "rec.mcap#chest" is the one named 'chest'.
namespace dermis::recordings {

enum class FrameFormat {
  csv,       ///< .csv: frames.csv
  mcap,      ///< .mcap: a recording
  hdf5,      ///< .h5, .hdf5
  wiresens,  ///< .wiresens.h5, .wiresens.hdf5; files of .h5 and .hdf5 that are read may be of this format too
  npy,       ///< .npy
};

/// "frames.csv", "MCAP", "HDF5", "WiReSens HDF5", "NumPy"
[[nodiscard]] const char* to_string(FrameFormat format);

/// By the ending of the name; pipes and devices such as /dev/stdin are frames.csv. Fails on a name with another ending,
/// listing those that are known.
[[nodiscard]] Result<FrameFormat> frame_format(const std::string& path);

/// Of a file that is there: HDF5 files are told apart by what they hold.
[[nodiscard]] Result<FrameFormat> recognise_frames(const std::string& path);

struct FrameFileInput {
  std::optional<FrameShape> shape{};  ///< That the frames must have; empty: what the file says. 1x1 ... 1024x1024.
  std::optional<double> rate_hz{};    ///< Frames a second of a .npy file, which has no times. > 0
};

/// The frames of a file, read one by one.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_frames(const std::string& path,
                                                               const FrameFileInput& input = {});

/// What the file says of all of its frames.
[[nodiscard]] Result<FrameNotes> read_frame_notes(const std::string& path);

/// A file of frames of `shape`, which appears complete or not at all. Formats that have no place for `notes` leave them
/// out.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_frames(const std::string& path, FrameShape shape,
                                                               const FrameNotes& notes = {});

/// All frames of a file.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(const std::string& path, const FrameFileInput& input = {});

}  // namespace dermis::recordings
