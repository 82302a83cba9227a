// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: 04_record_and_replay MODEL FRAMES REC.mcap
// Records what a device sends while its forces are computed, and replays the recording: the forces are the same bits.
// The device is played from a file of frames, in the protocol of dermis; a real one is 'serial:///dev/ttyACM0?...'.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>

#include "dermis/bytes/devices/device_source.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace {

using dermis::ForceFrame;
using dermis::FrameShape;
using dermis::FrameSource;
using dermis::RawFrame;
using dermis::Result;
using dermis::Status;

/// What a device would have sent of the frames of a file.
Status send(FrameSource& frames, const FrameShape& shape, const std::string& path) {
  const auto encoder = dermis::bytes::devices::make_encoder({.name = "dermis", .shape = shape});
  if (!encoder) return encoder.error();
  std::vector<std::uint8_t> bytes;
  RawFrame frame;
  for (;;) {
    const Result<bool> more = frames.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    (*encoder)->encode(frame, bytes);
  }
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) return dermis::failed("cannot write " + path);
  return dermis::Done{};
}

/// The forces of all frames of `source`, which go into `sink` on the way where there is one.
Result<std::vector<float>> forces_of(const dermis::touch::pipeline::Model& model, FrameSource& source,
                                     dermis::FrameSink* sink) {
  auto pipeline = dermis::touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  std::vector<float> newtons;
  RawFrame raw;
  ForceFrame force;
  for (;;) {
    const Result<bool> more = source.next(raw);
    if (!more) return more.error();
    if (!*more) break;
    if (sink != nullptr) {
      if (const Status written = sink->write(raw); !written) return written.error();
    }
    pipeline->process(raw, force);
    newtons.insert(newtons.end(), force.newtons.begin(), force.newtons.end());
  }
  if (sink != nullptr) {
    if (const Status complete = sink->commit(); !complete) return complete.error();
  }
  return newtons;
}

Status run(const std::string& model_path, const std::string& frames_path, const std::string& recording_path) {
  const auto model = dermis::bytes::models::read_model(model_path);
  if (!model) return model.error();
  const FrameShape shape{model->array.rows, model->array.cols};
  const auto frames = dermis::bytes::recordings::open_frames(frames_path, {.shape = shape});
  if (!frames) return frames.error();
  const std::string sent = recording_path + ".bytes";
  if (Status done = send(**frames, shape, sent); !done) return done;

  const auto device = dermis::bytes::devices::open_device("file:" + sent + "?protocol=dermis", {.shape = shape});
  if (!device) return device.error();
  const auto recording = dermis::bytes::recordings::RecordingWriter::create(recording_path, shape);
  if (!recording) return recording.error();
  const auto live = forces_of(*model, **device, recording->get());
  if (!live) return live.error();

  const auto replay = dermis::bytes::recordings::open_frames(recording_path);
  if (!replay) return replay.error();
  const auto replayed = forces_of(*model, **replay, nullptr);
  if (!replayed) return replayed.error();
  std::printf("%zu frames recorded; replayed forces are %s\n", live->size() / shape.taxel_count(),
              *replayed == *live ? "the same" : "different");
  return dermis::Done{};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: 04_record_and_replay MODEL FRAMES REC.mcap\n");
    return 1;
  }
  const Status done = run(argv[1], argv[2], argv[3]);
  if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
  return done ? 0 : 1;
}
