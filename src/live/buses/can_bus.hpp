// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/buses/bus_address.hpp"
#include "dermis/live/buses/can_map.hpp"
#include "live/buses/bus.hpp"

namespace dermis::live::buses {

/// Arrays on a CAN bus, by a socket of SocketCAN and a thread. Arrays that must be asked are asked in turn.
class CanBus final : public Bus {
 public:
  /// Fails where the map cannot be read, the kernel has no CAN or the interface is not there.
  [[nodiscard]] static Result<std::shared_ptr<Bus>> open(const BusAddress& address);
  /// Over a socket that is open, which it closes, of messages of the kernel's can_frame or canfd_frame.
  CanBus(CanInterface place, CanMap map, int socket);
  ~CanBus() override;

  [[nodiscard]] std::string name() const override { return place_.interface; }

 private:
  void run();
  void hear();
  void take(const CanFrame& frame);
  void ask();
  void come_back();
  void tell(const std::string& text);

  const CanInterface place_;
  const CanMap map_;
  int socket_;
  std::vector<CanAssembly> assemblies_;
  std::size_t asked_ = 0;  // the array that was asked last
  Nanos ask_at_{};         // when the next one is asked, at the latest
  RawFrame frame_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace dermis::live::buses
