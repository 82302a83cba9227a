// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "dermis/bytes/devices/frame_queue.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::devices {

struct RecorderProgress {
  std::uint64_t frames = 0;   ///< Written.
  SourceStatistics source{};  ///< Rate, lost, damaged.
  QueueStatistics queue{};    ///< Depth and back-pressure.
};

struct RecorderOptions {
  std::optional<std::uint64_t> frames{};  ///< Stop after so many.
  std::optional<Nanos>
      duration{};  ///< Stop so long after the first frame by frame times; after the begin where none comes.
  /// Set: stop after the frame that is being read. The source watches the same flag, so record() sets it when the
  /// duration is over and the device silent.
  std::atomic<bool>* stop = nullptr;
  bool source_stops =
      false;  ///< The source ends by the flag, after delivering what it has received; record() waits for it.
  std::size_t queue_frames = 256;  ///< Frames that may wait for the sink; fewer of large ones.
  std::function<void(const RecorderProgress&)>
      progress{};  ///< Called twice a second on the writing thread; must not throw.
};

/// Makes the sink for frames of a shape.
using OpenSink = std::function<Result<std::unique_ptr<FrameSink>>(const FrameShape&)>;

/// Copies frames from source to sink without loss. The caller's thread reads, a second thread writes, with a queue
/// between them. The sink is made as soon as the shape is known: at once, or with the first frame. A source without
/// frames and shape makes none. It ends at the end of the source, by the options, or with the first error of source or
/// sink, which is returned. In every case the frames read so far are written and the sink is committed, unless there
/// are none. `last` always holds the final progress.
[[nodiscard]] Status record(FrameSource& source, const OpenSink& open_sink, const RecorderOptions& options,
                            RecorderProgress& last);

}  // namespace dermis::bytes::devices
