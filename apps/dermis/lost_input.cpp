// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "lost_input.hpp"

#include <algorithm>
#include <mutex>

namespace dermis::app {
namespace {

std::mutex mutex;
std::vector<std::string> noted;

}  // namespace

void note_loss(const std::string& line) {
  const std::lock_guard lock(mutex);
  if (std::find(noted.begin(), noted.end(), line) == noted.end()) noted.push_back(line);
}

std::vector<std::string> losses() {
  const std::lock_guard lock(mutex);
  return noted;
}

}  // namespace dermis::app
