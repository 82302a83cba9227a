// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>

#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::serve {

/// Which frames of an array are taken, where not all are. Used by the thread of the array alone.
class Pace {
 public:
  /// Evenly, whatever the jitter of the frames: a late one does not make the next one late. A frame that comes again is
  /// for somebody who has not seen it.
  [[nodiscard]] bool is_due(Nanos time, double rate_hz) noexcept;

 private:
  std::optional<Nanos> last_{};  // frame that came
  Nanos due_{};
};

/// Such a frame is worth telling between those that are due.
[[nodiscard]] bool begins_or_ends(const ContactReport& report);

}  // namespace dermis::out::serve
