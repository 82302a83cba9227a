// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/raw_examination.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "learn/health/press_patterns.hpp"
#include "learn/health/reading_levels.hpp"
#include "learn/health/repeated_frames.hpp"

namespace dermis::learn::health {
namespace {

ArrayDescription described(FrameShape shape, const std::optional<Readout>& readout) {
  ArrayDescription array;
  array.rows = shape.rows;
  array.cols = shape.cols;
  if (readout) array.readout = *readout;
  return array;
}

}  // namespace

class RawExamination::Implementation {
 public:
  Implementation(FrameShape shape, const std::optional<Readout>& readout)
      : array_(described(shape, readout)),
        levels_(array_, readout.has_value()),
        presses_(array_),
        counts_(shape.taxel_count()) {}

  void add(const RawFrame& raw) {
    if (frames_++ == 0) first_time_ = raw.time;
    last_time_ = raw.time;
    for (std::size_t taxel = 0; taxel < counts_.size(); ++taxel) {
      if (std::isfinite(raw.counts[taxel])) counts_[taxel] = raw.counts[taxel];
    }
    levels_.add(counts_);
    presses_.add(counts_);
    repeated_.add(counts_);
  }

  [[nodiscard]] RawDiagnosis diagnosis() const {
    RawDiagnosis diagnosis;
    if (frames_ == 0) return diagnosis;
    diagnosis.frames = frames_;
    diagnosis.seconds = std::chrono::duration<double>(last_time_ - first_time_).count();
    diagnosis.least_counts = levels_.least();
    diagnosis.most_counts = levels_.most();
    if (auto finding = levels_.finding()) diagnosis.findings.push_back(*std::move(finding));
    for (std::string& finding : presses_.findings()) diagnosis.findings.push_back(std::move(finding));
    if (auto finding = repeated_.finding()) diagnosis.findings.push_back(*std::move(finding));
    diagnosis.stuck_lines = levels_.stuck_lines();
    diagnosis.remark = levels_.remark();
    if (!diagnosis.remark) diagnosis.remark = repeated_.remark();
    return diagnosis;
  }

 private:
  ArrayDescription array_;
  ReadingLevels levels_;
  PressPatterns presses_;
  RepeatedFrames repeated_;
  std::size_t frames_ = 0;
  Nanos first_time_{};
  Nanos last_time_{};
  std::vector<float> counts_;  // of the last frame; where one is no number, the last that was [taxels]
};

std::vector<std::string> RawDiagnosis::problems() const {
  std::vector<std::string> all = findings;
  all.insert(all.end(), stuck_lines.begin(), stuck_lines.end());
  return all;
}

RawExamination::RawExamination(FrameShape shape, const std::optional<Readout>& readout)
    : implementation_(std::make_unique<Implementation>(shape, readout)) {}
RawExamination::RawExamination(RawExamination&&) noexcept = default;
RawExamination& RawExamination::operator=(RawExamination&&) noexcept = default;
RawExamination::~RawExamination() = default;

void RawExamination::add(const RawFrame& raw) {
  implementation_->add(raw);
}

RawDiagnosis RawExamination::diagnosis() const {
  return implementation_->diagnosis();
}

std::string describe(const RawDiagnosis& diagnosis, FrameShape shape) {
  std::string text = fmt::format("array        {} x {}\n", shape.rows, shape.cols);
  text += fmt::format("frames       {}, {:.1f} s\n", diagnosis.frames, diagnosis.seconds);
  text += fmt::format("readings     {:g} to {:g}\n\n", diagnosis.least_counts, diagnosis.most_counts);
  for (const std::string& problem : diagnosis.problems()) text += problem + "\n";
  if (diagnosis.remark) text += "remark: " + *diagnosis.remark + "\n";
  if (diagnosis.problems().empty() && !diagnosis.remark) text += "nothing to doubt in these counts\n";
  return text;
}

}  // namespace dermis::learn::health
