// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "load_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "dermis/sources/open_source.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr std::size_t kTareFrames = 10;
constexpr std::chrono::seconds kTareTime{1};
constexpr std::chrono::seconds kMostTareTime{10};
constexpr double kMillimetresPerMetre = 1000.0;

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
  if (!input.model.empty()) {
    Result<pipeline::Model> model = pipeline::read_model(input.model);
    if (!model) return model.error();
    Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(*model);
    if (!pipeline) return pipeline.error();
    source.forces_ = std::make_unique<Forces>(Forces{*std::move(model), *std::move(pipeline), {}});
    if (input.tare) source.forces_->pipeline.drift().tare();
  } else if (input.tare) {
    source.unloaded_.emplace();
  }
  const ArrayDescription* const array = source.forces_ ? &source.forces_->model.array : input.array;
  Result<std::unique_ptr<FrameSource>> frames =
      sources::open_source(input.from, {.array = array, .stop = input.stop, .notice = say});
  if (!frames) return frames.error();
  source.frames_ = *std::move(frames);
  return source;
}

Result<bool> LoadSource::next() {
  Result<bool> more = frames_->next(raw_);
  if (!more || !*more) return more;
  forces_ ? process_forces() : process_readings();
  for (float& load : loads_) load = !is_tare_ && std::isfinite(load) ? std::max(load, 0.0F) : 0.0F;
  return true;
}

void LoadSource::process_forces() {
  forces_->pipeline.process(raw_, forces_->frame);
  is_tare_ = forces_->pipeline.drift().taring();
  loads_ = forces_->frame.newtons;
}

void LoadSource::process_readings() {
  loads_ = raw_.counts;
  is_tare_ = unloaded_ && unloaded_->add(raw_);
  if (unloaded_ && !is_tare_) unloaded_->subtract_from(loads_);
}

std::optional<recognition::SensedArray> LoadSource::array() const {
  if (forces_) {
    const ArrayDescription& array = forces_->model.array;
    return recognition::SensedArray{.name = array.name,
                                    .rows = array.rows,
                                    .cols = array.cols,
                                    .row_pitch_mm = kMillimetresPerMetre * array.row_pitch_m,
                                    .col_pitch_mm = kMillimetresPerMetre * array.col_pitch_m};
  }
  const std::optional<FrameShape> shape = frames_->shape();
  if (!shape) return std::nullopt;
  return recognition::SensedArray{.name = "array", .rows = shape->rows, .cols = shape->cols};
}

}  // namespace dermis::app
