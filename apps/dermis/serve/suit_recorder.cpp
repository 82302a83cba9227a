// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/suit_recorder.hpp"

#include <utility>

namespace dermis::app {

SuitRecorder::SuitRecorder(std::function<void(const std::string&)> failed) : failed_(std::move(failed)) {}

SuitRecorder::~SuitRecorder() {
  static_cast<void>(end());
}

Status SuitRecorder::begin(const std::string& path, const std::vector<recordings::RecordedArray>& arrays) {
  const std::lock_guard switching(switch_mutex_);
  if (recording_) return bad_input("a recording goes on: " + this->path());
  await_closing();
  Result<std::unique_ptr<recordings::SuitRecordingWriter>> writer =
      recordings::SuitRecordingWriter::create(path, arrays);
  if (!writer) return writer.error();
  const std::unique_lock lock(writer_mutex_);
  writer_ = *std::move(writer);
  path_ = path;
  outcome_ = Done{};
  frames_ = 0;
  recording_ = true;
  return Done{};
}

void SuitRecorder::stop() {
  const std::unique_lock lock(writer_mutex_);
  if (!writer_) return;
  closing_ = std::thread([this, writer = std::move(writer_)] { close(*writer); });
  recording_ = false;
}

/// A recording that failed is told so here, too: once, and by a thread that nobody waits for.
void SuitRecorder::close(recordings::SuitRecordingWriter& writer) {
  outcome_ = writer.commit();
  if (!outcome_) failed_(outcome_.error().message);
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
  if (!recording_) return;
  {
    const std::shared_lock lock(writer_mutex_);
    if (!writer_) return;
    if (writer_->write(array, raw)) {
      ++frames_;
      return;
    }
  }
  stop();
}

std::string SuitRecorder::path() const {
  const std::shared_lock lock(writer_mutex_);
  return path_;
}

}  // namespace dermis::app
