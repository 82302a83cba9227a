// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/core/frames.hpp"
#include "dermis/operation/operation.hpp"
#include "dermis/preprocessing/missing_readings.hpp"

namespace dermis::operation {

/// Counts the frames of an operation whose forces are not what a user expects. Not thread-safe.
class FrameTroubles {
 public:
  /// `from`: what the source of the operation was opened as, for messages. The operation must outlive this.
  FrameTroubles(const Operation& operation, std::string from);

  /// What the pipeline of the operation has just made of a frame. `number`: its place in the source, from 1.
  void add(const ForceFrame& force, std::size_t number);

  [[nodiscard]] std::size_t frames() const noexcept { return frames_; }

  /// A line for each kind of trouble that there was.
  [[nodiscard]] std::vector<std::string> describe() const;

 private:
  const Operation& operation_;
  std::string from_;
  preprocessing::MissingReadings missing_;
  std::size_t frames_ = 0;
  std::size_t rejected_ = 0;
  std::size_t unsolved_ = 0;
  std::size_t faulty_ = 0;
  std::string first_rejection_;
};

}  // namespace dermis::operation
