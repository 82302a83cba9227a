// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/array_forces.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::recognising {
namespace {

constexpr std::size_t kTareFrames = 10;
constexpr std::chrono::seconds kTareTime{1};
constexpr std::chrono::seconds kMostTareTime{10};

}  // namespace

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

Result<ArrayForces> ArrayForces::open(const ArrayForceInput& input) {
  ArrayForces source;
  source.from_ = input.from;
  live::sources::SourceOptions options = input.source;
  if (!input.model.empty()) {
    Result<live::forces::ModelAtWork> work = live::forces::ModelAtWork::read(input.model);
    if (!work) return work.error();
    source.work_.emplace(*std::move(work));
    options.array = &source.work_->model.array;
    source.troubles_.emplace(*options.array, input.from);
    source.loss_ = options.loss;
    if (input.tare) {
      source.work_->pipeline.tare(input.tare_force ? touch::pipeline::TareOver::any_load
                                                   : touch::pipeline::TareOver::drift);
    }
  } else if (input.tare) {
    source.unloaded_.emplace();
  }
  const std::string known_name = source.work_ ? source.work_->model.array.name : "array";
  source.name_ = input.name.empty() ? known_name : input.name;
  Result<std::unique_ptr<FrameSource>> frames = live::sources::open_source(input.from, options);
  if (!frames) return frames.error();
  source.frames_ = *std::move(frames);
  return source;
}

Result<bool> ArrayForces::next() {
  Result<bool> more = frames_->next(raw_);
  if (more && !*more) tell_loss();
  if (!more || !*more) return more;
  work_ ? process_forces() : process_readings();
  if (Status tared = check_tare(); !tared) return tared.error();
  for (float& load : loads_) load = !is_tare_ && std::isfinite(load) ? std::max(load, 0.0F) : 0.0F;
  return true;
}

void ArrayForces::process_forces() {
  work_->pipeline.process(raw_, force_);
  troubles_->add(raw_, force_, work_->pipeline, frames_.get());
  is_tare_ = work_->pipeline.drift().taring();
  loads_ = force_.newtons;
}

Status ArrayForces::check_tare() const {
  if (!work_ || work_->pipeline.last_tare().state != touch::pipeline::Tare::State::refused) return Done{};
  return failed(fmt::format("{}: not tared: {}, or force the tare", from_,
                            touch::pipeline::describe(work_->pipeline.last_tare(), work_->model.array)));
}

void ArrayForces::process_readings() {
  loads_ = raw_.counts;
  is_tare_ = unloaded_ && unloaded_->add(raw_);
  if (unloaded_ && !is_tare_) unloaded_->subtract_from(loads_);
}

void ArrayForces::tell_loss() {
  if (!troubles_ || !loss_) return;
  if (const Status verdict = troubles_->verdict(); !verdict) loss_(verdict.error().message);
}

std::optional<learn::recognition::SensedArray> ArrayForces::array() const {
  if (work_) return learn::recognition::sensed_array(work_->model.array, name_);
  const std::optional<FrameShape> shape = frames_->shape();
  if (!shape) return std::nullopt;
  return learn::recognition::SensedArray{.name = name_, .rows = shape->rows, .cols = shape->cols};
}

Result<HeldForces> HeldForces::open(const ArrayForceInput& input) {
  Result<ArrayForces> array = ArrayForces::open(input);
  if (!array) return array.error();
  if (const Result<bool> has_frame = array->next(); !has_frame) return has_frame.error();
  return HeldForces(*std::move(array), input.tare);
}

HeldForces::HeldForces(ArrayForces array, bool is_tare)
    : array_(std::move(array)), is_tare_(is_tare), loads_(array_.loads().size()) {}

Status HeldForces::move_to(Nanos time) {
  if (!last_) last_ = time;
  while (has_next_ && array_.time() <= time) {
    loads_ = array_.loads();
    is_tare_ = array_.is_tare();
    last_ = array_.time();
    const Result<bool> more = array_.next();
    if (!more) return more.error();
    has_next_ = *more;
  }
  if (time - *last_ > learn::recognition::kLongestSilence) {
    std::fill(loads_.begin(), loads_.end(), 0.0F);
    ++silent_;
  }
  return Done{};
}

}  // namespace dermis::recognising
