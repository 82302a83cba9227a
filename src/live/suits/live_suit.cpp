// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/suits/live_suit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "live/suits/array_worker.hpp"
#include "live/suits/work_loop.hpp"

namespace dermis::live::suits {

namespace {

/// A thread that another program puts off makes all of its arrays late.
constexpr std::size_t kMostArraysOfThread = 2;

/// Frames of a recording that work() takes: its clock waits for who is slower.
constexpr std::size_t kMostAtOnce = 8;

}  // namespace

class LiveSuit::Implementation {
 public:
  explicit Implementation(LiveOptions options) : options_(std::move(options)) {}

  Status add(LiveArray array) {
    const std::string place = fmt::format("array '{}': ", array.name);
    Result<std::unique_ptr<ArrayWorker>> worker = ArrayWorker::create(workers_.size(), std::move(array), options_);
    if (!worker) return bad_input(place + worker.error().message);
    workers_.push_back(*std::move(worker));
    return Done{};
  }

  /// The arrays, the largest first, each to the thread that has the fewest taxels so far.
  void start() {
    const std::size_t needed = (workers_.size() + kMostArraysOfThread - 1) / kMostArraysOfThread;
    const std::size_t threads =
        std::min(std::max<std::size_t>(std::thread::hardware_concurrency(), needed), workers_.size());
    std::vector<std::size_t> taxels(threads);
    std::vector<ArrayWorker*> largest_first;
    for (const auto& worker : workers_) largest_first.push_back(worker.get());
    std::ranges::stable_sort(largest_first, std::greater<>(), &ArrayWorker::taxel_count);
    loops_.resize(threads);
    for (ArrayWorker* const worker : largest_first) {
      const auto lightest = std::ranges::min_element(taxels);
      loops_[static_cast<std::size_t>(lightest - taxels.begin())].add(*worker);
      *lightest += worker->taxel_count();
    }
    for (WorkLoop& loop : loops_) loop.start();
  }

  void work() {
    for (const auto& worker : workers_) {
      if (worker->readiness()) {
        worker->acquire();
      } else {
        for (std::size_t k = 0; k < kMostAtOnce && worker->acquire_one(); ++k) {
        }
      }
      while (worker->process()) {
      }
    }
  }

  void stop() {
    for (WorkLoop& loop : loops_) loop.ask_to_stop();
    for (WorkLoop& loop : loops_) loop.stop();
  }

  void set_settings(const LiveSettings& settings) {
    const std::lock_guard lock(mutex_);
    options_.settings = settings;
    for (const auto& worker : workers_) worker->set_settings(settings);
  }
  LiveSettings settings() const {
    const std::lock_guard lock(mutex_);
    return options_.settings;
  }

  void set_zero(std::optional<std::size_t> array, ZeroRequest request) {
    if (array) return at(*array).set_zero(request);
    for (const auto& worker : workers_) worker->set_zero(request);
  }

  ArrayWorker& at(std::size_t array) const {
    assert(array < workers_.size());
    return *workers_[array];
  }
  const std::vector<std::unique_ptr<ArrayWorker>>& workers() const { return workers_; }

 private:
  LiveOptions options_;
  std::vector<std::unique_ptr<ArrayWorker>> workers_;
  std::deque<WorkLoop> loops_;
  mutable std::mutex mutex_;  // Of the settings.
};

Result<std::unique_ptr<LiveSuit>> LiveSuit::create(std::vector<LiveArray> arrays, LiveOptions options) {
  if (arrays.empty()) return bad_input("a suit needs at least one array");
  if (const Status valid = options.settings.validate(); !valid) return valid.error();
  auto implementation = std::make_unique<Implementation>(std::move(options));
  for (LiveArray& array : arrays) {
    if (const Status added = implementation->add(std::move(array)); !added) return added.error();
  }
  return std::unique_ptr<LiveSuit>(new LiveSuit(std::move(implementation)));
}

LiveSuit::LiveSuit(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

LiveSuit::~LiveSuit() {
  stop();
}

void LiveSuit::start() {
  implementation_->start();
}

void LiveSuit::work() {
  implementation_->work();
}

void LiveSuit::stop() {
  implementation_->stop();
}

bool LiveSuit::ended() const noexcept {
  const auto& workers = implementation_->workers();
  return std::all_of(workers.begin(), workers.end(), [](const auto& worker) { return worker->ended(); });
}

void LiveSuit::set_settings(const LiveSettings& settings) {
  assert(settings.validate());
  implementation_->set_settings(settings);
}

LiveSettings LiveSuit::settings() const {
  return implementation_->settings();
}

void LiveSuit::tare(std::optional<std::size_t> array, touch::pipeline::TareOver over) {
  implementation_->set_zero(array,
                            over == touch::pipeline::TareOver::drift ? ZeroRequest::tare : ZeroRequest::tare_over_load);
}

void LiveSuit::undo_tare(std::optional<std::size_t> array) {
  implementation_->set_zero(array, ZeroRequest::undo);
}

void LiveSuit::reset_tare(std::optional<std::size_t> array) {
  implementation_->set_zero(array, ZeroRequest::reset);
}

void LiveSuit::use_zero(std::size_t array, std::vector<double> offsets) {
  implementation_->at(array).use_zero(std::move(offsets));
}

Status LiveSuit::set_model(std::size_t array, const std::shared_ptr<const touch::pipeline::Model>& model) {
  assert(model);
  return implementation_->at(array).set_model(*model);
}

ArrayStatistics LiveSuit::statistics(std::size_t array) const {
  return implementation_->at(array).statistics();
}

std::vector<double> LiveSuit::zero(std::size_t array) const {
  return implementation_->at(array).zero();
}

}  // namespace dermis::live::suits
