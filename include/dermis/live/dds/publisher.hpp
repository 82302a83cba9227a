// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/result.hpp"

/// Messages as topics of DDS, as the nodes of ROS 2 hear them (docs/ros.md).
namespace dermis::live::dds {

struct PublisherOptions {
  std::uint32_t domain = 0;    ///< Programs hear each other within one, 0 ... 232.
  bool loopback_only = false;  ///< No other machine hears it.

  /// Names the first field that is out of its range, as "domain: ...".
  [[nodiscard]] Status validate() const;
};

/// As the nodes of ROS 2 have them that are started from the same shell. The domain is that of ROS_DOMAIN_ID where none
/// is `wanted`. ROS_LOCALHOST_ONLY and ROS_AUTOMATIC_DISCOVERY_RANGE tell whether loopback is all.
[[nodiscard]] Result<PublisherOptions> options_of_environment(std::optional<std::uint64_t> wanted = std::nullopt);

/// The messages to be published. Subscribers may be reliable or, as for the data of sensors, not.
struct Topic {
  std::string name;                              ///< As ROS 2 names it: "/chest/force".
  const bytes::ros_messages::MessageType& type;  ///< Must outlive the publisher.
  /// Size of one message. A reliable subscriber that does not follow has up to 32 MB kept for it, but ten
  /// messages at least.
  std::size_t message_bytes = 1024;
  bool is_kept = false;  ///< Later subscribers get the last message, too ("transient local").
};

using TopicId = std::size_t;

/// Publishes topics by Fast DDS, which is loaded with the first publisher. Thread-safe but for add_topic().
class Publisher {
 public:
  /// Fails where Fast DDS or its plugin is not there, and where the network gives no place in the domain.
  [[nodiscard]] static Result<std::unique_ptr<Publisher>> create(const PublisherOptions& options = {});
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  /// Sends what waits.
  ~Publisher();

  /// Before the first publish().
  [[nodiscard]] Result<TopicId> add_topic(const Topic& topic);

  [[nodiscard]] bool has_subscribers(TopicId topic) const noexcept;

  /// Queues a message, in CDR, and returns at once. A network that stalls has 16 MB kept for it; what comes then is
  /// left out and counted.
  void publish(TopicId topic, std::span<const std::uint8_t> message);

  [[nodiscard]] std::uint64_t left_out() const noexcept;

 private:
  class Implementation;
  explicit Publisher(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::dds
