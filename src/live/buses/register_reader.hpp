// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "dermis/live/buses/bus_address.hpp"
#include "dermis/touch/frames/result.hpp"

/// The work of the plugin of Modbus. It is loaded when asked for, as that of DDS is.
namespace dermis::live::buses {

/// The outcome of a question.
enum class Answer {
  read,
  refused,  ///< The device answers, but not with the registers.
  nothing,  ///< Nothing that can be understood came in time.
  lost,     ///< The connection is gone.
};

/// Reads registers of one device. Not thread-safe.
class RegisterReader {
 public:
  RegisterReader() = default;
  RegisterReader(const RegisterReader&) = delete;
  RegisterReader& operator=(const RegisterReader&) = delete;
  virtual ~RegisterReader() = default;

  /// Again, too, after the connection is lost.
  [[nodiscard]] virtual Status connect() = 0;
  [[nodiscard]] virtual Answer read(bool input, std::uint16_t address, std::span<std::uint16_t> words) = 0;
  /// Why the last question was not answered.
  [[nodiscard]] virtual std::string reason() const = 0;
};

/// The function of the plugin, and its name. `place` has port and unit.
using MakeRegisterReader = void (*)(const ModbusPlace& place, Result<std::unique_ptr<RegisterReader>>& made);
inline constexpr const char* kMakeRegisterReader = "dermis_make_register_reader";

/// Loads the plugin. Fails where it or its library is not there.
[[nodiscard]] Result<std::unique_ptr<RegisterReader>> make_register_reader(const ModbusPlace& place);

}  // namespace dermis::live::buses
