// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/unloaded_law.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::touch::pipeline {

/// The least sum over taxels that counts as a load [N], as where contacts begin.
inline constexpr double kLeastStandingNewtons = 0.1;

/// A load that rests on taxels.
struct StandingLoad {
  double newtons = 0.0;             ///< In all.
  std::vector<std::uint8_t> bears;  ///< 1: the taxel bears a part of it [taxels].
};

/// "r3c5", "r3c4 to r5c6" or "16 taxels between r2c3 and r9c8".
[[nodiscard]] std::string place_name(const StandingLoad& load, const ArrayDescription& array);

/// "r3c5 reads 1.2 N", "r3c4 to r5c6 read 48 N".
[[nodiscard]] std::string describe(const StandingLoad& load, const ArrayDescription& array);

/// Follows which taxels have been loaded since the first frame without a release. Something lies there, or the array
/// was put on after its calibration. Drift explains a conductance up to 1.5 times the unloaded one; it is no load. Not
/// thread-safe.
class StandingLoadWatch {
 public:
  explicit StandingLoadWatch(const Model& model);

  /// Takes the results of the next frame. Frames that are rejected or not solved are ignored.
  void add(const ConductanceFrame& conductance, const ForceFrame& force);

  /// Takes the next frame as if it were the first.
  void begin_anew();

  /// Mean force of the taxels that were never released; empty where it is below 0.1 N, or before 5 s have passed.
  [[nodiscard]] std::optional<StandingLoad> load() const;
  /// Some taxel has been loaded in each frame so far.
  [[nodiscard]] bool is_any_loaded() const noexcept;
  /// From the first to the last frame.
  [[nodiscard]] Nanos lasted() const noexcept { return last_ - first_; }

 private:
  UnloadedLaw unloaded_;
  std::size_t frames_ = 0;
  Nanos first_{};
  Nanos last_{};
  std::vector<std::uint8_t> bears_;  // in all frames [taxels]
  std::vector<double> newtons_;      // sum over the frames [taxels]
};

/// "r2c3 to r5c6 were never released and read 16 N: take off what lies there, or tare if the array was put on"
[[nodiscard]] std::string describe_never_released(const StandingLoad& load, const ArrayDescription& array);

}  // namespace dermis::touch::pipeline
