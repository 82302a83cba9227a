// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/paper/ranks.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// A safetensors file with large tensors of [networks, parameters], of which each rank has the rows of its networks.
/// All ranks call the same function, and get the same errors.
class BankRowsFile {
 public:
  struct Rows {
    std::vector<std::string> tensors;  ///< Names of the large tensors, sorted.
    std::size_t networks = 0;
    std::size_t parameters = 0;
  };
  /// Gives or takes a row; `network` counts the rank's own.
  using Row = std::function<void(std::size_t tensor, std::size_t network, std::span<float> values)>;

  /// `first`: metadata and the tensors before the large ones. `ranks` must outlive it.
  BankRowsFile(const bytes::files::SafetensorsFile& first, Rows rows, Ranks& ranks);

  /// Each rank writes its rows; the file takes its place when all are done.
  [[nodiscard]] Status write(const std::string& path, const Row& give) const;

  /// Takes the rows, and returns the bytes of the tensors before them. Errors: the header is not that of write(), for
  /// which `otherwise` is said; the checksum differs.
  [[nodiscard]] Result<std::string> read(const std::string& path, const char* otherwise, const Row& take) const;

 private:
  [[nodiscard]] std::uint64_t offset(std::size_t tensor, std::size_t network) const;
  [[nodiscard]] std::string checksum(const std::string& first, const Row& row) const;
  [[nodiscard]] int write_own(int descriptor, bool is_regular, const std::string& beginning, const Row& give) const;

  bytes::files::SafetensorsBeginning beginning_;
  Rows rows_;
  Ranks& ranks_;
  Part own_;
};

}  // namespace dermis::paper
