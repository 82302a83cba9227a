// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/frame_mean.hpp"

#include <cassert>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

template <typename T>
void accumulate(std::vector<T>& sum, const std::vector<T>& values) {
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += values[k];
}

}  // namespace

void FrameMean::clear() {
  *this = {};
}

void FrameMean::add(const RawFrame& raw, std::span<const double> ratio) {
  if (count_ == 0) {
    begin_ = raw.time;
    counts_.assign(ratio.size(), 0.0);
    ratio_.assign(ratio.size(), 0.0);
    sensors_.assign(raw.sensor_celsius.size(), 0.0);
    sensor_readings_.assign(raw.sensor_celsius.size(), 0);
    squared_steps_.assign(ratio.size(), 0.0);
    last_ratio_.assign(ratio.begin(), ratio.end());
  }
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    const double step = ratio[k] - last_ratio_[k];
    counts_[k] += static_cast<double>(raw.counts[k]);
    ratio_[k] += ratio[k];
    squared_steps_[k] += step * step;
    last_ratio_[k] = ratio[k];
  }
  if (raw.temperature_celsius) {
    temperature_ += *raw.temperature_celsius;
    ++temperatures_;
  }
  if (raw.sensor_celsius.size() == sensors_.size()) add_sensors(raw);
  if (raw.supply_v) {
    supply_ += *raw.supply_v;
    ++supplies_;
  }
  end_ = raw.time;
  ++count_;
}

void FrameMean::add_sensors(const RawFrame& raw) {
  for (std::size_t k = 0; k < sensors_.size(); ++k) {
    if (!std::isfinite(raw.sensor_celsius[k])) continue;
    sensors_[k] += static_cast<double>(raw.sensor_celsius[k]);
    ++sensor_readings_[k];
  }
}

void FrameMean::add(const FrameMean& other) {
  if (count_ == 0) {
    *this = other;
    return;
  }
  accumulate(counts_, other.counts_);
  accumulate(ratio_, other.ratio_);
  if (other.sensors_.size() == sensors_.size()) {
    accumulate(sensors_, other.sensors_);
    accumulate(sensor_readings_, other.sensor_readings_);
  }
  accumulate(squared_steps_, other.squared_steps_);
  temperature_ += other.temperature_;
  supply_ += other.supply_;
  temperatures_ += other.temperatures_;
  supplies_ += other.supplies_;
  count_ += other.count_;
  end_ = other.end_;
}

RawFrame FrameMean::frame() const {
  assert(count_ > 0);
  RawFrame frame;
  frame.time = end_;
  for (const double sum : counts_) frame.counts.push_back(static_cast<float>(sum / static_cast<double>(count_)));
  if (temperatures_ > 0) frame.temperature_celsius = temperature_ / static_cast<double>(temperatures_);
  for (std::size_t k = 0; k < sensors_.size(); ++k) {
    const double mean = sensors_[k] / static_cast<double>(sensor_readings_[k]);  // NaN where there is no reading
    frame.sensor_celsius.push_back(static_cast<float>(mean));
  }
  if (supplies_ > 0) frame.supply_v = supply_ / static_cast<double>(supplies_);
  return frame;
}

}  // namespace dermis::learn::calibration
