// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dermis/live/buses/bus_address.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::buses {

struct BusOptions {
  std::optional<FrameShape> shape{};                 ///< Required shape of the frames.
  const std::atomic<bool>* stop = nullptr;           ///< Set: next() returns false within 100 ms.
  std::function<void(const std::string&)> notice{};  ///< Receives messages for the user, one line each.
};

/// The frames of an address were turned by its sender already (LineOrder), as those of another dermis are.
[[nodiscard]] bool sends_turned_frames(const BusAddress& address);

/// The frames of one array of a device or a topic. All arrays of one connection in this process share it. A frame of
/// registers has the time when its last word had come. A frame of a topic has the time of its message, mapped to the
/// clock of this machine. Its device time is that of the message. Its sequence counts the messages of the topic, lost
/// ones included. A frame of another dermis (dermis_msgs/msg/RawFrame) has all that it was sent with, but for
/// arrival_steady. One such sender is followed (docs/hands.md). Frames of another shape than the first are damaged.
///
/// Fails where the plugin of the bus is not there, and on a device that cannot be reached. Also fails where the address
/// names no array of several. A topic is waited for. A device that goes is waited for, too (reconnect_s).
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_bus(const BusAddress& address, const BusOptions& options);

}  // namespace dermis::live::buses
