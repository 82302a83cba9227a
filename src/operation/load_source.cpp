// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/operation/load_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace dermis::operation {
namespace {

constexpr std::size_t kTareFrames = 10;
constexpr std::chrono::seconds kTareTime{1};
constexpr std::chrono::seconds kMostTareTime{10};

}  // namespace

Status check_loads(const recognition::Layout& examples, const std::string& classes, const std::string& model) {
  if (examples.has_forces() && model.empty()) {
    return bad_input(classes + ": its classes were learned from forces; name the --model of the array");
  }
  if (!examples.has_forces() && !model.empty()) {
    return bad_input(classes +
                     ": its classes were learned from readings, not from forces; leave --model out, or learn " +
                     "them with --model");
  }
  return Done{};
}

bool UnloadedReadings::add(const RawFrame& frame) {
  if (is_done_) return false;
  if (frames_ == 0) {
    first_time_ = frame.time;
    sum_.assign(frame.counts.size(), 0.0);
    count_.assign(frame.counts.size(), 0.0);
  }
  const Nanos lasted = frame.time - first_time_;
  is_done_ = frames_ > 0 && (lasted >= kMostTareTime || (lasted >= kTareTime && frames_ >= kTareFrames));
  if (is_done_) return false;
  ++frames_;
  for (std::size_t taxel = 0; taxel < sum_.size(); ++taxel) {
    if (!std::isfinite(frame.counts[taxel])) continue;
    sum_[taxel] += static_cast<double>(frame.counts[taxel]);
    count_[taxel] += 1.0;
  }
  return true;
}

void UnloadedReadings::subtract_from(std::vector<float>& readings) const {
  for (std::size_t taxel = 0; taxel < sum_.size(); ++taxel) {
    readings[taxel] -= static_cast<float>(sum_[taxel] / std::max(count_[taxel], 1.0));
  }
}

Result<LoadSource> LoadSource::open(const LoadInput& input) {
  LoadSource source;
  sources::SourceOptions options = input.source;
  if (!input.model.empty()) {
    Result<ModelAtWork> work = ModelAtWork::read(input.model);
    if (!work) return work.error();
    source.work_.emplace(*std::move(work));
    options.array = &source.work_->model.array;
    if (input.tare) source.work_->pipeline.drift().tare();
  } else if (input.tare) {
    source.unloaded_.emplace();
  }
  Result<std::unique_ptr<FrameSource>> frames = sources::open_source(input.from, options);
  if (!frames) return frames.error();
  source.frames_ = *std::move(frames);
  return source;
}

Result<bool> LoadSource::next() {
  Result<bool> more = frames_->next(raw_);
  if (!more || !*more) return more;
  work_ ? process_forces() : process_readings();
  for (float& load : loads_) load = !is_tare_ && std::isfinite(load) ? std::max(load, 0.0F) : 0.0F;
  return true;
}

void LoadSource::process_forces() {
  work_->pipeline.process(raw_, force_);
  is_tare_ = work_->pipeline.drift().taring();
  loads_ = force_.newtons;
}

void LoadSource::process_readings() {
  loads_ = raw_.counts;
  is_tare_ = unloaded_ && unloaded_->add(raw_);
  if (unloaded_ && !is_tare_) unloaded_->subtract_from(loads_);
}

std::optional<recognition::SensedArray> LoadSource::array() const {
  if (work_) return recognition::sensed_array(work_->model.array, work_->model.array.name);
  const std::optional<FrameShape> shape = frames_->shape();
  if (!shape) return std::nullopt;
  return recognition::SensedArray{.name = "array", .rows = shape->rows, .cols = shape->cols};
}

}  // namespace dermis::operation
