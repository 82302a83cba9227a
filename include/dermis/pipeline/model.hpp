// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dermis/contacts/strip_table.hpp"
#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/files/safetensors.hpp"
#include "dermis/fusion/force_fusion.hpp"
#include "dermis/fusion/look_up.hpp"
#include "dermis/fusion/material_memory.hpp"
#include "dermis/preprocessing/supply_bounds.hpp"

namespace dermis::pipeline {

/// Everything that turns the counts of one array into newtons. It holds what is known (the array and its circuit) and
/// what was learned (the networks). It also holds the baselines of the same calibration, to compare the networks with.
struct Model {
  ArrayDescription array;
  fusion::ForceNetworks networks;
  std::vector<fusion::LookUpTables> baselines;
  std::optional<fusion::MemoryLaw> memory{};    ///< Memory of the material, where the calibration learned one.
  std::optional<contacts::StripTable> strip{};  ///< Learned positions on a strip, where the calibration had some.
  /// Supplies of the frames of the calibration; empty: they had none, or the model is of a time that did not keep them.
  std::optional<preprocessing::SupplyRange> supply{};
  std::map<std::string, std::string> provenance;  ///< Hashes, counts and statistics of the calibration, as text.
};

/// The provenance that says in what circuit and ADC are not as described; missing: nothing was noticed.
inline constexpr const char* kDoubts = "doubts";

/// The format of a model file.
inline constexpr files::FileFormat kModelFormat{"dermis model 3", "dermis model 2",
                                                "is not a dermis model; a calibration writes one"};

/// Writes a safetensors file (docs/file-formats.md) beside `path` and renames it.
[[nodiscard]] Status write_model(const std::string& path, const Model& model);

/// Reads a model file, or, by the ending .toml, the array.toml of an array whose readings are forces: its
/// direct_model(). A model read is complete and consistent, or an error that names the file. Damage is found by the
/// checksum in the file, which those of older releases do not have: files::checksum_note().
[[nodiscard]] Result<Model> read_model(const std::string& path);

}  // namespace dermis::pipeline
