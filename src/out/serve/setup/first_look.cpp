// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/first_look.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <span>
#include <thread>
#include <utility>

#include "dermis/bytes/devices/device_source.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::chrono::milliseconds kPeriod{50};
constexpr std::size_t kMostKept = 65536;

/// Sets a flag when another is set, or after kPatience.
class Patience {
 public:
  explicit Patience(const std::atomic<bool>* stop)
      : thread_([this, stop](const std::stop_token& token) {
          const auto end = std::chrono::steady_clock::now() + kPatience;
          const auto is_over = [&] { return std::chrono::steady_clock::now() >= end || (stop != nullptr && *stop); };
          while (!token.stop_requested() && !is_over()) std::this_thread::sleep_for(kPeriod);
          over_ = true;
        }) {}

  [[nodiscard]] const std::atomic<bool>* over() const noexcept { return &over_; }

 private:
  std::atomic<bool> over_ = false;
  std::jthread thread_;
};

/// These bytes, possibly none, made no frame.
void explain(const live::sources::SourceName& name, std::vector<std::uint8_t> bytes, FirstLook& found) {
  if (!name.uri || bytes.empty()) {
    if (found.message.empty()) found.message = "nothing came within 8 s";
    return;
  }
  bytes::devices::UndecodedReason reason = bytes::devices::why_undecoded(*name.uri, bytes);
  found.message = std::move(reason.why);
  found.shape = reason.likely_shape;
  found.bytes = std::move(bytes);
}

}  // namespace

Result<FirstLook> first_look(const live::sources::SourceName& name, live::sources::SourceOptions options) {
  FirstLook found;
  const Patience patience(options.stop);
  options.stop = patience.over();
  const auto log = std::move(options.notice);
  options.notice = [&](const std::string& line) {
    found.message = line;
    if (log) log(line);
  };
  std::vector<std::uint8_t> bytes;
  options.received = [&](std::span<const std::uint8_t> more) {
    more = more.first(std::min(more.size(), kMostKept - bytes.size()));
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  const Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(name, options);
  if (!source) return source.error();
  RawFrame frame;
  const Result<bool> came = (*source)->next(frame);
  if (!came && came.error().kind != ErrorKind::bad_input) return came.error();
  if (!came) found.message = came.error().message;
  found.has_frames = came && *came;
  if (found.has_frames) {
    found.shape = (*source)->shape();
  } else {
    explain(name, std::move(bytes), found);
  }
  return found;
}

}  // namespace dermis::out::serve
