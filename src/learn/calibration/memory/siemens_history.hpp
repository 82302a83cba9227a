// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"

namespace dermis::learn::calibration {

/// The history of a sheet's material: the conductances of the frames of a recording, labelled or not.
struct SiemensHistory {
  std::size_t taxels = 0;
  std::vector<std::size_t> frame;                          ///< Numbers in the recording, rising [frames].
  std::vector<Nanos> time;                                 ///< [frames]
  std::vector<std::optional<double>> temperature_celsius;  ///< [frames]
  std::vector<float> taxel_celsius;  ///< [frames, taxels]; NaN where a frame has one temperature, empty where all do.
  std::vector<float> siemens;        ///< [frames, taxels]; NaN where a taxel or a frame has no reading.

  [[nodiscard]] std::span<const float> siemens_of(std::size_t place) const {
    return std::span(siemens).subspan(place * taxels, taxels);
  }
  /// Empty where the frame has one temperature.
  [[nodiscard]] std::span<const float> taxel_celsius_of(std::size_t place) const {
    if (taxel_celsius.empty() || std::isnan(taxel_celsius[place * taxels])) return {};
    return std::span(taxel_celsius).subspan(place * taxels, taxels);
  }
};

/// All frames of the recording that `database` comes from; of very many those of its samples and, evenly, some of the
/// others. A film over the lines is as `networks` tell the loads. Errors: those of Compensator::create().
[[nodiscard]] Result<SiemensHistory> read_history(const SampleDatabase& database, std::span<const RawFrame> frames,
                                                  const touch::fusion::ForceNetworks& networks);

}  // namespace dermis::learn::calibration
