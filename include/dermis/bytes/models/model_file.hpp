// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::bytes::models {

/// The format of a model file.
inline constexpr files::FileFormat kModelFormat{"dermis model 3", "dermis model 2",
                                                "is not a dermis model; a calibration writes one"};

/// Writes a safetensors file (docs/model-file.md) beside `path` and renames it.
[[nodiscard]] Status write_model(const std::string& path, const touch::pipeline::Model& model);
/// The bytes of that file, such as a recording holds.
[[nodiscard]] Result<std::string> model_to_bytes(const touch::pipeline::Model& model);

/// Reads a model file, or, by the ending .toml, the array.toml of an array whose readings are forces: its
/// touch::pipeline::direct_model(). A model read is complete and consistent, or an error that names the file. Damage is
/// found by the checksum in the file, which those of older releases do not have: files::checksum_note().
[[nodiscard]] Result<touch::pipeline::Model> read_model(const std::string& path);
/// The same of the bytes of a model file; `name` stands for the path in messages.
[[nodiscard]] Result<touch::pipeline::Model> model_from_bytes(std::string_view bytes, const std::string& name);

}  // namespace dermis::bytes::models
