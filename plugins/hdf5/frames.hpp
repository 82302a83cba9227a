// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bytes/recordings/hdf5_plugin.hpp"
#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Frames as HDF5 (docs/frame-files.md), readable by h5py: counts (N, rows, cols), time_s and one dataset of N values
/// for each further member of RawFrame.
namespace dermis::bytes::recordings {

/// Reads a file of Hdf5FramesWriter: every RawFrame has the bits that were written. Also reads files that hold only
/// counts (N, rows, cols) of any numbers, and time_s or time_ns. The memory is that of some chunks, at most 200 MiB.
/// Errors name the dataset and the frame. Not thread-safe.
class Hdf5FramesReader final : public NotedFrames {
 public:
  /// Fails if the frames do not have the given shape.
  [[nodiscard]] static Result<std::unique_ptr<Hdf5FramesReader>> open(const std::string& path,
                                                                      std::optional<FrameShape> shape = {});
  ~Hdf5FramesReader() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override;
  [[nodiscard]] SourceStatistics statistics() const override;
  [[nodiscard]] const FrameNotes& notes() const noexcept override;

 private:
  struct State;
  explicit Hdf5FramesReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes frames with all that is known of them. Counts are u16. If u16 cannot hold a frame, all counts become f32, and
/// earlier frames are rewritten. Without commit(), no file remains. The memory is that of one chunk, about 1 MiB. Not
/// thread-safe.
class Hdf5FramesWriter final : public FrameSink {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Hdf5FramesWriter>> create(const std::string& path, FrameShape shape,
                                                                        const FrameNotes& notes = {});
  ~Hdf5FramesWriter() override;

  [[nodiscard]] Status write(const RawFrame& frame) override;
  [[nodiscard]] Status commit() override;

 private:
  struct State;
  explicit Hdf5FramesWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::bytes::recordings
