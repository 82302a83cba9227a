// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "dermis/touch/frames/result.hpp"

namespace dermis::out::datasets {

/// lerobot_tables.py at work, which writes the Parquet files of a dataset by pyarrow. Not thread-safe.
class LeRobotTables {
 public:
  /// `python`: the interpreter, which is looked for as a shell does. Fails where there is none, or it has no pyarrow.
  [[nodiscard]] static Result<std::unique_ptr<LeRobotTables>> start(const std::string& python,
                                                                    const std::string& folder);
  LeRobotTables(const LeRobotTables&) = delete;
  LeRobotTables& operator=(const LeRobotTables&) = delete;
  /// Waits for the end of the process.
  ~LeRobotTables();

  /// A line of JSON, or bytes that such a line has announced.
  [[nodiscard]] Status send(std::span<const std::byte> bytes) const;
  [[nodiscard]] Status send_line(std::string line) const;
  /// The last line; then all is written.
  [[nodiscard]] Status finish(std::string line) const;

 private:
  LeRobotTables(int socket, int process) : socket_(socket), process_(process) {}
  [[nodiscard]] Status expect(std::string_view answer) const;

  int socket_;
  int process_;
};

}  // namespace dermis::out::datasets
