// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "typed_marks.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <utility>

#include "dermis/bytes/recordings/marks.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr int kLookMs = 100;
constexpr std::size_t kMostTyped = 256;

}  // namespace

TypedMarks::TypedMarks(std::string recording) : recording_(std::move(recording)) {
  if (!recording_.ends_with(".mcap") || ::isatty(STDIN_FILENO) == 0) return;
  thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
}

void TypedMarks::begin() {
  const std::lock_guard lock(mutex_);
  begin_ = Clock::now();
  if (thread_.joinable()) print_notice("a word and Enter marks the moment, Enter alone ends the label");
}

void TypedMarks::listen(const std::stop_token& stop) {
  std::array<char, kMostTyped> typed{};
  while (!stop.stop_requested()) {
    pollfd descriptor{STDIN_FILENO, POLLIN, 0};
    if (::poll(&descriptor, 1, kLookMs) <= 0) continue;
    const ssize_t count = ::read(STDIN_FILENO, typed.data(), typed.size());
    if (count <= 0) return;
    take({typed.data(), static_cast<std::size_t>(count)});
  }
}

void TypedMarks::take(std::string_view typed) {
  for (const char letter : typed) {
    if (letter == '\n')
      mark(std::exchange(line_, {}));
    else if (line_.size() < bytes::recordings::kMostLabelBytes)
      line_ += letter;
  }
}

void TypedMarks::mark(std::string label) {
  const std::lock_guard lock(mutex_);
  if (!begin_) return;
  marks_.push_back({.time = Clock::now() - *begin_, .label = std::move(label)});
  const Status written = bytes::recordings::write_marks(recording_, Nanos{}, marks_);
  if (written) return;
  marks_.pop_back();
  print_notice("not marked: " + written.error().message);
}

}  // namespace dermis::app
