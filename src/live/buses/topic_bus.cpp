// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/topic_bus.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::live::buses {
namespace {

constexpr std::size_t kMostWriters = 64;

std::vector<BusArray> arrays_of(const bytes::ros_messages::TouchType& type) {
  std::vector<BusArray> arrays;
  for (const bytes::ros_messages::TouchArray& array : type.arrays) arrays.push_back({array.name, array.shape});
  return arrays;
}

}  // namespace

Result<std::shared_ptr<Bus>> TopicBus::open(const BusAddress& address) {
  const auto& place = std::get<TopicPlace>(address.place);
  const Result<const bytes::ros_messages::TouchType*> type = bytes::ros_messages::find_touch_type(place.type);
  if (!type) return bad_input("'" + address.text + "': " + type.error().message);
  auto bus = std::make_shared<TopicBus>(**type, place.topic);
  const auto hear = [bus = bus.get()](const dds::Sample& sample) { bus->hear(sample); };
  Result<std::unique_ptr<dds::Subscriber>> subscriber = dds::Subscriber::create(
      {.domain = place.domain, .loopback_only = place.loopback_only}, {place.topic, (*type)->dds_name, hear});
  if (!subscriber) return subscriber.error();
  bus->subscriber_ = *std::move(subscriber);
  return std::shared_ptr<Bus>(std::move(bus));
}

TopicBus::TopicBus(const bytes::ros_messages::TouchType& type, std::string topic)
    : Bus(arrays_of(type)), type_(type), topic_(std::move(topic)), readings_(type.arrays.size()) {}

void TopicBus::hear(const dds::Sample& sample) {
  Arrival arrival;
  const std::uint32_t lost = lost_before(sample);
  sequence_ = has_come_ ? sequence_ + 1 + lost : sample.sequence;
  for (bytes::ros_messages::TouchReading& reading : readings_) reading.frame.acquisition = {};
  const Status decoded = type_.decode(sample.message, readings_);
  if (!decoded) return count_damaged(decoded.error());
  if (readings_.front().shape.cols > kMaxLines) return count_damaged(bad_input("has one row of more than 1024 values"));
  has_come_ = true;
  if (type_.is_raw_frame) {
    const std::string_view objection = sender_.objection(sample.writer, readings_.front().frame.time, arrival.steady);
    return objection.empty() ? pass_on(readings_.front(), arrival, lost) : leave_out(objection);
  }
  const Nanos device_time = readings_.front().frame.acquisition.device_time.value_or(sample.source_time);
  arrival.taken = taken_at(device_time, sample.writer, arrival.steady);
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    bytes::ros_messages::TouchReading& reading = readings_[k];
    if (reading.shape == FrameShape{}) continue;
    Acquisition& acquisition = reading.frame.acquisition;
    acquisition.sequence = sequence_;
    acquisition.lost_before = lost;
    acquisition.device_time = device_time;
    deliver(k, reading.shape, arrival, reading.frame);
  }
}

/// By the steady clock of this machine, rising. Another writer has another clock.
Nanos TopicBus::taken_at(Nanos device_time, const dds::Sample::Writer& writer, Nanos arrival) {
  if (std::exchange(writer_, writer) != writer) clock_.restart();
  last_taken_ = std::max(clock_.map(device_time, arrival), last_taken_ + Nanos(1));
  return last_taken_;
}

/// A frame of another dermis stays as it was sent. Its time on the way counts from here.
void TopicBus::pass_on(bytes::ros_messages::TouchReading& reading, const Arrival& arrival, std::uint32_t lost) {
  reading.frame.acquisition.arrival_steady = arrival.steady;
  reading.frame.acquisition.lost_before = saturated_sum(reading.frame.acquisition.lost_before, lost);
  deliver_timed(0, reading.shape, reading.frame);
}

/// The user hears of each reason once.
void TopicBus::leave_out(std::string_view objection) {
  const std::vector<std::shared_ptr<ArrayFeed>> all = all_readers();
  for (const std::shared_ptr<ArrayFeed>& reader : all) reader->count_damaged();
  if (!all.empty() && told_.insert(objection).second) all.front()->tell(name() + ": " + std::string(objection));
}

/// Gaps in the numbers of its writer.
std::uint32_t TopicBus::lost_before(const dds::Sample& sample) {
  if (last_.size() > kMostWriters) last_.clear();
  const auto [known, is_new] = last_.emplace(sample.writer, sample.sequence);
  if (is_new) return 0;
  const std::uint64_t lost = sample.sequence - std::exchange(known->second, sample.sequence) - 1;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, std::numeric_limits<std::uint32_t>::max()));
}

/// A topic that has never had a message of its type is not that topic.
void TopicBus::count_damaged(const Error& why) {
  for (const std::shared_ptr<ArrayFeed>& reader : all_readers()) {
    has_come_ ? reader->count_damaged() : reader->end(bad_input(name() + ": " + why.message));
  }
}

}  // namespace dermis::live::buses
