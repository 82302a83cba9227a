// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::devices {

struct DeviceOptions {
  std::optional<FrameShape> shape{};  ///< Required shape of the frames, turned as the URI says.
  /// If set, next() delivers what was received, then returns false within 100 ms.
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string&)> notice{};  ///< Receives messages for the user, one line each.
  /// Is given all bytes as they come, before they are decoded.
  std::function<void(std::span<const std::uint8_t>)> received{};
};

/// Opens a device as a source of frames. Each frame carries when its last byte had come;
/// the device's clock, where it has one, is mapped to the host's (core/clock_mapping.hpp).
///
/// The source waits for a serial device that is unplugged and for a TCP connection that ends (reconnect_s, 10 s by
/// default). It is an error if a serial device does not come back. A TCP peer that closed in an orderly way ends the
/// source. stdin and files end at their end. tcp-listen waits for its first device without limit. Errors say in one
/// line what to do. Reasons are a device that is missing, busy, in use or not permitted, different shapes, and 5 s of
/// bytes that are not frames.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_device(SourceUri uri, const DeviceOptions& options);

/// The same by the text of its URI. Also fails on one that parse_source_uri() refuses.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_device(const std::string& uri, const DeviceOptions& options);

/// Why no frame was made of what a device sent.
struct UndecodedReason {
  std::string why;                           ///< In one line, with the mend.
  std::optional<FrameShape> likely_shape{};  ///< Its frames may have it; empty where nothing is known.
};

/// `bytes`: the first that came from the device, which hold no frame.
[[nodiscard]] UndecodedReason why_undecoded(const SourceUri& uri, std::span<const std::uint8_t> bytes);

}  // namespace dermis::bytes::devices
