// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/pace.hpp"

#include <algorithm>
#include <cstdint>

namespace dermis::out::serve {

bool Pace::is_due(Nanos time, double rate_hz) noexcept {
  const Nanos period(static_cast<std::int64_t>(1e9 / rate_hz));
  if (last_ == time) return true;
  const bool went_back = last_ && time < *last_;
  const bool due = !last_ || went_back || time >= due_;
  if (due) due_ = !went_back && time - due_ < period ? due_ + period : time + period;
  last_ = time;
  return due;
}

bool begins_or_ends(const ContactReport& report) {
  return std::ranges::any_of(report.contacts,
                             [](const Contact& contact) { return contact.phase != ContactPhase::held; });
}

}  // namespace dermis::out::serve
