// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/first_look.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace dermis::serve {
namespace {

constexpr std::chrono::seconds kPatience{8};
constexpr std::chrono::milliseconds kPeriod{50};

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

}  // namespace

Result<FirstLook> first_look(const sources::SourceName& name, sources::SourceOptions options) {
  FirstLook found;
  const Patience patience(options.stop);
  options.stop = patience.over();
  const auto log = std::move(options.notice);
  options.notice = [&](const std::string& line) {
    found.message = line;
    if (log) log(line);
  };
  const Result<std::unique_ptr<FrameSource>> source = sources::open_source(name, options);
  if (!source) return source.error();
  RawFrame frame;
  const Result<bool> came = (*source)->next(frame);
  if (!came && came.error().kind != ErrorKind::bad_input) return came.error();
  if (!came) found.message = came.error().message;
  if (came && *came) found.shape = (*source)->shape();
  if (came && !*came && found.message.empty()) found.message = "nothing came within 8 s";
  return found;
}

}  // namespace dermis::serve
