// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "learn/health/silent_taxels.hpp"

namespace dermis::learn::health {

/// Taxels without information though no fault has been found. They have no force in any frame, a high reading that
/// never changes, or no reading any more.
class MuteTaxels {
 public:
  explicit MuteTaxels(const touch::pipeline::Model& model);

  /// A frame that was solved.
  void add(const RawFrame& raw, const ConditionedFrame& conditioned, const ConductanceFrame& conductance,
           const ForceFrame& force);

  /// A sentence for each line or taxel, few at most; empty before there are enough frames.
  [[nodiscard]] std::vector<std::string> findings() const;

 private:
  void name(std::vector<bool> taxels, const std::string& what, std::vector<std::string>& found) const;
  [[nodiscard]] bool is_whole_line(const std::vector<bool>& taxels, Axis axis, std::size_t line) const;

  const touch::pipeline::Model& model_;
  SilentTaxels silent_;
  std::size_t frames_ = 0;
  std::vector<std::size_t> forces_;   // frames with a force [taxels]
  std::vector<std::size_t> changes_;  // of the reading [taxels]
  std::vector<float> counts_;         // of the last frame [taxels]
  std::vector<bool> is_high_;         // in all frames [taxels]
  std::vector<bool> is_explained_;    // by a fault, or by a reading that is missing [taxels]
};

}  // namespace dermis::learn::health
