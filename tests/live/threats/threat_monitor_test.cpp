// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/threats/threat_monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/allocation_guard.hpp"
#include "support/reference_array.hpp"

namespace dermis::live::threats {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kCols = 6;
constexpr std::size_t kTaxels = 24;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ArrayDescription chest() {
  return support::reference_array(kTaxels / kCols, kCols);
}

ForceFrame idle_frame(Nanos time) {
  ForceFrame frame;
  frame.time = time;
  frame.newtons.assign(kTaxels, 0.0F);
  frame.sigma_newtons.assign(kTaxels, 0.01F);
  frame.signal_to_noise.assign(kTaxels, 0.0F);
  frame.taxels.assign(kTaxels, TaxelStatus::ok);
  return frame;
}

void press(ForceFrame& frame, std::size_t taxel, float newtons, float sigma = 0.01F) {
  frame.newtons[taxel] = newtons;
  frame.sigma_newtons[taxel] = sigma;
  frame.signal_to_noise[taxel] = std::isfinite(sigma) ? newtons / 0.01F : kInfinity;
}

Contact contact(double x_m, double y_m, double newtons, double sigma) {
  Contact contact;
  contact.id = 7;
  contact.phase = ContactPhase::held;
  contact.position = {x_m, y_m};
  contact.force_n = newtons;
  contact.sigma_force_n = sigma;
  contact.mean_pressure_pa = newtons * 1e3;
  return contact;
}

ThreatMonitor monitor_of(const ThreatLimits& limits, const std::string& array = "chest") {
  EXPECT_TRUE(limits.validate());
  Result<ThreatMonitor> monitor = ThreatMonitor::create(limits, array, chest());
  EXPECT_TRUE(monitor) << monitor.error().message;
  return *std::move(monitor);
}

ThreatLimit limit_of(ThreatQuantity quantity, double limit) {
  return {.name = "limit", .quantity = quantity, .limit = limit};
}

/// One contact and nothing else in the frame.
struct ContactScene {
  explicit ContactScene(const ThreatLimit& limit) : monitor(monitor_of({{}, {limit}})) {}

  bool see(Nanos time, double newtons, double sigma) {
    report.contacts = {contact(0.01, 0.01, newtons, sigma)};
    return monitor.process(idle_frame(time), report);
  }

  [[nodiscard]] const ThreatState& state() const { return monitor.states().front(); }

  ThreatMonitor monitor;
  ContactReport report;
};

TEST(ThreatMonitor, begins_a_threat_where_two_sigma_less_are_still_beyond_the_limit) {
  ContactScene scene(limit_of(ThreatQuantity::contact_force, 50.0));
  EXPECT_FALSE(scene.see(milliseconds(10), 60.0, 5.1));
  EXPECT_EQ(scene.state().phase, ThreatPhase::clear);
  EXPECT_TRUE(scene.see(milliseconds(20), 60.0, 4.9));
  EXPECT_EQ(scene.state().phase, ThreatPhase::standing);
  EXPECT_EQ(scene.state().crossed, milliseconds(20));
  EXPECT_EQ(scene.state().now.contact, 7U);
  EXPECT_EQ(scene.state().now.position, (PlaneVector{0.01, 0.01}));
}

TEST(ThreatMonitor, ends_a_threat_below_the_share_of_its_limit) {
  ContactScene scene(limit_of(ThreatQuantity::contact_force, 50.0));
  EXPECT_TRUE(scene.see(milliseconds(10), 60.0, 0.5));
  EXPECT_FALSE(scene.see(milliseconds(20), 41.0, 0.5));
  EXPECT_EQ(scene.state().phase, ThreatPhase::standing);
  EXPECT_EQ(scene.state().worst.value, 60.0);
  EXPECT_TRUE(scene.see(milliseconds(30), 39.0, 0.5));
  EXPECT_EQ(scene.state().phase, ThreatPhase::clear);
}

TEST(ThreatMonitor, keeps_a_latched_threat_until_it_is_reset) {
  ThreatLimit latched = limit_of(ThreatQuantity::contact_force, 50.0);
  latched.latched = true;
  ContactScene scene(latched);
  EXPECT_TRUE(scene.see(milliseconds(10), 60.0, 0.5));
  EXPECT_FALSE(scene.see(milliseconds(20), 0.0, 0.5));
  EXPECT_EQ(scene.state().phase, ThreatPhase::standing);
  scene.monitor.reset();
  EXPECT_EQ(scene.state().phase, ThreatPhase::clear);
  EXPECT_TRUE(scene.see(milliseconds(30), 60.0, 0.5));
}

TEST(ThreatMonitor, waits_as_long_as_a_limit_must_be_exceeded_and_tells_when_it_was_crossed) {
  ThreatLimit limit = limit_of(ThreatQuantity::contact_force, 50.0);
  limit.lasts_s = 0.1;
  ContactScene scene(limit);
  EXPECT_FALSE(scene.see(milliseconds(10), 60.0, 0.5));
  EXPECT_EQ(scene.state().phase, ThreatPhase::crossed);
  EXPECT_FALSE(scene.see(milliseconds(60), 30.0, 0.5));
  EXPECT_EQ(scene.state().phase, ThreatPhase::clear);
  EXPECT_FALSE(scene.see(milliseconds(70), 60.0, 0.5));
  EXPECT_FALSE(scene.see(milliseconds(160), 45.0, 0.5));
  EXPECT_TRUE(scene.see(milliseconds(170), 45.0, 0.5));
  EXPECT_EQ(scene.state().crossed, milliseconds(70));
}

TEST(ThreatMonitor, takes_a_saturated_force_for_a_lower_bound) {
  ContactScene scene(limit_of(ThreatQuantity::contact_force, 50.0));
  EXPECT_TRUE(scene.see(milliseconds(10), 60.0, std::numeric_limits<double>::infinity()));
  ThreatMonitor taxels = monitor_of({{}, {limit_of(ThreatQuantity::taxel_force, 20.0)}});
  ForceFrame frame = idle_frame(milliseconds(10));
  press(frame, 8, 25.0F, kInfinity);
  EXPECT_TRUE(taxels.process(frame, {}));
  EXPECT_EQ(taxels.states().front().now.position, (PlaneVector{0.02, 0.01}));
}

TEST(ThreatMonitor, bounds_a_force_beyond_the_calibrated_range_by_its_logarithm) {
  ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::taxel_force, 40.0)}});
  ForceFrame frame = idle_frame(milliseconds(10));
  press(frame, 8, 300.0F, 280.0F);
  EXPECT_FALSE(monitor.process(frame, {}));  // 0 N at least
  frame.status = FrameStatus::above_range;
  frame.taxels[8] = TaxelStatus::above_range;
  press(frame, 8, 300.0F, 310.0F);
  EXPECT_FALSE(monitor.process(frame, {}));  // 38 N
  press(frame, 8, 300.0F, 300.0F);
  EXPECT_TRUE(monitor.process(frame, {}));  // 41 N, though 2 sigma less is nothing
}

TEST(ThreatMonitor, compares_contacts_by_what_they_exceed_beyond_the_calibrated_range) {
  ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::contact_force, 40.0)}});
  ForceFrame frame = idle_frame(milliseconds(10));
  frame.status = FrameStatus::above_range;
  ContactReport report;
  report.contacts = {contact(0.01, 0.01, 300.0, 300.0), contact(0.03, 0.02, 5.0, 0.1)};
  EXPECT_TRUE(monitor.process(frame, report));
}

TEST(ThreatMonitor, sums_signed_forces_so_that_noise_cancels) {
  ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::total_force, 30.0)}});
  ForceFrame frame = idle_frame(milliseconds(10));
  const std::vector<float> zeros(frame.newtons.size());
  frame.sums.own_variance = frame.sums.newtons_per_siemens = frame.sums.newtons_per_celsius = zeros;
  for (std::size_t taxel = 0; taxel < zeros.size(); ++taxel) {
    frame.sums.newtons.push_back(taxel % 2 == 0 ? 5.0F : -5.0F);
    frame.newtons[taxel] = std::max(frame.sums.newtons[taxel], 0.0F);
  }
  EXPECT_FALSE(monitor.process(frame, {}));
  EXPECT_EQ(monitor.states().front().now.value, 0.0);
  press(frame, 0, 20.0F);
  press(frame, 2, 20.0F);
  press(frame, 3, kNan);
  frame.sums.newtons = zeros;
  for (const std::size_t taxel : {0U, 2U, 3U}) frame.sums.newtons[taxel] = frame.newtons[taxel];
  frame.time = milliseconds(20);
  EXPECT_TRUE(monitor.process(frame, {}));
  EXPECT_NEAR(monitor.states().front().now.value, 40.0, 1e-6);
  EXPECT_NEAR(monitor.states().front().now.position.x, 0.01, 1e-9);
}

TEST(ThreatMonitor, limits_the_mean_pressure_of_a_contact_and_the_pressure_on_a_taxel) {
  ContactScene scene(limit_of(ThreatQuantity::contact_pressure, 50e3));
  EXPECT_FALSE(scene.see(milliseconds(10), 60.0, 6.0));
  EXPECT_TRUE(scene.see(milliseconds(20), 60.0, 4.0));
  const double area_m2 = *chest().taxel_area_m2;
  ThreatMonitor taxels = monitor_of({{}, {limit_of(ThreatQuantity::taxel_pressure, 20.0 / area_m2)}});
  ForceFrame frame = idle_frame(milliseconds(10));
  press(frame, 8, 19.0F);
  EXPECT_FALSE(taxels.process(frame, {}));
  press(frame, 8, 21.0F);
  EXPECT_TRUE(taxels.process(frame, {}));
}

TEST(ThreatMonitor, calls_sharp_what_two_taxels_carry) {
  const auto is_sharp = [](const std::vector<float>& newtons) {
    ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::sharp_pressure, 60e3)}});
    ForceFrame frame = idle_frame(milliseconds(10));
    double sum = 0.0;
    for (std::size_t k = 0; k < newtons.size(); ++k) {
      press(frame, 8 + k, newtons[k]);
      sum += static_cast<double>(newtons[k]);
    }
    ContactReport report;
    report.contacts = {contact(0.02, 0.01, sum, 0.02)};
    return monitor.process(frame, report);
  };
  EXPECT_TRUE(is_sharp({4.0F}));
  EXPECT_TRUE(is_sharp({3.0F, 2.9F, 0.3F}));
  EXPECT_FALSE(is_sharp({2.9F}));              // less than 3 N
  EXPECT_FALSE(is_sharp({2.0F, 1.8F}));        // too little pressure
  EXPECT_FALSE(is_sharp({9.0F, 9.0F, 9.0F}));  // broad
}

TEST(ThreatMonitor, takes_the_rate_over_30_milliseconds_at_any_rate_of_frames) {
  for (const double frames_per_s : {33.0, 100.0, 1000.0, 20000.0}) {
    ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::force_rate, 1000.0)}});
    double steepest = 0.0;
    for (int k = 0; k < static_cast<int>(0.5 * frames_per_s); ++k) {
      const double seconds = k / frames_per_s;
      ForceFrame frame = idle_frame(Nanos(static_cast<Nanos::rep>(seconds * 1e9)));
      press(frame, 8, static_cast<float>(900.0 * seconds + 1.0));
      EXPECT_FALSE(monitor.process(frame, {})) << frames_per_s;
      steepest = std::max(steepest, monitor.states().front().now.value);
    }
    EXPECT_NEAR(steepest, 900.0, 5.0) << frames_per_s;
  }
}

TEST(ThreatMonitor, finds_a_hit) {
  ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::force_rate, 1000.0)}});
  Nanos first{};
  for (int k = 0; k < 30; ++k) {
    ForceFrame frame = idle_frame(milliseconds(10 * k));
    if (k >= 20) press(frame, 8, 45.0F);
    if (monitor.process(frame, {}) && first == Nanos{}) first = frame.time;
  }
  EXPECT_EQ(first, milliseconds(200));
  EXPECT_EQ(monitor.states().front().phase, ThreatPhase::clear);
}

TEST(ThreatMonitor, looks_at_the_zone_of_a_limit_alone) {
  ThreatLimit limit = limit_of(ThreatQuantity::taxel_force, 20.0);
  limit.zone = "throat";
  const ThreatLimits limits{{{"throat", "chest", 1, 2, 2, 3}}, {limit}};
  ThreatMonitor monitor = monitor_of(limits);
  ForceFrame frame = idle_frame(milliseconds(10));
  press(frame, 7, 50.0F);   // r1c1
  press(frame, 20, 50.0F);  // r3c2
  EXPECT_FALSE(monitor.process(frame, {}));
  press(frame, 15, 50.0F);  // r2c3
  EXPECT_TRUE(monitor.process(frame, {}));
  EXPECT_TRUE(monitor_of(limits, "arm").states().empty());
}

TEST(ThreatMonitor, looks_at_contacts_whose_centre_is_in_the_zone) {
  ThreatLimit limit = limit_of(ThreatQuantity::contact_force, 20.0);
  limit.zone = "throat";
  ThreatMonitor monitor = monitor_of({{{"throat", "chest", 1, 2, 2, 3}}, {limit}});
  ContactReport report;
  report.contacts = {contact(0.0149, 0.01, 50.0, 0.5)};
  EXPECT_FALSE(monitor.process(idle_frame(milliseconds(10)), report));
  report.contacts = {contact(0.015, 0.01, 50.0, 0.5)};  // between two zones: in the second
  EXPECT_TRUE(monitor.process(idle_frame(milliseconds(20)), report));
}

TEST(ThreatMonitor, takes_no_verdict_from_a_rejected_frame) {
  ContactScene scene(limit_of(ThreatQuantity::contact_force, 50.0));
  EXPECT_TRUE(scene.see(milliseconds(10), 60.0, 0.5));
  ForceFrame rejected = idle_frame(milliseconds(20));
  rejected.status = FrameStatus::rejected;
  EXPECT_FALSE(scene.monitor.process(rejected, {}));
  EXPECT_EQ(scene.state().phase, ThreatPhase::standing);
  EXPECT_FALSE(scene.state().changed);
}

TEST(ThreatMonitor, takes_what_is_beyond_the_edge_for_the_border) {
  ContactScene scene(limit_of(ThreatQuantity::contact_force, 50.0));
  scene.report.contacts = {contact(-0.02, 0.2, 60.0, 0.5)};
  EXPECT_TRUE(scene.monitor.process(idle_frame(milliseconds(10)), scene.report));
}

TEST(ThreatMonitor, ends_a_threat_where_time_goes_back) {
  ContactScene scene(limit_of(ThreatQuantity::contact_force, 50.0));
  EXPECT_TRUE(scene.see(milliseconds(1000), 60.0, 0.5));
  EXPECT_TRUE(scene.see(milliseconds(10), 0.0, 0.5));
  EXPECT_EQ(scene.state().phase, ThreatPhase::clear);
  EXPECT_TRUE(scene.state().changed);
}

TEST(ThreatMonitor, begins_anew_where_time_goes_back) {
  ThreatMonitor monitor = monitor_of({{}, {limit_of(ThreatQuantity::force_rate, 100.0)}});
  for (const int ms : {1000, 1010, 1020, 1030}) monitor.process(idle_frame(milliseconds(ms)), {});
  ForceFrame frame = idle_frame(milliseconds(10));
  press(frame, 8, 40.0F);
  EXPECT_FALSE(monitor.process(frame, {}));
}

TEST(ThreatMonitor, refuses_limits_that_do_not_fit_the_array) {
  ArrayDescription array = chest();
  ThreatLimit limit = limit_of(ThreatQuantity::taxel_force, 20.0);
  limit.zone = "throat";
  const Result<ThreatMonitor> outside =
      ThreatMonitor::create({{{"throat", "chest", 1, 4, 2, 3}}, {limit}}, "chest", array);
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().message, "zone 'throat': ends at r4c3; 'chest' has 4 x 6 taxels");
  array.taxel_area_m2.reset();
  array.name = "pad";
  const Result<ThreatMonitor> unknown =
      ThreatMonitor::create({{}, {limit_of(ThreatQuantity::sharp_pressure, 1e5)}}, "chest", array);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "threat 'limit': sharp_pressure needs taxel_area_mm2 in the array.toml of 'pad'");
}

TEST(ThreatMonitor, allocates_nothing_after_its_first_frame) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  ThreatLimits limits;
  for (std::size_t k = 0; k < threat_quantity_names().size(); ++k) {
    limits.limits.push_back(limit_of(static_cast<ThreatQuantity>(k), 20.0));
    limits.limits.back().name = threat_quantity_names()[k];
  }
  ThreatMonitor monitor = monitor_of(limits);
  ForceFrame frame = idle_frame(milliseconds(0));
  press(frame, 8, 40.0F);
  ContactReport report;
  report.contacts = {contact(0.02, 0.01, 40.0, 0.1)};
  monitor.process(frame, report);
  const support::AllocationGuard guard;
  for (int k = 1; k < 100; ++k) {
    frame.time = milliseconds(k);
    monitor.process(frame, report);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::live::threats
