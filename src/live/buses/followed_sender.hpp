// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string_view>

#include "dermis/live/dds/subscriber.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::buses {

/// Chooses the frames that are taken of a topic whose senders stamp them. One sender is followed. Its times neither go
/// back nor leap 10 s ahead of the clock here. After a second without a frame to take, the next one begins anew: its
/// sender was started again, or what it plays was sought.
class FollowedSender {
 public:
  /// Empty: the frame is taken. Else why it is left out, as "frames of ... are left out".
  [[nodiscard]] std::string_view objection(const dds::Sample::Writer& writer, Nanos time, Nanos arrival);

 private:
  /// The last frame that was taken.
  struct Taken {
    dds::Sample::Writer writer;
    Nanos time;
    Nanos arrival;  // by the steady clock
  };

  [[nodiscard]] bool is_possible(Nanos time, Nanos arrival) const noexcept;

  std::optional<Taken> last_;
};

}  // namespace dermis::live::buses
