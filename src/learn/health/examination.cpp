// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/examination.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/health/ageing_monitor.hpp"
#include "dermis/learn/health/raw_examination.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"
#include "dermis/touch/pipeline/standing_load.hpp"
#include "dermis/touch/preprocessing/missing_readings.hpp"
#include "learn/health/findings.hpp"
#include "learn/health/line_gains.hpp"
#include "learn/health/mute_taxels.hpp"
#include "learn/health/noise_meter.hpp"
#include "learn/health/offset_meter.hpp"
#include "learn/health/supply_dips.hpp"
#include "learn/health/unloaded_taxels.hpp"

namespace dermis::learn::health {
namespace {

using touch::compensation::LineFault;

constexpr double kTouchedSigmas = 3.0;
constexpr double kHumSigmas = 6.0;             // noise that has grown may be of one sign for long
constexpr std::size_t kNoiseIsKnown = 64;      // frames after it has begun, at most
constexpr double kSurelyTouchedSigmas = 20.0;  // of calibrated noise: noise that has grown is no touch

bool same(const LineFault& a, const LineFault& b) {
  return a.kind == b.kind && a.place == b.place && a.frame == b.frame;
}

/// The taxel was found to be dead before the whole line of it was.
bool is_explained(const LineFault& dead, const LineFault& line, const ArrayDescription& array) {
  const touch::compensation::LineFaultTraits& traits = traits_of(line.kind);
  if (dead.kind != touch::compensation::LineFaultKind::dead_taxel ||
      traits.effect != touch::compensation::LineFaultEffect::silent) {
    return false;
  }
  return line.place == (*traits.axis == Axis::row ? dead.place / array.cols : dead.place % array.cols);
}

/// Updates which of the faults so far stand and which have gone at this frame.
void follow(std::span<const LineFault> present, std::size_t frame, const ArrayDescription& array,
            std::vector<FaultHistory>& faults) {
  std::erase_if(faults, [&](const FaultHistory& known) {
    const auto explains = [&](const LineFault& fault) { return is_explained(known.fault, fault, array); };
    return !known.until && std::any_of(present.begin(), present.end(), explains);
  });
  for (FaultHistory& known : faults) {
    const auto is_same = [&](const LineFault& fault) { return same(fault, known.fault); };
    const auto now = std::find_if(present.begin(), present.end(), is_same);
    if (now != present.end()) known.fault = *now;
    if (now == present.end() && !known.until) known.until = frame;
  }
  for (const LineFault& fault : present) {
    const auto is_open = [&](const FaultHistory& known) { return !known.until && same(fault, known.fault); };
    if (std::none_of(faults.begin(), faults.end(), is_open)) faults.push_back({fault});
  }
}

/// Lines that would not be missed, while nothing presses them.
std::vector<std::string> blind_lines(const touch::compensation::LineFaultMonitor& monitor,
                                     const ArrayDescription& array) {
  std::vector<std::string> lines;
  for (std::size_t row = 0; row < array.rows; ++row) {
    if (!monitor.sees_silent_row(row)) lines.push_back(fmt::format("row {}", row));
  }
  for (std::size_t col = 0; col < array.cols; ++col) {
    if (!monitor.sees_silent_column(col)) lines.push_back(fmt::format("column {}", col));
  }
  return lines;
}

}  // namespace

/// Many members: each watches one kind of trouble.
class Examination::Implementation {
 public:
  explicit Implementation(const touch::pipeline::Model& model)
      : model_(model),
        missing_(model.array),
        mute_(model),
        unloaded_(model),
        offsets_(model.array.taxel_count()),
        dips_(model.array.taxel_count()),
        ageing_(model),
        line_gains_{LineGains(model, Axis::row), LineGains(model, Axis::column)},
        standing_(model),
        troubles_(model.array, ""),
        raw_({model.array.rows, model.array.cols}, model.array.readout),
        deviation_(model.array.taxel_count()) {}

  void add(const RawFrame& raw, const ForceFrame& force, const touch::pipeline::Pipeline& pipeline) {
    ageing_.add(force);
    for (const Axis axis : kAxes) line_gains_[axis].add(force);
    troubles_.add(raw, force, pipeline);
    const std::size_t frame = counted_.frames++;
    const ConductanceFrame& conductance = pipeline.conductance();
    if (has(conductance.status, FrameStatus::rejected)) {
      ++counted_.frames_rejected;
      ++counted_.rejections[touch::preprocessing::to_string(pipeline.rejection())];
      return;
    }
    if (!first_time_) first_time_ = raw.time;
    last_time_ = raw.time;
    if (troubles_.is_silent(raw, force, pipeline)) return;  // no evidence on the sheet
    if (model_.array.readout.quantity == Quantity::counts) raw_.add(raw);
    follow_temperature(pipeline.conditioned());
    follow_supply(raw);
    follow(pipeline.line_faults().faults(), frame, model_.array, counted_.faults);
    forget_noise(pipeline.conditioned().noise_growth, frame);
    missing_.add(raw, pipeline.conditioned());
    const auto& taxels = pipeline.conditioned().taxels;
    saturated_ += static_cast<std::size_t>(std::count(taxels.begin(), taxels.end(), TaxelStatus::saturated));
    if (has(conductance.status, FrameStatus::not_converged)) {
      ++counted_.frames_unsolved;
      return;
    }
    counted_.worst_misfit_sigma = std::max(counted_.worst_misfit_sigma, conductance.residual_sigma);
    mute_.add(raw, pipeline.conditioned(), conductance, force);
    standing_.add(conductance, force);
    unloaded_.expect(conductance);
    follow_noise(conductance, pipeline.conditioned().noise_growth);
    follow_offsets(conductance, pipeline.conditioned().noise_growth);
  }

  [[nodiscard]] Diagnosis diagnosis(const touch::pipeline::Pipeline& pipeline) const {
    Diagnosis diagnosis = counted_;
    if (first_time_) diagnosis.seconds = std::chrono::duration<double>(last_time_ - *first_time_).count();
    if (const std::optional<double> noise = noise_ratio())
      diagnosis.noise_counts = *noise * model_.array.readout.adc_noise_counts;
    diagnosis.saturated_share = saturated_share();
    if (missing_.any()) {
      diagnosis.missing_readings = missing_.describe();
      if (const auto range = missing_.describe_range()) diagnosis.missing_readings += "; " + *range;
    }
    diagnosis.offset_drift = offsets_.drift();
    diagnosis.offset_spread = offsets_.spread();
    diagnosis.ageing = ageing_.evidence();
    diagnosis.blind_lines = blind_lines(pipeline.line_faults(), model_.array);
    diagnosis.findings = findings_of(diagnosis, model_);
    for (const Axis axis : kAxes) {
      const auto finding = line_gains_[axis].finding(diagnosis.ageing.calibrated_spread);
      if (finding) diagnosis.findings.push_back(*finding);
    }
    if (const auto dips = dips_.finding()) diagnosis.findings.push_back(*dips);
    for (const std::string& finding : mute_.findings()) diagnosis.findings.push_back(finding);
    if (const auto load = standing_.load()) {
      diagnosis.findings.push_back(touch::pipeline::describe_never_released(*load, model_.array));
    }
    add_findings_of_counts(diagnosis);
    diagnosis.remarks = remarks_on(pipeline.line_faults().suspicions(), model_.array);
    if (const auto silent = troubles_.silent_frames()) diagnosis.findings.push_back(*silent);
    if (const auto silence = troubles_.silence()) diagnosis.remarks.push_back(*silence);
    // Whatever else is found comes of that.
    if (const auto impossible = troubles_.impossible()) diagnosis.findings = {*impossible};
    return diagnosis;
  }

 private:
  /// Lines that are found to be faulty explain theirs.
  void add_findings_of_counts(Diagnosis& diagnosis) const {
    const RawDiagnosis raw = raw_.diagnosis();
    const auto is_explained = [&](const std::string& finding) {
      return std::ranges::any_of(counted_.faults, [&](const FaultHistory& known) {
        return finding.starts_with(place_name(known.fault, model_.array) + " ");
      });
    };
    diagnosis.findings.insert(diagnosis.findings.end(), raw.findings.begin(), raw.findings.end());
    for (const auto* stuck : {&raw.stuck_lines, &raw.stuck_taxels}) {
      std::ranges::remove_copy_if(*stuck, std::back_inserter(diagnosis.findings), is_explained);
    }
  }

  void follow_temperature(const ConditionedFrame& conditioned) {
    if (!conditioned.temperature_celsius) return;
    const double celsius = *conditioned.temperature_celsius;
    const TemperatureRange range = counted_.temperature.value_or(TemperatureRange{celsius, celsius});
    counted_.temperature = {std::min(range.coldest_celsius, celsius), std::max(range.hottest_celsius, celsius)};
  }

  void follow_supply(const RawFrame& raw) {
    if (!raw.supply_v || !model_.array.readout.adc_reference_v) return;
    const touch::preprocessing::SupplyRange range =
        counted_.supply.value_or(touch::preprocessing::SupplyRange{*raw.supply_v, *raw.supply_v});
    counted_.supply = {std::min(range.least_v, *raw.supply_v), std::max(range.most_v, *raw.supply_v)};
  }

  /// Differences between frames do not show hum that stands still in them; neither does the pipeline less than a clear
  /// growth.
  [[nodiscard]] std::optional<double> noise_ratio() const {
    const std::optional<double> of_differences = noise_.ratio();
    const double growth = std::sqrt(square_growths_ / std::max(noise_frames_, 1.0));
    return growth > 1.0 ? std::max(of_differences.value_or(0.0), growth) : of_differences;
  }

  void follow_noise(const ConductanceFrame& conductance, double growth) {
    for (std::size_t taxel = 0; taxel < deviation_.size(); ++taxel) {
      const bool is_noise = conductance.taxels[taxel] == TaxelStatus::ok && conductance.siemens[taxel] > 0.0 &&
                            !unloaded_.is_near_touch(conductance, taxel, kSurelyTouchedSigmas);
      deviation_[taxel] = is_noise ? growth * (conductance.siemens[taxel] - unloaded_.expected(taxel)) /
                                         conductance.sigma_siemens[taxel]
                                   : std::numeric_limits<double>::quiet_NaN();
    }
    noise_.add(deviation_);
    square_growths_ += growth * growth;
    noise_frames_ += 1.0;
  }

  /// A fault that was found and withdrawn while noise was not known yet was that noise.
  void forget_noise(double growth, std::size_t frame) {
    if (growth <= 1.0) {
      noise_frame_ = frame + 1;
      return;
    }
    std::erase_if(counted_.faults, [&](const FaultHistory& known) {
      const std::size_t found = known.fault.frame;
      return known.until && found < noise_frame_ && std::max(noise_frame_, *known.until) <= found + kNoiseIsKnown;
    });
  }

  /// Frames in which neither the taxel nor one of its neighbours is touched tell what it conducts unloaded, where that
  /// is more than noise.
  void follow_offsets(const ConductanceFrame& conductance, double growth) {
    const double least_sigmas = growth > 1.0 ? kHumSigmas : kTouchedSigmas;
    bool is_untouched = growth <= 1.0;  // hum moves all readings together, as a supply does
    for (std::size_t taxel = 0; taxel < deviation_.size(); ++taxel) {
      if (conductance.taxels[taxel] != TaxelStatus::ok) continue;
      if (!(unloaded_.expected(taxel) > conductance.sigma_siemens[taxel])) continue;
      if (unloaded_.is_near_touch(conductance, taxel, kTouchedSigmas)) {
        is_untouched = false;
        continue;
      }
      dips_.add(taxel, conductance.siemens[taxel], conductance.sigma_siemens[taxel]);
      if (!(unloaded_.expected(taxel) > least_sigmas * conductance.sigma_siemens[taxel])) continue;
      offsets_.add(taxel, conductance.siemens[taxel] / unloaded_.expected(taxel));
    }
    dips_.end_frame(is_untouched);
  }

  [[nodiscard]] double saturated_share() const {
    const std::size_t accepted = counted_.frames - counted_.frames_rejected;
    return static_cast<double>(saturated_) /
           static_cast<double>(std::max<std::size_t>(accepted * model_.array.taxel_count(), 1));
  }

  const touch::pipeline::Model& model_;
  Diagnosis counted_;  // what is counted frame by frame
  std::optional<Nanos> first_time_;
  Nanos last_time_{};
  std::size_t saturated_ = 0;  // readings
  touch::preprocessing::MissingReadings missing_;
  MuteTaxels mute_;
  UnloadedTaxels unloaded_;
  NoiseMeter noise_;
  double square_growths_ = 0.0;  // of the noise, summed over the frames
  double noise_frames_ = 0.0;
  std::size_t noise_frame_ = 0;  // the first in which it is known to have grown
  OffsetMeter offsets_;
  SupplyDips dips_;
  AgeingMonitor ageing_;
  PerAxis<LineGains> line_gains_;
  touch::pipeline::StandingLoadWatch standing_;
  touch::pipeline::FrameTroubles troubles_;
  RawExamination raw_;
  std::vector<double> deviation_;  // from the unloaded conductance, in standard deviations [taxels]
};

Examination::Examination(const touch::pipeline::Model& model)
    : implementation_(std::make_unique<Implementation>(model)) {}
Examination::Examination(Examination&&) noexcept = default;
Examination& Examination::operator=(Examination&&) noexcept = default;
Examination::~Examination() = default;

void Examination::add(const RawFrame& raw, const ForceFrame& force, const touch::pipeline::Pipeline& pipeline) {
  implementation_->add(raw, force, pipeline);
}

Diagnosis Examination::diagnosis(const touch::pipeline::Pipeline& pipeline) const {
  return implementation_->diagnosis(pipeline);
}

}  // namespace dermis::learn::health
