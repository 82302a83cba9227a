// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/first_look.hpp"

#include <algorithm>
#include <span>
#include <thread>
#include <utility>

#include "dermis/bytes/devices/device_source.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kMostKept = 65536;
constexpr std::chrono::milliseconds kPeriod{20};

}  // namespace

SourceLook::SourceLook(live::sources::SourceName name, live::sources::SourceOptions options)
    : name_(std::move(name)),
      stop_(options.stop),
      watch_(name_, std::nullopt, heard_by(std::move(options)), [this](const FrameSource& source, const RawFrame&) {
        const std::lock_guard lock(mutex_);
        found_.has_frames = true;
        found_.shape = source.shape();
        return false;
      }) {}

live::sources::SourceOptions SourceLook::heard_by(live::sources::SourceOptions options) {
  options.notice = [this, log = std::move(options.notice)](const std::string& line) {
    {
      const std::lock_guard lock(mutex_);
      found_.message = line;
    }
    if (log) log(line);
  };
  options.received = [this](std::span<const std::uint8_t> more) {
    const std::lock_guard lock(mutex_);
    more = more.first(std::min(more.size(), kMostKept - found_.bytes.size()));
    found_.bytes.insert(found_.bytes.end(), more.begin(), more.end());
  };
  return options;
}

std::optional<Result<FirstLook>> SourceLook::found() {
  const std::optional<SourceWatch::Ended> ended = watch_.ended();
  if (ended) return outcome(*ended);
  const bool is_over = std::chrono::steady_clock::now() >= end_ || (stop_ != nullptr && *stop_);
  return is_over ? std::optional(outcome(watch_.stop())) : std::nullopt;
}

Result<FirstLook> SourceLook::outcome(const SourceWatch::Ended& ended) {
  const bool shows_bytes = ended.was_open && !ended.how && ended.how.error().kind == ErrorKind::bad_input;
  if (!ended.how && !shows_bytes) return ended.how.error();
  if (!ended.how) found_.message = ended.how.error().message;
  if (found_.has_frames) {
    found_.bytes.clear();
  } else {
    explain();
  }
  return found_;
}

/// These bytes, possibly none, made no frame.
void SourceLook::explain() {
  if (!name_.uri || found_.bytes.empty()) {
    if (found_.message.empty()) found_.message = "nothing came within 8 s";
    found_.bytes.clear();
    return;
  }
  bytes::devices::UndecodedReason reason = bytes::devices::why_undecoded(*name_.uri, found_.bytes);
  found_.message = std::move(reason.why);
  found_.shape = reason.likely_shape;
}

Result<FirstLook> first_look(const live::sources::SourceName& name, live::sources::SourceOptions options) {
  SourceLook look(name, std::move(options));
  for (;;) {
    if (std::optional<Result<FirstLook>> found = look.found()) return *std::move(found);
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace dermis::out::serve
