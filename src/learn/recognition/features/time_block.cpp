// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/time_block.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dermis::learn::recognition {
namespace {

constexpr double kHeld = 0.5;  // share of the peak force
constexpr double kTouched = 0.25;
constexpr double kLeastPeak = 0.3;

using Out = std::span<double>;

double mean_of(std::span<const double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double largest_of(std::span<const double> values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

double smallest_of(std::span<const double> values) {
  return values.empty() ? 0.0 : *std::min_element(values.begin(), values.end());
}

double share_above(std::span<const double> values, double level) {
  const auto above = std::count_if(values.begin(), values.end(), [&](double value) { return value > level; });
  return static_cast<double>(above) / static_cast<double>(values.size());
}

double correlation(std::span<const double> a, std::span<const double> b) {
  const double spread = deviation_of(a) * deviation_of(b);
  if (!(spread > 0.0)) return 0.0;
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean_a) * (b[i] - mean_b);
  return sum / (spread * static_cast<double>(a.size()));
}

/// Linear between the values, at as many places from the first to the last as `out` has.
void resample(std::span<const double> values, double scale, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double place =
        static_cast<double>(i) / static_cast<double>(out.size() - 1) * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    out[i] = scale * (values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]));
  }
}

std::size_t peak_count(std::span<const double> force) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const bool rises = i == 0 || force[i] > force[i - 1];
    const bool falls = i + 1 == force.size() || force[i] >= force[i + 1];
    if (force[i] > kLeastPeak && rises && falls) ++count;
  }
  return count;
}

std::size_t crossing_count(std::span<const double> force) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < force.size(); ++i) {
    if ((force[i] > kHeld) != (force[i - 1] > kHeld)) ++count;
  }
  return count;
}

double autocorrelation(std::span<const double> values, std::size_t lag) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    square += values[i] * values[i];
    if (i >= lag) product += values[i] * values[i - lag];
  }
  return square > 0.0 ? product / square : 0.0;
}

double over(double value, double scale) {
  return scale > 0.0 ? value / scale : 0.0;
}

}  // namespace

void FrameSeries::resize(std::size_t frames) {
  for (auto* const values : {&force, &row, &col, &peak, &area, &change}) values->assign(frames, 0.0);
}

TimeBlock::TimeBlock(double least_reading, std::size_t most_frames) : least_reading_(least_reading) {
  for (auto* const values : {&force_, &slope_, &signal_}) values->reserve(most_frames);
}

void TimeBlock::scale(const FrameSeries& series) {
  peak_force_ = largest_of(series.force);
  peak_taxel_ = largest_of(series.peak);
  peak_area_ = largest_of(series.area);
  force_.resize(series.frames());
  slope_.resize(series.frames() - 1);
  for (std::size_t i = 0; i < force_.size(); ++i) force_[i] = over(series.force[i], peak_force_);
  for (std::size_t i = 0; i < slope_.size(); ++i) slope_[i] = force_[i + 1] - force_[i];
}

constexpr std::array<FeatureRow<TimeBlock, FrameSeries>, 12> TimeBlock::kRows{{
    {{"length", FeatureAspect::time, 1},
     [](TimeBlock&, const FrameSeries& series, Out out) { out[0] = std::log(static_cast<double>(series.frames())); }},
    {{"force and peak", FeatureAspect::force, 2},
     [](TimeBlock& block, const FrameSeries&, Out out) {
       out[0] = std::log(block.peak_force_ + block.least_reading_);
       out[1] = std::log(block.peak_taxel_ + block.least_reading_);
     }},
    {{"area", FeatureAspect::area, 2},
     [](TimeBlock& block, const FrameSeries& series, Out out) {
       out[0] = std::log(1.0 + block.peak_area_);
       out[1] = std::log(1.0 + mean_of(series.area));
     }},
    {{"course of the force", FeatureAspect::time, 9},
     [](TimeBlock& block, const FrameSeries&, Out out) { block.put_course(out); }},
    {{"path of the centre", FeatureAspect::time, 12},
     [](TimeBlock& block, const FrameSeries& series, Out out) { block.put_path(series, out); }},
    {{"changes", FeatureAspect::time, 7},
     [](TimeBlock& block, const FrameSeries& series, Out out) { block.put_changes(series, out); }},
    {{"spectrum of the force", FeatureAspect::time, 4},
     [](TimeBlock& block, const FrameSeries&, Out out) { block.put_spectrum(block.force_, out); }},
    {{"spectrum of the row", FeatureAspect::time, 4},
     [](TimeBlock& block, const FrameSeries& series, Out out) { block.put_centre_spectrum(series.row, out); }},
    {{"spectrum of the column", FeatureAspect::time, 4},
     [](TimeBlock& block, const FrameSeries& series, Out out) { block.put_centre_spectrum(series.col, out); }},
    {{"autocorrelation of the slope", FeatureAspect::time, 4},
     [](TimeBlock& block, const FrameSeries&, Out out) { block.put_autocorrelations(out); }},
    {{"curve of the force", FeatureAspect::time, 10},
     [](TimeBlock& block, const FrameSeries&, Out out) { resample(block.force_, 1.0, out); }},
    {{"curve of the area", FeatureAspect::time, 6},
     [](TimeBlock& block, const FrameSeries& series, Out out) {
       resample(series.area, over(1.0, block.peak_area_), out);
     }},
}};

std::vector<FeatureGroup> TimeBlock::groups() {
  return groups_of(kRows);
}

void TimeBlock::write(const FrameSeries& series, std::span<double> out) {
  scale(series);
  write_rows(kRows, *this, series, out);
}

void TimeBlock::put_course(std::span<double> out) const {
  const auto peak = std::max_element(force_.begin(), force_.end()) - force_.begin();
  double absolute = 0.0;
  for (const double slope : slope_) absolute += std::abs(slope);
  out[0] = mean_of(force_);
  out[1] = deviation_of(force_);
  out[2] = share_above(force_, kHeld);
  out[3] = share_above(force_, kTouched);
  out[4] = over(static_cast<double>(peak), static_cast<double>(slope_.size()));
  out[5] = over(absolute, static_cast<double>(slope_.size()));
  out[6] = largest_of(slope_);
  out[7] = smallest_of(slope_);
  out[8] = deviation_of(slope_);
}

/// Where the centre goes. A step counts as much as the weaker of its two frames.
void TimeBlock::put_path(const FrameSeries& series, std::span<double> out) const {
  double path = 0.0;
  double fastest = 0.0;
  for (std::size_t i = 0; i < slope_.size(); ++i) {
    const double step = std::hypot(series.row[i + 1] - series.row[i], series.col[i + 1] - series.col[i]);
    const double weighted = step * std::min(force_[i], force_[i + 1]);
    path += weighted;
    fastest = std::max(fastest, weighted);
  }
  const auto touched = [](double force) { return force > kTouched; };
  const auto first = std::find_if(force_.begin(), force_.end(), touched) - force_.begin();
  const auto last = std::find_if(force_.rbegin(), force_.rend(), touched).base() - force_.begin() - 1;
  double distance = 0.0;
  if (first <= last) {
    const auto from = static_cast<std::size_t>(first);
    const auto to = static_cast<std::size_t>(last);
    distance = std::hypot(series.row[to] - series.row[from], series.col[to] - series.col[from]);
  }
  constexpr double kLeastLength = 0.3;
  const auto frames = static_cast<double>(series.frames());
  out[0] = path;
  out[1] = over(path, static_cast<double>(slope_.size()));
  out[2] = fastest;
  out[3] = distance;
  out[4] = deviation_of(series.row);
  out[5] = deviation_of(series.col);
  out[6] = std::log((out[4] + kLeastLength) / (out[5] + kLeastLength));
  out[7] = distance / (path + kLeastLength);
  out[8] = static_cast<double>(peak_count(force_));
  out[9] = out[8] / frames;
  out[10] = static_cast<double>(crossing_count(force_));
  out[11] = out[10] / frames;
}

void TimeBlock::put_changes(const FrameSeries& series, std::span<double> out) const {
  const std::span<const double> changes = std::span(series.change).subspan(1);
  out[0] = over(mean_of(changes), peak_force_);
  out[1] = over(largest_of(changes), peak_force_);
  out[2] = over(deviation_of(changes), peak_force_);
  out[3] = over(deviation_of(series.peak), peak_taxel_);
  out[4] = over(deviation_of(series.area), peak_area_);
  out[5] = correlation(force_, series.area);
  out[6] = std::log((peak_taxel_ + least_reading_) / (peak_force_ + least_reading_));
}

/// Root of the shares of power in four bands.
void TimeBlock::put_spectrum(std::span<const double> signal, std::span<double> out) const {
  constexpr std::array<std::size_t, 5> kBands{1, 3, 6, 12, 33};  // where each begins, and the end
  const std::span<const double> points = signal.first(std::min(signal.size(), kPeriod));
  double sum = 0.0;
  for (std::size_t band = 0; band < out.size(); ++band) {
    out[band] = 0.0;
    for (std::size_t harmonic = kBands[band]; harmonic < kBands[band + 1]; ++harmonic) {
      out[band] += period_.power(points, harmonic);
    }
    sum += out[band];
  }
  for (double& power : out) power = std::sqrt(over(power, sum));
}

void TimeBlock::put_autocorrelations(std::span<double> out) const {
  constexpr std::array<std::size_t, 4> kLags{1, 2, 3, 5};
  for (std::size_t i = 0; i < kLags.size(); ++i) out[i] = autocorrelation(slope_, kLags[i]);
}

void TimeBlock::put_centre_spectrum(std::span<const double> place, std::span<double> out) {
  const double mean = mean_of(place);
  signal_.resize(force_.size());
  for (std::size_t i = 0; i < force_.size(); ++i) signal_[i] = force_[i] * (place[i] - mean);
  put_spectrum(signal_, out);
}

}  // namespace dermis::learn::recognition
