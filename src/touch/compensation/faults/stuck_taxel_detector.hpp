// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "touch/compensation/faults/fault_list.hpp"
#include "touch/compensation/faults/observation.hpp"
#include "touch/compensation/faults/taxel_block.hpp"

namespace dermis::touch::compensation {

/// Noise moves a reading to another count with a known probability, which taxels that nothing presses show. A reading
/// that repeats while it should not is as unlikely as the product of these probabilities. Readings like those of
/// unloaded taxels are not judged: they are weak, and may be quiet. Where the noise is less than a count, others repeat
/// as long; where the readout ends before its full scale, the hardest pressed do.
class StuckTaxelDetector {
 public:
  explicit StuckTaxelDetector(const ArrayDescription& array);

  void judge(const Observation& seen, FaultList& faults) noexcept;

 private:
  /// The counts that the ADC gave, as a line over the readings.
  struct CountScale {
    double zero;
    double per_ratio;
  };

  [[nodiscard]] CountScale count_scale(const ConditionedFrame& conditioned) const noexcept;
  void follow_largest_rise(const Observation& seen, const CountScale& scale, const TaxelBlock& block) noexcept;
  void heal(const Observation& seen, const CountScale& scale, const TaxelBlock& block, FaultList& faults) noexcept;
  [[nodiscard]] bool count_repetitions(const Observation& seen, const CountScale& scale,
                                       const TaxelBlock& block) noexcept;
  [[nodiscard]] double chance_of_share(double share) const noexcept;
  void find(const Observation& seen, const TaxelBlock& block, FaultList& faults) noexcept;

  const Readout& readout_;
  double repeats_by_noise_;                // probability that a reading repeats, at least
  double chance_ = 0.0;                    // minus logarithm of that probability, as other taxels show it
  double largest_rise_ = 0.0;              // of a reading above its zero, of all frames [counts]
  double idle_repetitions_ = 0.0;          // in a row, the most of an interior reading that nothing presses; fades
  std::vector<double> evidence_;           // Page's sum [taxels]
  std::vector<std::int64_t> repetitions_;  // in a row [taxels]
  std::vector<double> last_counts_;        // [taxels]
  std::vector<int> changes_;               // since it was found to be stuck [taxels]
};

}  // namespace dermis::touch::compensation
