// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// A dataset of any name in an HDF5 file: frames x rows x cols, or frames x taxels where the shape is given. Other axes
/// are those of dermis/bytes/files/array_frames.hpp. Times are those of its names beside the dataset or at the top,
/// or of the rate. The memory is that of some chunks, at most 200 MiB; of all where frames do not stand first.
class Hdf5DatasetReader final : public FrameSource {
 public:
  /// `dataset`: "/observations/tactile", "tactile[..., 2]". `rate_hz` goes before the times of the file.
  [[nodiscard]] static Result<std::unique_ptr<Hdf5DatasetReader>> open(const std::string& path,
                                                                       const std::string& dataset,
                                                                       const std::optional<FrameShape>& shape,
                                                                       const std::optional<double>& rate_hz);
  ~Hdf5DatasetReader() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override;

 private:
  struct State;
  explicit Hdf5DatasetReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::bytes::recordings
