// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fuzz_splits.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  dermis::fuzz::fuzz_splits(data, size, dermis::learn::recognition::open_splits_of);
  return 0;
}
