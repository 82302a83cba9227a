// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis::app {

/// Shows how far long work is, on stderr: a bar that redraws itself on a terminal, a plain line every quarter
/// otherwise. Not thread-safe.
class Progress {
 public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `share` in [0, 1] of `stage`.
  void show(const std::string& stage, double share);

 private:
  void end_line();

  bool is_terminal_;
  bool line_open_ = false;
  std::string stage_;
  int last_shown_ = -1;
};

}  // namespace dermis::app
