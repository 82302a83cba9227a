// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/comparison.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "learn/recognition/answer/calibration_error.hpp"
#include "learn/recognition/features/standardisation.hpp"

namespace dermis::learn::recognition {
namespace {

/// Counts what an estimator answers.
class Tally {
 public:
  void add(std::size_t truth, std::size_t answer, double confidence) {
    ++count_;
    right_ += truth == answer ? 1 : 0;
    calibration_.add(confidence, truth == answer);
  }
  [[nodiscard]] double accuracy() const {
    return static_cast<double>(right_) / static_cast<double>(std::max<std::size_t>(count_, 1));
  }
  [[nodiscard]] double calibration_error() const { return calibration_.value(); }

 private:
  std::size_t count_ = 0;
  std::size_t right_ = 0;
  CalibrationError calibration_;
};

/// Examples by their place: of one fold, and what the others teach.
struct FoldPlaces {
  std::vector<std::size_t> taught;
  std::vector<const Judgement*> asked;
};

FoldPlaces places_of(const LearningReport& report, std::size_t fold) {
  FoldPlaces places;
  for (std::size_t i = 0; i < report.fold_of.size(); ++i) {
    if (report.fold_of[i] != fold) places.taught.push_back(i);
  }
  for (const Judgement& judgement : report.judgements) {
    if (report.fold_of[judgement.example] == fold) places.asked.push_back(&judgement);
  }
  return places;
}

std::vector<float> in_one_piece(const Matrix& table) {
  std::vector<float> values;
  for (Eigen::Index row = 0; row < table.rows(); ++row) {
    for (Eigen::Index col = 0; col < table.cols(); ++col) values.push_back(static_cast<float>(table(row, col)));
  }
  return values;
}

Lesson lesson_of(const Matrix& features, const std::vector<std::size_t>& class_of, std::size_t classes,
                 const LearningReport& report, const FoldPlaces& places) {
  std::vector<std::size_t> columns(static_cast<std::size_t>(features.cols()));
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::vector<std::size_t> asked;
  for (const Judgement* judgement : places.asked) asked.push_back(judgement->example);
  const Standardisation standardisation = standardisation_of(features, places.taught, columns);
  Lesson lesson{standardisation.columns.size(),
                classes,
                in_one_piece(standardised(features, places.taught, standardisation)),
                {},
                {},
                in_one_piece(standardised(features, asked, standardisation))};
  for (const std::size_t example : places.taught) {
    lesson.class_of.push_back(class_of[example]);
    lesson.fold_of.push_back(report.fold_of[example]);
  }
  return lesson;
}

/// Held images of all labels, over the root of their mean square.
std::vector<std::vector<float>> scaled_images(const LabelledFrames& data) {
  std::vector<std::vector<float>> images;
  for (const Label& label : data.labels) {
    std::vector<float> image = held_image(data, label);
    const float square = std::inner_product(image.begin(), image.end(), image.begin(), 0.0F);
    const float scale = square > 0.0F ? std::sqrt(static_cast<float>(image.size()) / square) : 0.0F;
    for (float& reading : image) reading *= scale;
    images.push_back(std::move(image));
  }
  return images;
}

std::size_t nearest(const std::vector<std::vector<float>>& images, const std::vector<std::size_t>& among,
                    std::size_t to) {
  float least = std::numeric_limits<float>::infinity();
  std::size_t best = among.front();
  for (const std::size_t example : among) {
    float distance = 0.0F;
    for (std::size_t i = 0; i < images[to].size(); ++i) {
      const float difference = images[example][i] - images[to][i];
      distance += difference * difference;
    }
    if (distance >= least) continue;
    least = distance;
    best = example;
  }
  return best;
}

void tally_answers(const std::vector<float>& answers, std::size_t classes, const FoldPlaces& places, Tally& tally) {
  assert(answers.size() == places.asked.size() * classes);
  for (std::size_t i = 0; i < places.asked.size(); ++i) {
    const auto row = answers.begin() + static_cast<std::ptrdiff_t>(i * classes);
    const auto largest = std::max_element(row, row + static_cast<std::ptrdiff_t>(classes));
    tally.add(places.asked[i]->truth, static_cast<std::size_t>(largest - row), static_cast<double>(*largest));
  }
}

}  // namespace

Result<std::vector<EstimatorFigures>> compare_estimators(const LabelledFrames& data, const LearningSet& set,
                                                         const Learned& learned,
                                                         std::span<const ComparedEstimator> further,
                                                         const std::function<void(double)>& progress) {
  const LearningReport& report = learned.report;
  const std::vector<std::string>& names = learned.classes.names;
  assert(report.fold_of.size() == data.labels.size());
  std::vector<std::size_t> class_of;
  for (const Label& label : data.labels) {
    class_of.push_back(
        static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), label.name) - names.begin()));
  }
  const Eigen::Map<const Matrix> features(set.features().data(), index(data.labels.size()),
                                          index(set.features().size() / data.labels.size()));
  const std::vector<std::vector<float>> images = scaled_images(data);
  Tally by_frame;
  std::vector<Tally> by_further(further.size());
  for (std::size_t fold = 0; fold < report.folds; ++fold) {
    const FoldPlaces places = places_of(report, fold);
    if (places.asked.empty()) continue;
    for (const Judgement* asked : places.asked) {
      by_frame.add(asked->truth, class_of[nearest(images, places.taught, asked->example)], 1.0);
    }
    const Lesson lesson = lesson_of(features, class_of, names.size(), report, places);
    for (std::size_t i = 0; i < further.size(); ++i) {
      const Result<std::vector<float>> answers = further[i].answer(lesson);
      if (!answers) return answers.error();
      tally_answers(*answers, names.size(), places, by_further[i]);
    }
    if (progress) progress(static_cast<double>(fold + 1) / static_cast<double>(report.folds));
  }
  std::vector<EstimatorFigures> figures{{"dermis", report.accuracy, report.calibration_error},
                                        {"nearest frame", by_frame.accuracy(), std::nullopt}};
  for (std::size_t i = 0; i < further.size(); ++i) {
    figures.push_back({further[i].name, by_further[i].accuracy(), by_further[i].calibration_error()});
  }
  return figures;
}

}  // namespace dermis::learn::recognition
