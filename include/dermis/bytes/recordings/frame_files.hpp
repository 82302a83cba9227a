// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Files of raw frames of every format; the ending of the name gives the format (docs/frame-files.md). In a recording
/// of several arrays, "rec.mcap#chest" is the one named 'chest'. Other files that may have several work alike.
namespace dermis::bytes::recordings {

enum class FrameFormat {
  csv,       ///< .csv: frames.csv
  mcap,      ///< .mcap: a recording
  hdf5,      ///< .h5, .hdf5
  wiresens,  ///< .wiresens.h5, .wiresens.hdf5; files of .h5 and .hdf5 that are read may be of this format too
  npy,       ///< .npy
  // Formats of other systems, only read (formats/imports.hpp):
  npz,           ///< .npz
  dsa,           ///< .dsa, .dsa3
  tekscan,       ///< .asf; .csv and .txt that begin as one
  xsensor,       ///< .csv and .txt that begin as one
  novel_lst,     ///< .lst
  novel_asc,     ///< .asc
  matlab,        ///< .mat
  text_matrix,   ///< .txt; .csv that begins with numbers
  png_stack,     ///< .png, or a folder of them
  packed10,      ///< .packed10
  hdf5_dataset,  ///< A dataset of another name of .h5 and .hdf5: "file.h5#/observations/tactile"
};

/// "frames.csv", "MCAP", "HDF5", "WiReSens HDF5", "NumPy", ...
[[nodiscard]] const char* to_string(FrameFormat format);

/// If false, FrameFileInput::rate_hz gives the times.
[[nodiscard]] bool has_times(FrameFormat format);

/// Files without times, as a rule, that may have some: FrameFileInput::rate_hz is needed where they have none.
[[nodiscard]] bool may_have_times(FrameFormat format);

/// Format by the ending of the name; pipes and devices such as /dev/stdin are frames.csv. Fails on another ending, and
/// lists the known ones.
[[nodiscard]] Result<FrameFormat> frame_format(const std::string& path);

/// The same for a file to write: fails on formats that are only read.
[[nodiscard]] Result<FrameFormat> output_format(const std::string& path);

/// Format of an existing file: the content distinguishes HDF5 and text files.
[[nodiscard]] Result<FrameFormat> recognise_frames(const std::string& path);

struct FrameFileInput {
  std::optional<FrameShape> shape{};  ///< Required shape of the frames; empty: that of the file. 1x1 ... 1024x1024.
  std::optional<double> rate_hz{};    ///< Frames a second of a file without times (has_times). > 0
  std::function<void(const std::string&)> notice{};  ///< Receives one line on what a user should know of the frames.
  std::function<void(const std::string&)> loss{};    ///< Receives one line at the end, if the file is cut off there.
};

/// The frames of a file, read one by one. A file that is cut off gives all whole frames, then `loss` is called. A file
/// without a frame is bad input: next() says so.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_frames(const std::string& path,
                                                               const FrameFileInput& input = {});

/// The notes of the file on all of its frames.
[[nodiscard]] Result<FrameNotes> read_frame_notes(const std::string& path);

/// A file of frames of `shape`, which appears complete or not at all. Formats without a place for `notes` omit them.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_frames(const std::string& path, FrameShape shape,
                                                               const FrameNotes& notes = {});

/// All remaining frames of a source that ends.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(FrameSource& source);

/// All frames of a file.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(const std::string& path, const FrameFileInput& input = {});

}  // namespace dermis::bytes::recordings
