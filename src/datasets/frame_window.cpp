// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/datasets/frame_window.hpp"

namespace dermis::datasets {

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

void FrameWindow::drop_oldest() {
  free_.push_back(held_.front().slot);
  held_.pop_front();
  if (fresh_ < length_) return;
  --fresh_;
  ++missed_;
}

void FrameWindow::step(Nanos time) {
  fresh_ = 0;
  while (!waiting_.empty() && waiting_.front().time <= time) {
    if (held_.size() == length_) drop_oldest();
    held_.push_back(waiting_.front());
    waiting_.pop_front();
    ++fresh_;
  }
}

}  // namespace dermis::datasets
