// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "lost_input.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <mutex>
#include <vector>

namespace dermis::app {
namespace {

std::mutex mutex;
std::vector<std::string> noted;

}  // namespace

void note_loss(const std::string& text) {
  const std::lock_guard lock(mutex);
  if (std::find(noted.begin(), noted.end(), text) == noted.end()) noted.push_back(text);
}

std::string losses() {
  const std::lock_guard lock(mutex);
  return fmt::format("{}", fmt::join(noted, "; "));
}

}  // namespace dermis::app
