// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/status_messages.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "dermis/learn/health/fault_words.hpp"

namespace dermis::out::serve {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double seconds(Nanos span) {
  return std::chrono::duration<double>(span).count();
}

/// Lines that cross share taxels, so these are at most so many.
std::uint64_t masked_taxels(const touch::pipeline::Model& model,
                            const std::vector<touch::compensation::LineFault>& faults) {
  const std::vector<std::uint8_t>& dead = model.networks.dead;
  auto masked = static_cast<std::uint64_t>(std::count_if(dead.begin(), dead.end(), [](auto one) { return one != 0; }));
  for (const touch::compensation::LineFault& fault : faults) masked += masked_taxel_count(fault, model.array);
  return std::min<std::uint64_t>(masked, model.array.rows * model.array.cols);
}

}  // namespace

bytes::ros_messages::ArrayStatistics statistics_message(const std::string& name,
                                                        const live::suits::ArrayStatistics& array) {
  bytes::ros_messages::ArrayStatistics out;
  out.name = name;
  out.ended = array.ended;
  out.error = array.error;
  out.frames = array.frames;
  out.rejected = array.rejected;
  out.lost = array.source.lost_frames;
  out.skipped = array.skipped;
  out.damaged = array.source.damaged_frames;
  out.rate_hz = array.source.rate_hz;
  out.jitter_s = seconds(array.source.jitter);
  out.latency_p50_s = array.latency_p50 > Nanos{} ? seconds(array.latency_p50) : kUnknown;
  out.latency_p99_s = array.latency_p99 > Nanos{} ? seconds(array.latency_p99) : kUnknown;
  out.temperature_celsius = array.temperature_celsius.value_or(kUnknown);
  out.supply_v = array.supply_v.value_or(kUnknown);
  return out;
}

bytes::ros_messages::Diagnosis diagnosis_message(const std::string& name, const touch::pipeline::Model& model,
                                                 const live::suits::ArrayStatistics& statistics,
                                                 const learn::health::AgeingEvidence& ageing) {
  bytes::ros_messages::Diagnosis diagnosis;
  diagnosis.name = name;
  diagnosis.hardware_id = model.array.name;
  learn::health::Condition condition = learn::health::condition_of(model, statistics.faults, ageing);
  const bool is_uncalibrated = learn::calibration::is_uncalibrated(model);  // "since calibration" says nothing of it
  if (!is_uncalibrated) diagnosis.values = std::move(condition.details);
  if (!statistics.error.empty()) {
    diagnosis.level = bytes::ros_messages::Diagnosis::Level::error;
    diagnosis.message = statistics.error;
  } else if (statistics.ended) {
    diagnosis.level = bytes::ros_messages::Diagnosis::Level::stale;
    diagnosis.message = "the source has ended";
  } else if (is_uncalibrated) {
    diagnosis.level = bytes::ros_messages::Diagnosis::Level::warning;
    diagnosis.message = "not calibrated yet: calibrate";
  } else {
    const bool is_healthy = statistics.faults.empty() && !ageing.has_aged();
    if (!is_healthy || statistics.standing) diagnosis.level = bytes::ros_messages::Diagnosis::Level::warning;
    diagnosis.message = std::move(condition.message);
    if (statistics.standing) {
      if (is_healthy) diagnosis.message = "lies on something, or was put on: tare";
      diagnosis.values.emplace_back("standing load", describe_never_released(*statistics.standing, model.array));
    }
  }
  return diagnosis;
}

void fill_in(live::fleet::ArrayHealth& array, const touch::pipeline::Model& model,
             const live::suits::ArrayStatistics& statistics, const learn::health::AgeingEvidence& ageing) {
  const bytes::ros_messages::Diagnosis diagnosis = diagnosis_message(array.name, model, statistics, ageing);
  const bool is_uncalibrated = learn::calibration::is_uncalibrated(model);
  array.level = static_cast<live::fleet::ArrayHealth::Level>(diagnosis.level);
  array.message = diagnosis.message;
  array.rate_hz = statistics.source.rate_hz;
  array.lost = statistics.source.lost_frames;
  array.damaged = statistics.source.damaged_frames;
  array.late = statistics.source.late_frames + statistics.skipped;
  array.wants_calibration = is_uncalibrated || ageing.has_aged();
  if (is_uncalibrated) return;
  array.masked_taxels = masked_taxels(model, statistics.faults);
  array.gain_change = ageing.gain_spread;
}

}  // namespace dermis::out::serve
