// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/suit_recorder.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/kept_copy.hpp"
#include "dermis/bytes/recordings/mcap.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::uintmax_t kRoomToResume = std::uintmax_t{64} << 20U;  // some seconds of a large suit

bool has_room(const std::string& path) {
  std::error_code error;
  const auto folder = std::filesystem::absolute(path, error).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  return !error && space.available >= kRoomToResume;
}

/// Those of all arrays, by the summary; each frame has one image.
std::uint64_t frames_in(const std::string& path) {
  const auto reader = bytes::recordings::McapReader::open(path);
  if (!reader || !(*reader)->statistics()) return 0;
  std::uint64_t frames = 0;
  for (const auto& [channel, messages] : (*reader)->statistics()->channel_messages) {
    if ((*reader)->channels().at(channel).topic.ends_with("/raw")) frames += messages;
  }
  return frames;
}

}  // namespace

std::string recording_name(const std::string& wanted, bool is_first, std::chrono::system_clock::time_point now) {
  std::error_code error;
  if (is_first && !wanted.empty() && !std::filesystem::is_regular_file(wanted, error)) return wanted;
  const std::filesystem::path pattern(wanted.empty() ? "dermis.mcap" : wanted);
  const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch());
  const std::string name = fmt::format("{}-{}-{:03}{}", pattern.stem().string(), bytes::files::time_stamp(now),
                                       since_epoch.count() % 1000, pattern.extension().string());
  return (pattern.parent_path() / name).string();
}

SuitRecorder::SuitRecorder(std::string wanted, Arrays arrays, Failed failed, Written written)
    : wanted_(std::move(wanted)),
      arrays_(std::move(arrays)),
      failed_(std::move(failed)),
      written_(std::move(written)) {}

SuitRecorder::~SuitRecorder() {
  static_cast<void>(end());
}

Status SuitRecorder::begin(std::string path) {
  return begin(std::move(path), Counts::anew);
}

Status SuitRecorder::begin(std::string path, Counts counts) {
  const std::lock_guard switching(switch_mutex_);
  if (recording_) return bad_input("a recording goes on: " + this->path());
  await_closing();
  if (path.empty()) path = recording_name(wanted_, this->path().empty(), std::chrono::system_clock::now());
  Result<std::unique_ptr<bytes::recordings::SuitRecordingWriter>> writer =
      bytes::recordings::SuitRecordingWriter::create(path, arrays_());
  if (!writer) return writer.error();
  const std::unique_lock lock(writer_mutex_);
  writer_ = *std::move(writer);
  path_ = path;
  outcome_ = Done{};
  frames_ = 0;
  const std::uint64_t left_out = left_out_.exchange(0);
  if (counts == Counts::go_on) missed_ += left_out;
  if (counts == Counts::anew) missed_ = 0;
  is_broken_ = false;
  is_wanted_ = true;
  recording_ = true;
  return Done{};
}

bool SuitRecorder::resume() {
  return is_wanted_ && is_broken_ && has_room(path()) && begin({}, Counts::go_on).has_value();
}

void SuitRecorder::stop() {
  is_wanted_ = false;
  release();
}

void SuitRecorder::release() {
  const std::unique_lock lock(writer_mutex_);
  if (!writer_) return;
  recording_ = false;
  closing_ = std::thread([this, writer = std::move(writer_)] { close(*writer); });
}

/// The end is reported here, too: once, and by a thread that nobody waits for.
void SuitRecorder::close(bytes::recordings::SuitRecordingWriter& writer) {
  outcome_ = writer.commit();
  if (outcome_ && written_) written_(frames_);
  if (outcome_) return;
  missed_ += frames_ - frames_in(path());
  failed_(outcome_.error().message);
  is_broken_ = true;
}

Status SuitRecorder::end() {
  const std::lock_guard switching(switch_mutex_);
  stop();
  await_closing();
  return std::exchange(outcome_, Done{});
}

void SuitRecorder::await_closing() {
  std::thread closing;
  {
    const std::unique_lock lock(writer_mutex_);  // stop() may just be setting it
    closing.swap(closing_);
  }
  if (closing.joinable()) closing.join();
}

void SuitRecorder::write(std::size_t array, const RawFrame& raw) {
  write_with([&](bytes::recordings::SuitRecordingWriter& writer) {
    Result<bool> taken = writer.try_write(array, raw);
    if (taken) ++(*taken ? frames_ : left_out_);
    return taken;
  });
  if (is_wanted_ && !recording_) ++missed_;
}

void SuitRecorder::write(const bytes::recordings::RecordedEvent& event) {
  write_with([&](bytes::recordings::SuitRecordingWriter& writer) {
    Result<bool> taken = writer.try_write(event);
    if (taken && !*taken && !event.is_of_frame) ++left_out_;
    return taken;
  });
}

template <typename Write>
void SuitRecorder::write_with(const Write& write) {
  if (!recording_) return;
  {
    const std::shared_lock lock(writer_mutex_);
    if (!writer_ || write(*writer_)) return;
  }
  release();
}

std::string SuitRecorder::path() const {
  const std::shared_lock lock(writer_mutex_);
  return path_;
}

}  // namespace dermis::out::serve
