// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>

#include "touch/compensation/faults/page_test.hpp"

namespace dermis::touch::compensation {

inline constexpr int kTaxelFrames = 12;                                               // for a faulty taxel, at least
inline constexpr float kMostForTaxel = static_cast<float>(kEvidence / kTaxelFrames);  // evidence of one frame

/// Single taxels are judged a block a frame, by turns.
struct TaxelBlock {
  static constexpr std::size_t kTaxels = 64;

  std::size_t from;
  std::size_t to;

  [[nodiscard]] static std::size_t count(std::size_t taxels) { return (taxels + kTaxels - 1) / kTaxels; }
  [[nodiscard]] static TaxelBlock of_frame(std::size_t frame, std::size_t taxels) {
    const std::size_t from = frame % count(taxels) * kTaxels;
    return {from, std::min(from + kTaxels, taxels)};
  }
};

}  // namespace dermis::touch::compensation
