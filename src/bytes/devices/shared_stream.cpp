// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/shared_stream.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace dermis::bytes::devices {
namespace {

constexpr std::size_t kMostWaiting = std::size_t{1} << 20U;  // bytes

/// The bytes of one reader that others have received for it.
struct Reader {
  std::deque<std::uint8_t> waiting;
  std::uint64_t opening = 0;  ///< Of the connection that it reads.
};

/// One connection, and those who read it. One of them at a time uses the stream, for all.
struct Connection {
  explicit Connection(std::unique_ptr<ByteStream> opened) : stream(std::move(opened)) {}

  std::mutex mutex;
  std::condition_variable changed;
  std::unique_ptr<ByteStream> stream;
  bool is_used = false;  ///< By a reader that does not hold the mutex meanwhile.
  std::vector<Reader*> readers;
  std::uint64_t openings = 0;
  ByteStream::End end = ByteStream::End::closed;  ///< None while it is open.
};

class SharedStream final : public ByteStream {
 public:
  explicit SharedStream(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {
    const std::lock_guard lock(connection_->mutex);
    connection_->readers.push_back(&reader_);
  }
  SharedStream(const SharedStream&) = delete;
  SharedStream& operator=(const SharedStream&) = delete;
  ~SharedStream() override {
    const std::lock_guard lock(connection_->mutex);
    std::erase(connection_->readers, &reader_);
  }

  Result<bool> open(Nanos timeout) override {
    std::unique_lock lock(connection_->mutex);
    if (!wait_until_unused(lock, timeout)) return false;
    const bool is_open = connection_->end == End::none && reader_.opening < connection_->openings;
    if (!is_open) {
      Result<bool> opened = connection_->stream->open(timeout);
      if (!opened || !*opened) return opened;
      ++connection_->openings;
      connection_->end = End::none;
    }
    reader_.opening = connection_->openings;
    reader_.waiting.clear();
    return true;
  }

  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    std::unique_lock lock(connection_->mutex);
    const auto needs_no_wait = [&] { return !connection_->is_used || !reader_.waiting.empty(); };
    if (!connection_->changed.wait_for(lock, timeout, needs_no_wait)) return {};
    if (!reader_.waiting.empty()) return take_waiting(into);
    const bool is_of_another = reader_.opening < connection_->openings;
    if (is_of_another) return {0, End::lost};
    if (connection_->end != End::none) return {0, connection_->end};
    return receive(lock, into, timeout);
  }

  Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) override {
    std::unique_lock lock(connection_->mutex);
    if (!wait_until_unused(lock, timeout)) return {};
    return connection_->stream->write(bytes, timeout);
  }

  [[nodiscard]] std::string name() const override {
    const std::lock_guard lock(connection_->mutex);
    return connection_->stream->name();
  }

 private:
  bool wait_until_unused(std::unique_lock<std::mutex>& lock, Nanos timeout) {
    return connection_->changed.wait_for(lock, timeout, [&] { return !connection_->is_used; });
  }

  /// Leaves the mutex to others while it waits.
  Transferred receive(std::unique_lock<std::mutex>& lock, std::span<std::uint8_t> into, Nanos timeout) {
    connection_->is_used = true;
    lock.unlock();
    const Transferred received = connection_->stream->read(into, timeout);
    lock.lock();
    connection_->is_used = false;
    connection_->end = received.end;
    hand_on(into.first(received.bytes));
    connection_->changed.notify_all();
    return received;
  }

  Transferred take_waiting(std::span<std::uint8_t> into) {
    const std::size_t size = std::min(into.size(), reader_.waiting.size());
    const auto end = reader_.waiting.begin() + static_cast<std::ptrdiff_t>(size);
    std::copy(reader_.waiting.begin(), end, into.begin());
    reader_.waiting.erase(reader_.waiting.begin(), end);
    return {size};
  }

  void hand_on(std::span<const std::uint8_t> bytes) {
    for (Reader* const reader : connection_->readers) {
      if (reader == &reader_ || reader->opening != connection_->openings) continue;
      std::deque<std::uint8_t>& waiting = reader->waiting;
      waiting.insert(waiting.end(), bytes.begin(), bytes.end());
      const std::size_t excess = waiting.size() - std::min(waiting.size(), kMostWaiting);
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(excess));
    }
  }

  std::shared_ptr<Connection> connection_;
  Reader reader_;
};

/// The connections of this process that are in use, by their places.
class Connections {
 public:
  Result<std::shared_ptr<Connection>> find(const SourceUri& uri) {
    const std::string place = uri.text.substr(0, uri.text.find('?'));
    const std::lock_guard lock(mutex_);
    if (std::shared_ptr<Connection> used = by_place_[place].lock()) return used;
    Result<std::unique_ptr<ByteStream>> stream = make_source_stream(uri);
    if (!stream) return stream.error();
    auto connection = std::make_shared<Connection>(*std::move(stream));
    std::erase_if(by_place_, [](const auto& entry) { return entry.second.expired(); });
    by_place_[place] = connection;
    return connection;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<Connection>> by_place_;
};

}  // namespace

Result<std::unique_ptr<ByteStream>> make_shared_source_stream(const SourceUri& uri) {
  static Connections connections;
  Result<std::shared_ptr<Connection>> connection = connections.find(uri);
  if (!connection) return connection.error();
  return std::unique_ptr<ByteStream>(std::make_unique<SharedStream>(*std::move(connection)));
}

}  // namespace dermis::bytes::devices
