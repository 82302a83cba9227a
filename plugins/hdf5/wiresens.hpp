// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Recordings of the WiReSens toolkit as HDF5 (WiReSensPy, Sensor.py). `pressure` (N, ground wires, read wires) holds
/// the raw readings of the ADC, which fall with pressure. `ts` (N) holds seconds of the local clock since 1970, as if
/// it were UTC. `frame_count` follows. `predCount` and, in some, `packetNumber` are not read.
namespace dermis::bytes::recordings {

/// Reads the recorded frames. The arrays are longer than the recording, and `frame_count` is the index of the last
/// frame. Entries between that were never written are left out: their time and readings are 0. Rows are the ground
/// wires. Times are not changed. Not thread-safe.
class WiresensHdf5Reader final : public FrameSource {
 public:
  /// Fails if the frames do not have the given shape.
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
/// predCount is 0. Fails on counts that are not whole. Without commit(), no file remains. Not thread-safe.
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

}  // namespace dermis::bytes::recordings
