// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "check_error.hpp"
#include "dermis/bytes/files/taxel_tables_csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto bytes = std::make_unique<std::istringstream>(std::string(reinterpret_cast<const char*>(data), size));
  auto reader = dermis::bytes::files::TaxelTablesReader::open(std::move(bytes), "fuzz", 2, 3,
                                                              dermis::bytes::files::TableValues::not_negative);
  std::array<double, 6> table{};
  while (true) {
    const dermis::Result<bool> got_frame = reader.next(table);
    if (!got_frame) dermis::fuzz::check_error(got_frame.error());
    if (!got_frame || !*got_frame) return 0;
    for (const double value : table) {
      if (!std::isfinite(value) || value < 0.0) std::abort();
    }
  }
}
