// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "dermis/live/dds/publisher.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::dds {

/// A message of a topic. Valid during the call.
struct Sample {
  using Writer = std::array<std::uint8_t, 16>;

  std::span<const std::uint8_t> message;  ///< In CDR.
  std::uint64_t sequence = 0;             ///< Its writer counts by one.
  Nanos source_time{};                    ///< When it was written, by the writer's clock.
  Writer writer{};                        ///< Its GUID.
};

/// A topic, and who hears it.
struct Subscription {
  std::string topic;  ///< As DDS names it: "rt/chest/raw" is "/chest/raw" of ROS 2.
  std::string type;   ///< As DDS names it: "sensor_msgs::msg::dds_::Image_".
  /// Told each message once, in the order of its writer, on a thread of Fast DDS. It must be quick.
  std::function<void(const Sample&)> heard;
};

/// Subscribes to a topic by Fast DDS, which is loaded with the first one. Writers may be reliable or not. The
/// subscribers of a process share one participant in each domain. Thread-safe.
class Subscriber {
 public:
  /// Fails where Fast DDS or its plugin is not there, and where the network gives no place in the domain.
  [[nodiscard]] static Result<std::unique_ptr<Subscriber>> create(const PublisherOptions& options,
                                                                  const Subscription& subscription);
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;
  /// Nothing is heard afterwards.
  ~Subscriber();

 private:
  class Implementation;
  explicit Subscriber(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::dds
