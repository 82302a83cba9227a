// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// ByteStream and the serial ports for the page that the module is part of: the page has the port, and hands bytes on.
#include <algorithm>
#include <utility>

#include "bindings/browser/page_port.hpp"
#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/serial_ports.hpp"

namespace dermis {
namespace browser {
namespace {

constexpr const char* kBoard = "board";

}  // namespace

PagePort& page_port() {
  static PagePort port;
  return port;
}

void PagePort::connect(std::string product, unsigned baud) {
  is_there_ = true;
  product_ = std::move(product);
  baud_ = baud;
}

std::string PagePort::uri() const {
  return std::string("serial://") + kBoard + "?baud=" + std::to_string(baud_);
}

void PagePort::receive(std::span<const std::uint8_t> bytes) {
  if (!is_read_) return;
  if (taken_ > 0 && waiting_.size() + bytes.size() > kMostWaiting) {
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(std::exchange(taken_, 0)));
  }
  const std::size_t room = std::min(bytes.size(), kMostWaiting - waiting_.size());
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(room));
  dropped_ += bytes.size() - room;
}

std::optional<PagePort::Request> PagePort::next_request() {
  if (requests_.empty()) return std::nullopt;
  Request request = std::move(requests_.front());
  requests_.pop_front();
  if (const Write* const write = std::get_if<Write>(&request)) requested_bytes_ -= write->size();
  return request;
}

bool PagePort::open(unsigned baud) {
  if (is_read_) return false;
  is_read_ = true;
  waiting_.clear();
  taken_ = 0;
  if (baud != baud_) requests_.emplace_back(Open{baud});
  baud_ = baud;
  return true;
}

void PagePort::close() {
  is_read_ = false;
}

std::size_t PagePort::read(std::span<std::uint8_t> into) {
  const std::size_t size = std::min(into.size(), waiting_.size() - taken_);
  std::copy_n(waiting_.begin() + static_cast<std::ptrdiff_t>(taken_), size, into.begin());
  taken_ += size;
  if (taken_ == waiting_.size()) {
    waiting_.clear();
    taken_ = 0;
  }
  return size;
}

std::size_t PagePort::write(std::span<const std::uint8_t> bytes) {
  const std::size_t room = std::min(bytes.size(), kMostWaiting - requested_bytes_);
  if (room > 0) requests_.emplace_back(Write(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(room)));
  requested_bytes_ += room;
  return room;
}

}  // namespace browser

namespace bytes::devices {
namespace {

using browser::kBoard;

class PageStream final : public ByteStream {
 public:
  explicit PageStream(unsigned baud) : baud_(baud) {}
  PageStream(const PageStream&) = delete;
  PageStream& operator=(const PageStream&) = delete;
  ~PageStream() override { close(); }

  Result<bool> open(Nanos /*timeout*/) override {
    close();
    if (!port_.is_there()) return failed("no board is connected: press Connect a board");
    if (!port_.open(baud_)) return failed("the board is in use by another array of this page");
    is_open_ = true;
    return true;
  }
  Transferred read(std::span<std::uint8_t> into, Nanos /*timeout*/) override {
    const std::size_t size = port_.read(into);
    return {size, size == 0 && !port_.is_there() ? End::lost : End::none};
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos /*timeout*/) override { return {port_.write(bytes)}; }
  /// Nobody waits for it: all that has come is taken at once.
  [[nodiscard]] int descriptor() const override { return is_open_ ? 0 : -1; }
  [[nodiscard]] std::string name() const override { return "the board"; }

 private:
  void close() {
    if (std::exchange(is_open_, false)) port_.close();
  }

  browser::PagePort& port_ = browser::page_port();
  unsigned baud_;
  bool is_open_ = false;
};

}  // namespace

Result<std::unique_ptr<ByteStream>> make_source_stream(const SourceUri& uri) {
  if (uri.transport == Transport::serial && uri.path == kBoard) {
    return std::unique_ptr<ByteStream>(std::make_unique<PageStream>(uri.baud));
  }
  return bad_input("'" + uri.text + "': a page has only the board that is connected to it; the command opens it");
}

std::vector<SerialPort> serial_ports(const std::string& /*dev*/, const std::string& /*sys*/) {
  const browser::PagePort& port = browser::page_port();
  if (!port.is_there()) return {};
  return {{kBoard, kBoard, port.product()}};
}

}  // namespace bytes::devices
}  // namespace dermis
