// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "dermis/out/report/terminal_picture.hpp"
#include "dermis/touch/frames/result.hpp"
#include "views/array_view.hpp"

namespace dermis::views {

/// Reads the frames of a view on a thread of its own, for callers that draw one now and then. Frames of a file come at
/// their pace.
class ViewPlayer {
 public:
  /// Begins. `stop`: what the source of the view was opened with; it ends the playing, and the end of the player sets
  /// it. `high`: end of the colour scale; empty: ArrayView::scale() of the largest value so far. The view and `stop`
  /// must outlive the player.
  ViewPlayer(ArrayView& view, std::atomic<bool>& stop, std::optional<double> high = {});
  ViewPlayer(const ViewPlayer&) = delete;
  ViewPlayer& operator=(const ViewPlayer&) = delete;
  ~ViewPlayer();

  /// The picture of the last frame; without values before the first. Thread-safe.
  [[nodiscard]] out::report::TerminalPicture picture() const;
  /// Whether the source has failed. Thread-safe.
  [[nodiscard]] Status status() const;

 private:
  void run();
  void update();

  ArrayView& view_;
  std::atomic<bool>& stop_;
  std::optional<double> high_;
  double largest_ = 0.0;
  mutable std::mutex mutex_;  ///< Of the next two.
  out::report::TerminalPicture picture_;
  Status status_ = Done{};
  std::thread thread_;  ///< The last: it uses all others.
};

}  // namespace dermis::views
