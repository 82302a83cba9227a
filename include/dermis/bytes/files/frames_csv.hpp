// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The optional columns of frames.csv; time_s and the taxels are always present.
struct FramesCsvColumns {
  bool temperature_celsius = true;
  bool supply_v = true;
  std::size_t sensors = 0;  ///< Temperature sensors, at least; the first frame may have more.
};

/// Reads frames.csv (docs/file-formats.md) frame by frame. The memory is that of one line, at most 32 MiB. Counts may
/// be fractional, nan or inf; preprocessing decides whether a reading can be used. An empty cell of
/// temperature_celsius, supply_v or sensor0_celsius is no value. Errors name the line and the column. An incomplete
/// last line without line end is left out if frames come before it, with a notice. Not thread-safe.
class FramesCsvReader final : public FrameSource {
 public:
  using Notice = std::function<void(const std::string&)>;  ///< Takes one line.

  /// Opens the file and checks its header against `shape`. Without one, the last column names the shape (1x1 ...
  /// 1024x1024).
  [[nodiscard]] static Result<std::unique_ptr<FramesCsvReader>> open(const std::string& path,
                                                                     std::optional<FrameShape> shape = {},
                                                                     Notice notice = {});
  /// The same from a stream; `name` stands for the path in messages.
  [[nodiscard]] static Result<std::unique_ptr<FramesCsvReader>> open(std::unique_ptr<std::istream> in,
                                                                     const std::string& name,
                                                                     std::optional<FrameShape> shape = {},
                                                                     Notice notice = {});
  ~FramesCsvReader() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override;

  /// "frames.csv:17", the line of the last frame.
  [[nodiscard]] std::string place() const override;

 private:
  struct State;
  explicit FramesCsvReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes frames.csv with exact times and the fewest digits that read back as the same number. RawFrame::acquisition is
/// dropped. Without commit(), no file remains. Not thread-safe.
class FramesCsvWriter final : public FrameSink {
 public:
  [[nodiscard]] static Result<std::unique_ptr<FramesCsvWriter>> create(const std::string& path, FrameShape shape,
                                                                       const FramesCsvColumns& columns = {});

  /// Appends a frame of `shape`. Values without a column in the file are dropped. Sensors have columns where the first
  /// frame has them, or FramesCsvColumns names them.
  [[nodiscard]] Status write(const RawFrame& frame) override;
  [[nodiscard]] Status commit() override;

 private:
  FramesCsvWriter(AtomicFile file, FrameShape shape, const FramesCsvColumns& columns);
  void begin(std::size_t sensors);

  AtomicFile file_;
  FrameShape shape_;
  std::optional<std::size_t> sensors_;  // of temperature, with columns of their own; empty: no header yet
  FramesCsvColumns columns_;
  std::string line_;
};

}  // namespace dermis::bytes::files
