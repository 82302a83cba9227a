// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/threats/threat_monitor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/millimetres.hpp"
#include "live/threats/measure.hpp"
#include "live/threats/rate_window.hpp"

namespace dermis::live::threats {
namespace {

constexpr double kKilo = 1e-3;

bool is_pressure(ThreatQuantity quantity) {
  return std::string_view(unit_of(quantity)) == "Pa";
}

bool concerns(const ThreatLimit& limit, const ThreatLimits& limits, std::string_view array) {
  return limit.zone.empty() || limits.zone(limit.zone)->array == array;
}

Result<Area> area_of(const ThreatLimit& limit, const ThreatLimits& limits, const ArrayDescription& array) {
  Area area = Area::whole(array);
  if (is_pressure(limit.quantity) && !array.taxel_area_m2) {
    return bad_input(fmt::format("threat '{}': {} needs taxel_area_mm2 in the array.toml of '{}'", limit.name,
                                 threat_quantity_names()[static_cast<std::size_t>(limit.quantity)], array.name));
  }
  if (limit.zone.empty()) return area;
  const Zone& zone = *limits.zone(limit.zone);
  if (zone.last_row > area.last_row || zone.last_col > area.last_col) {
    return bad_input(fmt::format("zone '{}': ends at r{}c{}; '{}' has {} x {} taxels", zone.name, zone.last_row,
                                 zone.last_col, zone.array, array.rows, array.cols));
  }
  area.first_row = zone.first_row;
  area.last_row = zone.last_row;
  area.first_col = zone.first_col;
  area.last_col = zone.last_col;
  return area;
}

/// One limit at work.
class Watch {
 public:
  Watch(std::size_t place, ThreatLimit limit, const Area& area) : limit_(std::move(limit)), area_(area) {
    state_.limit = place;
    if (limit_.quantity == ThreatQuantity::force_rate) rate_.emplace(kRateWindow);
  }

  /// `is_earlier`: than the frame before; the present state is of another time.
  void process(const ForceFrame& force, const ContactReport& report, bool is_earlier) noexcept {
    state_.changed = false;
    if (is_earlier) forget();
    state_.now = value_of(force, report);
    if (state_.phase == ThreatPhase::clear) {
      if (!(state_.now.least() > limit_.limit)) return;
      state_.phase = ThreatPhase::crossed;
      state_.crossed = force.time;
      state_.worst = state_.now;
    }
    if (state_.now.value > state_.worst.value) state_.worst = state_.now;
    if (state_.now.value < limit_.release_share * limit_.limit) release();
    if (state_.phase == ThreatPhase::crossed && lasts(force.time)) begin();
  }

  void pass_over() noexcept { state_.changed = false; }

  void reset() noexcept {
    if (state_.phase == ThreatPhase::standing && limit_.latched) end();
  }

  [[nodiscard]] const ThreatState& state() const noexcept { return state_; }

 private:
  ThreatValue value_of(const ForceFrame& force, const ContactReport& report) noexcept {
    ThreatValue value = measure(limit_, area_, force, report);
    if (!rate_) return value;
    const std::optional<RateWindow::Rate> rate = rate_->add(force.time, value.value, value.sigma);
    value.value = rate ? rate->per_second : 0.0;
    value.sigma = rate ? rate->sigma : 0.0;
    return value;
  }

  [[nodiscard]] bool lasts(Nanos now) const noexcept {
    return std::chrono::duration<double>(now - state_.crossed).count() >= limit_.lasts_s;
  }

  void forget() noexcept {
    if (rate_) rate_->forget();
    release();
  }

  void begin() noexcept {
    state_.phase = ThreatPhase::standing;
    state_.changed = true;
  }

  void end() noexcept {
    state_.phase = ThreatPhase::clear;
    state_.changed = true;
  }

  void release() noexcept {
    if (state_.phase == ThreatPhase::crossed) state_.phase = ThreatPhase::clear;
    if (state_.phase == ThreatPhase::standing && !limit_.latched) end();
  }

  ThreatLimit limit_;
  Area area_;
  std::optional<RateWindow> rate_;
  ThreatState state_;
};

}  // namespace

class ThreatMonitor::Implementation {
 public:
  void add(Watch watch) {
    watches_.push_back(std::move(watch));
    states_.push_back(watches_.back().state());
  }

  bool process(const ForceFrame& force, const ContactReport& report) noexcept {
    const bool is_rejected = has(force.status, FrameStatus::rejected);
    const bool is_earlier = !is_rejected && force.time < last_;
    if (!is_rejected) last_ = force.time;
    for (Watch& watch : watches_) is_rejected ? watch.pass_over() : watch.process(force, report, is_earlier);
    take_states();
    return std::any_of(states_.begin(), states_.end(), [](const ThreatState& state) { return state.changed; });
  }

  void reset() noexcept {
    for (Watch& watch : watches_) watch.reset();
    take_states();
  }

  [[nodiscard]] std::span<const ThreatState> states() const noexcept { return states_; }

 private:
  void take_states() noexcept {
    for (std::size_t k = 0; k < watches_.size(); ++k) states_[k] = watches_[k].state();
  }

  std::vector<Watch> watches_;
  std::vector<ThreatState> states_;  // of each
  Nanos last_ = Nanos::min();
};

std::string describe(const ThreatLimit& limit, const ThreatValue& value) {
  std::string quantity = threat_quantity_names()[static_cast<std::size_t>(limit.quantity)];
  std::ranges::replace(quantity, '_', ' ');
  const double scale = is_pressure(limit.quantity) ? kKilo : 1.0;
  return fmt::format("{} {:.1f} \u00b1 {:.1f} {}{}, limit {:g}, at x {:.1f} mm, y {:.1f} mm", quantity,
                     scale * value.value, scale * value.sigma, is_pressure(limit.quantity) ? "k" : "",
                     unit_of(limit.quantity), scale * limit.limit, kMillimetresPerMetre * value.position.x,
                     kMillimetresPerMetre * value.position.y);
}

Result<ThreatMonitor> ThreatMonitor::create(const ThreatLimits& limits, std::string_view name,
                                            const ArrayDescription& array) {
  auto implementation = std::make_unique<Implementation>();
  for (std::size_t place = 0; place < limits.limits.size(); ++place) {
    const ThreatLimit& limit = limits.limits[place];
    if (!concerns(limit, limits, name)) continue;
    const Result<Area> area = area_of(limit, limits, array);
    if (!area) return area.error();
    implementation->add(Watch(place, limit, *area));
  }
  return ThreatMonitor(std::move(implementation));
}

ThreatMonitor::ThreatMonitor(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ThreatMonitor::ThreatMonitor(ThreatMonitor&&) noexcept = default;
ThreatMonitor& ThreatMonitor::operator=(ThreatMonitor&&) noexcept = default;
ThreatMonitor::~ThreatMonitor() = default;

bool ThreatMonitor::process(const ForceFrame& force, const ContactReport& report) noexcept {
  return implementation_->process(force, report);
}

std::span<const ThreatState> ThreatMonitor::states() const noexcept {
  return implementation_->states();
}

void ThreatMonitor::reset() noexcept {
  implementation_->reset();
}

}  // namespace dermis::live::threats
