// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "views/view_player.hpp"

#include <algorithm>

#include "dermis/live/sources/pacer.hpp"
#include "dermis/out/report/frame_picture.hpp"

namespace dermis::views {

ViewPlayer::ViewPlayer(ArrayView& view, std::atomic<bool>& stop, std::optional<double> high)
    : view_(view), stop_(stop), high_(high), thread_([this] { run(); }) {}

ViewPlayer::~ViewPlayer() {
  stop_.store(true);
  thread_.join();
}

out::report::TerminalPicture ViewPlayer::picture() const {
  const std::scoped_lock lock(mutex_);
  return picture_;
}

Status ViewPlayer::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

void ViewPlayer::run() {
  live::sources::Pacer pacer(&stop_);
  std::optional<Nanos> first;
  while (!stop_.load()) {
    const Result<bool> more = view_.next();
    if (!more || !*more) {
      const std::scoped_lock lock(mutex_);
      if (!more) status_ = more.error();
      picture_.has_ended = true;
      return;
    }
    if (!first) first = view_.raw().time;
    if (!view_.is_live() && !pacer.wait_until(live::sources::due_after(*first, view_.raw().time))) return;
    update();
  }
}

/// The scale grows where it must, and never shrinks.
void ViewPlayer::update() {
  largest_ = std::max(largest_, out::report::largest_of(view_.values()));
  const std::scoped_lock lock(mutex_);
  picture_.name = view_.name();
  picture_.unit = view_.unit();
  picture_.shape = view_.shape();
  picture_.values = view_.values();
  picture_.high = high_.value_or(view_.scale(largest_));
  picture_.has_contacts = view_.has_model();
  picture_.report = view_.contacts();
  picture_.statistics = view_.statistics();
}

}  // namespace dermis::views
