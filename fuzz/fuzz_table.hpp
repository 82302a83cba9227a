// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <sstream>
#include <string>

#include "check_error.hpp"
#include "dermis/bytes/files/csv_table.hpp"

namespace dermis::fuzz {

/// The bytes as a table; empty where they are none.
inline std::optional<dermis::bytes::files::CsvTable> table_of(const std::uint8_t* data, std::size_t size) {
  std::istringstream bytes(std::string(reinterpret_cast<const char*>(data), size));
  Result<dermis::bytes::files::CsvTable> table = dermis::bytes::files::CsvTable::read(bytes, "fuzz");
  if (table) return *std::move(table);
  check_error(table.error());
  return std::nullopt;
}

}  // namespace dermis::fuzz
