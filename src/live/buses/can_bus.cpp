// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/can_bus.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "dermis/bytes/system/thread_priority.hpp"

namespace dermis::live::buses {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr int kTickMs = 20;
constexpr Nanos kRetryAfter = 200ms;
constexpr Nanos kLongestAnswer = 100ms;

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

std::vector<BusArray> arrays_of(const CanMap& map) {
  std::vector<BusArray> arrays;
  for (const CanArray& array : map.arrays) arrays.push_back({array.name, array.shape});
  return arrays;
}

Error no_interface(const std::string& interface) {
  return failed("there is no CAN interface '" + interface + "'; bring it up by: ip link set " + interface +
                " up type can bitrate 1000000");
}

/// A socket that hears the interface, frames of CAN FD too where the kernel has them.
Result<int> open_socket(const std::string& interface) {
  const unsigned index = ::if_nametoindex(interface.c_str());
  const int socket = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (socket < 0) return failed("this kernel has no CAN (modprobe can_raw): " + std::string(std::strerror(errno)));
  const int on = 1;
  static_cast<void>(::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof(on)));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (index != 0 && ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return socket;
  ::close(socket);
  return no_interface(interface);
}

}  // namespace

Result<std::shared_ptr<Bus>> CanBus::open(const BusAddress& address) {
  const auto& place = std::get<CanInterface>(address.place);
  Result<CanMap> map = read_can_map(place.map);
  if (!map) return bad_input("'" + address.text + "': " + map.error().message);
  const Result<int> socket = open_socket(place.interface);
  if (!socket) return failed("'" + address.text + "': " + socket.error().message);
  return std::shared_ptr<Bus>(std::make_shared<CanBus>(place, *std::move(map), *socket));
}

CanBus::CanBus(CanInterface place, CanMap map, int socket)
    : Bus(arrays_of(map)), place_(std::move(place)), map_(std::move(map)), socket_(socket) {
  for (const CanArray& array : map_.arrays) assemblies_.emplace_back(array);
  thread_ = std::thread([this] { run(); });
}

CanBus::~CanBus() {
  stop_ = true;
  thread_.join();
  if (socket_ >= 0) ::close(socket_);
}

void CanBus::run() {
  raise_thread_priority();
  while (!stop_) {
    if (socket_ < 0) come_back();
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, kTickMs) > 0) hear();
    if (!stop_ && steady_now() >= ask_at_) ask();
  }
}

/// All that has come.
void CanBus::hear() {
  canfd_frame received{};
  CanFrame frame;
  while (!stop_) {
    const ssize_t size = ::recv(socket_, &received, sizeof(received), MSG_DONTWAIT);
    if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
    if (size <= 0) return come_back();
    const bool is_frame = size == static_cast<ssize_t>(CAN_MTU) || size == static_cast<ssize_t>(CANFD_MTU);
    const bool has_data = (received.can_id & (CAN_RTR_FLAG | CAN_ERR_FLAG)) == 0;
    if (!is_frame || !has_data) continue;
    frame.id = received.can_id & CAN_EFF_MASK;
    const std::size_t most = size == static_cast<ssize_t>(CAN_MTU) ? CAN_MAX_DLEN : CANFD_MAX_DLEN;
    frame.data.assign(received.data, received.data + std::min<std::size_t>(received.len, most));
    take(frame);
  }
}

void CanBus::take(const CanFrame& frame) {
  const Arrival arrival;
  for (std::size_t k = 0; k < assemblies_.size(); ++k) {
    const std::uint32_t incomplete = assemblies_[k].incomplete();
    const CanAssembly::Taken taken = assemblies_[k].take(frame);
    if (assemblies_[k].incomplete() != incomplete) {
      for (const std::shared_ptr<ArrayFeed>& reader : readers(k)) reader->count_damaged();
    }
    if (taken != CanAssembly::Taken::frame) continue;
    frame_.counts = assemblies_[k].counts();
    frame_.acquisition = {};
    deliver(k, map_.arrays[k].shape, arrival, frame_);
    if (k == asked_ && !place_.rate_hz) ask_at_ = Nanos{};
  }
}

/// The next array that somebody reads and that must be asked. Each one has its time to answer.
void CanBus::ask() {
  std::vector<std::size_t> asked = wanted();
  std::erase_if(asked, [&](std::size_t array) { return map_.arrays[array].request.empty(); });
  if (asked.empty()) return;
  const auto next = std::upper_bound(asked.begin(), asked.end(), asked_);
  asked_ = next == asked.end() ? asked.front() : *next;
  const Nanos pause = place_.rate_hz ? Nanos(static_cast<std::int64_t>(1e9 / *place_.rate_hz)) : kLongestAnswer;
  ask_at_ = steady_now() + (place_.rate_hz ? pause / static_cast<std::int64_t>(asked.size()) : pause);
  const CanArray& array = map_.arrays[asked_];
  can_frame question{};
  question.can_id = array.request_id > CAN_SFF_MASK ? array.request_id | CAN_EFF_FLAG : array.request_id;
  question.can_dlc = static_cast<std::uint8_t>(std::min<std::size_t>(array.request.size(), CAN_MAX_DLEN));
  std::copy_n(array.request.begin(), question.can_dlc, question.data);
  static_cast<void>(::send(socket_, &question, sizeof(question), MSG_NOSIGNAL));
}

void CanBus::come_back() {
  const std::string seconds =
      std::to_string(std::chrono::duration_cast<std::chrono::seconds>(place_.reconnect).count());
  tell(place_.interface + " is down: waiting up to " + seconds + " s for it to come back");
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  const Nanos last = steady_now() + place_.reconnect;
  while (!stop_ && steady_now() < last) {
    if (const Result<int> socket = open_socket(place_.interface)) {
      socket_ = *socket;
      tell(place_.interface + " is back");
      for (const std::shared_ptr<ArrayFeed>& reader : all_readers()) reader->count_reconnection();
      return;
    }
    std::this_thread::sleep_for(kRetryAfter);
  }
  for (const std::shared_ptr<ArrayFeed>& reader : all_readers()) {
    reader->end(failed(place_.interface + " has not come back within " + seconds + " s"));
  }
}

/// Once, however many arrays it has.
void CanBus::tell(const std::string& text) {
  const std::vector<std::shared_ptr<ArrayFeed>> all = all_readers();
  if (!all.empty()) all.front()->tell(text);
}

}  // namespace dermis::live::buses
