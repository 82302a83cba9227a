// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/axis.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::compensation {

/// Readings that jump from one frame to the next while the others of their line do not answer. A taxel that is pressed
/// takes from the others: with what the line has left of the supply, 1 - s, their readings fall by
///
///   f = (1 - s) / (1 - s_last)
///
/// where s is the sum of the readings of a column (dividers with grounded rows), or Rd sum_j I_kj of a row (virtual
/// ground). Where those that were loaded, or the unloaded ones together, should fall and none does, the largest jump is
/// a spike. A jump that stays is believed after some frames.
class Spikes {
 public:
  explicit Spikes(const ArrayDescription& array);

  /// Spikes become invalid in `taxels`, where frames follow each other within 50 ms. Allocates nothing.
  void check(const ConditionedFrame& frame, std::span<TaxelStatus> taxels) noexcept;

  void forget() noexcept { has_last_ = false; }

 private:
  [[nodiscard]] bool any_jump(std::span<const double> ratio) const noexcept;
  [[nodiscard]] bool follows_last(std::span<const double> ratio, double sigma_ratio) const noexcept;
  void renew(std::span<const double> ratio, std::span<const TaxelStatus> taxels) noexcept;
  void follow(std::span<const double> ratio, double sigma_ratio, std::span<const TaxelStatus> taxels) noexcept;
  void check_line(std::size_t line, std::span<const double> ratio, double sigma_ratio,
                  std::span<TaxelStatus> taxels) noexcept;
  [[nodiscard]] bool others_answer(std::size_t line, std::size_t jumping, double fall, std::span<const double> ratio,
                                   double sigma_ratio, std::span<const TaxelStatus> taxels) const noexcept;
  [[nodiscard]] std::size_t taxel_of(std::size_t line, std::size_t place) const noexcept {
    return axis_ == Axis::row ? line * cols_ + place : place * cols_ + line;
  }

  std::size_t cols_;
  Axis axis_;                  // of the lines whose readings share a supply
  std::vector<double> taken_;  // of it by a reading of 1, [places, lines]; empty: nothing is known of the circuit
  std::size_t lines_;
  std::size_t places_;
  bool has_last_ = false;
  Nanos last_time_{};
  bool any_stale_ = false;
  std::vector<double> last_;          // readings; the mean of those that stay [taxels]
  std::vector<double> change_;        // since then [taxels]
  std::vector<double> jumped_;        // 1: in the last frame, and it was believed [taxels]
  std::vector<std::uint8_t> frames_;  // for which it has not been believed [taxels]
  std::vector<std::uint8_t> stale_;   // last_ is older than the last frame [taxels]
};

}  // namespace dermis::compensation
