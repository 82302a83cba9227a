// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/window_decoder.hpp"

#include <cassert>
#include <utility>

namespace dermis::bytes::layouts {
namespace {

/// Times are the caller's.
void clear(RawFrame& frame) {
  frame.temperature_celsius.reset();
  frame.sensor_celsius.clear();
  frame.supply_v.reset();
  frame.acquisition.sequence.reset();
  frame.acquisition.device_time.reset();
  frame.acquisition.lost_before = 0;
  frame.acquisition.held_taxels = 0;
}

}  // namespace

bool WindowDecoder::next(RawFrame& frame) {
  while (!window_.bytes().empty()) {
    clear(frame);
    const Verdict verdict = judge(window_.bytes(), ended_, frame);
    assert(verdict.size <= window_.bytes().size());
    switch (verdict.kind) {
      case Verdict::Kind::undecided:
        if (!ended_) return false;
        skip(window_.bytes().size());
        break;
      case Verdict::Kind::noise: skip(verdict.size); break;
      case Verdict::Kind::damaged:
        ++counts_.damaged_frames;
        skip(verdict.size);
        break;
      case Verdict::Kind::frame:
        window_.drop(verdict.size);
        frame_end_ = window_.position();
        ++counts_.frames;
        counts_.lost_frames += frame.acquisition.lost_before;
        return true;
    }
  }
  if (std::exchange(ended_, false)) begin_again();
  return false;
}

void WindowDecoder::skip(std::size_t size) {
  window_.drop(size);
  counts_.skipped_bytes += size;
}

}  // namespace dermis::bytes::layouts
