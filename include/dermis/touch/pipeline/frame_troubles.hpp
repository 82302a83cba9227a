// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "dermis/touch/preprocessing/missing_readings.hpp"

namespace dermis::touch::pipeline {

/// Counts the frames of a stream whose forces are not what a user expects. Not thread-safe.
class FrameTroubles {
 public:
  /// `from`: what the frames come from, for messages; empty: those do not say it.
  FrameTroubles(const ArrayDescription& array, const std::string& from);

  /// Takes the result of `pipeline` for the next frame, `raw`. `source`: the one that gave it; null: only the number of
  /// the frame is reported.
  void add(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline, const FrameSource* source = nullptr);

  /// The next frame of the source is not looked at.
  void skip() noexcept { ++number_; }

  /// The number of frames that were added.
  [[nodiscard]] std::size_t frames() const noexcept { return frames_; }

  /// A line for each kind of trouble that there was.
  [[nodiscard]] std::vector<std::string> describe() const;

  /// Impossible readings of most frames, with the likely mend: a temperature in kelvin, or nothing but zeros of an
  /// array that reads more.
  [[nodiscard]] std::optional<std::string> impossible() const;

  /// Whether nothing reads anything, of an array most of whose rows read something where nothing presses.
  [[nodiscard]] bool is_silent(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline) const;
  /// How many frames were so, and the likely mend; empty: none.
  [[nodiscard]] std::optional<std::string> silent_frames() const;

  /// A note where all frames are zeros and an untouched array may read so.
  [[nodiscard]] std::optional<std::string> silence() const;

  /// Failed, with the likeliest cause, where more than half of the frames have no force, a temperature in kelvin, or
  /// nothing but zeros.
  [[nodiscard]] Status verdict() const;

 private:
  /// A kind of trouble: how many frames have it.
  struct Trouble {
    std::size_t frames = 0;
    std::string first;  ///< "with a supply outside of the calibration, the first: 6.5 V", or the place of the first.
  };

  /// Frames without a force: rejected, or not solved.
  struct Lost {
    std::size_t frames = 0;
    std::size_t outside = 0;  ///< Of these, with readings that are none of the ADC,
    std::size_t zero = 0;     ///< and with nothing but zeros.
  };

  void add_doubts(const RawFrame& raw, const ForceFrame& force, const Pipeline& pipeline);
  [[nodiscard]] std::string cause() const;
  [[nodiscard]] std::string describe(const Trouble& trouble) const;

  std::string prefix_;  ///< Of messages: "frames.csv: ", or nothing.
  preprocessing::MissingReadings missing_;
  std::size_t number_ = 0;  ///< Number of the last frame in its source, from 1.
  std::size_t frames_ = 0;
  std::size_t faulty_ = 0;
  Lost lost_;
  std::optional<std::size_t> zero_;  ///< Nothing but zeros; empty where readings are forces, of which 0 is one.
  Trouble rejected_;
  Trouble unsolved_;
  std::size_t rows_;     ///< Of the array.
  std::size_t sensors_;  ///< Of its temperature.
  Trouble supply_;
  Trouble kelvin_;
  Trouble other_sensors_;
  Trouble silent_;
};

}  // namespace dermis::touch::pipeline
