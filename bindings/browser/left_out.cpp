// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The ends of the session that a page does not have yet: what is kept in folders of arrays, and what other machines
// hear.
#include <utility>

#include "dermis/live/dds/publisher.hpp"
#include "dermis/live/dds/subscriber.hpp"
#include "out/serve/health/kept_zero.hpp"

namespace dermis {
namespace {

Error not_in_a_page() {
  return bad_input("a page cannot do this; the command dermis can");
}

}  // namespace

namespace out::serve {

KeptZero::KeptZero(const ServedSuit& /*suit*/, const ServedArray& /*array*/) {}

std::vector<double> KeptZero::read() const {
  return {};
}

std::string KeptZero::taken_at() const {
  return {};
}

Status KeptZero::write(std::span<const double> /*offsets*/) const {
  return Done{};
}

void KeptZero::remove() const {}

}  // namespace out::serve

namespace live::dds {

class Publisher::Implementation {};
Publisher::~Publisher() = default;

Result<std::unique_ptr<Publisher>> Publisher::create(const PublisherOptions& /*options*/) {
  return not_in_a_page();
}

Result<TopicId> Publisher::add_topic(const Topic& /*topic*/) {
  return not_in_a_page();
}

bool Publisher::has_subscribers(TopicId /*topic*/) const noexcept {
  return false;
}

void Publisher::publish(TopicId /*topic*/, std::span<const std::uint8_t> /*message*/) {}

std::uint64_t Publisher::left_out() const noexcept {
  return 0;
}

class Subscriber::Implementation {};
Subscriber::~Subscriber() = default;

Result<std::unique_ptr<Subscriber>> Subscriber::create(const PublisherOptions& /*options*/,
                                                       const Subscription& /*subscription*/) {
  return not_in_a_page();
}

}  // namespace live::dds
}  // namespace dermis
