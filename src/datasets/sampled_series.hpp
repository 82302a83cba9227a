// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"

namespace dermis::datasets {

/// Numbers that were sampled beside the frames, such as joint angles: a CSV with time_s, whose times rise.
class SampledSeries {
 public:
  [[nodiscard]] static Result<SampledSeries> read(const std::string& path);

  /// The other columns.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// The newest row of that time or earlier, or the first one.
  [[nodiscard]] const std::vector<float>& at(Nanos time) const;

 private:
  std::vector<std::string> names_;
  std::vector<Nanos> times_;
  std::vector<std::vector<float>> rows_;
};

}  // namespace dermis::datasets
