// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/open_bus.hpp"

#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/ros_messages/touch_messages.hpp"
#include "dermis/live/buses/candump.hpp"
#include "dermis/touch/frames/nearest_name.hpp"
#include "live/buses/array_feed.hpp"
#include "live/buses/bus.hpp"
#include "live/buses/can_bus.hpp"
#include "live/buses/register_bus.hpp"
#include "live/buses/topic_bus.hpp"

namespace dermis::live::buses {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr Nanos kTick = 50ms;
constexpr Nanos kSilence = 2s;  // then the user gets a notice

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

class BusSource final : public FrameSource {
 public:
  BusSource(std::string text, std::shared_ptr<Bus> bus, std::size_t array, BusOptions options)
      : text_(std::move(text)),
        bus_(std::move(bus)),
        array_(bus_->arrays()[array]),
        options_(std::move(options)),
        feed_(std::make_shared<ArrayFeed>(options_.notice, "'" + text_ + "'", options_.shape)) {
    bus_->add(array, feed_);
  }

  Result<bool> next(RawFrame& frame) override {
    for (;;) {
      const Result<Polled> polled = poll(frame);
      if (!polled) return polled.error();
      if (*polled != Polled::nothing) return *polled == Polled::frame;
      feed_->wait(kTick);
    }
  }

  [[nodiscard]] std::optional<Readiness> readiness() const override {
    return Readiness{feed_->descriptor(), steady_now() + kTick};
  }

  Result<Polled> poll(RawFrame& frame) override {
    Result<Polled> taken = feed_->take(frame);
    if (!taken) return Error{taken.error().kind, "'" + text_ + "': " + taken.error().message};
    if (*taken == Polled::frame) {
      last_ = steady_now();
      is_silent_ = false;
    }
    if (*taken == Polled::nothing && options_.stop != nullptr && options_.stop->load()) return Polled::end;
    if (*taken == Polled::nothing) tell_silence();
    return taken;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override {
    if (array_.shape != FrameShape{}) return array_.shape;
    return feed_->shape();
  }

  [[nodiscard]] SourceStatistics statistics() const override { return feed_->statistics(); }
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  void tell_silence() {
    if (is_silent_ || steady_now() - last_ < kSilence) return;
    is_silent_ = true;
    if (options_.notice) options_.notice("no frames from " + bus_->name() + " for 2 s");
  }

  const std::string text_;
  const std::shared_ptr<Bus> bus_;
  const BusArray array_;
  const BusOptions options_;
  const std::shared_ptr<ArrayFeed> feed_;
  Nanos last_ = steady_now();
  bool is_silent_ = false;
};

/// The connections of this process that are in use.
class Buses {
 public:
  Result<std::shared_ptr<Bus>> find(const BusAddress& address) {
    const std::lock_guard lock(mutex_);
    std::erase_if(buses_, [](const auto& entry) { return entry.second.expired(); });
    if (const auto known = buses_.find(address.connection); known != buses_.end()) {
      if (std::shared_ptr<Bus> bus = known->second.lock()) return bus;
    }
    Result<std::shared_ptr<Bus>> bus = open(address);
    if (bus) buses_[address.connection] = *bus;
    return bus;
  }

 private:
  static Result<std::shared_ptr<Bus>> open(const BusAddress& address) {
    if (std::holds_alternative<TopicPlace>(address.place)) return TopicBus::open(address);
    if (std::holds_alternative<CanInterface>(address.place)) return CanBus::open(address);
    return RegisterBus::open(address);
  }

  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<Bus>> buses_;
};

template <typename Array>
Result<std::size_t> find_array(const std::vector<Array>& arrays, const BusAddress& address) {
  std::set<std::string> names;
  std::string all;
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    const std::string& name = arrays[k].name;
    if (name == address.array || (address.array.empty() && arrays.size() == 1)) return k;
    names.insert(name);
    all += (all.empty() ? "" : ", ") + name;
  }
  const std::string place = "'" + address.text + "': ";
  if (address.array.empty()) return bad_input(place + "has several arrays; add array=NAME, of " + all);
  const std::string nearest = nearest_name(address.array, names);
  if (!nearest.empty())
    return bad_input(place + "has no array '" + address.array + "'; did you mean '" + nearest + "'?");
  return bad_input(place + "has no array '" + address.array + "'" + (all.empty() ? "" : "; there are " + all));
}

Status check_shape(FrameShape shape, const BusAddress& address, const BusOptions& options) {
  if (!options.shape || shape == FrameShape{} || shape == *options.shape) return Done{};
  return bad_input("'" + address.text + "': frames are " + bytes::files::size_text(shape) + ", the array is " +
                   bytes::files::size_text(*options.shape));
}

Result<std::unique_ptr<FrameSource>> open_log(const BusAddress& address, const CanLog& log, const BusOptions& options) {
  const Result<CanMap> map = read_can_map(log.map);
  if (!map) return bad_input("'" + address.text + "': " + map.error().message);
  const Result<std::size_t> array = find_array(map->arrays, address);
  if (!array) return array.error();
  if (Status same = check_shape(map->arrays[*array].shape, address, options); !same) return same.error();
  Result<std::unique_ptr<std::istream>> in = bytes::files::open_input(log.path);
  if (!in) return in.error();
  return open_candump(*std::move(in), log.path, map->arrays[*array], {log.interface, log.rate_hz});
}

}  // namespace

bool sends_turned_frames(const BusAddress& address) {
  const auto* const topic = std::get_if<TopicPlace>(&address.place);
  if (topic == nullptr) return false;
  const Result<const bytes::ros_messages::TouchType*> type = bytes::ros_messages::find_touch_type(topic->type);
  return type && (*type)->is_raw_frame;
}

Result<std::unique_ptr<FrameSource>> open_bus(const BusAddress& address, const BusOptions& options) {
  if (const auto* const log = std::get_if<CanLog>(&address.place)) return open_log(address, *log, options);
  static Buses buses;
  Result<std::shared_ptr<Bus>> bus = buses.find(address);
  if (!bus) return bus.error();
  const Result<std::size_t> array = find_array((*bus)->arrays(), address);
  if (!array) return array.error();
  if (Status same = check_shape((*bus)->arrays()[*array].shape, address, options); !same) return same.error();
  return std::unique_ptr<FrameSource>(std::make_unique<BusSource>(address.text, *std::move(bus), *array, options));
}

}  // namespace dermis::live::buses
