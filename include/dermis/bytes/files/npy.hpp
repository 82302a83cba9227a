// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Counts as an array of NumPy (numpy.lib.format, versions 1.0 to 3.0). A .npy file holds no times.
namespace dermis::bytes::files {

struct NpyInput {
  double rate_hz = 0.0;               ///< Frames a second, > 0: frame k is at k / rate_hz.
  std::optional<FrameShape> shape{};  ///< Required shape of the frames; needed for arrays of two dimensions.
  std::string axes{};                 ///< As ArrayHints::axes.
  std::vector<double> seconds{};      ///< When each frame was taken; goes before the rate.
};

/// Reads (frames, rows, cols), (frames, rows * cols) of a given shape, or what else array_frames.hpp finds frames in.
/// The numbers are whole, of 8 to 64 bits, or floats of 32 or 64 bits, of either byte order. Fails on whole numbers
/// that a float does not hold exactly. The memory is that of one frame; of all where frames do not stand first, or
/// where that is in doubt. Not thread-safe.
class NpyReader final : public FrameSource {
 public:
  [[nodiscard]] static Result<std::unique_ptr<NpyReader>> open(const std::string& path, const NpyInput& input);
  /// The same from a stream; `name` stands for the path in messages.
  [[nodiscard]] static Result<std::unique_ptr<NpyReader>> open(std::unique_ptr<std::istream> in,
                                                               const std::string& name, const NpyInput& input);
  ~NpyReader() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override;

 private:
  struct State;
  explicit NpyReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Numbers of a file of two or three dimensions; of three, the last two are merged.
struct NpyTable {
  std::size_t rows = 0;
  std::size_t cols = 0;
  std::vector<float> values;  ///< [rows, cols]
};

/// Reads the formats of NpyReader, with 1 to 1048576 columns.
[[nodiscard]] Result<NpyTable> read_npy_table(const std::string& path);
/// The same from a stream; `name` stands for the path in messages.
[[nodiscard]] Result<NpyTable> read_npy_table(std::unique_ptr<std::istream> in, const std::string& name);

/// All numbers of an array, such as times.
[[nodiscard]] Result<std::vector<double>> read_npy_numbers(std::istream& in);

/// Writes the counts of frames as (frames, rows, cols), as u16. If a count needs f32, all frames are written as f32,
/// and earlier ones are rewritten. Nothing else of a frame is kept. Without commit(), no file remains. Not thread-safe.
class NpyWriter final : public FrameSink {
 public:
  [[nodiscard]] static Result<std::unique_ptr<NpyWriter>> create(const std::string& path, FrameShape shape);
  ~NpyWriter() override;

  [[nodiscard]] Status write(const RawFrame& frame) override;
  [[nodiscard]] Status commit() override;

 private:
  struct State;
  explicit NpyWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::bytes::files
