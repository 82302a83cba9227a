// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/saved_minute.hpp"

#include <algorithm>
#include <utility>

#include "dermis/bytes/files/forces_csv.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "out/serve/suit/saved_files.hpp"

namespace dermis::out::serve {
namespace {

struct FrameOfArray {
  std::size_t array = 0;
  RawFrame frame;
};

Error nothing_there() {
  return bad_input("there is no frame of that time any more; the last minute is kept");
}

}  // namespace

Result<std::vector<RawFrame>> selected_frames(const LastMinute& minute, std::size_t array, const Selection& selection) {
  std::vector<RawFrame> frames = minute.frames(array, selection.first, selection.last);
  if (frames.empty()) return nothing_there();
  return frames;
}

Status save_csv(std::span<const RawFrame> frames, FrameShape shape, const std::string& path) {
  const auto take = [&](std::size_t number, RawFrame& frame) { frame = frames[number]; };
  return write_frames(path, shape, frames.size(), take);
}

Status save_forces(std::span<const RawFrame> frames, const touch::pipeline::Model& model, const std::string& path) {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  Result<bytes::files::ForcesCsvWriter> writer =
      bytes::files::ForcesCsvWriter::create(path, model.array.rows, model.array.cols);
  if (!writer) return writer.error();
  ForceFrame force;
  for (const RawFrame& frame : frames) {
    pipeline->process(frame, force);
    if (Status written = writer->write(force); !written) return written;
  }
  return writer->commit();
}

Result<std::size_t> save_recording(const LastMinute& minute,
                                   const std::vector<bytes::recordings::RecordedArray>& arrays,
                                   const Selection& selection, const std::string& path) {
  std::vector<FrameOfArray> frames;
  for (std::size_t array = 0; array < arrays.size(); ++array) {
    for (RawFrame& frame : minute.frames(array, selection.first, selection.last)) {
      frames.push_back({array, std::move(frame)});
    }
  }
  if (frames.empty()) return nothing_there();
  std::ranges::stable_sort(frames, {}, [](const FrameOfArray& one) { return one.frame.time; });
  const auto writer = bytes::recordings::SuitRecordingWriter::create(path, arrays, {.live = false});
  if (!writer) return writer.error();
  for (const FrameOfArray& one : frames) {
    if (Status written = (*writer)->write(one.array, one.frame); !written) return written.error();
  }
  if (Status complete = (*writer)->commit(); !complete) return complete.error();
  return frames.size();
}

}  // namespace dermis::out::serve
