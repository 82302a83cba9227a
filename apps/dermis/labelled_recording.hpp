// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::app {

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
