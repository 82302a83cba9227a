// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::out::datasets {

/// The episodes that are not trained on: the last ones of a dataset.
class HoldOut {
 public:
  /// `wanted`: as EpisodeOptions::hold_out.
  [[nodiscard]] static Result<HoldOut> create(const std::vector<std::string>& wanted,
                                              const std::vector<std::string>& recordings);

  /// In which order the recordings come: those that are held out at the end.
  [[nodiscard]] const std::vector<std::size_t>& order() const noexcept { return order_; }
  /// So many of them are trained on; of a share it is not known, and all count.
  [[nodiscard]] std::size_t trained() const noexcept { return trained_; }
  /// Episodes at the end of `episodes`, of which `of_trained` are of recordings that are trained on.
  [[nodiscard]] Result<std::uint64_t> episodes(std::uint64_t episodes, std::uint64_t of_trained) const;

 private:
  std::vector<std::size_t> order_;
  std::size_t trained_ = 0;
  double share_ = 0.0;
};

}  // namespace dermis::out::datasets
