// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/paper/paper_bank.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// The format of a bank file.
inline constexpr bytes::files::FileFormat kPaperBankFormat{
    "dermis paper bank 2", "dermis paper bank 1", "is not a bank of the paper; the paper's calibration writes one"};

/// Writes a safetensors file (docs/model-file.md) beside `path` and renames it; 135 MB for 16 x 16 taxels. Each rank
/// writes the networks of its bank.
[[nodiscard]] Status write_paper_bank(const std::string& path, const PaperBank& bank, Ranks& ranks = one_process());

/// A bank read is complete and all its numbers are finite, or an error that names the file.
[[nodiscard]] Result<PaperBank> read_paper_bank(const std::string& path);

}  // namespace dermis::paper
