// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dermis::live::fleet {

/// A process that publishes, as it writes itself into the lease of its name.
struct PublishingProcess {
  std::string token{};        ///< No other process has it.
  std::string host{};         ///< The name of its machine.
  std::string kernel{};       ///< The start of its kernel and its space of numbers of processes.
  std::int64_t pid = 0;       ///< In that space.
  std::uint64_t started = 0;  ///< In ticks of that kernel; 0: not known.
  std::string replaces{};     ///< Token of the process from which it took the name; empty: of none.

  /// "process 12 on anna.local"
  [[nodiscard]] std::string shown() const;
  /// It was of this kernel and has ended. False where that cannot be known from here.
  [[nodiscard]] bool is_gone() const;
};

[[nodiscard]] PublishingProcess this_process();

[[nodiscard]] std::string to_json(const PublishingProcess& process);
/// Empty of a text without a token. Accepts any text.
[[nodiscard]] std::optional<PublishingProcess> process_from_json(std::string_view text);

}  // namespace dermis::live::fleet
