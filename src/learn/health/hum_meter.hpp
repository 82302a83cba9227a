// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::health {

/// A line in the spectrum of most taxels that nothing touches: hum of the mains, which a slow scan shows at another
/// frequency. Frames are looked at in windows of equal length.
class HumMeter {
 public:
  explicit HumMeter(std::size_t taxels);

  void add(std::span<const float> counts, Nanos time);

  /// A sentence where there is hum in most windows.
  [[nodiscard]] std::optional<std::string> finding() const;

 private:
  static constexpr std::size_t kFrames = 128;  // of a window
  static constexpr std::size_t kBins = kFrames / 2 + 1;

  using Spectrum = std::array<double, kBins>;  // squares of amplitudes [counts2]

  /// Hum that windows have shown at about one frequency.
  struct Hum {
    std::size_t windows = 0;
    double bin = 0.0;      ///< Sums over them: frequency in periods a window,
    double counts = 0.0;   ///< amplitude,
    double rate_hz = 0.0;  ///< frames a second.
  };

  void judge_window();
  [[nodiscard]] static bool is_line(const Spectrum& squares, std::size_t peak, double floor);
  [[nodiscard]] std::vector<std::size_t> quiet_places() const;
  [[nodiscard]] Spectrum spectrum(const std::vector<std::size_t>& places) const;
  void count(double bin, double counts, double rate_hz);

  std::size_t stride_;                      // from one examined taxel to the next
  std::size_t places_;                      // examined taxels
  std::vector<std::vector<float>> window_;  // [frames of the window so far, places]
  std::vector<double> times_s_;
  std::size_t windows_ = 0;
  std::vector<Hum> hums_;
};

}  // namespace dermis::learn::health
