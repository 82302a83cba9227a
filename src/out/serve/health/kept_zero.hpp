// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// The zero of an array, in its folder for the next day: mat/zero.csv, one number a taxel [S]. It belongs to the newest
/// model of the folder. Arrays without a folder of their own, and recordings that are played, have none.
class KeptZero {
 public:
  KeptZero() = default;
  KeptZero(const ServedSuit& suit, const ServedArray& array);

  /// Empty where there is none, or it is older than the model.
  [[nodiscard]] std::vector<double> read() const;
  /// "2026-11-29 14:02:00 UTC", when it was taken.
  [[nodiscard]] std::string taken_at() const;
  [[nodiscard]] Status write(std::span<const double> offsets) const;
  void remove() const;

 private:
  std::string path_;   // empty: none is kept
  std::string model_;  // of the folder
  FrameShape shape_{};
};

}  // namespace dermis::out::serve
