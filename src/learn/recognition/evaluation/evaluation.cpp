// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/evaluation.hpp"

#include <algorithm>

#include "dermis/learn/recognition/recogniser.hpp"
#include "learn/recognition/answer/calibration_error.hpp"

namespace dermis::learn::recognition {

Result<ClassesEvaluation> evaluate_classes(const Classes& classes, const LabelledFrames& data) {
  if (Status checked = data.validate(); !checked) return checked.error();
  Result<Recogniser> recogniser = Recogniser::create(classes, data.layout, data.longest());
  if (!recogniser) return recogniser.error();
  const std::size_t count = classes.names.size();
  ClassesEvaluation evaluation;
  evaluation.confusion.assign(count * count, 0);
  CalibrationError calibration;
  std::size_t right = 0;
  for (const Label& label : data.labels) {
    const Answer answer = recogniser->recognise(data.segment(label));
    const std::size_t is_unknown = answer.verdict != Verdict::known ? 1 : 0;
    const auto place = std::lower_bound(classes.names.begin(), classes.names.end(), label.name);
    if (place == classes.names.end() || *place != label.name) {
      ++evaluation.others;
      evaluation.others_unknown += is_unknown;
      continue;
    }
    const auto truth = static_cast<std::size_t>(place - classes.names.begin());
    const bool is_right = truth == answer.likeliest;
    ++evaluation.judged;
    ++evaluation.confusion[truth * count + answer.likeliest];
    evaluation.called_unknown += is_unknown;
    right += is_right ? 1 : 0;
    calibration.add(answer.probabilities[answer.likeliest], is_right);
  }
  if (evaluation.judged == 0) return bad_input("no label is of a class that was learned");
  evaluation.accuracy = static_cast<double>(right) / static_cast<double>(evaluation.judged);
  evaluation.calibration_error = calibration.value();
  return evaluation;
}

}  // namespace dermis::learn::recognition
