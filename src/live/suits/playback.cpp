// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/suits/playback.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "dermis/bytes/recordings/recording.hpp"
#include "live/suits/played_track.hpp"

namespace dermis::live::suits {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSlowest = 0.01;
constexpr double kFastest = 100.0;
constexpr Nanos kReadAhead = std::chrono::milliseconds(100);     // of the time that passes, not of the recording
constexpr Nanos kFirstAhead = std::chrono::seconds(2);           // of the recording, for the first frames after a seek
constexpr std::size_t kMostWaiting = 1024;                       // frames of an array
constexpr Nanos kMostLate = std::chrono::milliseconds(200);      // then the clock waits
constexpr Nanos kResultsAfter = std::chrono::milliseconds(200);  // so much later than its frame a result may be

Nanos scaled(Nanos time, double factor) {
  return Nanos(std::llround(static_cast<double>(time.count()) * factor));
}

}  // namespace

class Playback::Implementation {
 public:
  Implementation(std::string path, std::unique_ptr<bytes::recordings::SuitRecordingReader> reader,
                 std::vector<bytes::recordings::RecordedArray> arrays,
                 std::vector<std::optional<std::size_t>> track_of_array, Nanos start, Nanos end)
      : path(std::move(path)),
        arrays(std::move(arrays)),
        start(start),
        end(end),
        reader_(std::move(reader)),
        track_of_array_(std::move(track_of_array)),
        tracks_(this->arrays.size()),
        position_(start) {
    reader_->hear_results([this](const bytes::recordings::RecordedResult& result) { keep(result); });
    reader_->seek(start);
  }

  const std::string path;
  const std::vector<bytes::recordings::RecordedArray> arrays;
  const Nanos start;
  const Nanos end;

  [[nodiscard]] PlayedResults results(std::size_t track, Nanos time) const;
  [[nodiscard]] bool has_results(std::size_t track) const;
  void set_used(std::size_t track, bool is_used);
  [[nodiscard]] Result<bool> next(std::size_t track, RawFrame& frame);
  [[nodiscard]] Result<Polled> poll(std::size_t track, RawFrame& frame);
  [[nodiscard]] SourceStatistics statistics(std::size_t track) const;
  PlaybackStatus control(const PlaybackCommand& command);
  [[nodiscard]] PlaybackStatus status() const;
  void show_again();
  void stop();

 private:
  [[nodiscard]] Nanos now() const;
  [[nodiscard]] PlaybackStatus::State state() const;
  void set_clock(Nanos position, bool plays);
  [[nodiscard]] Clock::time_point moment_of(Nanos time) const;
  void seek(Nanos time);
  [[nodiscard]] Status read_ahead();
  [[nodiscard]] Status read_one();
  [[nodiscard]] Status read_results_of(const PlayedTrack& track);
  void keep(const bytes::recordings::RecordedResult& result);
  [[nodiscard]] bool is_full() const;
  [[nodiscard]] bool may_read() const;
  [[nodiscard]] Result<bool> take_due(PlayedTrack& track, RawFrame& frame);
  void wait(PlayedTrack& track, std::unique_lock<std::mutex>& lock);
  void pop(PlayedTrack& track, RawFrame& frame);
  void wake_all();

  mutable std::mutex mutex_;  ///< Of all that follows.
  std::unique_ptr<bytes::recordings::SuitRecordingReader> reader_;
  std::vector<std::optional<std::size_t>> track_of_array_;
  std::vector<PlayedTrack> tracks_;
  Status read_status_ = Done{};
  bool has_read_all_ = false;
  bool is_stopped_ = false;
  Nanos read_until_{};  ///< Time of the last frame that was read.

  bool plays_ = false;
  double speed_ = 1.0;
  Nanos position_;  ///< At that moment:
  Clock::time_point moment_ = Clock::now();
};

Nanos Playback::Implementation::now() const {
  if (!plays_) return position_;
  return std::min(position_ + scaled(Clock::now() - moment_, speed_), end);
}

PlaybackStatus::State Playback::Implementation::state() const {
  if (!plays_) return PlaybackStatus::State::paused;
  return now() >= end ? PlaybackStatus::State::ended : PlaybackStatus::State::playing;
}

void Playback::Implementation::set_clock(Nanos position, bool plays) {
  position_ = position;
  moment_ = Clock::now();
  plays_ = plays;
}

Clock::time_point Playback::Implementation::moment_of(Nanos time) const {
  return moment_ + scaled(time - position_, 1.0 / speed_);
}

void Playback::Implementation::wake_all() {
  for (PlayedTrack& track : tracks_) track.changed.notify_all();
}

void Playback::Implementation::seek(Nanos time) {
  reader_->seek(time);
  has_read_all_ = false;
  read_until_ = time;
  for (PlayedTrack& track : tracks_) {
    track.waiting.clear();
    track.results.clear();
    track.is_shown_at_once = true;
  }
}

/// Not so far that one array without frames has all of the others in memory.
bool Playback::Implementation::is_full() const {
  return std::any_of(tracks_.begin(), tracks_.end(),
                     [](const PlayedTrack& track) { return track.waiting.size() >= kMostWaiting; });
}

bool Playback::Implementation::may_read() const {
  const bool is_first_awaited = std::any_of(tracks_.begin(), tracks_.end(), [](const PlayedTrack& track) {
    return track.is_used && track.is_shown_at_once && track.waiting.empty();
  });
  const Nanos ahead = scaled(kReadAhead, speed_);
  return !has_read_all_ && !is_full() &&
         read_until_ <= now() + (is_first_awaited ? std::max(kFirstAhead, ahead) : ahead);
}

Status Playback::Implementation::read_ahead() {
  while (may_read()) {
    if (Status read = read_one(); !read) return read;
  }
  return Done{};
}

Status Playback::Implementation::read_one() {
  PlayedTrack::Waiting read;
  std::size_t array = 0;
  const Result<bool> more = reader_->next(array, read.frame);
  if (!more) return more.error();
  has_read_all_ = !*more;
  if (has_read_all_) return Done{};
  read.time = std::clamp(read.frame.time, start, end);
  read_until_ = std::max(read_until_, read.time);
  if (!track_of_array_[array]) return Done{};
  PlayedTrack& track = tracks_[*track_of_array_[array]];
  if (!track.is_used) return Done{};
  track.waiting.push_back(std::move(read));
  track.changed.notify_all();
  return Done{};
}

/// Results stand behind their frame in a recording of a server.
Status Playback::Implementation::read_results_of(const PlayedTrack& track) {
  const Nanos until = track.waiting.front().time + kResultsAfter;
  while (!has_read_all_ && !is_full() && read_until_ < until) {
    if (Status read = read_one(); !read) return read;
  }
  return Done{};
}

void Playback::Implementation::keep(const bytes::recordings::RecordedResult& result) {
  if (!track_of_array_[result.array]) return;
  PlayedTrack& track = tracks_[*track_of_array_[result.array]];
  if (!track.is_used) return;
  track.keep(result);
}

PlayedResults Playback::Implementation::results(std::size_t track, Nanos time) const {
  const std::scoped_lock lock(mutex_);
  return tracks_[track].results_of(time);
}

bool Playback::Implementation::has_results(std::size_t track) const {
  const std::scoped_lock lock(mutex_);
  return tracks_[track].has_results;
}

/// Until the next frame is due, or there may be one; control() and stop() wake.
void Playback::Implementation::wait(PlayedTrack& track, std::unique_lock<std::mutex>& lock) {
  if (!track.waiting.empty() && plays_) {
    const Clock::time_point due = moment_of(track.waiting.front().time);
    track.changed.wait_until(lock, due);
  } else if (plays_ && !has_read_all_) {
    track.changed.wait_for(lock, kReadAhead / 2);
  } else {
    track.changed.wait(lock);
  }
}

void Playback::Implementation::pop(PlayedTrack& track, RawFrame& frame) {
  const Nanos time = track.waiting.front().time;
  std::swap(frame, track.waiting.front().frame);
  track.waiting.pop_front();
  track.forget_results(time);
  if (plays_ && !track.is_shown_at_once && now() - time > scaled(kMostLate, speed_)) set_clock(time, plays_);
  track.is_shown_at_once = false;
  track.is_shown_again = false;
  track.shown = frame;
  frame.acquisition.arrival_steady = Clock::now().time_since_epoch();
  track.count(frame);
}

/// Fills `frame` with the next one where its time has come, or with the last, to be shown again.
Result<bool> Playback::Implementation::take_due(PlayedTrack& track, RawFrame& frame) {
  if (track.waiting.empty() && read_status_) read_status_ = read_ahead();
  if (!track.waiting.empty() && read_status_) read_status_ = read_results_of(track);
  if (!read_status_) return read_status_.error();
  if (!track.waiting.empty()) {
    const bool is_due = track.is_shown_at_once || (plays_ && moment_of(track.waiting.front().time) <= Clock::now());
    if (is_due) {
      pop(track, frame);
      return true;
    }
  }
  if (!std::exchange(track.is_shown_again, false)) return false;
  frame = *track.shown;
  frame.acquisition.arrival_steady = Clock::now().time_since_epoch();
  return true;
}

Result<bool> Playback::Implementation::next(std::size_t index, RawFrame& frame) {
  std::unique_lock lock(mutex_);
  PlayedTrack& track = tracks_[index];
  while (!is_stopped_) {
    Result<bool> taken = take_due(track, frame);
    if (!taken || *taken) return taken;
    wait(track, lock);
  }
  return false;
}

Result<Polled> Playback::Implementation::poll(std::size_t index, RawFrame& frame) {
  const std::scoped_lock lock(mutex_);
  if (is_stopped_) return Polled::end;
  const Result<bool> taken = take_due(tracks_[index], frame);
  if (!taken) return taken.error();
  return *taken ? Polled::frame : Polled::nothing;
}

void Playback::Implementation::set_used(std::size_t track, bool is_used) {
  const std::scoped_lock lock(mutex_);
  tracks_[track].is_used = is_used;
  tracks_[track].waiting.clear();
}

SourceStatistics Playback::Implementation::statistics(std::size_t track) const {
  const std::scoped_lock lock(mutex_);
  return tracks_[track].statistics;
}

PlaybackStatus Playback::Implementation::status() const {
  const std::scoped_lock lock(mutex_);
  return {state(), now(), speed_};
}

PlaybackStatus Playback::Implementation::control(const PlaybackCommand& command) {
  const std::scoped_lock lock(mutex_);
  std::optional<Nanos> goal = command.seek;
  if (command.play && !goal && state() == PlaybackStatus::State::ended) goal = start;
  Nanos position = now();
  if (goal) {
    position = std::clamp(*goal, start, end);
    seek(position);
  }
  if (std::isfinite(command.speed)) speed_ = std::clamp(command.speed, kSlowest, kFastest);
  set_clock(position, command.play);
  wake_all();
  return {state(), now(), speed_};
}

void Playback::Implementation::show_again() {
  const std::scoped_lock lock(mutex_);
  for (PlayedTrack& track : tracks_) track.is_shown_again = track.shown.has_value();
  wake_all();
}

void Playback::Implementation::stop() {
  const std::scoped_lock lock(mutex_);
  is_stopped_ = true;
  wake_all();
}

class Playback::Source final : public FrameSource {
 public:
  Source(std::shared_ptr<Implementation> playback, std::size_t track) : playback_(std::move(playback)), track_(track) {
    playback_->set_used(track_, true);
  }
  ~Source() override { playback_->set_used(track_, false); }

  Result<bool> next(RawFrame& frame) override { return playback_->next(track_, frame); }
  Result<Polled> poll(RawFrame& frame) override { return playback_->poll(track_, frame); }
  std::optional<FrameShape> shape() const override {
    const FrameShape& shape = playback_->arrays[track_].shape;
    return shape.taxel_count() == 0 ? std::nullopt : std::optional(shape);
  }
  SourceStatistics statistics() const override { return playback_->statistics(track_); }
  bool is_live() const override { return true; }

 private:
  std::shared_ptr<Implementation> playback_;
  std::size_t track_;
};

Playback::Playback(std::shared_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Playback::~Playback() = default;

Result<std::unique_ptr<Playback>> Playback::open(const std::string& path) {
  const bytes::recordings::RecordingPlace place = bytes::recordings::recording_place(path);
  const Result<bytes::recordings::RecordingInfo> info = bytes::recordings::recording_info(place.path);
  if (!info) return info.error();
  if (info->frames == 0) return bad_input(place.path + ": has no frame to play");
  Result<std::unique_ptr<bytes::recordings::SuitRecordingReader>> reader =
      bytes::recordings::SuitRecordingReader::open(place.path);
  if (!reader) return reader.error();
  std::vector<bytes::recordings::RecordedArray> arrays = (*reader)->arrays();
  std::vector<std::optional<std::size_t>> tracks(arrays.size());
  if (place.array.empty()) {
    for (std::size_t i = 0; i < arrays.size(); ++i) tracks[i] = i;
  } else {
    const Result<std::size_t> chosen = bytes::recordings::find_array(arrays, place.path, place.array);
    if (!chosen) return chosen.error();
    (*reader)->read_only(*chosen);
    tracks[*chosen] = 0;
    arrays = {arrays[*chosen]};
  }
  const Nanos end = info->start_utc + Nanos(std::llround(1e9 * info->duration_s));
  return std::unique_ptr<Playback>(new Playback(std::make_shared<Implementation>(
      place.path, *std::move(reader), std::move(arrays), std::move(tracks), info->start_utc, end)));
}

const std::vector<bytes::recordings::RecordedArray>& Playback::arrays() const noexcept {
  return implementation_->arrays;
}

const std::string& Playback::path() const noexcept {
  return implementation_->path;
}

Nanos Playback::start() const noexcept {
  return implementation_->start;
}

Nanos Playback::end() const noexcept {
  return implementation_->end;
}

std::unique_ptr<FrameSource> Playback::source(std::size_t array) {
  assert(array < arrays().size());
  return std::make_unique<Source>(implementation_, array);
}

PlayedResults Playback::results(std::size_t array, Nanos time) const {
  return implementation_->results(array, time);
}

bool Playback::has_results(std::size_t array) const {
  return implementation_->has_results(array);
}

PlaybackStatus Playback::control(const PlaybackCommand& command) {
  return implementation_->control(command);
}

PlaybackStatus Playback::status() const {
  return implementation_->status();
}

void Playback::show_again() {
  implementation_->show_again();
}

void Playback::stop() {
  implementation_->stop();
}

}  // namespace dermis::live::suits
