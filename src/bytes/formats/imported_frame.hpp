// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <utility>

#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// Leaves nothing of another source in the frame but its buffers.
inline void begin_frame(RawFrame& frame, Nanos time) {
  frame.time = time;
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.acquisition = {};
}

/// When frame `index` of a file without times was taken.
[[nodiscard]] Result<Nanos> time_of_frame(const std::string& place, std::size_t index, double rate_hz);

/// Gives notice that the last frame is left out.
void tell_cut(const ImportOptions& options, const std::string& place, std::size_t frames);

/// A source of frames that its open() has found to be good.
template <typename Source>
Result<std::unique_ptr<FrameSource>> open_as(std::unique_ptr<std::istream> in, const std::string& name,
                                             const ImportOptions& options) {
  auto source = std::make_unique<Source>(std::move(in), name, options);
  if (const Status opened = source->open(); !opened) return opened.error();
  return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace dermis::bytes::formats
