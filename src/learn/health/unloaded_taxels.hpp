// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// The conductances of the untouched taxels, and which ones are touched.
class UnloadedTaxels {
 public:
  explicit UnloadedTaxels(const touch::pipeline::Model& model) : model_(model), expected_(model.array.taxel_count()) {}

  /// For the temperature of this frame.
  void expect(const ConductanceFrame& conductance);

  /// Unloaded conductance [S].
  [[nodiscard]] double expected(std::size_t taxel) const { return expected_[taxel]; }

  /// The taxel or one near it conducts three times what it does unloaded, and so many standard deviations more.
  [[nodiscard]] bool is_near_touch(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const;

 private:
  [[nodiscard]] bool is_touched(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const;

  const touch::pipeline::Model& model_;
  std::vector<double> expected_;  // [taxels] [S]
};

}  // namespace dermis::learn::health
