// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/recognition/dataset.hpp"
#include "dermis/recognition/examples.hpp"
#include "dermis/sources/open_source.hpp"

namespace dermis::operation {

/// Where labelled examples are: in recordings, or in plain files.
struct ExampleOptions {
  recognition::DatasetFiles data;
  std::vector<std::string> in;  ///< Recordings; then of `data` only the labels and the rate are used.
  std::string model;            ///< As for LoadInput.
  bool tare = false;            ///< Of the recordings: as for LoadInput.
};

/// Recordings must be of one array at one rate and have names of their own; `source`: how they are opened. Validates.
/// Errors name the file or, as the commands call it, the option.
[[nodiscard]] Result<recognition::LabelledFrames> read_examples(const ExampleOptions& options,
                                                                const sources::SourceOptions& source = {});

}  // namespace dermis::operation
