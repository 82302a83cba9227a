// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/frame_window.hpp"

#include <utility>

namespace dermis::out::datasets {

std::optional<std::size_t> FrameWindow::add(Nanos time) {
  if (newest_ && time < *newest_) {
    ++missed_;
    return std::nullopt;
  }
  newest_ = time;
  if (free_.empty()) free_.push_back(slots_++);
  waiting_.push_back({free_.back(), time});
  free_.pop_back();
  return waiting_.back().slot;
}

void FrameWindow::step(Nanos time) {
  came_ = std::exchange(skipped_, 0);
  for (; !waiting_.empty() && waiting_.front().time <= time; ++came_) {
    if (held_.size() == length_) {
      free_.push_back(held_.front().slot);
      held_.pop_front();
    }
    held_.push_back(waiting_.front());
    waiting_.pop_front();
  }
  missed_ += came_ - fresh();
}

void FrameWindow::await(Nanos next) {
  const auto is_later = [next](const Held& frame) { return frame.time > next; };
  const auto later = std::find_if(waiting_.begin(), waiting_.end(), is_later);
  for (auto count = static_cast<std::size_t>(later - waiting_.begin()); count > length_; --count) {
    free_.push_back(waiting_.front().slot);
    waiting_.pop_front();
    ++skipped_;
  }
}

}  // namespace dermis::out::datasets
