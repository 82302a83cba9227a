// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/pipeline/model.hpp"

namespace dermis::health {

/// Taxels that tell nothing though no fault has been found: they have no force in any frame, or a high reading that
/// never changes.
class MuteTaxels {
 public:
  explicit MuteTaxels(const pipeline::Model& model);

  /// A frame that was solved.
  void add(const RawFrame& raw, const ConditionedFrame& conditioned, const ForceFrame& force);

  /// A sentence each, few at most; empty before there are enough frames, and where it is so of much of the array.
  [[nodiscard]] std::vector<std::string> findings() const;

 private:
  const pipeline::Model& model_;
  std::size_t frames_ = 0;
  std::vector<std::size_t> forces_;   // frames with a force [taxels]
  std::vector<std::size_t> changes_;  // of the reading [taxels]
  std::vector<float> counts_;         // of the last frame [taxels]
  std::vector<bool> is_high_;         // in all frames [taxels]
  std::vector<bool> is_explained_;    // by a fault, or by a reading that is missing [taxels]
};

}  // namespace dermis::health
