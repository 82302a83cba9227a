// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::pipeline {

/// Noise of readings in operation against that of the calibration: white noise, hum. A touch only adds to an unloaded
/// taxel, noise shows on both sides of its zero. So of the deviations of a size or more, as many count as the rarer
/// side has. Taxels at 0 S may be any size below zero: the ADC ends there. Not thread-safe.
class LiveNoise {
 public:
  /// `unloaded_siemens`: calibrated conductance of the unloaded taxels [taxels].
  LiveNoise(const ArrayDescription& array, std::span<const double> unloaded_siemens);

  /// Raises the noise of the readings to that of the frames before, and tells how much of it they share, as hum.
  /// Allocates nothing after the first frame.
  void raise(ConditionedFrame& conditioned) const noexcept;

  /// Learns from a part of the taxels. `force` came of `conductance`, which came of a frame that was raised. Allocates
  /// nothing.
  void observe(const ConductanceFrame& conductance, const ForceFrame& force) noexcept;

  /// Standard deviation over that of the calibration, 0 as long as too little is known.
  [[nodiscard]] double measured() const noexcept { return measured_; }

 private:
  static constexpr std::size_t kBins = 32;
  using Counts = std::array<std::uint32_t, kBins + 1>;  // by size; the last: any size

  struct Noise {
    double count = 0.0;
    double squares = 0.0;
    double more = 0.0;        // deviations of the side that has more of them
    double left_above = 0.0;  // deviations that only that side has, with the sum of their squares
    double left_squares = 0.0;
    [[nodiscard]] double rms() const noexcept { return count > 0.0 ? std::sqrt(squares / count) : 0.0; }
  };
  /// The deviations of untouched taxels on a driven line.
  struct LineSum {
    double count = 0.0;
    double sum = 0.0;
    double squares = 0.0;
  };
  struct Products {
    double count = 0.0;
    double sum = 0.0;
  };

  void count(const ConductanceFrame& conductance, std::span<const float> deviations) noexcept;
  void estimate() noexcept;
  [[nodiscard]] Noise noise_below(std::size_t end) const noexcept;
  void add_cut_off(Noise& noise) const noexcept;
  [[nodiscard]] static std::size_t end_of_noise(const Noise& noise, double sigmas) noexcept;
  void forget_half() noexcept;
  void correlate(const ConductanceFrame& conductance, std::span<const float> deviations) noexcept;
  void sum_lines(const ConductanceFrame& conductance, std::span<const float> deviations) noexcept;
  [[nodiscard]] bool is_visible(const ConductanceFrame& conductance, std::size_t taxel) const noexcept;

  std::vector<double> unloaded_siemens_;
  std::size_t cols_;
  Axis driven_;
  std::vector<LineSum> lines_;      // [driven lines]
  std::vector<Products> products_;  // of pairs of taxels, by the distance of their lines [driven lines]
  Products squares_;
  std::vector<float> shared_;  // [driven lines]
  Counts above_{};
  Counts below_{};
  std::size_t frame_ = 0;
  double measured_ = 0.0;
  double growth_ = 1.0;
};

}  // namespace dermis::touch::pipeline
