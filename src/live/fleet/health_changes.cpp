// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/health_changes.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "dermis/live/fleet/robot_condition.hpp"

namespace dermis::live::fleet {
namespace {

/// "2 faults" and "12 faults" say the same.
std::string without_numbers(std::string text) {
  std::erase_if(text, [](char c) { return c >= '0' && c <= '9'; });
  return text;
}

bool is_same_level(const ArrayHealth& a, const ArrayHealth& b) {
  return a.level == b.level && without_numbers(a.message) == without_numbers(b.message);
}

bool is_same(const ArrayHealth& a, const ArrayHealth& b) {
  return a.name == b.name && is_same_level(a, b) && a.used_model == b.used_model && a.refusal == b.refusal;
}

}  // namespace

bool HealthChanges::take(RobotHealth& health) {
  bool is_new = !last_ || last_->arrays.size() != health.arrays.size() || last_->is_doubled != health.is_doubled ||
                last_->has_little_space() != health.has_little_space();
  for (std::size_t k = 0; k < health.arrays.size(); ++k) {
    ArrayHealth& array = health.arrays[k];
    const ArrayHealth* const old = last_ && k < last_->arrays.size() ? &last_->arrays[k] : nullptr;
    array.since = old != nullptr && is_same_level(*old, array) ? old->since : health.time;
    is_new = is_new || old == nullptr || !is_same(*old, array);
  }
  last_ = health;
  return is_new;
}

}  // namespace dermis::live::fleet
