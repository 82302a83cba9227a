// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/sample_database.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "dermis/touch/preprocessing/missing_readings.hpp"
#include "dermis/touch/preprocessing/phase.hpp"
#include "learn/calibration/labels/labels.hpp"
#include "learn/calibration/samples/inverted_frames.hpp"
#include "learn/calibration/samples/sample_choice.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kMaxRejectedShare = 0.1;
constexpr double kOutliers = 0.005;          // of the supplies, at either end
constexpr double kMostMissingShare = 0.001;  // of the samples of the median taxel
constexpr std::size_t kFramesPerTask = 128;
constexpr std::size_t kFramesPerBatch = 128 * kFramesPerTask;

struct SelectedFrame {
  std::size_t index = 0;  // in the recording
  ConditionedFrame conditioned;
};

/// The chosen frames of the calibrate phase, in order, with supply removed, a batch at a time.
class Selection {
 public:
  Selection(const ArrayDescription& array, std::vector<bool> is_chosen, Nanos settle_time)
      : is_chosen_(std::move(is_chosen)),
        phase_(settle_time, touch::preprocessing::Phase::calibrate),
        conditioner_(array),
        missing_(array) {}

  /// Empty at the end.
  std::vector<SelectedFrame> next_batch(std::span<const RawFrame> frames, SampleDatabase& database) {
    std::vector<SelectedFrame> batch;
    for (; next_ < frames.size() && batch.size() < kFramesPerBatch; ++next_) {
      const auto destination = phase_.select(frames[next_].time, is_chosen_[next_]);
      if (destination != touch::preprocessing::Destination::sample_database) continue;
      ConditionedFrame conditioned;
      conditioner_.process(frames[next_], conditioned);
      missing_.add(frames[next_], conditioned);
      if (conditioner_.rejection() == touch::preprocessing::Rejection::none) {
        batch.push_back({next_, std::move(conditioned)});
        if (frames[next_].supply_v) supplies_v_.push_back(*frames[next_].supply_v);
      } else if (database.frames_rejected++ == 0) {
        database.first_rejection = fmt::format("frame {}: {}", next_, conditioner_.why_rejected());
      }
    }
    return batch;
  }

  [[nodiscard]] const touch::preprocessing::MissingReadings& missing() const { return missing_; }
  /// Supplies of the frames so far, without the outliers among many.
  [[nodiscard]] std::optional<touch::preprocessing::SupplyRange> supply() const {
    if (supplies_v_.empty()) return std::nullopt;
    return touch::preprocessing::SupplyRange{quantile(supplies_v_, kOutliers), quantile(supplies_v_, 1.0 - kOutliers)};
  }
  [[nodiscard]] double share_done() const {
    return static_cast<double>(next_) / static_cast<double>(is_chosen_.size());
  }

 private:
  std::vector<bool> is_chosen_;  // [frames]
  touch::preprocessing::PhaseSelector phase_;
  touch::preprocessing::Conditioner conditioner_;
  touch::preprocessing::MissingReadings missing_;
  std::vector<double> supplies_v_;
  std::size_t next_ = 0;
};

Sample make_sample(const ArrayDescription& array, std::size_t frame, std::span<const Load> loads,
                   const ConditionedFrame& conditioned, const ConductanceFrame& conductance) {
  Sample sample;
  sample.frame = frame;
  sample.temperature_celsius = conductance.temperature_celsius;
  sample.taxel_celsius = conductance.taxel_celsius;
  sample.ratio.assign(conditioned.ratio.begin(), conditioned.ratio.end());
  sample.sigma_ratio = conditioned.sigma_ratio;
  sample.siemens.assign(conductance.siemens.begin(), conductance.siemens.end());
  sample.sigma_siemens.assign(conductance.sigma_siemens.begin(), conductance.sigma_siemens.end());
  sample.taxels = conditioned.taxels;
  expand_loads(array, loads, sample);
  // A reading at the end of the ADC no longer shows its force. The neighbours of a missing one show some.
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (conductance.taxels[taxel] != TaxelStatus::ok) {
      sample.known_newtons[taxel] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  std::erase_if(sample.totals, [&](const TotalForce& total) {
    return std::any_of(total.taxels.begin(), total.taxels.end(),
                       [&](std::size_t taxel) { return conditioned.taxels[taxel] == TaxelStatus::saturated; });
  });
  return sample;
}

/// Leaves out the samples for which `is_bad` holds, and counts them.
template <typename Predicate>
void reject_if(SampleDatabase& database, Predicate is_bad, const std::string& reason) {
  for (const Sample& sample : database.samples) {
    if (!is_bad(sample)) continue;
    if (database.frames_rejected++ == 0) database.first_rejection = fmt::format("frame {}: {}", sample.frame, reason);
  }
  std::erase_if(database.samples, is_bad);
}

void reject_unsolved(SampleDatabase& database) {
  const std::string mend =
      database.doubts.empty() ? "check drive_ohm, load_ohm, supply and stuck lines" : database.doubts.back();
  reject_if(
      database, [](const Sample& sample) { return sample.siemens.empty(); },
      "readings that the circuit of the array cannot give; " + mend);
}

/// A few samples without a temperature among many with one are left out, so that temperature stays an input.
void reject_without_temperature(SampleDatabase& database) {
  const auto lacks_temperature = [](const Sample& sample) { return !sample.temperature_celsius; };
  const auto lacking = std::count_if(database.samples.begin(), database.samples.end(), lacks_temperature);
  if (static_cast<double>(lacking) > kMaxRejectedShare * static_cast<double>(database.samples.size())) return;
  reject_if(database, lacks_temperature, "no temperature, where most frames have one");
}

Status check_rejected(const SampleDatabase& database, const touch::preprocessing::MissingReadings& missing) {
  const auto rejected = static_cast<double>(database.frames_rejected);
  const double all = rejected + static_cast<double>(database.samples.size());
  if (rejected > kMaxRejectedShare * all) {
    const bool is_outside = 2 * missing.frames_outside() > database.frames_rejected;
    return bad_input(fmt::format("{} of {} labelled frames cannot be used: {}", rejected, all,
                                 is_outside ? *missing.describe_range() : "the first is " + database.first_rejection));
  }
  if (database.samples.empty()) return bad_input("no labelled frame is left after settling");
  if (std::none_of(database.samples.begin(), database.samples.end(), [](const Sample& s) { return s.unloaded; })) {
    return bad_input(
        "the loads name no unloaded frame: record a few frames with nothing on the array and label them "
        "'<frame>,force,all,0'");
  }
  return Done{};
}

/// Appends the samples of a batch.
void invert_batch(std::span<const SelectedFrame> batch, const LoadsOfFrames& loads_of, SampleDatabase& database) {
  const ArrayDescription& array = database.array;
  const std::size_t before = database.samples.size();
  database.samples.resize(before + batch.size());
  parallel_for((batch.size() + kFramesPerTask - 1) / kFramesPerTask, [&](std::size_t task) {
    Result<touch::compensation::Compensator> solver = touch::compensation::Compensator::create(array);
    FilmConductances film(array.rows, array.cols);
    ConductanceFrame conductance;
    const std::size_t end = std::min(batch.size(), (task + 1) * kFramesPerTask);
    for (std::size_t k = task * kFramesPerTask; k < end; ++k) {
      const auto& [index, conditioned] = batch[k];
      if (array.readout.film) {
        Sample loaded;
        expand_loads(array, loads_of[index], loaded);
        film.set(*array.readout.film, film_newtons(std::move(loaded.known_newtons), loaded.totals));
        solver->hold_film(film);
      }
      solver->forget();  // whatever task a frame is in, its bits are the same
      solver->process(conditioned, conductance);
      Sample& sample = database.samples[before + k];
      sample.frame = index;
      if (has(conductance.status, FrameStatus::not_converged)) continue;
      sample = make_sample(array, index, loads_of[index], conditioned, conductance);
    }
  });
}

/// Single taxels break; where most of them lack readings, the description of the array is wrong.
Status check_missing(const SampleDatabase& database, const touch::preprocessing::MissingReadings& missing) {
  std::vector<std::size_t> samples(database.array.taxel_count());
  for (const Sample& sample : database.samples) {
    for (std::size_t taxel = 0; taxel < samples.size(); ++taxel) {
      if (sample.taxels[taxel] == TaxelStatus::invalid) ++samples[taxel];
    }
  }
  for (const std::size_t taxel : database.array.absent) samples[taxel] = 0;
  const auto of_median = static_cast<double>(upper_median(std::move(samples)));
  if (of_median <= 1.0 + kMostMissingShare * static_cast<double>(database.samples.size())) return Done{};
  return bad_input("labelled frames have " + missing.describe() + ": " +
                   missing.describe_range().value_or("check adc_bits"));
}

std::optional<std::string> remark_on_choice(const LoadsOfFrames& loads_of, const std::vector<bool>& is_chosen) {
  std::size_t labelled = 0;
  for (std::size_t frame = 0; frame < is_chosen.size(); ++frame) labelled += loads_of[frame].empty() ? 0 : 1;
  const auto chosen = static_cast<std::size_t>(std::count(is_chosen.begin(), is_chosen.end(), true));
  if (chosen == labelled) return std::nullopt;
  return fmt::format("{} labelled frames repeat: {} of them are used, evenly over places and forces", labelled, chosen);
}

}  // namespace

Result<SampleDatabase> invert_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                     std::span<const Load> loads, Nanos settle_time,
                                     const std::vector<std::string>& doubts,
                                     const std::function<void(double)>& progress) {
  SampleDatabase database;
  database.array = array;
  database.doubts = doubts;
  const Result<touch::compensation::Compensator> compensator = touch::compensation::Compensator::create(array);
  if (!compensator) return compensator.error();
  const Readout& readout = array.readout;
  const double reference =
      readout.adc_reference_v && readout.supply_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
  database.siemens_per_count = compensator->siemens_per_ratio() * reference / readout.full_scale_counts();

  const LoadsOfFrames loads_of(loads, frames.size());
  std::vector<bool> is_chosen = choose_samples(array.taxel_count(), loads_of);
  if (auto remark = remark_on_choice(loads_of, is_chosen)) database.remarks.push_back(*std::move(remark));
  Selection selection(array, std::move(is_chosen), settle_time);
  while (true) {
    const std::vector<SelectedFrame> batch = selection.next_batch(frames, database);
    if (batch.empty()) break;
    invert_batch(batch, loads_of, database);
    if (progress) progress(selection.share_done());
  }
  database.supply = selection.supply();
  if (selection.missing().any()) {
    database.remarks.push_back(selection.missing().describe() + " with a label: left out");
  }
  reject_unsolved(database);
  reject_without_temperature(database);
  if (Status checked = check_rejected(database, selection.missing()); !checked) return checked.error();
  if (Status checked = check_missing(database, selection.missing()); !checked) return checked.error();
  return database;
}

double bare_reading(const SampleDatabase& database, const Sample& sample, std::size_t taxel) {
  if (sample.taxels[taxel] == TaxelStatus::invalid) return 0.0;
  const Readout& readout = database.array.readout;
  const double noise_counts = readout.adc_noise_counts * touch::preprocessing::noise_gain(readout.adc_errors);
  const double full_scale = sample.sigma_ratio * readout.full_scale_counts() / noise_counts;  // as a ratio
  const auto ratio = static_cast<double>(sample.ratio[taxel]);
  return readout.pressure_raises_reading ? ratio / full_scale : 1.0 - (1.0 - ratio) / full_scale;
}

}  // namespace dermis::learn::calibration
