// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::devices {

/// Bytes to and from a device, by any transport. No call exceeds its time limit. Not thread-safe.
class ByteStream {
 public:
  enum class End {
    none,    ///< There may be more.
    closed,  ///< The other side closed in an orderly way; the end of a file.
    lost,    ///< Unplugged or reset: closed without intention.
  };
  struct Transferred {
    std::size_t bytes = 0;
    End end = End::none;
  };

  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// Opens, or reopens after an end. False: nobody has connected yet (tcp-listen, pty); call it again. Errors name the
  /// place and the remedy.
  [[nodiscard]] virtual Result<bool> open(Nanos timeout) = 0;

  /// Reads the bytes that have come, or waits for some. Without a timeout it does not wait.
  [[nodiscard]] virtual Transferred read(std::span<std::uint8_t> into, Nanos timeout) = 0;

  /// Writes the bytes that the other side accepts within the time.
  [[nodiscard]] virtual Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) = 0;

  /// Readable while read() has bytes of an open stream; below 0 where that cannot be told.
  [[nodiscard]] virtual int descriptor() const { return -1; }

  /// Readable name of the opened place: "/dev/ttyACM0", "127.0.0.1:7000", the name of a new pty.
  [[nodiscard]] virtual std::string name() const = 0;
};

/// The stream of a URI of parse_source_uri(), not yet open; not of a simulation. udp: receives on host and port.
[[nodiscard]] Result<std::unique_ptr<ByteStream>> make_source_stream(const SourceUri& uri);

/// The stream of a URI of parse_target_uri(), not yet open, to play a device. udp: sends to host and port.
[[nodiscard]] Result<std::unique_ptr<ByteStream>> make_target_stream(const SourceUri& uri);

}  // namespace dermis::bytes::devices
