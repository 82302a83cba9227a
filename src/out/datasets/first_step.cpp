// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/episodes.hpp"
#include "dermis/out/datasets/step_plan.hpp"
#include "out/datasets/recorded_arrays.hpp"

namespace dermis::out::datasets {

Result<Nanos> first_step(const std::string& recording, double fps) {
  if (Status valid = EpisodeOptions{.fps = fps}.validate(); !valid) return valid.error();
  Result<RecordedArrays> opened = RecordedArrays::open(recording, {}, {});
  if (!opened) return opened.error();
  StepPlan plan(opened->arrays().size(), 1, fps);
  std::size_t array = 0;
  RawFrame frame;
  while (!plan.next()) {
    const Result<bool> more = opened->next(array, frame);
    if (!more) return more.error();
    if (!*more) break;
    plan.see(array, frame.time);
  }
  if (!plan.newest()) return bad_input(recording + ": has no frame");
  return plan.next().value_or(*plan.newest());
}

}  // namespace dermis::out::datasets
