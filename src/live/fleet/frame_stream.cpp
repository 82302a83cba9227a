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
#include "live/fleet/followed_session.hpp"
#include "live/fleet/message_id.hpp"
#include "live/fleet/stream_descriptions.hpp"
#include "live/fleet/stream_gaps.hpp"
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

/// Many members: the place in the stream, what is known of its senders, and the frames at hand.
class FrameStream::Implementation {
 public:
  Implementation(const StreamAddress& address, FrameStreamOptions options, std::unique_ptr<Broker> broker)
      : stream_(stream_of(address.robot)),
        subject_(subject_of(address.robot, address.array, "frames")),
        address_(address),
        options_(std::move(options)),
        broker_(std::move(broker)),
        descriptions_(*broker_, {stream_, subject_of(address.robot, address.array, "description")}),
        gaps_(address.text, options_.notice) {}

  [[nodiscard]] Status begin();
  [[nodiscard]] Result<bool> next(RawFrame& frame);
  [[nodiscard]] FrameShape shape() const noexcept { return shape_; }
  [[nodiscard]] const bytes::recordings::FrameNotes& notes() const noexcept { return notes_; }
  [[nodiscard]] const SourceStatistics& statistics() const noexcept { return statistics_; }
  [[nodiscard]] bool ends() const noexcept { return address_.ends; }
  [[nodiscard]] std::string place() const { return address_.text + ": message " + std::to_string(next_sequence_ - 1); }

 private:
  [[nodiscard]] Result<std::uint64_t> sequence_at(const StreamPlace& place, std::uint64_t newest);
  [[nodiscard]] Result<const StreamDescription*> describe(std::uint64_t first, const StoredMessage& newest);
  [[nodiscard]] Result<bool> fetch();
  [[nodiscard]] bool wait_after(const Error& outage);
  [[nodiscard]] Status take(const StoredMessage& message);
  [[nodiscard]] Status decode(const StoredMessage& message, const MessageId& id);
  void leave_out(const StoredMessage& message, const MessageId& id, const char* why);
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
  StreamDescriptions descriptions_;
  FollowedSession session_;
  StreamGaps gaps_;
  bool has_told_of_others_ = false;
  bytes::recordings::FrameNotes notes_;
  FrameShape shape_;
  std::uint64_t next_sequence_ = 1;
  End end_;
  std::vector<RawFrame> frames_;  ///< The last batch.
  std::size_t next_frame_ = 0;
  std::uint64_t missing_ = 0;  ///< Frames, before the next one.
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
  const Result<std::optional<StoredMessage>> newest = broker_->last(stream_, subject_);
  if (!newest) return error(newest.error());
  if (!*newest) return has_nothing();
  const std::uint64_t last = (*newest)->sequence;
  const Result<std::uint64_t> first = sequence_at(address_.from, last + 1);
  if (!first) return error(first.error());
  const Result<const StreamDescription*> description = describe(*first, **newest);
  if (!description) return error(description.error());
  if (*description == nullptr) {
    return failed("'" + address_.text +
                  "': none of its descriptions can be read; a robot that publishes sends them again");
  }
  const bytes::recordings::RecordedArray& array = (*description)->array;
  notes_ = {array.name, array.array_toml, array.model_hash, array.simulation};
  shape_ = array.shape;
  next_sequence_ = *first;
  if (!address_.ends) return Done{};
  end_.sequence = last;
  if (const auto* sequence = std::get_if<std::uint64_t>(&address_.to)) end_.sequence = std::min(last, *sequence);
  if (const auto* time = std::get_if<Nanos>(&address_.to)) end_.time = *time;
  return Done{};
}

/// That of the first message to be read, or of the newest one.
Result<const StreamDescription*> FrameStream::Implementation::describe(std::uint64_t first,
                                                                       const StoredMessage& newest) {
  const Result<std::optional<StoredMessage>> message = broker_->next(stream_, subject_, first);
  if (!message) return message.error();
  if (*message) {
    auto found = descriptions_.find(parse_message_id((*message)->id).session, **message);
    if (!found || *found != nullptr) return found;
  }
  return descriptions_.find(parse_message_id(newest.id).session, newest);
}

Result<std::uint64_t> FrameStream::Implementation::sequence_at(const StreamPlace& place, std::uint64_t newest) {
  if (const auto* sequence = std::get_if<std::uint64_t>(&place)) return *sequence;
  if (const auto* time = std::get_if<Nanos>(&place)) return first_since(*broker_, {stream_, subject_}, *time, newest);
  return newest;
}

/// The next batch; false where there is none yet, or no more.
Result<bool> FrameStream::Implementation::fetch() {
  Result<std::optional<StoredMessage>> message = broker_->next(stream_, subject_, next_sequence_);
  if (!message) return wait_after(message.error());
  if (!*message) {
    tell_of_return();
    return false;
  }
  if ((*message)->sequence > end_.sequence || (*message)->time > end_.time) {
    end_.sequence = 0;
    return false;
  }
  next_sequence_ = (*message)->sequence + 1;
  const Status taken = take(**message);
  if (!taken && taken.error().kind == ErrorKind::failed) {
    next_sequence_ = (*message)->sequence;
    return wait_after(taken.error());
  }
  tell_of_return();
  if (!taken) return taken.error();
  return true;
}

/// The server does not answer.
bool FrameStream::Implementation::wait_after(const Error& outage) {
  tell(outage);
  std::this_thread::sleep_for(kRetryAfter);
  return false;
}

/// Frames of one session at a time.
Status FrameStream::Implementation::take(const StoredMessage& message) {
  const MessageId id = parse_message_id(message.id);
  const FollowedSession::Answer session = session_.take(id, message.time);
  if (session == FollowedSession::Answer::other) {
    if (!std::exchange(has_told_of_others_, true)) {
      gaps_.tell("message " + std::to_string(message.sequence) + " is of another process than the one that is read; " +
                 "such messages are passed over");
    }
    return Done{};
  }
  if (session == FollowedSession::Answer::next) {
    has_told_of_others_ = false;
    gaps_.tell("message " + std::to_string(message.sequence) + ": another run of the robot begins");
  }
  if (const std::uint64_t before = session_.missing_before(id); before > 0) {
    gaps_.add(message.sequence, "does not follow the one before", before);
    missing_ += before;
  }
  session_.pass(id);
  return decode(message, id);
}

Status FrameStream::Implementation::decode(const StoredMessage& message, const MessageId& id) {
  const Result<const StreamDescription*> description = descriptions_.find(id.session, message);
  if (!description) return description.error();
  if (*description == nullptr) {
    leave_out(message, id, "has no description that can be read");
    return Done{};
  }
  if ((*description)->array.shape != shape_) {
    return bad_input(place() + ": frames of another shape begin here; read the others from this number on");
  }
  Result<bytes::recordings::ReadBatch> read = bytes::recordings::read_frame_batch((*description)->bytes, message.bytes);
  if (!read || read->array.shape != shape_) {
    leave_out(message, id, "is damaged");
    return Done{};
  }
  frames_ = std::move(read->frames);
  next_frame_ = 0;
  return Done{};
}

void FrameStream::Implementation::leave_out(const StoredMessage& message, const MessageId& id, const char* why) {
  gaps_.add(message.sequence, why, id.frames);
  const std::uint64_t frames = std::max<std::uint64_t>(id.frames, 1);
  statistics_.damaged_frames += frames;
  missing_ += frames;
}

Result<bool> FrameStream::Implementation::next(RawFrame& frame) {
  while (next_frame_ == frames_.size()) {
    if (next_sequence_ > end_.sequence) gaps_.tell_all();
    if (is_stopped() || next_sequence_ > end_.sequence) return false;
    const Result<bool> fetched = fetch();
    if (!fetched) return fetched.error();
    if (!*fetched && next_sequence_ <= end_.sequence) std::this_thread::sleep_for(kLookEvery);
  }
  std::swap(frame, frames_[next_frame_++]);
  frame.acquisition.lost_before += static_cast<std::uint32_t>(std::exchange(missing_, 0));
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
