// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/recogniser.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "dermis/bytes/files/text.hpp"
#include "learn/recognition/answer/kernel_distance.hpp"
#include "learn/recognition/answer/rank_table.hpp"
#include "learn/recognition/answer/softmax.hpp"
#include "learn/recognition/features/segment_features.hpp"
#include "learn/recognition/features/standardisation.hpp"
#include "learn/recognition/matrix.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr double kMostRateRatio = 1000.0;

using FloatMap = Eigen::Map<const Eigen::VectorXf>;

double dot(const float* a, const std::vector<float>& b, std::size_t count) {
  return static_cast<double>(FloatMap(a, index(count)).dot(FloatMap(b.data(), index(count))));
}

/// An expert at work.
class ExpertAtWork {
 public:
  ExpertAtWork(const Expert& expert, std::size_t class_count)
      : deviations_(expert.columns.size()), place_(expert.rank), scores_(class_count) {
    for (std::size_t label = 0; label < class_count; ++label) {
      const FloatMap mean(expert.class_means.data() + label * expert.rank, index(expert.rank));
      half_squares_.push_back(0.5 * static_cast<double>(mean.squaredNorm()));
    }
  }

  void score(const Expert& expert, std::span<const double> features) {
    const std::size_t columns = expert.columns.size();
    for (std::size_t i = 0; i < columns; ++i) {
      const double value = features[static_cast<std::size_t>(expert.columns[i])];
      const double deviation = (value - static_cast<double>(expert.mean[i])) * static_cast<double>(expert.scale[i]);
      const double clipped = std::clamp(deviation, -kMostDeviations, kMostDeviations);
      deviations_[i] = std::isfinite(deviation) ? static_cast<float>(clipped) : 0.0F;
    }
    if (expert.centres.empty()) return discriminate(expert);
    compare(expert);
  }

  [[nodiscard]] const std::vector<double>& scores() const noexcept { return scores_; }
  [[nodiscard]] double distance(const Expert& expert, std::size_t label) const {
    return expert.centres.empty() ? std::sqrt(std::max(square_ - 2.0 * scores_[label], 0.0))
                                  : kernel_distance(scores_[label]);
  }

 private:
  void discriminate(const Expert& expert) {
    const std::size_t columns = expert.columns.size();
    for (std::size_t axis = 0; axis < expert.rank; ++axis) {
      place_[axis] = static_cast<float>(dot(expert.axes.data() + axis * columns, deviations_, columns));
    }
    square_ = dot(place_.data(), place_, expert.rank);
    for (std::size_t label = 0; label < scores_.size(); ++label) {
      scores_[label] = dot(expert.class_means.data() + label * expert.rank, place_, expert.rank) - half_squares_[label];
    }
  }

  /// Compares with the centres of the kernels.
  void compare(const Expert& expert) {
    const std::size_t columns = expert.columns.size();
    const FloatMap here(deviations_.data(), index(columns));
    std::fill(scores_.begin(), scores_.end(), 0.0);
    const float* influence = expert.influences.data();
    for (const float* centre = expert.centres.data(); influence != expert.influences.data() + expert.influences.size();
         centre += columns) {
      const auto square = static_cast<double>((here - FloatMap(centre, index(columns))).squaredNorm());
      const double likeness = std::exp(-expert.width * square);
      for (double& score : scores_) score += likeness * static_cast<double>(*influence++);
    }
  }

  std::vector<double> half_squares_;  ///< Of the means of the classes.
  std::vector<float> deviations_;
  std::vector<float> place_;  ///< Along the axes.
  std::vector<double> scores_;
  double square_ = 0.0;
};

std::string in_hz(double rate) {
  std::string text;
  bytes::files::append_number(text, rate);
  return text + " Hz";
}

std::string size_of(const SensedArray& array) {
  return std::to_string(array.rows) + "x" + std::to_string(array.cols);
}

Status check_array(const SensedArray& examples, const SensedArray& source) {
  const bool is_same_size = examples.rows == source.rows && examples.cols == source.cols;
  if (is_same_size || (examples.has_pitch() && source.has_pitch())) return Done{};
  return bad_input("array '" + source.name + "' has " + size_of(source) + " taxels, the examples were of '" +
                   examples.name + "' with " + size_of(examples) +
                   "; classes move to an array of another size where the pitch of both is known");
}

Status check_rate(double examples_hz, double source_hz) {
  if (examples_hz == 0.0 || source_hz == 0.0) return Done{};
  const double ratio = source_hz / examples_hz;
  if (ratio >= 1.0 / kMostRateRatio && ratio <= kMostRateRatio) return Done{};
  return bad_input("the rate is " + in_hz(source_hz) + ", that of the examples " + in_hz(examples_hz) +
                   "; classes move to a rate at most 1000 times higher or lower");
}

std::string list_of(const std::vector<SensedArray>& arrays) {
  std::string names;
  for (const SensedArray& array : arrays) names += (names.empty() ? "'" : ", '") + array.name + "'";
  return names;
}

Status check_source(const Layout& examples, const Layout& source) {
  if (Status checked = source.validate(); !checked) return checked;
  if (Status checked = check_rate(examples.rate_hz, source.rate_hz); !checked) return checked;
  if (source.arrays.size() != examples.arrays.size()) {
    return bad_input("there are " + std::to_string(source.arrays.size()) + " arrays, the examples had " +
                     std::to_string(examples.arrays.size()));
  }
  if (source.extras != examples.extras) {
    return bad_input("there are " + std::to_string(source.extras) +
                     " further readings beside a frame, the examples had " + std::to_string(examples.extras));
  }
  if (source.arrays.size() > 1 && names_of(source.arrays) != names_of(examples.arrays)) {
    return bad_input("its arrays are " + list_of(source.arrays) + ", the examples were of " + list_of(examples.arrays) +
                     "; arrays of the same names must come, in the same order");
  }
  for (std::size_t i = 0; i < source.arrays.size(); ++i) {
    if (Status checked = check_array(examples.arrays[i], source.arrays[i]); !checked) return checked;
  }
  return Done{};
}

/// Returns what the largest one is, and the second.
std::pair<std::size_t, std::size_t> two_largest(std::span<const double> values) {
  std::size_t first = values[1] > values[0] ? 1 : 0;
  std::size_t second = 1 - first;
  for (std::size_t i = 2; i < values.size(); ++i) {
    if (values[i] > values[first]) {
      second = std::exchange(first, i);
    } else if (values[i] > values[second]) {
      second = i;
    }
  }
  return {first, second};
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::known: return "known";
    case Verdict::unlike_examples: return "unlike the examples";
    default: return "between classes";
  }
}

struct Recogniser::State {
  Classes classes;
  SegmentFeatures features;
  std::vector<ExpertAtWork> experts;
  std::vector<double> probabilities;
};

Result<Recogniser> Recogniser::create(Classes classes, const Layout& source, std::size_t most_frames) {
  assert(most_frames > 0);
  if (Status checked = classes.validate(); !checked) return checked.error();
  if (Status checked = check_source(classes.layout, source); !checked) return checked.error();
  SegmentFeatures features(classes.layout, source, classes.moving, most_frames);
  std::vector<ExpertAtWork> experts;
  for (const Expert& expert : classes.experts) experts.emplace_back(expert, classes.names.size());
  std::vector<double> probabilities(classes.names.size());
  return Recogniser(std::make_unique<State>(
      State{std::move(classes), std::move(features), std::move(experts), std::move(probabilities)}));
}

Recogniser::Recogniser(std::unique_ptr<State> state) : state_(std::move(state)) {}
Recogniser::Recogniser(Recogniser&&) noexcept = default;
Recogniser& Recogniser::operator=(Recogniser&&) noexcept = default;
Recogniser::~Recogniser() = default;

const Classes& Recogniser::classes() const noexcept {
  return state_->classes;
}

Answer Recogniser::recognise(const Segment& segment) {
  auto& [classes, features, experts, probabilities] = *state_;
  const std::span<const double> values = features.compute(segment);
  std::fill(probabilities.begin(), probabilities.end(), 0.0);
  for (std::size_t i = 0; i < experts.size(); ++i) {
    experts[i].score(classes.experts[i], values);
    for (std::size_t label = 0; label < probabilities.size(); ++label) {
      probabilities[label] += classes.experts[i].weight * experts[i].scores()[label];
    }
  }
  softmax(probabilities);
  const auto [likeliest, second] = two_largest(probabilities);
  Answer answer{probabilities, likeliest, second};
  double strangeness = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < experts.size(); ++i) {
    const Expert& expert = classes.experts[i];
    strangeness += expert.unknown_weight * rank_in(expert.distances, experts[i].distance(expert, likeliest));
    weights += expert.unknown_weight;
  }
  const double doubt = rank_in(classes.doubts, 1.0 - probabilities[likeliest]);
  answer.unknown_score = strangeness + classes.doubt_weight * doubt;
  if (!(answer.unknown_score <= classes.unknown_from)) {
    const bool is_strange = !std::isfinite(answer.unknown_score) || (weights > 0.0 && strangeness >= weights * doubt);
    answer.verdict = is_strange ? Verdict::unlike_examples : Verdict::between_classes;
  }
  return answer;
}

}  // namespace dermis::learn::recognition
