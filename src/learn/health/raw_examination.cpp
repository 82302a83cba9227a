// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/raw_examination.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "dermis/bytes/files/frame_times.hpp"
#include "learn/health/hum_meter.hpp"
#include "learn/health/joint_channels.hpp"
#include "learn/health/press_patterns.hpp"
#include "learn/health/reading_levels.hpp"
#include "learn/health/repeated_frames.hpp"
#include "learn/health/standing_lines.hpp"

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
        standing_(array_),
        joint_(shape.taxel_count()),
        hum_(shape.taxel_count()),
        counts_(shape.taxel_count()) {}

  void add(const RawFrame& raw) {
    clock_.add(raw.time);
    for (std::size_t taxel = 0; taxel < counts_.size(); ++taxel) {
      if (std::isfinite(raw.counts[taxel])) counts_[taxel] = raw.counts[taxel];
    }
    levels_.add(counts_);
    presses_.add(counts_);
    repeated_.add(counts_);
    standing_.add(counts_, raw.time);
    joint_.add(counts_, raw);
    hum_.add(counts_, raw.time);
  }

  [[nodiscard]] RawDiagnosis diagnosis() const {
    RawDiagnosis diagnosis;
    diagnosis.frames = clock_.frames();
    if (diagnosis.frames == 0) return diagnosis;
    diagnosis.seconds = clock_.seconds();
    diagnosis.least_counts = levels_.least();
    diagnosis.most_counts = levels_.most();
    if (auto finding = levels_.finding()) diagnosis.findings.push_back(*std::move(finding));
    for (std::string& finding : presses_.findings()) diagnosis.findings.push_back(std::move(finding));
    for (auto finding :
         {repeated_.finding(), joint_.finding(), hum_.finding(), clock_.wrong_unit(joint_.has_smooth_touches())}) {
      if (finding) diagnosis.findings.push_back(*std::move(finding));
    }
    for (std::string& finding : clock_.findings()) diagnosis.findings.push_back(std::move(finding));
    diagnosis.stuck_lines = standing_.lines(levels_.full_scale());
    diagnosis.stuck_taxels = standing_.taxels_at(levels_.full_scale());
    diagnosis.remark = levels_.remark();
    if (!diagnosis.remark) diagnosis.remark = repeated_.remark();
    return diagnosis;
  }

 private:
  ArrayDescription array_;
  ReadingLevels levels_;
  PressPatterns presses_;
  RepeatedFrames repeated_;
  StandingLines standing_;
  JointChannels joint_;
  HumMeter hum_;
  bytes::files::FrameTimes clock_;
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
