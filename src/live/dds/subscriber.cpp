// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/dds/subscriber.hpp"

#include <map>
#include <mutex>
#include <utility>

#include "live/dds/participant.hpp"

namespace dermis::live::dds {
namespace {

/// The participants of this process that subscribe.
class Participants {
 public:
  Result<std::shared_ptr<Participant>> find(const PublisherOptions& options) {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<Participant>& known = participants_[{options.domain, options.loopback_only}];
    if (std::shared_ptr<Participant> used = known.lock()) return used;
    Result<std::unique_ptr<Participant>> opened = open_participant(options);
    if (!opened) return opened.error();
    std::shared_ptr<Participant> participant = *std::move(opened);
    known = participant;
    return participant;
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<std::uint32_t, bool>, std::weak_ptr<Participant>> participants_;
};

}  // namespace

class Subscriber::Implementation {
 public:
  Implementation(std::shared_ptr<Participant> participant, std::unique_ptr<Reader> reader)
      : participant_(std::move(participant)), reader_(std::move(reader)) {}

 private:
  std::shared_ptr<Participant> participant_;
  std::unique_ptr<Reader> reader_;
};

Result<std::unique_ptr<Subscriber>> Subscriber::create(const PublisherOptions& options,
                                                       const Subscription& subscription) {
  if (Status valid = options.validate(); !valid) return valid.error();
  static Participants participants;
  Result<std::shared_ptr<Participant>> participant = participants.find(options);
  if (!participant) return participant.error();
  Result<std::unique_ptr<Reader>> reader = (*participant)->add_reader(subscription);
  if (!reader) return reader.error();
  return std::unique_ptr<Subscriber>(
      new Subscriber(std::make_unique<Implementation>(*std::move(participant), *std::move(reader))));
}

Subscriber::Subscriber(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Subscriber::~Subscriber() = default;

}  // namespace dermis::live::dds
