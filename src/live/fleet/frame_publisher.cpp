// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/frame_publisher.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/bytes/recordings/frame_batches.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/health_changes.hpp"
#include "live/fleet/message_id.hpp"
#include "live/fleet/name_keeper.hpp"
#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostThreads = 4;
constexpr std::chrono::milliseconds kLookEvery{20};
constexpr std::chrono::milliseconds kRetryAfter{200};
constexpr std::chrono::seconds kDescribeAgainFirst{1};  // the next ones are twice as far apart, up to:
constexpr std::chrono::seconds kDescribeEvery{60};
constexpr std::chrono::seconds kLastWords{2};
constexpr std::size_t kMostChanges = 1000;      // that wait
constexpr std::chrono::seconds kRenewEvery{1};  // the lease of the name

/// An array whose batches go to the server, one at a time.
struct PublishedArray {
  PublishedArray(const std::string& robot, bytes::recordings::RecordedArray array)
      : name(array.name),
        frames(subject_of(robot, name, "frames")),
        contacts(subject_of(robot, name, "contacts")),
        description(subject_of(robot, name, "description")),
        writer(std::move(array)) {}

  std::string name;
  std::string frames;
  std::string contacts;
  std::string description;
  bytes::recordings::FrameBatchWriter writer;
  std::uint64_t next_frame = 0;
  std::uint64_t next_contacts = 0;
  std::uint64_t descriptions = 0;
  std::uint64_t described_session = 0;  ///< 0: never.
  Clock::duration describe_after = kDescribeAgainFirst;
  Clock::time_point describe_next{};
  Clock::time_point begun = Clock::now();
  Clock::time_point contacts_begun = Clock::now();
  std::atomic<std::uint64_t> refused = 0;  ///< Frames that the server will never take.

  [[nodiscard]] std::uint64_t left_out() const noexcept { return refused + writer.left_out(); }
};

/// The health of the robot on its way to the server.
struct Telling {
  const Nanos begun = std::chrono::system_clock::now().time_since_epoch();
  std::mutex mutex;                   ///< Guards the next three.
  std::optional<RobotHealth> last{};  ///< That is not sent yet.
  std::deque<RobotHealth> changes{};  ///< The same, of each change.
  HealthChanges seen{};
  std::uint64_t sent_changes = 0;  ///< It and the next are of the first thread.
  std::optional<Nanos> before{};   ///< A run before this one told its health last; 0: none did; empty: not known yet.
};

}  // namespace

class FramePublisher::Implementation {
 public:
  explicit Implementation(PublisherOptions options)
      : options_(std::move(options)), name_(options_.robot, options_.take_over, options_.notice) {}
  ~Implementation();

  [[nodiscard]] Status begin(std::vector<bytes::recordings::RecordedArray> arrays);
  void publish(std::size_t array, const RawFrame& frame) { arrays_[array]->writer.add(frame); }
  void publish(const RobotHealth& health);
  [[nodiscard]] PublisherCounts counts() const noexcept;
  void publish_contacts(std::size_t array, Nanos time, std::span<const std::uint8_t> message) {
    arrays_[array]->writer.add_contacts(time, message);
  }
  [[nodiscard]] std::uint64_t left_out(std::size_t array) const noexcept { return arrays_[array]->left_out(); }

 private:
  /// The fate of a message; late: there was no time left.
  enum class Fate : std::uint8_t { stored, refused, late };

  void work(std::size_t first, std::size_t stride, const std::stop_token& stop);
  void keep_name(const std::stop_token& stop);
  [[nodiscard]] bool send_waiting(PublishedArray& array, std::uint64_t session, bool unfinished);
  [[nodiscard]] bool send_contacts(PublishedArray& array, std::uint64_t session, bool unfinished);
  [[nodiscard]] bool describe(PublishedArray& array, std::uint64_t session);
  void send_health();
  void look_before();
  [[nodiscard]] bool send_changes();
  [[nodiscard]] std::string text_of(RobotHealth health) const;
  [[nodiscard]] Fate store(const std::string& subject, const std::string& id, std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::optional<Fate> try_to_store(const std::string& subject, const std::string& id,
                                                 std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool has_stored(const std::string& subject, const std::string& id);
  [[nodiscard]] Broker* broker();
  void tell(const Status& outcome);
  [[nodiscard]] bool is_over() const noexcept { return Clock::now() >= end_.load(); }

  const PublisherOptions options_;
  std::vector<std::unique_ptr<PublishedArray>> arrays_;

  std::mutex connecting_;
  std::unique_ptr<Broker> broker_;  ///< Null: the server has not answered yet.
  std::set<std::string> told_;      ///< Failures since it answered last; guarded by `connecting_`.

  std::atomic<std::uint64_t> batches_ = 0;
  std::atomic<std::uint64_t> frames_ = 0;
  std::atomic<std::uint64_t> bytes_ = 0;
  Telling telling_;
  NameKeeper name_;

  std::atomic<Clock::time_point> end_ = Clock::time_point::max();
  std::jthread name_thread_;
  std::vector<std::jthread> threads_;
};

FramePublisher::Implementation::~Implementation() {
  end_ = Clock::now() + kLastWords;
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
  name_thread_ = {};
  if (broker_ != nullptr) name_.give_back(*broker_);
}

Status FramePublisher::Implementation::begin(std::vector<bytes::recordings::RecordedArray> arrays) {
  Result<std::unique_ptr<Broker>> connected = connect_broker(options_.broker);
  if (!connected && connected.error().kind == ErrorKind::bad_input) return connected.error();
  if (connected) {
    broker_ = *std::move(connected);
    if (Status claimed = name_.claim(*broker_); !claimed) return claimed;
  } else {
    tell(connected.error());
  }
  for (bytes::recordings::RecordedArray& array : arrays) {
    arrays_.push_back(std::make_unique<PublishedArray>(options_.robot, std::move(array)));
  }
  name_thread_ = std::jthread([this](const std::stop_token& stop) { keep_name(stop); });
  const std::size_t threads = std::min(arrays_.size(), kMostThreads);
  for (std::size_t first = 0; first < threads; ++first) {
    threads_.emplace_back([this, first, threads](const std::stop_token& stop) { work(first, threads, stop); });
  }
  return Done{};
}

void FramePublisher::Implementation::keep_name(const std::stop_token& stop) {
  ::pthread_setname_np(::pthread_self(), "publish-name");
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  while (!stop.stop_requested()) {
    Broker* const server = broker();
    const Status renewed = server != nullptr ? name_.renew(*server) : Status(Done{});
    if (!renewed) tell(renewed);
    stopped.wait_for(lock, stop, kRenewEvery, [] { return false; });
  }
}

/// Sends the batches of every `stride`th array.
void FramePublisher::Implementation::work(std::size_t first, std::size_t stride, const std::stop_token& stop) {
  ::pthread_setname_np(::pthread_self(), "publish");
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  bool is_last_round = false;
  while (!is_last_round) {
    is_last_round = stop.stop_requested();
    const std::uint64_t session = name_.session();
    const bool may_send = session > 0 || name_.is_replaced();  // what a replaced process has counts as refused
    for (std::size_t i = first; may_send && i < arrays_.size(); i += stride) {
      if (!send_waiting(*arrays_[i], session, is_last_round)) return;
      if (!send_contacts(*arrays_[i], session, is_last_round)) return;
    }
    if (first == 0) send_health();
    stopped.wait_for(lock, stop, kLookEvery, [] { return false; });
  }
}

/// false: there is no time left.
bool FramePublisher::Implementation::send_waiting(PublishedArray& array, std::uint64_t session, bool unfinished) {
  bool is_due = Clock::now() - array.begun > bytes::recordings::FrameBatchWriter::kLongest;
  while (const std::optional<bytes::recordings::FrameBatch> batch = array.writer.take(unfinished || is_due)) {
    is_due = false;  // what comes meanwhile is for the next round
    array.begun = Clock::now();
    if (is_over() || !describe(array, session)) return false;
    const std::uint64_t first = std::exchange(array.next_frame, array.next_frame + batch->frames);
    const std::string numbers = std::to_string(first) + "." + std::to_string(batch->frames);
    const Fate fate = store(array.frames, begin_of_id(session, array.name) + numbers, batch->bytes);
    if (fate == Fate::late) return false;
    if (fate == Fate::refused) {
      array.refused += batch->frames;
      continue;
    }
    ++batches_;
    frames_ += batch->frames;
    bytes_ += batch->bytes.size();
  }
  return true;
}

/// The same for contacts.
bool FramePublisher::Implementation::send_contacts(PublishedArray& array, std::uint64_t session, bool unfinished) {
  bool is_due = Clock::now() - array.contacts_begun > bytes::recordings::FrameBatchWriter::kLongest;
  while (const std::optional<bytes::recordings::FrameBatch> batch = array.writer.take_contacts(unfinished || is_due)) {
    is_due = false;
    array.contacts_begun = Clock::now();
    if (is_over() || !describe(array, session)) return false;
    const std::string id = begin_of_id(session, array.name) + "c" + std::to_string(array.next_contacts++);
    if (store(array.contacts, id, batch->bytes) == Fate::late) return false;
    bytes_ += batch->bytes.size();
  }
  return true;
}

/// Streams forget, and bytes are damaged: the description is there again and again. false: there is no time left.
bool FramePublisher::Implementation::describe(PublishedArray& array, std::uint64_t session) {
  const bool is_new = array.described_session != session;
  if (!is_new && Clock::now() < array.describe_next) return true;
  const std::span<const std::uint8_t> text = array.writer.description();
  const std::string id = begin_of_id(session, array.name) + "d" + std::to_string(array.descriptions++) + "." +
                         std::to_string(bytes::recordings::checksum(text));
  if (store(array.description, id, text) == Fate::late) return false;
  array.described_session = session;
  array.describe_after =
      is_new ? kDescribeAgainFirst : std::min<Clock::duration>(2 * array.describe_after, kDescribeEvery);
  array.describe_next = Clock::now() + array.describe_after;
  return true;
}

/// Tries once: the next one is newer. Changes wait until they are stored.
void FramePublisher::Implementation::send_health() {
  std::optional<RobotHealth> health;
  {
    const std::scoped_lock lock(telling_.mutex);
    health.swap(telling_.last);
  }
  if (!health || name_.session() == 0) return;
  if (!telling_.before) look_before();
  if (!send_changes()) return;
  const std::string text = text_of(*std::move(health));
  static_cast<void>(try_to_store(health_subject_of(options_.robot), "",
                                 {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
}

void FramePublisher::Implementation::look_before() {
  Broker* const server = broker();
  if (server == nullptr) return;
  const auto last = server->last(stream_of(options_.robot), health_subject_of(options_.robot));
  if (last) telling_.before = *last ? (*last)->time : Nanos{};
}

/// false: some still wait.
bool FramePublisher::Implementation::send_changes() {
  while (true) {
    std::string text;
    {
      const std::scoped_lock lock(telling_.mutex);
      if (telling_.changes.empty()) return true;
      text = text_of(telling_.changes.front());
    }
    const std::string id =
        "change-" + std::to_string(telling_.begun.count()) + "-" + std::to_string(telling_.sent_changes);
    const auto fate = try_to_store(changes_subject_of(options_.robot), id,
                                   {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    if (!fate) return false;
    ++telling_.sent_changes;
    const std::scoped_lock lock(telling_.mutex);
    if (!telling_.changes.empty()) telling_.changes.pop_front();
  }
}

std::string FramePublisher::Implementation::text_of(RobotHealth health) const {
  health.begun = telling_.begun;
  health.before = telling_.before.value_or(Nanos{});
  return health_to_json(health);
}

/// Tries until the server has stored or refused it, or there is no time left.
FramePublisher::Implementation::Fate FramePublisher::Implementation::store(const std::string& subject,
                                                                           const std::string& id,
                                                                           std::span<const std::uint8_t> bytes) {
  while (true) {
    if (name_.is_replaced()) return Fate::refused;
    if (const std::optional<Fate> fate = try_to_store(subject, id, bytes)) return *fate;
    if (is_over()) return Fate::late;
    std::this_thread::sleep_for(kRetryAfter);
    if (has_stored(subject, id)) return Fate::stored;
  }
}

/// Empty: it is to be tried again.
std::optional<FramePublisher::Implementation::Fate> FramePublisher::Implementation::try_to_store(
    const std::string& subject, const std::string& id, std::span<const std::uint8_t> bytes) {
  Broker* const server = broker();
  if (server == nullptr) return std::nullopt;
  Result<std::uint64_t> stored = server->store(subject, id, bytes);
  if (!stored && stored.error().kind == ErrorKind::failed && make_stream(*server, options_.robot)) {
    stored = server->store(subject, id, bytes);
  }
  tell(stored ? Status(Done{}) : Status(stored.error()));
  if (stored) return Fate::stored;
  return stored.error().kind == ErrorKind::bad_input ? std::optional(Fate::refused) : std::nullopt;
}

/// A server may have stored a message and gone before it said so.
bool FramePublisher::Implementation::has_stored(const std::string& subject, const std::string& id) {
  Broker* const server = broker();
  if (server == nullptr) return false;
  const Result<std::optional<StoredMessage>> last = server->last(stream_of(options_.robot), subject);
  return last && *last && (*last)->id == id;
}

Broker* FramePublisher::Implementation::broker() {
  const std::scoped_lock lock(connecting_);
  if (broker_ != nullptr) return broker_.get();
  Result<std::unique_ptr<Broker>> connected = connect_broker(options_.broker);
  if (connected) broker_ = *std::move(connected);
  return broker_.get();
}

void FramePublisher::Implementation::tell(const Status& outcome) {
  const std::scoped_lock lock(connecting_);
  const bool is_news = outcome ? !std::exchange(told_, {}).empty() : told_.insert(outcome.error().message).second;
  if (!is_news || !options_.notice) return;
  options_.notice(outcome
                      ? options_.broker.url + ": stores frames again"
                      : outcome.error().message +
                            (outcome.error().kind == ErrorKind::failed ? "; frames wait, and it is asked again" : ""));
}

void FramePublisher::Implementation::publish(const RobotHealth& health) {
  RobotHealth told = health;
  told.is_doubled = name_.is_doubled();
  const std::scoped_lock lock(telling_.mutex);
  if (telling_.seen.take(told) && telling_.changes.size() < kMostChanges) telling_.changes.push_back(told);
  telling_.last = std::move(told);
}

PublisherCounts FramePublisher::Implementation::counts() const noexcept {
  PublisherCounts counts{batches_, frames_, bytes_};
  for (const auto& array : arrays_) counts.left_out += array->left_out();
  return counts;
}

FramePublisher::FramePublisher(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

FramePublisher::~FramePublisher() = default;

Result<std::unique_ptr<FramePublisher>> FramePublisher::create(std::vector<bytes::recordings::RecordedArray> arrays,
                                                               PublisherOptions options) {
  if (const Status good = check_name("robot", options.robot); !good) return good.error();
  for (const bytes::recordings::RecordedArray& array : arrays) {
    if (const Status good = check_name("array", array.name); !good) return good.error();
  }
  auto implementation = std::make_unique<Implementation>(std::move(options));
  if (const Status begun = implementation->begin(std::move(arrays)); !begun) return begun.error();
  return std::unique_ptr<FramePublisher>(new FramePublisher(std::move(implementation)));
}

void FramePublisher::publish(std::size_t array, const RawFrame& frame) {
  implementation_->publish(array, frame);
}

void FramePublisher::publish_contacts(std::size_t array, Nanos time, std::span<const std::uint8_t> message) {
  implementation_->publish_contacts(array, time, message);
}

void FramePublisher::publish(const RobotHealth& health) {
  implementation_->publish(health);
}

PublisherCounts FramePublisher::counts() const noexcept {
  return implementation_->counts();
}

std::uint64_t FramePublisher::left_out(std::size_t array) const noexcept {
  return implementation_->left_out(array);
}

}  // namespace dermis::live::fleet
