// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/result.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {

/// A description of an array, as a session of its robot gave it.
struct StreamDescription {
  std::uint64_t session = 0;
  std::vector<std::uint8_t> bytes;
  bytes::recordings::RecordedArray array;
};

/// Finds the descriptions of an array in a stream: each session repeats its own. Damaged ones are passed over.
class StreamDescriptions {
 public:
  StreamDescriptions(Broker& broker, StreamSubject of) : broker_(broker), of_(std::move(of)) {}

  /// The one of a session, for its message `near`. Null where there is none yet that can be read. It is good until the
  /// next call. Fails where the server does not answer.
  [[nodiscard]] Result<const StreamDescription*> find(std::uint64_t session, const StoredMessage& near);

 private:
  Broker& broker_;
  const StreamSubject of_;
  std::optional<StreamDescription> found_{};
  std::optional<std::uint64_t> wanted_{};  ///< The session that is looked for, from `next_` on.
  std::uint64_t next_ = 0;
};

}  // namespace dermis::live::fleet
