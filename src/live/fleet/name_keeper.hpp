// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "dermis/touch/frames/result.hpp"
#include "live/fleet/name_lease.hpp"

namespace dermis::live::fleet {

/// Keeps the name of a robot for this process: on the server to which it publishes, and on a hub behind that. A hub
/// that does not answer is asked again, and ends nothing. One thread claims, renews and gives back; any may ask.
class NameKeeper {
 public:
  /// `notice` is told in one line when another process comes. `takes_over`: also from a process that lives.
  NameKeeper(std::string robot, bool takes_over, std::function<void(std::string)> notice);

  /// Claims the name, and waits where the process that has it may have ended. Fails where that lives. A server that
  /// does not answer is no failure.
  [[nodiscard]] Status claim(Broker& broker);
  /// Claims or renews the name; once a second. Fails where the server does not answer.
  [[nodiscard]] Status renew(Broker& broker);
  void give_back(Broker& broker);

  /// The number of this process among those of the name, a later one has a greater number. 0: it may not publish now.
  [[nodiscard]] std::uint64_t session() const noexcept { return session_; }
  /// Another process has taken the name over, for good.
  [[nodiscard]] bool is_replaced() const noexcept { return is_replaced_; }
  /// Another robot has the name on the hub.
  [[nodiscard]] bool is_doubled() const noexcept { return is_doubled_; }

 private:
  [[nodiscard]] Status prepare(Broker& broker);
  [[nodiscard]] Status take(Broker& broker);
  [[nodiscard]] const NameLease* refused() const;
  void tell();

  const std::string robot_;
  const bool takes_over_;
  const std::function<void(std::string)> notice_;
  const PublishingProcess self_ = this_process();
  bool is_prepared_ = false;
  NameLease own_;
  std::optional<NameLease> hub_{};  ///< Empty: the server is the hub, or it is not known yet.
  std::string told_{};
  std::atomic<std::uint64_t> session_ = 0;
  std::atomic<bool> is_replaced_ = false;
  std::atomic<bool> is_doubled_ = false;
};

}  // namespace dermis::live::fleet
