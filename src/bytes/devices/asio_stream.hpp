// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <boost/asio.hpp>
#include <span>
#include <string>
#include <utility>  // Asio 1.74 forgets it

#include "dermis/bytes/devices/byte_stream.hpp"

namespace dermis::bytes::devices {

namespace asio = boost::asio;
using boost::system::error_code;

inline std::string in_quotes(const std::string& text) {
  return "'" + text + "'";
}

inline ByteStream::End end_of(const error_code& error, ByteStream::End at_end) {
  const bool goes_on = !error || error == asio::error::operation_aborted || error == asio::error::interrupted ||
                       error == asio::error::would_block;
  if (goes_on) return ByteStream::End::none;
  const bool is_end = error == asio::error::eof || error == asio::error::broken_pipe;
  return is_end ? at_end : ByteStream::End::lost;
}

/// One asynchronous operation at a time, each given some time.
class AsioStream : public ByteStream {
 protected:
  /// Runs what was started; where the time is over, `cancel` must make it end.
  template <typename Cancel>
  void run(Nanos timeout, Cancel cancel) {
    context_.restart();
    context_.run_for(timeout);
    if (context_.stopped()) return;
    cancel();
    context_.run();
  }

  /// `start` begins a transfer with the handler that it is given.
  template <typename Device, typename Start>
  Transferred transfer(Device& device, Nanos timeout, End at_end, Start start) {
    error_code error;
    std::size_t bytes = 0;
    start([&](const error_code& outcome, std::size_t count) {
      error = outcome;
      bytes = count;
    });
    run(timeout, [&] {
      error_code ignored;
      device.cancel(ignored);
    });
    return {bytes, end_of(error, at_end)};
  }

  template <typename Device>
  Transferred read_some(Device& device, std::span<std::uint8_t> into, Nanos timeout, End at_end) {
    return transfer(device, timeout, at_end,
                    [&](auto handler) { device.async_read_some(asio::buffer(into.data(), into.size()), handler); });
  }

  template <typename Device>
  Transferred write_some(Device& device, std::span<const std::uint8_t> bytes, Nanos timeout, End at_end) {
    return transfer(device, timeout, at_end,
                    [&](auto handler) { device.async_write_some(asio::buffer(bytes.data(), bytes.size()), handler); });
  }

  asio::io_context context_{1};
};

}  // namespace dermis::bytes::devices
