// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/name_keeper.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

using Clock = std::chrono::steady_clock;
using State = NameLease::State;

constexpr std::chrono::milliseconds kLookEvery{200};
constexpr std::chrono::seconds kLongestClaim = 2 * kLeaseLasts;

}  // namespace

NameKeeper::NameKeeper(std::string robot, bool takes_over, std::function<void(std::string)> notice)
    : robot_(std::move(robot)),
      takes_over_(takes_over),
      notice_(std::move(notice)),
      own_(robot_, self_, "", takes_over) {}

Status NameKeeper::prepare(Broker& broker) {
  if (is_prepared_) return Done{};
  const Result<std::string> domain = domain_of(broker);
  if (!domain) return domain.error();
  if (Status made = make_leases(broker); !made) return made;
  if (!domain->empty() && *domain != kHubDomain) hub_.emplace(robot_, self_, kHubDomain, takes_over_);
  is_prepared_ = true;
  return Done{};
}

Status NameKeeper::take(Broker& broker) {
  if (Status prepared = prepare(broker); !prepared) return prepared;
  Status taken = own_.take(broker);
  if (taken && hub_) static_cast<void>(hub_->take(broker));
  const bool is_replaced_there = hub_ && hub_->state() == State::replaced;
  is_replaced_ = own_.state() == State::replaced || is_replaced_there;
  is_doubled_ = hub_ && hub_->state() == State::taken;
  session_ = own_.state() == State::held && !is_replaced_ ? own_.session() : 0;
  return taken;
}

/// The lease that another process has; null: none.
const NameLease* NameKeeper::refused() const {
  const auto is_of_another = [](const NameLease& lease) {
    return lease.state() == State::taken || lease.state() == State::replaced;
  };
  if (is_of_another(own_)) return &own_;
  return hub_ && is_of_another(*hub_) ? &*hub_ : nullptr;
}

Status NameKeeper::claim(Broker& broker) {
  const Clock::time_point end = Clock::now() + kLongestClaim;
  std::optional<std::uint64_t> seen;
  while (take(broker)) {
    const NameLease* const other = refused();
    if (other == nullptr && session_ > 0) break;
    const bool is_alive = other != nullptr && seen && *seen != other->holder_revision();
    if (is_alive || (other != nullptr && Clock::now() > end)) {
      give_back(broker);
      return bad_input("another robot publishes as '" + robot_ + "' (" + other->holder().shown() +
                       "); give this one another name, or have it take over");
    }
    if (other != nullptr) seen = other->holder_revision();
    std::this_thread::sleep_for(kLookEvery);
  }
  return Done{};
}

Status NameKeeper::renew(Broker& broker) {
  Status taken = take(broker);
  tell();
  return taken;
}

void NameKeeper::tell() {
  std::string line;
  if (const NameLease* const other = refused()) {
    const std::string named = other->holder().shown() + " publishes as '" + robot_ + "', too; ";
    line = is_replaced_
               ? other->holder().shown() + " has taken over the name '" + robot_ + "'; nothing more is published"
           : other == &own_ ? named + "nothing is published from here until it ends"
                            : named + "name one of the two robots otherwise";
  }
  if (std::exchange(told_, line) != line && !line.empty() && notice_) notice_(line);
}

void NameKeeper::give_back(Broker& broker) {
  own_.give_back(broker);
  if (hub_) hub_->give_back(broker);
}

}  // namespace dermis::live::fleet
