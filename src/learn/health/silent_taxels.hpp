// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// Taxels that read exactly nothing up to the last frame, and were untouched before. Others that read as little when
/// the array was calibrated read more.
class SilentTaxels {
 public:
  explicit SilentTaxels(const touch::pipeline::Model& model);

  /// A frame that was solved.
  void add(const ConditionedFrame& conditioned, const ConductanceFrame& conductance);

  /// Whether each is so; none before there are enough frames.
  [[nodiscard]] std::vector<bool> silent() const;

 private:
  [[nodiscard]] bool is_silent(std::size_t taxel) const;
  [[nodiscard]] bool others_read(std::size_t taxel) const;

  const touch::pipeline::Model& model_;
  std::size_t frames_ = 0;
  std::vector<std::size_t> zeros_;    // frames [taxels]
  std::vector<std::size_t> silence_;  // of them, up to the last frame [taxels]
  std::vector<double> last_siemens_;  // conductance when it read the last time [taxels]
  std::vector<double> last_counts_;   // and what it read [taxels]
};

}  // namespace dermis::learn::health
