// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/buses/bus_address.hpp"
#include "dermis/live/buses/register_map.hpp"
#include "live/buses/bus.hpp"
#include "live/buses/register_reader.hpp"

namespace dermis::live::buses {

/// A device that is asked for its registers, again and again, by a thread.
class RegisterBus final : public Bus {
 public:
  /// Fails where the map cannot be read, the plugin is not there or the device cannot be reached.
  [[nodiscard]] static Result<std::shared_ptr<Bus>> open(const BusAddress& address);
  /// Waits for the last answer, 1 s at most where the line is silent.
  ~RegisterBus() override;

  [[nodiscard]] std::string name() const override { return name_; }

 private:
  RegisterBus(ModbusPlace place, RegisterMap map, std::unique_ptr<RegisterReader> reader, std::string name);
  void run();
  void ask(const RegisterRead& read);
  void fill(const RegisterRead& read);
  void refuse(const RegisterRead& read);
  void count_damaged(const RegisterRead& read);
  void come_back();
  void tell(const std::string& text);
  void sleep_until(Nanos due) const;

  const ModbusPlace place_;
  const RegisterMap map_;
  const std::unique_ptr<RegisterReader> reader_;
  const std::string name_;
  std::vector<std::vector<std::uint16_t>> words_;  // of each array
  std::vector<std::size_t> filled_;                // words of each array that came in this round
  std::vector<bool> has_come_;                     // a frame of the array
  std::vector<std::uint16_t> answer_;
  RawFrame frame_;
  int unanswered_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace dermis::live::buses
