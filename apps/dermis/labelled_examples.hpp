// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/recognition/dataset.hpp"
#include "dermis/recognition/examples.hpp"

namespace dermis::app {

/// Where labelled examples are: in recordings, or in plain files.
struct ExampleOptions {
  recognition::DatasetFiles data;
  std::vector<std::string> in;  ///< Recordings; then of `data` only the labels and the rate are used.
  std::string model;            ///< What computes the forces of the recordings; empty: the readings are the loads.
  bool tare = false;            ///< Of the recordings.
};

[[nodiscard]] Result<recognition::LabelledFrames> read_examples(const ExampleOptions& options);

}  // namespace dermis::app
