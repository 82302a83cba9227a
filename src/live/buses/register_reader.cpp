// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/register_reader.hpp"

#include "dermis/bytes/system/plugin.hpp"

namespace dermis::live::buses {

Result<std::unique_ptr<RegisterReader>> make_register_reader(const ModbusPlace& place) {
  const Result<void*> function = find_plugin_function(
      {"Modbus", "libdermis_modbus.so", "of a build with DERMIS_BUILD_MODBUS, and its library (Debian: libmodbus5)"},
      kMakeRegisterReader);
  if (!function) return function.error();
  Result<std::unique_ptr<RegisterReader>> made{std::unique_ptr<RegisterReader>()};
  reinterpret_cast<MakeRegisterReader>(*function)(place, made);
  return made;
}

}  // namespace dermis::live::buses
