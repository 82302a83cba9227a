// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::learn::health {

/// The values that readings have: whether they are of one or two values only, or those of an array without power.
class ReadingLevels {
 public:
  /// `array` must outlive it. `is_readout_known`: its readout is described.
  ReadingLevels(const ArrayDescription& array, bool is_readout_known);

  void add(std::span<const float> counts);

  [[nodiscard]] float least() const;
  [[nodiscard]] float most() const;

  /// A sentence where the whole array cannot be so.
  [[nodiscard]] std::optional<std::string> finding() const;

  /// The highest reading, where it is the end of an ADC.
  [[nodiscard]] std::optional<float> full_scale() const;

  /// That all readings are those of an array without power or of one that nothing touches.
  [[nodiscard]] std::optional<std::string> remark() const;

 private:
  /// Lowest and highest reading of a taxel.
  struct Range {
    float least = 0.0F;
    float most = 0.0F;
  };

  void count_values(std::span<const float> counts);
  [[nodiscard]] bool is_full_scale(float counts) const;
  [[nodiscard]] bool may_rest_at(float counts) const;
  [[nodiscard]] std::optional<std::string> only_value() const;
  [[nodiscard]] std::optional<std::string> no_power() const;
  [[nodiscard]] std::optional<std::string> two_values() const;

  const ArrayDescription& array_;
  bool is_readout_known_;
  std::size_t frames_ = 0;
  std::size_t zeros_ = 0;                // readings of 0
  std::vector<Range> ranges_;            // [taxels]
  std::map<float, std::size_t> values_;  // how often each was read; no more are added beyond a few
};

}  // namespace dermis::learn::health
