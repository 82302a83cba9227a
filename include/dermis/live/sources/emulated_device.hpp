// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/encoder.hpp"
#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// Plays a device: sends encoded frames and waits for requests, as its protocol wants it. Later clients get the data
/// from then on. Not thread-safe.
class EmulatedDevice {
 public:
  /// `stream`: of make_target_stream(), by `transport`. `stop`: set, all calls return within 100 ms.
  EmulatedDevice(std::unique_ptr<bytes::devices::ByteStream> stream, bytes::devices::Transport transport,
                 std::unique_ptr<bytes::devices::Encoder> encoder, const std::atomic<bool>& stop);

  /// `stop` is set, or the reader that the device had connected to has left.
  [[nodiscard]] bool stopped() const noexcept { return stop_.load() || is_over_; }

  /// Until somebody reads. Fails where that cannot be.
  [[nodiscard]] Status wait_for_reader();

  /// The frames of a source once, at `rate_hz` (> 0), or in their own time where it is empty. Waits where nobody reads,
  /// and begins anew with the time when somebody does. Ends early where the device is stopped.
  [[nodiscard]] Status play(FrameSource& source, std::optional<double> rate_hz = {});

  /// Completes the last frame, and leaves the reader of a pseudo-terminal 2 s to take it: what that still holds goes
  /// with its end.
  [[nodiscard]] Status finish();

 private:
  [[nodiscard]] Status wait_for_request();
  [[nodiscard]] Status send(const RawFrame& frame);
  [[nodiscard]] Status send_bytes();
  [[nodiscard]] Status listen();
  [[nodiscard]] Status reader_left();

  std::unique_ptr<bytes::devices::ByteStream> stream_;
  bytes::devices::Transport transport_;
  std::unique_ptr<bytes::devices::Encoder> encoder_;
  const std::atomic<bool>& stop_;
  std::vector<std::uint8_t> bytes_;
  std::string received_;
  bool is_over_ = false;
  bool has_new_reader_ = false;
};

}  // namespace dermis::live::sources
