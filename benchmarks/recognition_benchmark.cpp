// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Time of one decision, one thread: a frame to the probabilities of ten classes and the unknown score.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "dermis/learn/recognition/learning.hpp"
#include "dermis/learn/recognition/recogniser.hpp"
#include "dermis/touch/frames/random.hpp"
#include "frame_times.hpp"
#include "rows.hpp"

namespace dermis {
namespace {

constexpr std::size_t kClasses = 10;
constexpr std::size_t kExamples = 10;  // of each class

/// Ellipses whose size and direction tell the class, somewhere near the middle.
std::vector<float> touch(Random& random, std::size_t rows, std::size_t cols, std::size_t kind) {
  const double angle = 0.3 * static_cast<double>(kind);
  const double length = 1.5 + 0.3 * static_cast<double>(kind % 4);
  const double middle_row = 0.5 * static_cast<double>(rows) + random.uniform(-2.0, 2.0);
  const double middle_col = 0.5 * static_cast<double>(cols) + random.uniform(-2.0, 2.0);
  std::vector<float> frame(rows * cols);
  for (std::size_t taxel = 0; taxel < frame.size(); ++taxel) {
    const std::size_t row = taxel / cols;
    const double y = static_cast<double>(row) - middle_row;
    const double x = static_cast<double>(taxel % cols) - middle_col;
    const double along = (x * std::cos(angle) + y * std::sin(angle)) / length;
    const double across = y * std::cos(angle) - x * std::sin(angle);
    const double reading = 800.0 * std::exp(-0.5 * (along * along + across * across)) + 2.0 * random.normal();
    frame[taxel] = static_cast<float>(std::max(reading, 0.0));
  }
  return frame;
}

learn::recognition::LabelledFrames examples(std::size_t rows, std::size_t cols) {
  Random random(1);
  learn::recognition::LabelledFrames data;
  data.layout.arrays = {{"skin", rows, cols, 0, 0.0, 0.0}};
  data.layout.readings = rows * cols;
  for (std::size_t i = 0; i < kClasses * kExamples; ++i) {
    const std::vector<float> frame = touch(random, rows, cols, i % kClasses);
    data.frames.insert(data.frames.end(), frame.begin(), frame.end());
    data.labels.push_back(
        {std::to_string(i), i, i, "class " + std::to_string(i % kClasses), "", static_cast<double>(i)});
  }
  return data;
}

void frame_to_class(benchmark::State& state) {
  const auto rows = static_cast<std::size_t>(state.range(0));
  const auto cols = static_cast<std::size_t>(state.range(1));
  const learn::recognition::LabelledFrames data = examples(rows, cols);
  std::vector<std::size_t> all(data.labels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto learned = learn::recognition::LearningSet::create(data)->learn(all);
  auto recogniser = learn::recognition::Recogniser::create(learned->classes, data.layout, 1);
  std::size_t right = 0;
  benchmarks::measure_frames(state, all.size(), [&](std::size_t k) {
    const learn::recognition::Answer answer = recogniser->recognise(data.segment(data.labels[k]));
    right += learned->classes.names[answer.likeliest] == data.labels[k].name ? 1 : 0;
  });
  state.counters["checked"] = 2 * right > all.size() ? 1 : 0;
}

BENCHMARK(frame_to_class)->Name("frame to class|dermis")->Args({16, 16})->Args({64, 32})->UseManualTime();

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  dermis::benchmarks::FrameTimesReporter reporter("one thread; ten classes, a single frame");
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("recognition", reporter.rows()) ? 0 : 1;
}
