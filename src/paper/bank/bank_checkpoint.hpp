// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/paper/bank_training.hpp"
#include "dermis/touch/frames/result.hpp"
#include "paper/bank/bank_rows_file.hpp"

namespace dermis::paper {

/// The file that a training of the bank goes on from: the parameters, the moments of Adam, and the errors so far.
class BankCheckpoint {
 public:
  /// All arguments must outlive it.
  BankCheckpoint(const learn::calibration::SampleDatabase& database, const BankTrainingOptions& options, Ranks& ranks);

  /// `curve`: the error of each step so far.
  [[nodiscard]] Status write(const NetworkBank& networks, const std::vector<double>& curve) const;

  /// The curve, after `networks` have become those of write(); empty where there is no file.
  [[nodiscard]] Result<std::vector<double>> read(NetworkBank& networks) const;

 private:
  [[nodiscard]] BankRowsFile file_of(const NetworkBank& networks, std::vector<double> curve) const;

  const BankTrainingOptions& options_;
  Ranks& ranks_;
  std::size_t taxels_;
  std::string samples_;  ///< Their hash.
};

}  // namespace dermis::paper
