// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// whole_recording MODEL FRAMES PASSES: processor time [us] of a frame of a recording, counts to newtons, for each pass:
// where each force is forgotten, and where all are kept. It is what scripts/python_speed compares Python with.
#include <fmt/core.h>

#include <charconv>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis {
namespace {

int fail(const std::string& why) {
  fmt::print(stderr, "whole_recording: {}\n", why);
  return 2;
}

double microseconds_of_thread() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

/// Of a frame, with keep() for each force.
template <typename Keep>
double time_of_frame(const touch::pipeline::Model& model, const std::vector<RawFrame>& frames, const Keep& keep) {
  touch::pipeline::Pipeline pipeline = touch::pipeline::Pipeline::create(model).value();
  ForceFrame force;
  const double begin = microseconds_of_thread();
  for (const RawFrame& frame : frames) {
    pipeline.process(frame, force);
    keep(force);
  }
  return (microseconds_of_thread() - begin) / static_cast<double>(frames.size());
}

int measure(const std::string& model_path, const std::string& frames_path, int passes) {
  const Result<touch::pipeline::Model> model = bytes::models::read_model(model_path);
  if (!model) return fail(model.error().message);
  const Result<std::vector<RawFrame>> frames = bytes::recordings::read_frames(frames_path);
  if (!frames) return fail(frames.error().message);
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<ForceFrame> kept;
    const double forgotten_us = time_of_frame(*model, *frames, [](const ForceFrame&) {});
    const double kept_us = time_of_frame(*model, *frames, [&](const ForceFrame& force) { kept.push_back(force); });
    fmt::print("{:.4f} {:.4f}\n", forgotten_us, kept_us);
  }
  return 0;
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  if (argc != 4) return dermis::fail("usage: whole_recording MODEL FRAMES PASSES");
  const std::string_view text = argv[3];
  int passes = 0;
  std::from_chars(text.data(), text.data() + text.size(), passes);
  return dermis::measure(argv[1], argv[2], passes);
}
