// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/instrument/instrument_judgement.hpp"
#include "learn/calibration/instrument/proof.hpp"
#include "learn/calibration/sheet/cover_fit.hpp"

namespace dermis::learn::calibration {

/// Each step of a calibration before the networks, to be taken once, in this order. `array`, `frames` and `loads` are
/// to outlive it.
class Preparation {
 public:
  Preparation(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
              Nanos settle_time);

  /// Leaves out flickering taxels and frames that are called unloaded but are pressed.
  [[nodiscard]] Status check_labels();
  /// Where readings end under whatever load.
  void find_rail();
  /// The readings that still hold some of the one before.
  void find_settling();
  /// A cover that spreads presses, as described or as presses tell. Loads on it become what the taxels feel.
  void find_cover();
  /// Unknown resistances, or an unknown circuit.
  [[nodiscard]] Status find_circuit();
  /// A film that conducts from line to line, where presses tell one, or where it is to be found.
  void find_film();
  /// ADC and supply, and what remains unexplained of them.
  void judge_instrument();
  /// Another circuit that explains the frames better.
  void doubt_circuit();
  /// Units 2 and 3.
  [[nodiscard]] Result<SampleDatabase> invert(const std::function<void(double)>& progress);

 private:
  [[nodiscard]] Trainable trainable() const;
  void take_cover(const std::optional<Cover>& cover);

  const ArrayDescription& described_;
  const std::span<const RawFrame> frames_;
  std::span<const Load> loads_;
  std::span<const Load> surface_;  // where they are felt through a cover: what stands on it
  const Nanos settle_time_;
  ArrayDescription known_;
  std::vector<Load> kept_;    // whose labels are right
  std::vector<Load> felt_;    // through the cover
  std::vector<Load> chosen_;  // of the frames that become samples
  std::vector<std::string> remarks_;
  bool asks_for_instrument_ = false;
  std::optional<std::string> lacking_film_;  // what to press for a word on the film that is asked for
  CoverFit cover_;
  std::optional<CircuitFit> circuit_;
  InstrumentFit instrument_;
};

}  // namespace dermis::learn::calibration
