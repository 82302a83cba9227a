// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/suits/array_worker.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace dermis::live::suits {
namespace {

constexpr Nanos kPublishInterval = std::chrono::milliseconds(100);
constexpr Nanos kLate = std::chrono::milliseconds(500);
constexpr Nanos kSilence = std::chrono::seconds(2);  // without a frame, the rate is 0
constexpr Nanos kStandingForLong = std::chrono::minutes(1);
constexpr double kSilentIntervals = 3.0;                        // of slow sources
constexpr Nanos kLongestWait = std::chrono::milliseconds(100);  // of a frame for its contacts
constexpr std::size_t kMostWaiting = 1024;

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

Result<std::unique_ptr<touch::pipeline::Pipeline>> make_pipeline(const touch::pipeline::Model& model) {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  return std::make_unique<touch::pipeline::Pipeline>(*std::move(pipeline));
}

Status check_sizes(const LiveArray& array) {
  const ArrayDescription& description = array.model->array;
  const std::optional<FrameShape> shape = array.source->shape();
  if (shape && *shape != FrameShape{description.rows, description.cols}) {
    return bad_input(fmt::format("the source has {}x{} taxels, its model {}x{}", shape->rows, shape->cols,
                                 description.rows, description.cols));
  }
  if (array.surface.taxels().size() != description.taxel_count()) {
    return bad_input(fmt::format("the surface has {} taxels, the model {}", array.surface.taxels().size(),
                                 description.taxel_count()));
  }
  return Done{};
}

bool is_silent(const ArrayStatistics& last, Nanos since) {
  return since > kSilence && 1e-9 * static_cast<double>(since.count()) * last.source.rate_hz > kSilentIntervals;
}

}  // namespace

Result<std::unique_ptr<ArrayWorker>> ArrayWorker::create(std::size_t index, LiveArray array,
                                                         const LiveOptions& options) {
  if (const Status fits = check_sizes(array); !fits) return fits.error();
  Result<std::unique_ptr<touch::pipeline::Pipeline>> pipeline = make_pipeline(*array.model);
  if (!pipeline) return pipeline.error();
  return std::unique_ptr<ArrayWorker>(new ArrayWorker(index, std::move(array), *std::move(pipeline), options));
}

ArrayWorker::ArrayWorker(std::size_t index, LiveArray array, std::unique_ptr<touch::pipeline::Pipeline> pipeline,
                         const LiveOptions& options)
    : index_(index),
      array_(std::move(array)),
      options_(options),
      pipeline_(std::move(pipeline)),
      settings_(options.settings),
      tracker_(array_.model->array, settings_.contacts, array_.model->strip),
      standing_{.watch = touch::pipeline::StandingLoadWatch(*array_.model)} {
  pipeline_->drift().set_options(settings_.drift);
}

template <typename Change>
void ArrayWorker::request(const Change& change) {
  const std::lock_guard lock(requests_.mutex);
  change(requests_.changes);
  requests_.is_any.store(true, std::memory_order_release);
}

void ArrayWorker::set_settings(const LiveSettings& settings) {
  request([&](Changes& changes) { changes.settings = settings; });
}

void ArrayWorker::set_zero(ZeroRequest zero) {
  request([&](Changes& changes) { changes.zero = zero; });
}

void ArrayWorker::use_zero(std::vector<double> offsets) {
  request([&](Changes& changes) { changes.offsets = std::move(offsets); });
}

Status ArrayWorker::set_model(const touch::pipeline::Model& model) {
  const ArrayDescription& present = array_.model->array;
  const ArrayDescription& next = model.array;
  if (next.rows != present.rows || next.cols != present.cols || next.row_pitch_m != present.row_pitch_m ||
      next.col_pitch_m != present.col_pitch_m) {
    return bad_input(fmt::format("array '{}': the new model is of another size or pitch", array_.name));
  }
  Result<std::unique_ptr<touch::pipeline::Pipeline>> pipeline = make_pipeline(model);
  if (!pipeline) return bad_input(fmt::format("array '{}': {}", array_.name, pipeline.error().message));
  touch::pipeline::StandingLoadWatch standing(model);
  request([&](Changes& changes) {
    changes.pipeline = *std::move(pipeline);
    changes.standing = std::move(standing);
  });
  return Done{};
}

void ArrayWorker::take_requests() {
  if (!requests_.is_any.load(std::memory_order_acquire)) return;
  Changes asked;
  {
    const std::lock_guard lock(requests_.mutex);
    asked = std::exchange(requests_.changes, {});
    requests_.is_any.store(false, std::memory_order_relaxed);
  }
  if (asked.pipeline) pipeline_ = std::move(asked.pipeline);
  if (asked.standing) standing_ = {.watch = *std::move(asked.standing)};
  settings_ = asked.settings.value_or(settings_);
  tracker_.set_options(settings_.contacts);
  pipeline_->drift().set_options(settings_.drift);
  if (!asked.offsets.empty()) pipeline_->drift().use_offsets(asked.offsets);
  set_zero_now(asked.zero);
}

void ArrayWorker::set_zero_now(ZeroRequest zero) {
  switch (zero) {
    case ZeroRequest::keep: break;
    case ZeroRequest::tare: pipeline_->tare(); break;
    case ZeroRequest::tare_over_load: pipeline_->tare(touch::pipeline::TareOver::any_load); break;
    case ZeroRequest::undo: pipeline_->undo_tare(); break;
    case ZeroRequest::reset: pipeline_->drift().reset(); break;
  }
}

void ArrayWorker::acquire() {
  while (acquire_one()) {
  }
}

bool ArrayWorker::acquire_one() {
  if (outcome_) return false;
  RawFrame& frame = waiting_.room();
  const Result<Polled> polled = array_.source->poll(frame);
  if (!polled) end(polled.error());
  if (polled && *polled == Polled::end) end(Done{});
  const bool has_come = polled && *polled == Polled::frame;
  if (has_come) take(frame);
  return has_come;
}

void ArrayWorker::await() {
  if (outcome_) return;
  RawFrame& frame = waiting_.room();
  const Result<bool> more = array_.source->next(frame);
  if (!more) return end(more.error());
  if (!*more) return end(Done{});
  take(frame);
}

/// Where frames come faster than their contacts can be found, the newest one counts.
void ArrayWorker::take(const RawFrame& frame) {
  if (options_.on_frame) options_.on_frame(index_, frame);
  waiting_.push();
  const Nanos waited = frame.acquisition.arrival_steady - waiting_.front().acquisition.arrival_steady;
  if (waited <= kLongestWait && waiting_.size() <= kMostWaiting) return;
  counts_.skipped += waiting_.size() - 1;
  while (waiting_.size() > 1) waiting_.pop();
}

void ArrayWorker::end(Status outcome) {
  outcome_ = std::move(outcome);
  if (waiting_.empty()) finish();
}

bool ArrayWorker::process() {
  if (waiting_.empty()) return false;
  find_contacts(waiting_.front());
  waiting_.pop();
  if (!waiting_.empty()) return true;
  if (outcome_) finish();
  return false;
}

void ArrayWorker::stop() {
  if (!ended()) finish();
}

void ArrayWorker::find_contacts(const RawFrame& frame) {
  take_requests();
  pipeline_->process(frame, results_.force);
  if (pipeline_->rejection() == touch::preprocessing::Rejection::time_going_backwards && was_sought_back(frame)) {
    begin_anew(frame);
  }
  last_time_ = frame.time;
  tracker_.process(results_.force, results_.report);
  place_contacts();
  follow_standing();
  results_.temperature_celsius =
      frame.sensor_celsius.empty() ? frame.temperature_celsius : pipeline_->conditioned().temperature_celsius;
  results_.supply_v = frame.supply_v;
  const Nanos now = steady_now();
  meter(frame, now);
  if (!options_.on_result) return;
  const Nanos arrival = frame.acquisition.arrival_steady;
  const Nanos latency = arrival > Nanos{} ? now - arrival : Nanos{};
  options_.on_result({index_, frame, pipeline_->conductance(), results_.force, results_.report, results_.contacts,
                      latency, pipeline_->last_tare().number});
}

/// A frame of a device that comes a little late is rejected and no more.
bool ArrayWorker::was_sought_back(const RawFrame& frame) const noexcept {
  return last_time_ - frame.time > kLate;
}

/// A recording was sought back: the frame counts, and touches from before are not followed on.
void ArrayWorker::begin_anew(const RawFrame& frame) {
  pipeline_->process(frame, results_.force);
  tracker_.forget();
}

void ArrayWorker::place_contacts() {
  results_.contacts.resize(results_.report.contacts.size());
  for (std::size_t k = 0; k < results_.contacts.size(); ++k) {
    const Contact& contact = results_.report.contacts[k];
    results_.contacts[k] = {index_, contact, array_.surface.at(contact.position),
                            array_.surface.along(contact.position, contact.velocity)};
  }
}

/// A load that is put there later counts from when nothing stood there.
void ArrayWorker::follow_standing() {
  standing_.watch.add(pipeline_->conductance(), results_.force);
  if (standing_.watch.is_any_loaded()) return;
  standing_.watch.begin_anew();
  standing_.since_first = false;
}

std::optional<touch::pipeline::StandingLoad> ArrayWorker::standing_load() const {
  if (!standing_.since_first && standing_.watch.lasted() < kStandingForLong) return std::nullopt;
  return standing_.watch.load();
}

void ArrayWorker::meter(const RawFrame& frame, Nanos now) {
  ++counts_.frames;
  if (has(results_.force.status, FrameStatus::rejected)) ++counts_.rejected;
  const Nanos arrival = frame.acquisition.arrival_steady;
  if (arrival > Nanos{}) counts_.latencies.add(now, now - arrival);
  if (now - published_.at < kPublishInterval) return;
  const std::unique_lock lock(published_.mutex, std::try_to_lock);
  if (lock) publish(now);
}

/// With published_.mutex held.
void ArrayWorker::publish(Nanos now) {
  published_.at = now;
  published_.statistics.source = array_.source->statistics();
  published_.statistics.frames = counts_.frames;
  published_.statistics.rejected = counts_.rejected;
  published_.statistics.skipped = counts_.skipped;
  published_.statistics.latency_p50 = counts_.latencies.quantile(now, 0.5);
  published_.statistics.latency_p99 = counts_.latencies.quantile(now, 0.99);
  const auto faults = pipeline_->line_faults().faults();
  published_.statistics.faults.assign(faults.begin(), faults.end());
  const touch::pipeline::Tare& tare = pipeline_->last_tare();
  const touch::pipeline::Tare& told = published_.statistics.tare;
  if (tare.number != told.number || tare.state != told.state) {
    const std::span<const double> offsets = pipeline_->drift().offsets();
    published_.zero.assign(offsets.begin(), offsets.end());
  }
  published_.statistics.tare = tare;
  published_.statistics.standing = standing_load();
  published_.statistics.temperature_celsius = results_.temperature_celsius;
  published_.statistics.supply_v = results_.supply_v;
}

void ArrayWorker::finish() {
  const Status outcome = outcome_.value_or(Done{});
  {
    const std::lock_guard lock(published_.mutex);
    publish(steady_now());
    published_.statistics.ended = true;
    if (!outcome) published_.statistics.error = outcome.error().message;
  }
  if (options_.notice && !outcome) options_.notice(fmt::format("array '{}': {}", array_.name, outcome.error().message));
  ended_.store(true, std::memory_order_release);
}

ArrayStatistics ArrayWorker::statistics() const {
  const std::lock_guard lock(published_.mutex);
  ArrayStatistics statistics = published_.statistics;
  if (!statistics.ended && is_silent(statistics, steady_now() - published_.at)) statistics.source.rate_hz = 0.0;
  return statistics;
}

std::vector<double> ArrayWorker::zero() const {
  const std::lock_guard lock(published_.mutex);
  return published_.zero;
}

}  // namespace dermis::live::suits
