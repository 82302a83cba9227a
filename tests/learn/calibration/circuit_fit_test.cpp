// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/circuit_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/simulated.hpp"
#include "learn/calibration/simulated_user.hpp"
#include "support/shared_data.hpp"

namespace dermis::learn::calibration {
namespace {

/// 20 ohm drivers and 200 ohm loads, each with 10 % of its own.
ArrayDescription uneven_array(std::size_t lines, std::uint64_t seed) {
  ArrayDescription array = reference_array(lines, lines);
  Random random(seed);
  for (double& ohm : array.readout.drive_ohm) ohm *= std::exp(0.1 * random.normal());
  for (double& ohm : array.readout.load_ohm) ohm *= std::exp(0.1 * random.normal());
  return array;
}

/// Only the first load is known.
ArrayDescription to_be_fitted(ArrayDescription array) {
  array.readout.drive_ohm.assign(array.readout.drive_ohm.size(), kFitOhm);
  std::fill(array.readout.load_ohm.begin() + 1, array.readout.load_ohm.end(), kFitOhm);
  return array;
}

double worst_error(const std::vector<double>& found, const std::vector<double>& truth) {
  double worst = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) worst = std::max(worst, std::abs(found[k] / truth[k] - 1.0));
  return worst;
}

/// Root mean square of the errors in their own standard errors: near 1 where those are honest.
double rms_in_standard_errors(const std::vector<double>& found, const std::vector<double>& truth,
                              const std::vector<double>& sigma) {
  double square = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    if (sigma[k] == 0.0) continue;
    square += std::pow((found[k] / truth[k] - 1.0) / sigma[k], 2);
    count += 1.0;
  }
  return std::sqrt(square / count);
}

bool says(const CircuitFit& fit, const std::string& words) {
  return std::any_of(fit.statements.begin(), fit.statements.end(),
                     [&](const std::string& statement) { return statement.find(words) != std::string::npos; });
}

CircuitFit fit_of(const ArrayDescription& array, const Recording& recording) {
  auto fit = fit_circuit(array, recording.frames, recording.loads);
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

simulation::SimulationOptions leaky_rubber() {
  simulation::SimulationOptions options;
  options.rubber.unloaded_ohm = 20e3;
  return options;
}

TEST(CircuitFit, finds_each_resistance_to_two_percent_under_uniform_loads) {
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    const ArrayDescription truth = uneven_array(8, seed);
    const CircuitFit fit = fit_of(to_be_fitted(truth), record(truth, "uniform", seed, leaky_rubber()));
    EXPECT_LE(worst_error(fit.array.readout.drive_ohm, truth.readout.drive_ohm), 0.02);
    EXPECT_LE(worst_error(fit.array.readout.load_ohm, truth.readout.load_ohm), 0.02);
    EXPECT_EQ(fit.array.readout.load_ohm[0], truth.readout.load_ohm[0]);
    EXPECT_EQ(fit.load_error[0], 0.0);
    EXPECT_FALSE(fit.array.has_unknown_circuit());
  }
}

TEST(CircuitFit, is_as_good_with_single_presses_as_it_says) {
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    const ArrayDescription truth = uneven_array(8, seed);
    const CircuitFit fit = fit_of(to_be_fitted(truth), record(truth, "calibration", seed));
    EXPECT_LT(rms_in_standard_errors(fit.array.readout.drive_ohm, truth.readout.drive_ohm, fit.drive_error), 2.0);
    EXPECT_LT(rms_in_standard_errors(fit.array.readout.load_ohm, truth.readout.load_ohm, fit.load_error), 2.0);
    EXPECT_LE(worst_error(fit.array.readout.load_ohm, truth.readout.load_ohm), 0.02);
    EXPECT_TRUE(says(fit, "uniform load")) << "which recording would help";
  }
}

TEST(CircuitFit, gives_forces_as_good_as_the_known_circuit) {
  const ArrayDescription truth = uneven_array(8, 4);
  const Recording recording = record(truth, "calibration", 1, leaky_rubber());
  const auto known = calibrate(truth, recording.frames, recording.loads);
  const auto fitted = calibrate(to_be_fitted(truth), recording.frames, recording.loads);
  ASSERT_TRUE(known && fitted);
  EXPECT_FALSE(fitted->report.circuit.empty());
  EXPECT_TRUE(fitted->model.provenance.contains("circuit"));
  const Recording test = record(truth, "multitouch", 2, leaky_rubber());
  const auto with_known = evaluate(known->model, test.frames, test.loads);
  const auto with_fitted = evaluate(fitted->model, test.frames, test.loads);
  ASSERT_TRUE(with_known && with_fitted);
  const ErrorSummary& best = with_known->estimators.front().relative_error;
  const ErrorSummary& reached = with_fitted->estimators.front().relative_error;
  EXPECT_LE(*reached.median, 1.1 * *best.median);
  EXPECT_LE(*reached.p95, 1.1 * *best.p95);
}

TEST(CircuitFit, leaves_its_own_uncertainty_in_the_forces) {
  double share_68 = 0.0;
  double share_95 = 0.0;
  constexpr std::uint64_t kArrays = 4;
  for (std::uint64_t seed = 1; seed <= kArrays; ++seed) {
    const ArrayDescription truth = uneven_array(8, seed);
    const Recording recording = record(truth, "calibration", seed);
    const auto fitted = calibrate(to_be_fitted(truth), recording.frames, recording.loads);
    ASSERT_TRUE(fitted) << fitted.error().message;
    const Recording test = record(truth, "multitouch", seed, {}, 300);
    const auto evaluation = evaluate(fitted->model, test.frames, test.loads);
    ASSERT_TRUE(evaluation) << evaluation.error().message;
    share_68 += *evaluation->coverage.share_68 / kArrays;
    share_95 += *evaluation->coverage.share_95 / kArrays;
  }
  EXPECT_GT(share_68, 0.6);
  EXPECT_LT(share_68, 0.78);
  EXPECT_GT(share_95, 0.9);
  EXPECT_LT(share_95, 0.985);
}

TEST(CircuitFit, keeps_the_errors_that_are_given_with_drivers) {
  constexpr double kGivenOhm = 0.7;
  const ArrayDescription truth = uneven_array(8, 1);
  const Recording recording = record(truth, "uniform", 1, leaky_rubber());
  ArrayDescription first_is_given = to_be_fitted(truth);
  first_is_given.readout.drive_ohm[0] = truth.readout.drive_ohm[0];
  first_is_given.readout.drive_error_ohm.assign(8, 0.0);
  first_is_given.readout.drive_error_ohm[0] = kGivenOhm;
  const Readout some = fit_of(first_is_given, recording).array.readout;
  EXPECT_EQ(some.drive_error_ohm[0], kGivenOhm);
  for (std::size_t line = 1; line < 8; ++line) EXPECT_GT(some.drive_error_ohm[line], 0.0);

  ArrayDescription all_are_given = to_be_fitted(truth);
  all_are_given.readout.drive_ohm = truth.readout.drive_ohm;
  all_are_given.readout.drive_error_ohm.assign(8, kGivenOhm);
  all_are_given.readout.drive_error_correlation = 0.4;
  const Readout all = fit_of(all_are_given, recording).array.readout;
  EXPECT_EQ(all.drive_error_ohm, std::vector<double>(8, kGivenOhm));
  EXPECT_EQ(all.drive_error_correlation, 0.4);
}

TEST(CircuitFit, sets_the_scale_and_says_so_where_no_resistance_is_known) {
  const ArrayDescription truth = uneven_array(8, 1);
  ArrayDescription unknown = to_be_fitted(truth);
  unknown.readout.load_ohm[0] = kFitOhm;
  const CircuitFit fit = fit_of(unknown, record(truth, "uniform", 1, leaky_rubber()));
  EXPECT_TRUE(says(fit, "only ratios"));
  double logarithm = 0.0;
  for (const double ohm : fit.array.readout.load_ohm) logarithm += std::log(ohm / 1000.0) / 8.0;
  EXPECT_NEAR(logarithm, 0.0, 1e-3);
  // Drivers to loads is what crosstalk depends on, and what the data determine.
  double ratio = 0.0;
  for (std::size_t k = 0; k < 8; ++k) {
    ratio += std::log(fit.array.readout.drive_ohm[k] / truth.readout.drive_ohm[k]) / 8.0;
    ratio -= std::log(fit.array.readout.load_ohm[k] / truth.readout.load_ohm[k]) / 8.0;
  }
  EXPECT_NEAR(ratio, 0.0, 0.02);
}

TEST(CircuitFit, says_that_ideal_drivers_cannot_be_measured) {
  ArrayDescription truth = reference_array(6, 6);
  truth.readout.drive_ohm.assign(6, 0.0);
  ArrayDescription unknown = truth;
  unknown.readout.drive_ohm.assign(6, kFitOhm);
  const CircuitFit fit = fit_of(unknown, record(truth, "calibration", 1));
  EXPECT_TRUE(says(fit, "drive_ohm: too small")) << fit.statements.front();
  for (const double ohm : fit.array.readout.drive_ohm) EXPECT_LT(ohm, 5.0);
}

TEST(CircuitFit, refuses_an_array_that_is_never_pressed) {
  const ArrayDescription truth = reference_array(4, 4);
  const Recording idle = record(truth, "idle", 1, {}, 50);
  const auto fit = fit_circuit(to_be_fitted(truth), idle.frames, idle.loads);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("no frame presses"), std::string::npos) << fit.error().message;
}

TEST(CircuitFit, leaves_readings_as_they_are_where_the_adc_does_not_resolve_the_circuit) {
  ArrayDescription truth = reference_array(24, 16);
  truth.readout.idle_rows = IdleRows::floating;
  truth.readout.load_ohm.assign(16, 100e3);
  truth.readout.adc_bits = 8;
  simulation::SimulationOptions options;
  options.rubber.resistance_at_10n_ohm = 2e3;
  options.rubber.unloaded_ohm = 100e3;
  const Recording recording = record(truth, "uniform", 1, options);
  Recording some;  // of every tenth frame
  for (Load load : recording.loads) {
    if (load.frame % 10 != 0) continue;
    load.frame = some.frames.size();
    some.loads.push_back(load);
    some.frames.push_back(recording.frames[10 * load.frame]);
  }
  const CircuitFit known = fit_of(truth, some);
  EXPECT_EQ(known.array.readout.circuit, Circuit::none);
  EXPECT_TRUE(says(known, "does not resolve this circuit"));
  ArrayDescription unknown = truth;
  unknown.readout = {};
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.adc_bits = 8;
  const CircuitFit chosen = fit_of(unknown, some);
  SCOPED_TRACE(chosen.statements[0]);
  EXPECT_EQ(chosen.array.readout.circuit, Circuit::none);
  EXPECT_TRUE(says(chosen, "does not resolve \"divider, idle rows floating\""));
  EXPECT_TRUE(says(chosen, "divider, idle rows floating not resolved"));
}

/// Uniform loads on the whole array and on the left and the right half of its columns in turn, and unloaded frames.
Recording record_halves(const ArrayDescription& array) {
  HandledArray handled(array, {}, 1);
  Recording recording;
  const auto add = [&](std::size_t first_col, std::size_t last_col, double newtons) {
    const TaxelRegion region{0, first_col, array.rows - 1, last_col};
    std::vector<double> force_n(array.taxel_count());
    for (const std::size_t taxel : taxel_indices(region, array.cols)) force_n[taxel] = newtons;
    recording.loads.push_back({recording.frames.size(), LoadKind::pressure, region, newtons / *array.taxel_area_m2});
    recording.frames.push_back(handled.frame(force_n));
  };
  for (double newtons = 10.0; newtons < 30.0; newtons += 1.0) {
    add(0, array.cols - 1, newtons);
    add(0, array.cols / 2 - 1, newtons);
    add(array.cols / 2, array.cols - 1, newtons);
    add(0, array.cols - 1, 0.0);
  }
  return recording;
}

TEST(CircuitFit, takes_a_circuit_that_explains_the_frames_though_another_is_not_resolved) {
  ArrayDescription truth = reference_array(24, 8);
  truth.readout.circuit = Circuit::transimpedance;
  truth.readout.adc_bits = 6;
  ArrayDescription unknown = truth;
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.drive_ohm = unknown.readout.load_ohm = {kFitOhm};
  const CircuitFit fit = fit_of(unknown, record_halves(truth));
  SCOPED_TRACE(fit.statements[0]);
  EXPECT_EQ(fit.array.readout.circuit, Circuit::transimpedance);
  EXPECT_TRUE(says(fit, "does not resolve \"divider, idle rows grounded\""));
  EXPECT_TRUE(says(fit, "it was not compared"));
  EXPECT_FALSE(says(fit, "readings are taken as they are"));
}

TEST(CircuitFit, takes_no_notice_of_what_depends_on_saturated_readings) {
  ArrayDescription truth = reference_array(4, 12);
  truth.readout.circuit = Circuit::transimpedance;
  truth.readout.drive_ohm.assign(4, 40.0);
  truth.readout.load_ohm.assign(12, 1000.0);
  truth.readout.adc_bits = 16;
  ArrayDescription unknown = truth;
  unknown.readout.drive_ohm.assign(4, kFitOhm);
  const CircuitFit fit = fit_of(unknown, record(truth, "calibration", 1));
  EXPECT_LE(worst_error(fit.array.readout.drive_ohm, truth.readout.drive_ohm), 0.1);
}

/// On an array of more than 48 lines, from which on Eigen's products of no columns divide by their number.
TEST(CircuitFit, takes_frames_in_which_no_taxel_is_idle) {
  ArrayDescription truth = reference_array(44, 6);
  const Recording recording = record(truth, "uniform", 1);
  Recording pressed;
  for (const Load& load : recording.loads) {
    if (load.value == 0.0 || load.frame % 20 != 0) continue;
    pressed.loads.push_back(load);
    pressed.loads.back().frame = pressed.frames.size();
    pressed.frames.push_back(recording.frames[load.frame]);
  }
  const CircuitFit fit = fit_of(to_be_fitted(truth), pressed);
  EXPECT_FALSE(fit.array.has_unknown_circuit());
  truth.readout.circuit = Circuit::automatic;
  truth.readout.drive_ohm = truth.readout.load_ohm = {kFitOhm};
  EXPECT_FALSE(fit_of(truth, pressed).array.has_unknown_circuit());
}

TEST(CircuitFit, tells_the_circuits_apart) {
  struct Case {
    Circuit circuit;
    IdleColumns idle_columns;
  };
  for (const Case& c :
       {Case{Circuit::divider, IdleColumns::loaded}, Case{Circuit::divider, IdleColumns::floating},
        Case{Circuit::transimpedance, IdleColumns::loaded}, Case{Circuit::flexitac, IdleColumns::loaded}}) {
    ArrayDescription truth = reference_array(4, 4);
    truth.readout.circuit = c.circuit;
    truth.readout.idle_columns = c.idle_columns;
    SCOPED_TRACE(to_string(c.circuit));
    ArrayDescription unknown = reference_array(4, 4);
    unknown.readout.circuit = Circuit::automatic;
    unknown.readout.drive_ohm = {kFitOhm};
    unknown.readout.load_ohm = {200.0};
    const CircuitFit fit = fit_of(unknown, record(truth, "multitouch", 1, leaky_rubber(), 300));
    EXPECT_EQ(to_string(fit.array.readout.circuit), std::string(to_string(c.circuit)));
    EXPECT_EQ(fit.array.readout.idle_columns, c.idle_columns);
    EXPECT_TRUE(fit.candidates.front().chosen);
    EXPECT_LT(fit.candidates.front().misfit, 1.2);
    EXPECT_TRUE(says(fit, "times the noise"));
  }
}

TEST(CircuitFit, does_not_take_the_resistance_of_contacts_for_that_of_the_circuit) {
  ArrayDescription truth = reference_array(9, 9);
  truth.readout.drive_ohm.assign(9, 25.0);
  simulation::SimulationOptions options;
  options.rubber.contact_ohm = 60.0;
  ArrayDescription unknown = truth;
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.drive_ohm = unknown.readout.load_ohm = {kFitOhm};
  const CircuitFit fit = fit_of(unknown, record(truth, "calibration", 1, options));
  SCOPED_TRACE(fit.statements[0] + "\n" + fit.statements[1]);
  EXPECT_EQ(fit.candidates.front().name, "divider, idle rows grounded");
  EXPECT_LT(fit.candidates.front().misfit, 1.1);
  const double ratio = fit.array.readout.drive_ohm[0] / fit.array.readout.load_ohm[0];
  EXPECT_NEAR(ratio, 25.0 / 200.0, 0.2 * 25.0 / 200.0);
}

/// Unloaded readings of three counts, at five temperatures.
TEST(CircuitFit, does_not_take_idle_readings_near_the_noise_for_no_circuit) {
  ArrayDescription truth = reference_array(9, 9);
  truth.readout.drive_ohm.assign(9, 25.0);
  simulation::SimulationOptions options;
  options.rubber.unloaded_ohm = 250e3;
  ArrayDescription unknown = truth;
  unknown.readout.circuit = Circuit::automatic;
  unknown.readout.drive_ohm = unknown.readout.load_ohm = {kFitOhm};
  const CircuitFit fit = fit_of(unknown, record(truth, "calibration", 1, options));
  SCOPED_TRACE(fit.statements[0]);
  EXPECT_EQ(fit.candidates.front().name, "divider, idle rows grounded");
  const CircuitCandidate* none = nullptr;
  const CircuitCandidate* transimpedance = nullptr;
  for (const CircuitCandidate& candidate : fit.candidates) {
    if (candidate.name == "none") none = &candidate;
    if (candidate.name == "transimpedance") transimpedance = &candidate;
  }
  ASSERT_TRUE(none != nullptr && transimpedance != nullptr);
  EXPECT_LT(fit.candidates.front().misfit, 1.1);
  EXPECT_NEAR(none->misfit, transimpedance->misfit, 0.1) << "the same where drivers are ideal";
}

TEST(CircuitFit, names_presses_that_make_the_drivers_surer) {
  const ArrayDescription truth = uneven_array(6, 3);
  Recording recording = record(truth, "calibration", 3);
  const CircuitFit alone = fit_of(to_be_fitted(truth), recording);
  ASSERT_FALSE(alone.driver_presses.empty());
  EXPECT_LE(alone.driver_presses.size(), 5U);
  EXPECT_TRUE(says(alone, "drive_ohm: these frames leave it uncertain"));
  HandledArray handled(truth, {}, 3);
  for (const PressPair& pair : alone.driver_presses) {
    EXPECT_EQ(pair.first / truth.cols, pair.second / truth.cols) << "one driver";
    std::vector<double> force_n(truth.taxel_count());
    for (const std::size_t taxel : {pair.first, pair.second}) {
      force_n[taxel] = pair.newtons;
      const std::size_t row = taxel / truth.cols;
      const std::size_t col = taxel % truth.cols;
      recording.loads.push_back({recording.frames.size(), LoadKind::force, {row, col, row, col}, pair.newtons});
    }
    recording.frames.push_back(handled.frame(force_n));
  }
  const CircuitFit beside = fit_of(to_be_fitted(truth), recording);
  EXPECT_LT(beside.common_drive_error, 0.6 * alone.common_drive_error);
}

TEST(CircuitFit, does_not_depend_on_the_number_of_threads) {
  const ArrayDescription truth = uneven_array(4, 1);
  const Recording recording = record(truth, "uniform", 1);
  const CircuitFit first = fit_of(to_be_fitted(truth), recording);
  std::vector<CircuitFit> nested(2);
  parallel_for(2, [&](std::size_t k) { nested[k] = fit_of(to_be_fitted(truth), recording); });
  for (const CircuitFit& other : nested) {
    EXPECT_EQ(first.array.readout.drive_ohm, other.array.readout.drive_ohm);
    EXPECT_EQ(first.array.readout.load_ohm, other.array.readout.load_ohm);
  }
}

// What the recordings of a real hand show of crosstalk (docs/reasons/ghosts.md). A contact: readings above 50 counts;
// remote: at least three taxels from it; shared: in a row or column of the contact.
constexpr float kContactCounts = 50.0F;
constexpr std::size_t kHandRows = 13;
constexpr std::size_t kHandCols = 6;
constexpr std::size_t kRemote = 3;

std::size_t distance(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

/// Sums of the remote readings of a recording.
struct RemoteReadings {
  std::vector<double> shared = std::vector<double>(kHandRows * kHandCols);  // of every taxel
  std::vector<double> shared_count = shared;
  std::vector<double> other = shared;
  std::vector<double> other_count = shared;
  double shared_at_zero = 0.0;

  /// Mean shared reading over mean other reading, some taxels left out.
  [[nodiscard]] double ratio(const std::vector<std::size_t>& without = {}) const {
    double sums[4] = {};
    for (std::size_t taxel = 0; taxel < shared.size(); ++taxel) {
      if (std::find(without.begin(), without.end(), taxel) != without.end()) continue;
      sums[0] += shared[taxel];
      sums[1] += shared_count[taxel];
      sums[2] += other[taxel];
      sums[3] += other_count[taxel];
    }
    return sums[0] / sums[1] / (sums[2] / sums[3]);
  }
};

void add_frame(const std::vector<float>& counts, RemoteReadings& readings) {
  std::vector<std::size_t> contact;
  for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
    if (counts[taxel] > kContactCounts) contact.push_back(taxel);
  }
  if (contact.empty()) return;
  for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
    const std::size_t row = taxel / kHandCols;
    const std::size_t col = taxel % kHandCols;
    const auto any = [&](auto condition) { return std::any_of(contact.begin(), contact.end(), condition); };
    const bool near = any([&](std::size_t pressed) {
      return std::max(distance(row, pressed / kHandCols), distance(col, pressed % kHandCols)) < kRemote;
    });
    if (near) continue;
    const bool is_shared =
        any([&](std::size_t pressed) { return row == pressed / kHandCols || col == pressed % kHandCols; });
    const auto reading = static_cast<double>(counts[taxel]);
    (is_shared ? readings.shared : readings.other)[taxel] += reading;
    (is_shared ? readings.shared_count : readings.other_count)[taxel] += 1.0;
    if (is_shared && reading == 0.0) readings.shared_at_zero += 1.0;
  }
}

TEST(CircuitFit, shows_why_the_ghosts_of_a_real_hand_cannot_be_solved) {
  const std::filesystem::path folder = support::shared_data("dsa_recordings");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << support::not_checked(folder);
  struct Case {
    const char* file;
    double ratio;
    double least_share;  // of the shared readings, in five taxels
  };
  for (const Case& c : {Case{"ghosting_m1.csv", 11.7, 0.93}, Case{"ghosting_m5.csv", 7.1, 0.75}}) {
    SCOPED_TRACE(c.file);
    const auto frames =
        bytes::recordings::read_frames((folder / c.file).string(), {.shape = FrameShape{kHandRows, kHandCols}});
    ASSERT_TRUE(frames) << frames.error().message;
    RemoteReadings readings;
    for (const RawFrame& frame : *frames) add_frame(frame.counts, readings);
    EXPECT_NEAR(readings.ratio(), c.ratio, 0.05);
    std::vector<std::size_t> order(readings.shared.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return readings.shared[a] > readings.shared[b]; });
    const std::vector<std::size_t> strongest(order.begin(), order.begin() + 5);
    double in_them = 0.0;
    for (const std::size_t taxel : strongest) in_them += readings.shared[taxel];
    const double all = std::accumulate(readings.shared.begin(), readings.shared.end(), 0.0);
    const double remote = std::accumulate(readings.shared_count.begin(), readings.shared_count.end(), 0.0);
    EXPECT_GE(in_them / all, c.least_share) << "a few taxels, not lines";
    EXPECT_LE(readings.ratio(strongest), 2.0) << "the others show no crosstalk";
    EXPECT_GE(readings.shared_at_zero / remote, 0.8) << "what the threshold took";
  }
}

}  // namespace
}  // namespace dermis::learn::calibration
