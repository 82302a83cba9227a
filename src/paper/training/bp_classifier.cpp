// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/bp_classifier.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/initialisation.hpp"
#include "dermis/paper/training.hpp"

namespace dermis::paper {
namespace {

using learn::recognition::Lesson;

constexpr std::array<std::size_t, 2> kHiddenUnits{16, 64};
constexpr std::uint64_t kMostEpochs = 200;
constexpr std::uint64_t kPatience = 20;
constexpr std::size_t kBatch = 32;
constexpr std::size_t kHeldOutOf = 5;  // where all that is taught is of one fold
constexpr std::uint64_t kSeed = 1;

/// Examples as patterns: a target is 1 for their class and 0 for all others.
struct Patterns {
  std::vector<float> inputs;
  std::vector<float> targets;

  [[nodiscard]] Samples<float> samples(const Lesson& lesson) const {
    return {inputs.size() / lesson.features, inputs, targets, {}};
  }
  void add(const Lesson& lesson, std::size_t example) {
    const auto row = lesson.taught.begin() + static_cast<std::ptrdiff_t>(example * lesson.features);
    inputs.insert(inputs.end(), row, row + static_cast<std::ptrdiff_t>(lesson.features));
    targets.insert(targets.end(), lesson.classes, 0.0F);
    targets[targets.size() - lesson.classes + lesson.class_of[example]] = 1.0F;
  }
};

/// The patterns that choose the size and the end of the training, and the rest.
struct Division {
  Patterns learned;
  Patterns held_out;
};

Division divide(const Lesson& lesson) {
  const auto [first, last] = std::minmax_element(lesson.fold_of.begin(), lesson.fold_of.end());
  const bool is_one_fold = *first == *last;
  Division division;
  for (std::size_t i = 0; i < lesson.class_of.size(); ++i) {
    const bool is_held_out = is_one_fold ? i % kHeldOutOf == 0 : lesson.fold_of[i] == *last;
    (is_held_out ? division.held_out : division.learned).add(lesson, i);
  }
  return division;
}

NetworkShape shape_of(const Lesson& lesson, std::size_t hidden) {
  return {lesson.features, {{hidden, Activation::tanh}, {lesson.classes, Activation::log_sigmoid}}};
}

/// [patterns, classes]
std::vector<float> outputs_of(const NetworkShape& shape, const std::vector<float>& parameters,
                              const std::vector<float>& inputs) {
  std::vector<float> outputs(inputs.size() / shape.inputs * shape.outputs());
  FeedForward<float>(shape).evaluate(parameters, inputs, outputs);
  return outputs;
}

std::size_t count_right(const std::vector<float>& outputs, const std::vector<float>& targets, std::size_t classes) {
  std::size_t right = 0;
  for (std::size_t begin = 0; begin < outputs.size(); begin += classes) {
    const auto row = outputs.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto largest = std::max_element(row, row + static_cast<std::ptrdiff_t>(classes)) - row;
    right += targets[begin + static_cast<std::size_t>(largest)] > 0.0F ? 1 : 0;
  }
  return right;
}

/// An output is the probability of its class against all others: their odds are shared out.
void to_probabilities(std::vector<float>& outputs, std::size_t classes) {
  constexpr float kLeast = 1e-6F;
  for (float& output : outputs) output = std::max(output, kLeast) / std::max(1.0F - output, kLeast);
  for (auto row = outputs.begin(); row != outputs.end(); row += static_cast<std::ptrdiff_t>(classes)) {
    const auto end = row + static_cast<std::ptrdiff_t>(classes);
    const float sum = std::accumulate(row, end, 0.0F);
    std::for_each(row, end, [sum](float& odds) { odds /= sum; });
  }
}

/// Returns the parameters after `epochs`, or where `goes_on` ends the training.
Result<std::vector<float>> trained_parameters(const NetworkShape& shape, const Samples<float>& samples,
                                              std::uint64_t epochs, const TrainingCallback<float>& goes_on) {
  TrainingOptions options;
  options.algorithm = TrainingAlgorithm::adam;
  options.batch = kBatch;
  options.rate = 0.003;
  options.epochs = epochs;
  options.seed = kSeed;
  TrainingState<float> state = start_training(shape, xavier_start<float>(shape, kSeed), options);
  const Result<TrainingReport> report = train(state, samples, options, {}, goes_on);
  if (!report) return report.error();
  return state.parameters;
}

/// How well a size does on what is held out, and after how many epochs.
struct Trial {
  std::size_t right = 0;
  std::uint64_t epochs = 1;
};

Result<Trial> try_out(const NetworkShape& shape, const Lesson& lesson, const Division& division) {
  Trial best;
  const auto look = [&](const TrainingState<float>& state) {
    const std::vector<float> outputs = outputs_of(shape, state.parameters, division.held_out.inputs);
    const std::size_t right = count_right(outputs, division.held_out.targets, lesson.classes);
    if (right > best.right) best = {right, state.epoch};
    return state.epoch < best.epochs + kPatience;
  };
  const auto trained = trained_parameters(shape, division.learned.samples(lesson), kMostEpochs, look);
  if (!trained) return trained.error();
  return best;
}

}  // namespace

Result<std::vector<float>> answer_by_bp_network(const Lesson& lesson) {
  const Division division = divide(lesson);
  Trial best;
  NetworkShape shape = shape_of(lesson, kHiddenUnits.front());
  for (const std::size_t hidden : kHiddenUnits) {
    const Result<Trial> trial = try_out(shape_of(lesson, hidden), lesson, division);
    if (!trial) return trial.error();
    if (trial->right <= best.right) continue;
    best = *trial;
    shape = shape_of(lesson, hidden);
  }
  Patterns all;
  for (std::size_t i = 0; i < lesson.class_of.size(); ++i) all.add(lesson, i);
  const auto parameters = trained_parameters(shape, all.samples(lesson), best.epochs, {});
  if (!parameters) return parameters.error();
  std::vector<float> answers = outputs_of(shape, *parameters, lesson.asked);
  to_probabilities(answers, lesson.classes);
  return answers;
}

}  // namespace dermis::paper
