// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/learn/recognition/dataset.hpp"
#include "dermis/learn/recognition/examples.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::recognising {

/// Where labelled examples are: in recordings, or in plain files.
struct ExampleOptions {
  learn::recognition::DatasetFiles data;
  std::vector<std::string> in;  ///< Recordings; then `data` has no frames and arrays, and its extras are
                                ///< as for FurtherReadings::read().
  std::string model;            ///< Model of the recordings: as for LoadInput, like the next two.
  bool tare = false;
  bool tare_force = false;
  std::vector<std::string> arrays;  ///< Empty: those of the first recording.
};

/// Recordings must be of the same arrays at one rate and have names of their own; `source`: how they are opened.
/// Validates.
/// Errors name the file or, as the commands call it, the option.
[[nodiscard]] Result<learn::recognition::LabelledFrames> read_examples(const ExampleOptions& options,
                                                                       const live::sources::SourceOptions& source = {});

}  // namespace dermis::recognising
