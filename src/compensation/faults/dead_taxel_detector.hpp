// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/faults/fault_list.hpp"
#include "compensation/faults/observation.hpp"
#include "compensation/faults/page_test.hpp"
#include "compensation/faults/silence_evidence.hpp"
#include "compensation/faults/taxel_block.hpp"

namespace dermis::compensation {

/// A taxel is dead when its conductance stays below what an unloaded one has: what crosses over from pressed taxels is
/// solved there.
class DeadTaxelDetector {
 public:
  explicit DeadTaxelDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  void weigh(const Observation& seen, const TaxelBlock& block) noexcept;
  [[nodiscard]] float add_up(std::size_t frame, const TaxelBlock& block) noexcept;
  void judge_taxel(const Observation& seen, std::size_t taxel, FaultList& faults) noexcept;

  FloorEvidence floor_;
  std::vector<float> evidence_;      // of this frame [taxels]
  std::vector<float> dead_;          // Page's sum [taxels]
  std::vector<std::int32_t> since_;  // frame before its evidence [taxels]
  std::vector<PageTest> alive_;      // of a taxel that was found to be dead [taxels]
};

}  // namespace dermis::compensation
