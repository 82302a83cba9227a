// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <numeric>
#include <utility>

#include "dermis/learn/recognition/learning.hpp"
#include "learn/recognition/learning/folds.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::int64_t kFewExamples = 5;
constexpr double kPoorRecall = 0.7;
constexpr double kPoorCalibration = 0.15;

std::size_t examples_of(const LearningReport& report, std::size_t label, std::size_t class_count) {
  const auto row = report.confusion.begin() + static_cast<std::ptrdiff_t>(label * class_count);
  return std::accumulate(row, row + static_cast<std::ptrdiff_t>(class_count), std::size_t{0});
}

/// Empty where the class has enough of them.
std::string need_of(const Learned& learned, std::size_t label) {
  const std::size_t class_count = learned.classes.names.size();
  const std::string& name = learned.classes.names[label];
  const std::int64_t examples = learned.classes.examples[label];
  const std::size_t judged = examples_of(learned.report, label, class_count);
  const std::size_t right = learned.report.confusion[label * class_count + label];
  if (examples < kFewExamples) {
    return name + " needs more examples: it has " + std::to_string(examples) + ", fewer than " +
           std::to_string(kFewExamples);
  }
  if (judged == 0) return name + " needs examples of another subject or session: all are of one";
  const std::size_t most = learned.report.by_group ? learned.report.in_one_fold[label] : 0;
  if (is_lopsided(most, static_cast<std::size_t>(examples))) {
    return name + " needs examples of another subject or session: " + std::to_string(most) + " of " +
           std::to_string(examples) + " are held out at once, so its figures tell little";
  }
  if (static_cast<double>(right) >= kPoorRecall * static_cast<double>(judged)) return {};
  return name + " needs more examples: " + std::to_string(right) + " of " + std::to_string(judged) + " were right";
}

std::string whole_percent(double share) {
  return std::to_string(static_cast<int>(std::round(100.0 * share))) + " %";
}

/// The two classes that are most often taken for each other, and by what.
std::string confused_pair(const Learned& learned) {
  if (!learned.report.confused) return {};
  const ConfusedPair& pair = *learned.report.confused;
  const std::size_t count = learned.classes.names.size();
  const std::size_t judged =
      examples_of(learned.report, pair.first, count) + examples_of(learned.report, pair.second, count);
  std::string line = learned.classes.names[pair.first] + " and " + learned.classes.names[pair.second] +
                     " are confused most: " + std::to_string(pair.mistakes) + " of " + std::to_string(judged) +
                     " examples";
  if (pair.aspects.empty()) return line;
  line += "; guessing tells 50 % apart";
  for (const Aspect& aspect : pair.aspects)
    line += ", " + aspect.name + " alone " + whole_percent(aspect.discrimination);
  return line;
}

std::string lopsided_groups(const Learned& learned) {
  std::size_t examples = 0;
  for (const std::int64_t count : learned.classes.examples) examples += static_cast<std::size_t>(count);
  return "the folds are by class, not by subject or session: most classes would have had too few examples left (the "
         "largest subject or session has " +
         std::to_string(learned.report.largest_group) + " of " + std::to_string(examples) +
         "); what another one gives is not known";
}

}  // namespace

std::vector<std::string> advice(const Learned& learned) {
  std::vector<std::string> lines;
  const auto add_line = [&](std::string line) {
    if (!line.empty()) lines.push_back(std::move(line));
  };
  for (std::size_t label = 0; label < learned.classes.names.size(); ++label) add_line(need_of(learned, label));
  add_line(confused_pair(learned));
  if (learned.report.groups == 1)
    add_line("all examples are of one subject or session: what another one gives is not known");
  if (learned.report.groups > 1 && !learned.report.by_group) add_line(lopsided_groups(learned));
  if (learned.report.calibration_error > kPoorCalibration) {
    add_line("the probabilities are not to be trusted: they are off by " +
             std::to_string(static_cast<int>(100.0 * learned.report.calibration_error)) + " % on average");
  }
  return lines;
}

}  // namespace dermis::learn::recognition
