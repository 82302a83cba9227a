// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/dds/publisher.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "dermis/bytes/files/numbers.hpp"
#include "live/dds/participant.hpp"
#include "live/dds/writing_queue.hpp"

namespace dermis::live::dds {
namespace {

constexpr std::uint32_t kLastDomain = 232;  // whose ports are below 65536
constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20U;

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// 0 where none is set.
Result<std::uint64_t> domain_of_environment() {
  const std::string_view text = environment("ROS_DOMAIN_ID");
  std::uint64_t domain = 0;
  if (text.empty()) return domain;
  if (bytes::files::parse_number(text, domain)) return domain;
  return bad_input("ROS_DOMAIN_ID: must be 0 to 232, is '" + std::string(text) + "'");
}

}  // namespace

Status PublisherOptions::validate() const {
  if (domain <= kLastDomain) return Done{};
  return bad_field("domain", "must be 0 to 232, is " + std::to_string(domain));
}

Result<PublisherOptions> options_of_environment(std::optional<std::uint64_t> wanted) {
  const Result<std::uint64_t> domain = wanted ? Result<std::uint64_t>(*wanted) : domain_of_environment();
  if (!domain) return domain.error();
  PublisherOptions options;
  options.domain =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(*domain, std::numeric_limits<std::uint32_t>::max()));
  options.loopback_only =
      environment("ROS_LOCALHOST_ONLY") == "1" || environment("ROS_AUTOMATIC_DISCOVERY_RANGE") == "LOCALHOST";
  if (Status valid = options.validate(); !valid) return valid.error();
  return options;
}

class Publisher::Implementation {
 public:
  explicit Implementation(std::unique_ptr<Participant> participant) : participant_(std::move(participant)) {}

  Result<TopicId> add_topic(const Topic& topic) {
    Result<std::unique_ptr<Writer>> writer = participant_->add_writer(topic);
    if (!writer) return writer.error();
    writers_.push_back(*std::move(writer));
    return writers_.size() - 1;
  }

  [[nodiscard]] Writer& writer(TopicId topic) const {
    assert(topic < writers_.size());
    return *writers_[topic];
  }

  void publish(TopicId topic, std::span<const std::uint8_t> message) {
    if (!queue_.push(writer(topic), message)) ++left_out_;
  }

  [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_.load(); }

 private:
  std::unique_ptr<Participant> participant_;
  std::vector<std::unique_ptr<Writer>> writers_;
  std::atomic<std::uint64_t> left_out_{0};
  WritingQueue queue_{kMostWaitingBytes};
};

Result<std::unique_ptr<Publisher>> Publisher::create(const PublisherOptions& options) {
  if (Status valid = options.validate(); !valid) return valid.error();
  Result<std::unique_ptr<Participant>> participant = open_participant(options);
  if (!participant) return participant.error();
  return std::unique_ptr<Publisher>(new Publisher(std::make_unique<Implementation>(*std::move(participant))));
}

Publisher::Publisher(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Publisher::~Publisher() = default;

Result<TopicId> Publisher::add_topic(const Topic& topic) {
  return implementation_->add_topic(topic);
}

bool Publisher::has_subscribers(TopicId topic) const noexcept {
  return implementation_->writer(topic).has_readers();
}

void Publisher::publish(TopicId topic, std::span<const std::uint8_t> message) {
  implementation_->publish(topic, message);
}

std::uint64_t Publisher::left_out() const noexcept {
  return implementation_->left_out();
}

}  // namespace dermis::live::dds
