// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "learn/recognition/features/image_analysis.hpp"

namespace dermis::learn::recognition {

/// The lattice of an array for classes that were learned on another of the same part of the body. It is as large as the
/// array, with the pitch of the examples. It is the array's own where either pitch is not known.
[[nodiscard]] Lattice common_lattice(const SensedArray& examples, const SensedArray& source);

/// Readings of an array on a lattice. A taxel's reading is shared out by area, so the sum stays. Not thread-safe.
class Regrid {
 public:
  Regrid(const SensedArray& source, const Lattice& lattice);

  /// `frame`: all readings of one; what is no load (below 0, not finite) is taken as 0. `out`: [rows, cols]
  void apply(std::span<const float> frame, std::span<double> out);

 private:
  SensedArray source_;
  Lattice lattice_;
  bool is_same_;
  std::vector<double> row_shares_;  ///< [source rows, rows]: the share of a source row that lies on each row.
  std::vector<double> col_shares_;
  std::vector<double> of_rows_;  ///< [rows, source columns]
};

}  // namespace dermis::learn::recognition
