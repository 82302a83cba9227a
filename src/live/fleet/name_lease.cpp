// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/name_lease.hpp"

#include <utility>

#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

constexpr const char* kLeases = "dermis-names";

std::string stream_of_leases() {
  return std::string("KV_") + kLeases;
}

}  // namespace

Status make_leases(Broker& broker) {
  return make_key_store(broker, kLeases, kLeaseLasts);
}

Status try_leases(Broker& broker) {
  const auto stored = broker.store(std::string("$KV.") + kLeases + "._", "", {});
  return stored ? Status(Done{}) : Status(stored.error());
}

NameLease::NameLease(const std::string& robot, PublishingProcess self, std::string domain, bool takes_over)
    : self_(std::move(self)),
      domain_(std::move(domain)),
      key_(std::string("$KV.") + kLeases + "." + robot),
      subject_(domain_.empty() ? key_ : "$JS." + domain_ + ".API." + key_),
      takes_over_(takes_over) {}

/// True: this process has it now. False: another was faster.
Result<bool> NameLease::store(Broker& broker, std::uint64_t last) {
  const auto stored = broker.store_after(last, subject_, to_json(self_));
  if (!stored) return stored.error();
  if (!*stored) return false;
  revision_ = **stored;
  if (state_ != State::held) session_ = revision_;
  state_ = State::held;
  takes_over_ = false;
  return true;
}

bool NameLease::may_follow(const PublishingProcess& holder) const {
  return holder.token == self_.token || (state_ != State::held && (takes_over_ || holder.is_gone()));
}

Status NameLease::take(Broker& broker) {
  if (state_ == State::replaced) return Done{};
  if (state_ == State::held) {
    const Result<bool> renewed = store(broker, revision_);
    if (!renewed) return renewed.error();
    if (*renewed) return Done{};
  }
  const auto last = broker.last(stream_of_leases(), key_, domain_);
  if (!last) return last.error();
  std::optional<PublishingProcess> holder;
  if (*last) {
    const std::vector<std::uint8_t>& text = (*last)->bytes;
    holder = process_from_json({reinterpret_cast<const char*>(text.data()), text.size()});
  }
  if (!holder || may_follow(*holder)) {
    if (holder && holder->token != self_.token) self_.replaces = holder->token;
    const Result<bool> stored = store(broker, *last ? (*last)->sequence : 0);
    return stored ? Status(Done{}) : Status(stored.error());  // another was faster: the next time tells who
  }
  state_ = holder->replaces == self_.token ? State::replaced : State::taken;
  holder_ = *std::move(holder);
  holder_revision_ = (*last)->sequence;
  return Done{};
}

void NameLease::give_back(Broker& broker) {
  if (state_ != State::held) return;
  static_cast<void>(broker.store_after(revision_, subject_, ""));
  state_ = State::free;
}

}  // namespace dermis::live::fleet
