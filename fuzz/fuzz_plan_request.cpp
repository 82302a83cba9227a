// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "dermis/calibration/plan_request.hpp"

namespace {

void check(const dermis::Error& error) {
  const bool is_one_line = error.message.find('\n') == std::string::npos;
  if (error.kind != dermis::ErrorKind::bad_input || !is_one_line || error.message.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto request = dermis::calibration::plan_request_from_json(text);
  if (!request) {
    check(request.error());
    return 0;
  }
  dermis::ArrayDescription array;
  array.rows = 4;
  array.cols = 4;
  const auto plan = request->plan(array);
  if (!plan) check(plan.error());
  return 0;
}
