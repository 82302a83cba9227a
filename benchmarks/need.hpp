// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// The value; a campaign that has none ends with the error.
template <typename T>
T need(Result<T> result) {
  if (result) return *std::move(result);
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

}  // namespace dermis
