// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <string_view>

#include "check_error.hpp"
#include "dermis/learn/calibration/plan_request.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto request = dermis::learn::calibration::plan_request_from_json(text);
  if (!request) {
    dermis::fuzz::check_line(request.error());
    return 0;
  }
  dermis::ArrayDescription array;
  array.rows = 4;
  array.cols = 4;
  const auto plan = request->plan(array);
  if (!plan) dermis::fuzz::check_line(plan.error());
  return 0;
}
