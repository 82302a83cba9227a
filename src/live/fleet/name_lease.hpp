// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "dermis/touch/frames/result.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/publishing_process.hpp"

/// Leases of the names of robots: keys of a store of JetStream, which end where nobody renews them.
namespace dermis::live::fleet {

inline constexpr std::chrono::seconds kLeaseLasts{5};

/// Makes the store of leases on this server. One that is there stays.
[[nodiscard]] Status make_leases(Broker& broker);

/// Stores a key of no robot there. Fails where the server cannot store.
[[nodiscard]] Status try_leases(Broker& broker);

/// The lease of one name on one server. Not thread-safe.
class NameLease {
 public:
  enum class State : std::uint8_t {
    free,      ///< It was not asked for yet.
    held,      ///< This process has it.
    taken,     ///< Another process has it.
    replaced,  ///< Another process has taken it over from this one, for good.
  };

  /// `domain`: of the server that has the lease, behind the one that is asked; empty: that one. `takes_over`: also from
  /// a process that lives.
  NameLease(const std::string& robot, PublishingProcess self, std::string domain, bool takes_over);

  /// Claims or renews it. Fails where the server does not answer; then the state stays.
  [[nodiscard]] Status take(Broker& broker);
  /// The next process gets it at once.
  void give_back(Broker& broker);

  [[nodiscard]] State state() const noexcept { return state_; }
  /// The number of this process among those of its name: a later one has a greater number. 0: it has none.
  [[nodiscard]] std::uint64_t session() const noexcept { return session_; }
  /// The other process, where there is one.
  [[nodiscard]] const PublishingProcess& holder() const noexcept { return holder_; }
  /// Grows whenever the other process renews the lease.
  [[nodiscard]] std::uint64_t holder_revision() const noexcept { return holder_revision_; }

 private:
  [[nodiscard]] Result<bool> store(Broker& broker, std::uint64_t last);
  [[nodiscard]] bool may_follow(const PublishingProcess& holder) const;

  PublishingProcess self_;
  const std::string domain_;
  const std::string key_;      ///< The subject as messages have it.
  const std::string subject_;  ///< To which this process stores.
  bool takes_over_;
  State state_ = State::free;
  std::uint64_t revision_ = 0;  ///< That of this process.
  std::uint64_t session_ = 0;
  PublishingProcess holder_{};
  std::uint64_t holder_revision_ = 0;
};

}  // namespace dermis::live::fleet
