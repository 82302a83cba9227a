// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace dermis::browser {

/// The board that somebody has connected in the page: its bytes, and what the page is to do with it.
class PagePort {
 public:
  struct Open {
    unsigned baud = 0;
  };
  using Write = std::vector<std::uint8_t>;
  using Request = std::variant<Open, Write>;

  static constexpr std::size_t kMostWaiting = std::size_t{4} << 20U;  ///< bytes, of either direction

  /// It is plugged in, and open at that baud. `product`: "USB 2341:0043".
  void connect(std::string product, unsigned baud);
  /// It was unplugged, or the page has closed it.
  void lose() noexcept { is_there_ = false; }
  /// Bytes from it. Those that come while nobody reads it are dropped, and those for which there is no room are
  /// counted.
  void receive(std::span<const std::uint8_t> bytes);
  /// The next request to the page; empty: there is none.
  [[nodiscard]] std::optional<Request> next_request();
  /// Bytes for which there was no room, since it was asked last.
  [[nodiscard]] std::uint64_t take_dropped() noexcept { return std::exchange(dropped_, 0); }

  [[nodiscard]] bool is_there() const noexcept { return is_there_; }
  [[nodiscard]] const std::string& product() const noexcept { return product_; }
  /// The source that it is, at the baud at which it is open.
  [[nodiscard]] std::string uri() const;

  /// One reader begins. False: another reads it.
  [[nodiscard]] bool open(unsigned baud);
  void close();
  [[nodiscard]] std::size_t read(std::span<std::uint8_t> into);
  /// Returns how many of the bytes there was room for.
  [[nodiscard]] std::size_t write(std::span<const std::uint8_t> bytes);

 private:
  bool is_there_ = false;
  bool is_read_ = false;
  std::string product_;
  unsigned baud_ = 0;
  std::vector<std::uint8_t> waiting_;  // from the board
  std::size_t taken_ = 0;              // of those
  std::uint64_t dropped_ = 0;
  std::deque<Request> requests_;
  std::size_t requested_bytes_ = 0;  // of those that write
};

/// The one of the page.
[[nodiscard]] PagePort& page_port();

}  // namespace dermis::browser
