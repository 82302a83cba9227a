// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dermis/core/frame_sink.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"

/// Recordings of the WiReSens toolkit as HDF5 (WiReSensPy, Sensor.py): `pressure` (N, ground wires, read wires), the
/// raw readings of the ADC, which fall with pressure; `ts` (N), seconds of the local clock since 1970 as if it were
/// UTC; `frame_count`; `predCount` and, in some, `packetNumber`, which are not read.
namespace dermis::recordings {

/// Reads the frames that were recorded: the arrays are longer than that, `frame_count` is the index of the last frame,
/// and entries that were never written lie between (their time is 0, and so are their readings). Rows are the ground
/// wires. Times are taken as they are. Not thread-safe.
class WiresensHdf5Reader final : public FrameSource {
 public:
  /// Fails where the frames do not have the shape, if one is given.
  [[nodiscard]] static Result<std::unique_ptr<WiresensHdf5Reader>> open(const std::string& path,
                                                                        std::optional<FrameShape> shape = {});
  ~WiresensHdf5Reader() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override;

 private:
  struct State;
  explicit WiresensHdf5Reader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes counts and times so that WiReSens reads all frames: the arrays are as long as `frame_count` says, and
/// predCount is 0. Fails on counts that are not whole. Without commit(), nothing is left behind. Not thread-safe.
class WiresensHdf5Writer final : public FrameSink {
 public:
  [[nodiscard]] static Result<std::unique_ptr<WiresensHdf5Writer>> create(const std::string& path, FrameShape shape);
  ~WiresensHdf5Writer() override;

  [[nodiscard]] Status write(const RawFrame& frame) override;
  [[nodiscard]] Status commit() override;

 private:
  struct State;
  explicit WiresensHdf5Writer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::recordings
