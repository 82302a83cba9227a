// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/frame_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/bytes/recordings/frame_batches.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::chrono::milliseconds kLookEvery{20};
constexpr std::chrono::milliseconds kRetryAfter{100};

/// The last message of a stream that is read, and the last time.
struct End {
  std::uint64_t sequence = std::numeric_limits<std::uint64_t>::max();
  Nanos time = Nanos::max();
};

}  // namespace

class FrameStream::Implementation {
 public:
  Implementation(const StreamAddress& address, FrameStreamOptions options, std::unique_ptr<Broker> broker)
      : stream_(stream_of(address.robot)),
        subject_(subject_of(address.robot, address.array, "frames")),
        address_(address),
        options_(std::move(options)),
        broker_(std::move(broker)) {}

  [[nodiscard]] Status begin();
  [[nodiscard]] Result<bool> next(RawFrame& frame);
  [[nodiscard]] FrameShape shape() const noexcept { return shape_; }
  [[nodiscard]] const bytes::recordings::FrameNotes& notes() const noexcept { return notes_; }
  [[nodiscard]] const SourceStatistics& statistics() const noexcept { return statistics_; }
  [[nodiscard]] bool ends() const noexcept { return address_.ends; }
  [[nodiscard]] std::string place() const { return address_.text + ": message " + std::to_string(next_sequence_ - 1); }

 private:
  [[nodiscard]] Result<std::uint64_t> sequence_at(const StreamPlace& place, std::uint64_t newest);
  [[nodiscard]] Result<bool> fetch();
  [[nodiscard]] bool is_stopped() const { return options_.stop != nullptr && *options_.stop; }
  [[nodiscard]] Error error(const Error& what) const;
  [[nodiscard]] Error has_nothing() const;
  void tell(const Error& outage);
  void tell_of_return();

  const std::string stream_;
  const std::string subject_;
  const StreamAddress address_;
  const FrameStreamOptions options_;
  const std::unique_ptr<Broker> broker_;
  std::vector<std::uint8_t> description_;
  bytes::recordings::FrameNotes notes_;
  FrameShape shape_;
  std::uint64_t next_sequence_ = 1;
  End end_;
  std::vector<RawFrame> frames_;  ///< The last batch.
  std::size_t next_frame_ = 0;
  bool answers_ = true;
  SourceStatistics statistics_;
};

Error FrameStream::Implementation::error(const Error& what) const {
  return {what.kind, "'" + address_.text + "': " + what.message};
}

Error FrameStream::Implementation::has_nothing() const {
  return bad_input("'" + address_.text + "': the server has no frames of array '" + address_.array + "' of robot '" +
                   address_.robot + "'");
}

Status FrameStream::Implementation::begin() {
  const Result<bool> has_robot = has_stream(*broker_, stream_);
  if (!has_robot) return error(has_robot.error());
  if (!*has_robot) return has_nothing();
  const std::string described = subject_of(address_.robot, address_.array, "description");
  Result<std::optional<StoredMessage>> description = broker_->last(stream_, described);
  if (!description) return error(description.error());
  const Result<std::optional<StoredMessage>> newest = broker_->last(stream_, subject_);
  if (!newest) return error(newest.error());
  if (!*description || !*newest) return has_nothing();
  description_ = std::move((*description)->bytes);
  const Result<bytes::recordings::ReadBatch> read = bytes::recordings::read_frame_batch(description_, (*newest)->bytes);
  if (!read) return error(read.error());
  notes_ = {read->array.name, read->array.array_toml, read->array.model_hash, read->array.simulation};
  shape_ = read->array.shape;
  const std::uint64_t last = (*newest)->sequence;
  const Result<std::uint64_t> first = sequence_at(address_.from, last + 1);
  if (!first) return error(first.error());
  next_sequence_ = *first;
  if (!address_.ends) return Done{};
  end_.sequence = last;
  if (const auto* sequence = std::get_if<std::uint64_t>(&address_.to)) end_.sequence = std::min(last, *sequence);
  if (const auto* time = std::get_if<Nanos>(&address_.to)) end_.time = *time;
  return Done{};
}

Result<std::uint64_t> FrameStream::Implementation::sequence_at(const StreamPlace& place, std::uint64_t newest) {
  if (const auto* sequence = std::get_if<std::uint64_t>(&place)) return *sequence;
  if (const auto* time = std::get_if<Nanos>(&place)) return first_since(*broker_, {stream_, subject_}, *time, newest);
  return newest;
}

/// The next batch; false where there is none yet, or no more.
Result<bool> FrameStream::Implementation::fetch() {
  Result<std::optional<StoredMessage>> message = broker_->next(stream_, subject_, next_sequence_);
  if (!message) {
    tell(message.error());
    std::this_thread::sleep_for(kRetryAfter);
    return false;
  }
  tell_of_return();
  if (!*message) return false;
  if ((*message)->sequence > end_.sequence || (*message)->time > end_.time) {
    end_.sequence = 0;
    return false;
  }
  next_sequence_ = (*message)->sequence + 1;
  Result<bytes::recordings::ReadBatch> read = bytes::recordings::read_frame_batch(description_, (*message)->bytes);
  if (!read) return bad_input(place() + ": " + read.error().message);
  if (read->array.shape != shape_) {
    return bad_input(place() + ": frames of another shape begin here; read the others from this number on");
  }
  frames_ = std::move(read->frames);
  next_frame_ = 0;
  return true;
}

Result<bool> FrameStream::Implementation::next(RawFrame& frame) {
  while (next_frame_ == frames_.size()) {
    if (is_stopped() || next_sequence_ > end_.sequence) return false;
    const Result<bool> fetched = fetch();
    if (!fetched) return fetched.error();
    if (!*fetched && next_sequence_ <= end_.sequence) std::this_thread::sleep_for(kLookEvery);
  }
  std::swap(frame, frames_[next_frame_++]);
  ++statistics_.frames;
  statistics_.lost_frames += frame.acquisition.lost_before;
  return true;
}

void FrameStream::Implementation::tell(const Error& outage) {
  if (std::exchange(answers_, false) && options_.notice) options_.notice(outage.message + "; it is asked again");
}

void FrameStream::Implementation::tell_of_return() {
  if (!std::exchange(answers_, true) && options_.notice) options_.notice(address_.broker.url + ": answers again");
}

FrameStream::FrameStream(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

FrameStream::~FrameStream() = default;

Result<std::unique_ptr<FrameStream>> FrameStream::open(const StreamAddress& address, FrameStreamOptions options) {
  Result<std::unique_ptr<Broker>> broker = connect_broker(address.broker);
  if (!broker) return broker.error();
  auto implementation = std::make_unique<Implementation>(address, std::move(options), *std::move(broker));
  if (const Status begun = implementation->begin(); !begun) return begun.error();
  return std::unique_ptr<FrameStream>(new FrameStream(std::move(implementation)));
}

Result<bool> FrameStream::next(RawFrame& frame) {
  return implementation_->next(frame);
}

std::optional<FrameShape> FrameStream::shape() const {
  return implementation_->shape();
}

SourceStatistics FrameStream::statistics() const {
  return implementation_->statistics();
}

bool FrameStream::is_live() const {
  return !implementation_->ends();
}

std::string FrameStream::place() const {
  return implementation_->place();
}

const bytes::recordings::FrameNotes& FrameStream::notes() const noexcept {
  return implementation_->notes();
}

}  // namespace dermis::live::fleet
