// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/recognition/classes.hpp"
#include "dermis/learn/recognition/examples.hpp"
#include "dermis/learn/recognition/touch_finder.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::recognition {

/// The evidence of some of the features by themselves.
struct Aspect {
  std::string name;             ///< In plain words: "place", "force", "area", "shape", "time", "the further readings".
  double discrimination = 0.0;  ///< Mean over two classes of the share of examples that is right by it alone, 0 ... 1.
};

/// Two classes that are taken for each other.
struct ConfusedPair {
  std::size_t first = 0;
  std::size_t second = 0;
  std::size_t mistakes = 0;     ///< Examples of one that were answered with the other.
  std::vector<Aspect> aspects;  ///< In which they are most alike first.
};

/// An answer to an example by what other folds taught.
struct Judgement {
  std::size_t example = 0;  ///< Its place among those chosen.
  std::size_t truth = 0;    ///< The class that it is.
  std::size_t answer = 0;   ///< The likeliest class.
  double probability = 0.0;
};

/// The results of the classes on examples that they had not learned from: each fold by what the others taught.
struct LearningReport {
  bool by_group = false;  ///< Whole subjects or sessions were held out; else runs in order of time.
  std::size_t folds = 0;
  std::size_t groups = 0;                  ///< Subjects or sessions that the labels name; 0 where some name none.
  std::size_t largest_group = 0;           ///< Examples of the largest of those.
  std::vector<std::size_t> in_one_fold{};  ///< [classes]: examples in the fold that has most of a class.
  std::vector<std::size_t> confusion;      ///< [classes, classes]: right class, answered class; of examples.
  std::size_t judged = 0;                  ///< Examples in `confusion`: not those whose class was in no other fold.
  double accuracy = 0.0;                   ///< Share of those that were right, 0 ... 1.
  double calibration_error = 0.0;          ///< Expected calibration error over 10 bins, 0 ... 1.
  std::vector<std::size_t> fold_of{};      ///< Of each example chosen.
  std::vector<Judgement> judgements{};     ///< Judgements of the examples in `confusion`, in order.
  std::optional<ConfusedPair> confused{};  ///< Most often; empty where no two are.
};

struct Learned {
  Classes classes;
  LearningReport report;
};

/// Labelled segments and their features, of which classes are learned. Thread-safe once made.
class LearningSet {
 public:
  /// Computes the features of all labels. `progress` gets the share that is done. Fails on what
  /// LabelledFrames::validate() refuses.
  [[nodiscard]] static Result<LearningSet> create(const LabelledFrames& data,
                                                  const std::function<void(double)>& progress = {});
  LearningSet(LearningSet&&) noexcept;
  LearningSet& operator=(LearningSet&&) noexcept;
  ~LearningSet();

  /// Learns from some of the labels, by their place. Fails on a single class, on more than 1000, on a class with one
  /// example, and where no class differs from another in anything.
  [[nodiscard]] Result<Learned> learn(std::span<const std::size_t> chosen) const;

  /// [labels, features] of all labels.
  [[nodiscard]] std::span<const double> features() const noexcept;

 private:
  struct State;
  explicit LearningSet(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Where touches begin and end, as all labels have it. Empty where there is nothing to learn it from: where examples
/// are single frames, or the labels leave fewer than a tenth of the frames.
[[nodiscard]] std::optional<TouchLimits> learn_touches(const LabelledFrames& data);

/// How well these limits find the labels again.
[[nodiscard]] FindingReport judge_touches(const LabelledFrames& data, const TouchLimits& limits);

/// Advice on the examples, a line each: which classes need more of them, which two are confused, and what the accuracy
/// does not show.
[[nodiscard]] std::vector<std::string> advice(const Learned& learned);

}  // namespace dermis::learn::recognition
