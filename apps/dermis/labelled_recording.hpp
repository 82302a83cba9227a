// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::app {

/// Reads loads.csv, and says for what it took values that are not in newtons or kPa.
[[nodiscard]] Result<std::vector<Load>> read_told_loads(const std::string& path, const ArrayDescription& array,
                                                        std::size_t frame_count);

/// A model, and frames of its array under known loads.
struct LabelledRecording {
  touch::pipeline::Model model;
  std::vector<RawFrame> frames;
  std::vector<Load> loads;

  /// The three files.
  [[nodiscard]] static Result<LabelledRecording> read(const std::string& model, const std::string& frames,
                                                      const std::string& loads);
};

}  // namespace dermis::app
