// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/out/report/frame_picture.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "views/array_view.hpp"

namespace dermis::views {

/// How long a picture of a film is seen.
inline constexpr Nanos kPictureTime = std::chrono::milliseconds(40);
inline constexpr std::size_t kMostPictures = 1500;  ///< Of a film.

/// The frames to draw, by their number from 0 or by their times after the first.
struct PictureRange {
  std::optional<std::size_t> number{};  ///< Number of the only frame; empty: the first from `from` on.
  Nanos from{};
  std::optional<Nanos> to{};  ///< Later than `from`: a picture every kPictureTime of the recording, each of the last
                              ///< frame before that moment. Empty: one frame is drawn.
};

/// At least one picture, each with its time after the first frame, the contacts and their total. `view` stands before
/// its first frame. `high`: end of the colour scale of all pictures; empty: ArrayView::scale() of the largest value
/// that is drawn. A film ends early with its source and where `stop` (null: nothing) is set. Fails where the
/// source does, where it ends or is stopped before the first picture, and on more than kMostPictures.
[[nodiscard]] Result<std::vector<out::report::FramePicture>> draw_pictures(ArrayView& view, const PictureRange& range,
                                                                           std::optional<double> high = {},
                                                                           const std::atomic<bool>* stop = nullptr);

}  // namespace dermis::views
