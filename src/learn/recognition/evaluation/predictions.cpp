// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/predictions.hpp"

#include "dermis/bytes/files/text.hpp"
#include "dermis/learn/recognition/recogniser.hpp"

namespace dermis::learn::recognition {
namespace {

/// A line for each label that a split asks for.
Status predict(const LabelledFrames& data, const LearningSet& set, const Split& split, Answers answers,
               std::string& lines) {
  const Result<Learned> learned = set.learn(split.taught);
  if (!learned) return bad_input("split " + bytes::files::in_quotes(split.name) + ": " + learned.error().message);
  Result<Recogniser> recogniser = Recogniser::create(learned->classes, data.layout, data.longest());
  if (!recogniser) return recogniser.error();
  const bool may_be_unknown = answers == Answers::classes_or_unknown;
  for (const std::size_t place : split.asked) {
    const Label& label = data.labels[place];
    const Answer answer = recogniser->recognise(data.segment(label));
    const bool is_unknown = may_be_unknown && answer.verdict != Verdict::known;
    const std::string& name = learned->classes.names[answer.likeliest];
    lines += split.name + "," + label.id + "," + (is_unknown ? "unknown" : name) + ",";
    bytes::files::append_number(lines, answer.probabilities[answer.likeliest]);
    if (may_be_unknown) {
      lines += ",";
      bytes::files::append_number(lines, answer.unknown_score);
    }
    lines += "\n";
  }
  return Done{};
}

}  // namespace

Result<std::string> predictions_of(const LabelledFrames& data, const LearningSet& set, std::span<const Split> splits,
                                   Answers answers, const std::function<void(double)>& progress) {
  std::string lines = "split,id,class,probability";
  lines += answers == Answers::classes_or_unknown ? ",unknown_score\n" : "\n";
  for (std::size_t i = 0; i < splits.size(); ++i) {
    if (const Status predicted = predict(data, set, splits[i], answers, lines); !predicted) return predicted.error();
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(splits.size()));
  }
  return lines;
}

}  // namespace dermis::learn::recognition
