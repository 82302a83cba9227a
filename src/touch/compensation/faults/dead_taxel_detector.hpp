// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/page_test.hpp"
#include "touch/compensation/faults/silence_evidence.hpp"
#include "touch/compensation/faults/taxel_block.hpp"

namespace dermis::touch::compensation {

/// A taxel is dead when its conductance stays below that of an unloaded one: there crosstalk from pressed taxels is
/// solved. A reading that remains is no evidence against it: the circuit may not be quite the given one. As its
/// unloaded conductance alone may be wrong, it must also keep silent between pressed taxels.
class DeadTaxelDetector {
 public:
  explicit DeadTaxelDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  void weigh(const Observation& seen, const TaxelBlock& block) noexcept;
  [[nodiscard]] float add_up(std::size_t frame, const TaxelBlock& block) noexcept;
  [[nodiscard]] bool is_between_presses(const Observation& seen, std::size_t taxel) const noexcept;
  void forget(std::size_t frame, const TaxelBlock& block) noexcept;
  void judge_taxel(const Observation& seen, std::size_t taxel, FaultList& faults) noexcept;

  const ArrayDescription& array_;
  FloorEvidence floor_;
  std::vector<float> evidence_;      // of this frame [taxels]
  std::vector<float> dead_;          // Page's sum [taxels]
  std::vector<std::int32_t> since_;  // frame before its evidence [taxels]
  std::vector<int> passed_over_;     // frames in which it kept silent between presses [taxels]
  std::vector<PageTest> alive_;      // of a taxel that was found to be dead [taxels]
};

}  // namespace dermis::touch::compensation
