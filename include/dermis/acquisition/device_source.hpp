// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dermis/acquisition/source_uri.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"

namespace dermis::acquisition {

struct DeviceOptions {
  std::optional<FrameShape> shape{};        ///< The shape that the frames must have; rows and cols of the URI.
  const std::atomic<bool>* stop = nullptr;  ///< Set: next() gives what was received, then returns false within 100 ms.
  std::function<void(const std::string&)> notice{};  ///< Told what a user should know while it goes on; one line.
};

/// Opens a device as a source of frames. Each frame carries when its last byte had come;
/// the device's clock, where it has one, is mapped to the host's (clock_mapping.hpp).
///
/// A serial device that is unplugged, or a TCP connection that ends, is waited for (reconnect_s, 10 s by default); a
/// serial device that does not come back is an error, a TCP peer that closed in an orderly way the end. stdin and files
/// end at their end, tcp-listen waits for its first device without limit.
/// Fails, with one line that says what to do, where the device is not there, busy, in use or not permitted, where the
/// shapes disagree, and where bytes come that are no frames of the protocol for 5 s.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_device(SourceUri uri, const DeviceOptions& options);

/// The same by the text of its URI; fails on one that parse_source_uri() refuses, too.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_device(const std::string& uri, const DeviceOptions& options);

}  // namespace dermis::acquisition
