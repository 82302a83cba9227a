// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/devices/clock_mapping.hpp"
#include "dermis/bytes/ros_messages/touch_messages.hpp"
#include "dermis/live/buses/bus_address.hpp"
#include "dermis/live/dds/subscriber.hpp"
#include "live/buses/bus.hpp"
#include "live/buses/followed_sender.hpp"

namespace dermis::live::buses {

/// A topic of DDS, each message of which holds all arrays.
class TopicBus final : public Bus {
 public:
  /// Fails on an unknown type, and where DDS is not there.
  [[nodiscard]] static Result<std::shared_ptr<Bus>> open(const BusAddress& address);

  /// Hears nothing but what it is told. `type` must outlive it.
  TopicBus(const bytes::ros_messages::TouchType& type, std::string topic);

  [[nodiscard]] std::string name() const override { return "'" + topic_ + "' of type " + type_.dds_name; }
  /// By one thread at a time.
  void hear(const dds::Sample& sample);

 private:
  [[nodiscard]] Nanos taken_at(Nanos device_time, const dds::Sample::Writer& writer, Nanos arrival);
  void pass_on(bytes::ros_messages::TouchReading& reading, const Arrival& arrival, std::uint32_t lost);
  void leave_out(std::string_view objection);
  [[nodiscard]] std::uint32_t lost_before(const dds::Sample& sample);
  void count_damaged(const Error& why);

  const bytes::ros_messages::TouchType& type_;
  const std::string topic_;
  std::vector<bytes::ros_messages::TouchReading> readings_;
  std::map<dds::Sample::Writer, std::uint64_t> last_;  // sequence
  std::uint64_t sequence_ = 0;
  ClockMapping clock_;            // of writer_, or of what stamps its messages
  dds::Sample::Writer writer_{};  // of the last message
  Nanos last_taken_{};
  FollowedSender sender_;  // of frames of another dermis
  std::set<std::string_view> told_;
  bool has_come_ = false;                        // a message that could be read
  std::unique_ptr<dds::Subscriber> subscriber_;  // the first to go
};

}  // namespace dermis::live::buses
