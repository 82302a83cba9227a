// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/line_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/reference_array.hpp"
#include "support/shared_data.hpp"

namespace dermis::touch::compensation {
namespace {

using learn::simulation::LineFaults;
using support::reference_circuit;

/// A simulated array with faults, and the monitor and compensation that act on what they see of it.
class Rig {
 public:
  Rig(const ArrayDescription& array, const std::string& scene, std::uint64_t seed, std::size_t frames,
      const LineFaults& faults = {}, double unloaded_ohm = 200e3)
      : Rig(array, scene, seed, frames, faults, rubber_with(unloaded_ohm)) {}

  /// `calibrated`: unloaded conductance that the monitor is told, over the true one.
  Rig(const ArrayDescription& array, const std::string& scene, std::uint64_t seed, std::size_t frames,
      const LineFaults& faults, const learn::simulation::RubberOptions& rubber, double calibrated = 1.0)
      : array_(array) {
    learn::simulation::SimulationOptions options;
    options.faults = faults;
    options.rubber = rubber;
    simulator_ = learn::simulation::Simulator::create(array, options, scene, seed, frames).value();
    constexpr double kCelsius = 25.0;
    const double unit =
        array.readout.circuit == Circuit::none ? learn::simulation::ReadoutCircuit::kUnknownCircuitOhm : 1.0;
    std::vector<double> unloaded;
    std::vector<double> typical;
    for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
      unloaded.push_back(calibrated * unit * simulator_->rubber().conductance_from_force(taxel, 0.0, kCelsius));
      typical.push_back(unit * simulator_->rubber().conductance_from_force(taxel, 10.0, kCelsius));
    }
    compensator_ = std::make_unique<Compensator>(Compensator::create(array, {typical, unloaded}).value());
    monitor_ = std::make_unique<LineFaultMonitor>(array, unloaded);
  }

  bool read() {
    if (!*simulator_->next(raw_)) return false;
    condition();
    return true;
  }

  bool next() {
    if (!read()) return false;
    process();
    return true;
  }

  void process() {
    compensator_->process(conditioned_, conductance_);
    if (monitor_->observe(conditioned_, conductance_)) {
      ++changes_;
      compensator_->set_faults(monitor_->faults());
      compensator_->process(conditioned_, conductance_);
    }
    ++frames_;
  }

  [[nodiscard]] const LineFaultMonitor& monitor() const { return *monitor_; }
  [[nodiscard]] ConditionedFrame& conditioned() { return conditioned_; }
  [[nodiscard]] const ConductanceFrame& conductance() const { return conductance_; }
  [[nodiscard]] const std::vector<double>& true_siemens() const { return simulator_->true_siemens(); }
  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] int changes() const { return changes_; }

 private:
  static learn::simulation::RubberOptions rubber_with(double unloaded_ohm) {
    learn::simulation::RubberOptions rubber;
    rubber.unloaded_ohm = unloaded_ohm;
    return rubber;
  }

  /// Unit 2, where the ADC measures against the supply.
  void condition() {
    const double full_scale = array_.readout.full_scale_counts();
    conditioned_.time = raw_.time;
    conditioned_.sigma_ratio = array_.readout.adc_noise_counts / full_scale;
    conditioned_.ratio.resize(raw_.counts.size());
    conditioned_.taxels.assign(raw_.counts.size(), TaxelStatus::ok);
    for (std::size_t taxel = 0; taxel < raw_.counts.size(); ++taxel) {
      conditioned_.ratio[taxel] = static_cast<double>(raw_.counts[taxel]) / full_scale;
      if (conditioned_.ratio[taxel] >= 1.0) conditioned_.taxels[taxel] = TaxelStatus::saturated;
    }
  }

  ArrayDescription array_;
  std::unique_ptr<Compensator> compensator_;
  std::unique_ptr<learn::simulation::Simulator> simulator_;
  std::unique_ptr<LineFaultMonitor> monitor_;
  RawFrame raw_;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
  std::size_t frames_ = 0;
  int changes_ = 0;
};

std::string describe(std::span<const LineFault> faults, const ArrayDescription& array) {
  std::string text;
  for (const LineFault& fault : faults)
    text += std::string(to_string(fault.kind)) + ' ' + place_name(fault, array) + "; ";
  return text;
}

struct FaultCase {
  const char* name;
  LineFaultKind kind;
  bool by_column;
  bool by_taxel;
  std::size_t within_frames;  ///< Found so soon after it began, in the multi-touch scene; presses are random.
  std::function<void(LineFaults&, std::size_t)> put;
};

std::vector<FaultCase> fault_cases(const ArrayDescription& array) {
  using Kind = LineFaultKind;
  const std::size_t silent = array.rows < 16 ? 20 : 10;  // fewer taxels tell less
  return {
      {"open row", Kind::silent_row, false, false, silent, [](auto& f, auto k) { f.rows.open = {k}; }},
      {"open column", Kind::silent_column, true, false, silent, [](auto& f, auto k) { f.columns.open = {k}; }},
      {"grounded row", Kind::silent_row, false, false, silent, [](auto& f, auto k) { f.rows.grounded = {k}; }},
      {"grounded column", Kind::silent_column, true, false, silent, [](auto& f, auto k) { f.columns.grounded = {k}; }},
      {"supplied row", Kind::supplied_row, false, false, 60, [](auto& f, auto k) { f.rows.supplied = {k}; }},
      {"supplied column", Kind::supplied_column, true, false, 25, [](auto& f, auto k) { f.columns.supplied = {k}; }},
      {"shorted rows", Kind::shorted_rows, false, false, 200, [](auto& f, auto k) { f.rows.shorted = {k}; }},
      {"shorted columns", Kind::shorted_columns, true, false, 200, [](auto& f, auto k) { f.columns.shorted = {k}; }},
      {"dead taxel", Kind::dead_taxel, false, true, 800,
       [array](auto& f, auto k) { f.dead_taxels = {array.taxel_name(k)}; }},
      {"stuck taxel", Kind::stuck_taxel, false, true, 240,
       [array](auto& f, auto k) { f.stuck_taxels = {array.taxel_name(k)}; }},
      {"shorted crossing", Kind::shorted_crossing, false, true, 50,
       [array](auto& f, auto k) { f.shorted_taxels = {array.taxel_name(k)}; }},
  };
}

TEST(LineFaultMonitor, finds_and_locates_every_fault_and_sees_it_heal) {
  constexpr std::size_t kFrom = 15;
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (const std::size_t size : {8UL, 16UL}) {
      const ArrayDescription array = reference_circuit(size, size, circuit);
      Random random(size);
      for (const FaultCase& kind : fault_cases(array)) {
        const std::size_t place = random.below(kind.by_taxel ? size * size : size - 1);
        SCOPED_TRACE(testing::Message() << to_string(circuit) << ' ' << size << ", " << kind.name << ' ' << place);
        const std::size_t lasts = kind.within_frames + 90;
        LineFaults faults;
        faults.from_frame = kFrom;
        faults.until_frame = kFrom + lasts;
        kind.put(faults, place);
        Rig rig(array, "multitouch", 100 + size, kFrom + lasts + 150, faults);
        std::size_t found_at = 0;
        while (rig.frames() < kFrom + lasts && rig.next()) {
          const auto present = rig.monitor().faults();
          ASSERT_TRUE(present.empty() || rig.frames() > kFrom) << describe(present, array);
          if (!present.empty() && found_at == 0) found_at = rig.frames() - 1;
        }
        const auto present = rig.monitor().faults();
        ASSERT_EQ(present.size(), 1U) << describe(present, array);
        EXPECT_EQ(present[0].kind, kind.kind);
        EXPECT_EQ(present[0].place, place);
        EXPECT_GE(present[0].frame + 1, kFrom) << "not before it began";
        EXPECT_LE(found_at, kFrom + kind.within_frames);
        while (rig.next()) continue;
        EXPECT_TRUE(rig.monitor().faults().empty()) << describe(rig.monitor().faults(), array);
        EXPECT_FALSE(has(rig.conductance().status, FrameStatus::line_fault));
      }
    }
  }
}

/// So many rows and columns that shorted crossings join, each by one.
LineFaults random_node(const ArrayDescription& array, std::size_t rows, std::size_t cols, Random& random,
                       std::vector<std::size_t>& crossings) {
  const std::size_t first_row = random.below(array.rows);
  const std::size_t first_col = random.below(array.cols);
  LineFaults faults;
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::size_t l = 0; l < cols; ++l) {
      const std::size_t taxel = array.index((first_row + 3 * k) % array.rows, (first_col + 5 * l) % array.cols);
      crossings.push_back(taxel);
      if (k == 0 || l == cols - 1) faults.shorted_taxels.push_back(array.taxel_name(taxel));
    }
  }
  return faults;
}

TEST(LineFaultMonitor, names_all_crossings_of_lines_that_are_one_and_nothing_else) {
  constexpr std::uint64_t kSeed = 55;
  Random random(kSeed);
  for (const IdleRows idle_rows : {IdleRows::grounded, IdleRows::floating}) {
    for (const auto& [rows, cols] : {std::pair{1U, 3U}, {3U, 1U}, {2U, 2U}, {2U, 3U}, {3U, 3U}}) {
      ArrayDescription array = reference_circuit(12, 12);
      array.readout.idle_rows = idle_rows;
      std::vector<std::size_t> crossings;
      const LineFaults faults = random_node(array, rows, cols, random, crossings);
      SCOPED_TRACE(testing::Message() << rows << " rows, " << cols << " columns, seed " << kSeed);
      Rig rig(array, "multitouch", kSeed, 120, faults);
      while (rig.next()) continue;
      const auto present = rig.monitor().faults();
      EXPECT_EQ(present.size(), crossings.size()) << describe(present, array);
      for (const std::size_t taxel : crossings) {
        const bool is_named = std::any_of(present.begin(), present.end(), [&](const LineFault& fault) {
          return fault.kind == LineFaultKind::shorted_crossing && fault.place == taxel;
        });
        EXPECT_TRUE(is_named) << array.taxel_name(taxel) << " of " << describe(present, array);
      }
    }
  }
}

TEST(LineFaultMonitor, names_readings_that_are_stuck_high_and_the_others_keep_theirs) {
  constexpr std::size_t kTaxel = 2 * 16 + 5;
  for (const double ratio : {1.0, 0.999, 0.9, 0.8, 0.6}) {
    SCOPED_TRACE(testing::Message() << "reading " << ratio);
    Rig rig(reference_circuit(), "contacts", 7, 60);
    while (rig.read()) {
      rig.conditioned().ratio[kTaxel] = ratio;
      rig.process();
      ASSERT_FALSE(has(rig.conductance().status, FrameStatus::not_converged)) << "frame " << rig.frames();
    }
    const auto found = rig.monitor().faults();
    ASSERT_EQ(found.size(), 1U) << describe(found, reference_circuit());
    EXPECT_EQ(found[0].kind, LineFaultKind::impossible_reading);
    EXPECT_EQ(found[0].place, kTaxel);
  }
}

TEST(LineFaultMonitor, finds_silent_lines_that_nothing_touches) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::flexitac, Circuit::none}) {
    for (const bool row : {true, false}) {
      SCOPED_TRACE(testing::Message() << to_string(circuit) << (row ? " row" : " column"));
      const ArrayDescription array = reference_circuit(12, 9, circuit);
      LineFaults faults;
      faults.from_frame = 30;
      (row ? faults.rows.open : faults.columns.open) = {4};
      Rig rig(array, "idle", 5, 60, faults, circuit == Circuit::none ? 40e3 : 200e3);  // none reads 100 ohm / R
      while (rig.next()) {
        if (rig.frames() <= 30) {
          ASSERT_TRUE(rig.monitor().faults().empty());
        }
      }
      const auto found = rig.monitor().faults();
      ASSERT_EQ(found.size(), 1U) << describe(found, array);
      EXPECT_EQ(found[0].kind, row ? LineFaultKind::silent_row : LineFaultKind::silent_column);
      EXPECT_EQ(found[0].place, 4U);
      EXPECT_EQ(found[0].frame, 30U);
    }
  }
}

TEST(LineFaultMonitor, a_loose_contact_is_masked_while_it_is_open_and_reads_while_it_is_closed) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    SCOPED_TRACE(testing::Message() << to_string(circuit));
    Rig rig(reference_circuit(16, 16, circuit), "multitouch", 6, 200);
    std::size_t late = 0;
    while (rig.read()) {
      const bool is_open = rig.frames() > 20 && rig.frames() % 20 < 3;
      if (is_open) {
        for (std::size_t col = 0; col < 16; ++col) rig.conditioned().ratio[std::size_t{4} * 16 + col] = 0.0;
      }
      rig.process();
      const auto present = rig.monitor().faults();
      ASSERT_LE(present.size(), 1U) << describe(present, reference_circuit());
      if (present.empty() == is_open) ++late;
      if (present.empty()) continue;
      EXPECT_EQ(present[0].kind, LineFaultKind::silent_row);
      EXPECT_EQ(present[0].place, 4U);
    }
    EXPECT_EQ(late, 0U);
  }
}

TEST(LineFaultMonitor, finds_a_supplied_row_beside_a_first_row_that_is_silent) {
  constexpr std::size_t kSuppliedFrom = 60;
  for (const std::size_t silent : {0U, 6U}) {
    SCOPED_TRACE(testing::Message() << "silent row " << silent);
    const ArrayDescription array = reference_circuit(8, 8);
    LineFaults faults;
    faults.rows.supplied = {3};
    faults.from_frame = kSuppliedFrom;
    Rig rig(array, "multitouch", 108, 240, faults);
    while (rig.read()) {
      for (std::size_t col = 0; col < array.cols; ++col) rig.conditioned().ratio[array.index(silent, col)] = 0.0;
      rig.process();
    }
    const auto found = rig.monitor().faults();
    const auto is_supplied = [](const LineFault& fault) { return fault.kind == LineFaultKind::supplied_row; };
    const auto supplied = std::find_if(found.begin(), found.end(), is_supplied);
    ASSERT_NE(supplied, found.end()) << describe(found, array);
    EXPECT_EQ(supplied->place, 3U);
  }
}

TEST(LineFaultMonitor, no_false_alarm_on_healthy_arrays) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::flexitac, Circuit::none}) {
    for (const char* scene : {"multitouch", "idle"}) {
      const ArrayDescription array = reference_circuit(8, 8, circuit);
      Rig rig(array, scene, 11, 3000);
      while (rig.next()) continue;
      EXPECT_EQ(rig.changes(), 0) << to_string(circuit) << ' ' << scene;
      EXPECT_EQ(rig.frames(), 3000U);
    }
  }
}

/// Offsets that stay up after a press, loops, 1/f noise, temperatures that halve and double the conductance, and an
/// unloaded conductance that was calibrated too high or too low.
TEST(LineFaultMonitor, memory_of_the_material_is_no_fault) {
  learn::simulation::RubberOptions rubber;
  rubber.hysteresis = 0.2;
  rubber.creep = 0.1;
  rubber.pink_noise = 1e-5;
  rubber.temperature_coefficient = -0.014;
  rubber.mechanical_spread = 0.1;
  for (const char* scene : {"multitouch", "idle"}) {
    for (const double calibrated : {0.7, 1.0, 1.4}) {
      SCOPED_TRACE(testing::Message() << scene << ", unloaded conductance calibrated " << calibrated);
      const ArrayDescription array = reference_circuit(16, 16);
      Rig rig(array, scene, 21, 1000, {}, rubber, calibrated);
      while (rig.next()) ASSERT_TRUE(rig.monitor().faults().empty()) << describe(rig.monitor().faults(), array);
      EXPECT_EQ(rig.changes(), 0);
    }
    LineFaults faults;
    faults.from_frame = 200;
    faults.rows.open = {6};
    Rig rig(reference_circuit(16, 16), scene, 22, 210, faults, rubber);
    while (rig.next()) continue;
    ASSERT_EQ(rig.monitor().faults().size(), 1U) << "found all the same, within 10 frames";
    EXPECT_EQ(rig.monitor().faults()[0].kind, LineFaultKind::silent_row);
    EXPECT_EQ(rig.monitor().faults()[0].place, 6U);
  }
}

TEST(LineFaultMonitor, says_where_it_is_blind) {
  for (const double unloaded_ohm : {200e3, 10e6}) {
    Rig rig(reference_circuit(16, 16), "idle", 2, 40, {}, unloaded_ohm);
    EXPECT_FALSE(rig.monitor().sees_silent_row(3)) << "before the first frame";
    while (rig.next()) continue;
    EXPECT_EQ(rig.monitor().sees_silent_row(3), unloaded_ohm < 1e6);
    EXPECT_EQ(rig.monitor().sees_silent_column(3), unloaded_ohm < 1e6);
    EXPECT_EQ(rig.changes(), 0) << "below the floor of the ADC nothing is missed";
  }
}

TEST(LineFaultMonitor, two_frames_without_readings_are_no_fault) {
  Rig rig(reference_circuit(8, 8), "idle", 3, 40);
  for (int frame = 0; frame < 10; ++frame) ASSERT_TRUE(rig.next());
  std::fill(rig.conditioned().ratio.begin(), rig.conditioned().ratio.end(), 0.0);
  rig.process();
  rig.process();
  while (rig.next()) continue;
  EXPECT_EQ(rig.changes(), 0);
}

TEST(LineFaultMonitor, repeated_frames_are_no_stuck_taxels) {
  Rig rig(reference_circuit(8, 8), "multitouch", 3, 2);
  ASSERT_TRUE(rig.next());
  for (int frame = 0; frame < 200; ++frame) rig.process();
  EXPECT_EQ(rig.changes(), 0);
}

TEST(LineFaultMonitor, measures_a_drifting_driver) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    LineFaults faults;
    faults.drifting_rows = {5};
    faults.drift_ohm = 60.0;
    Rig rig(reference_circuit(16, 16, circuit), "multitouch", 3, 6000, faults);
    while (rig.next()) continue;
    const auto found = rig.monitor().faults();
    ASSERT_EQ(found.size(), 1U) << describe(found, reference_circuit(16, 16, circuit));
    EXPECT_EQ(found[0].kind, LineFaultKind::drifting_driver);
    EXPECT_EQ(found[0].place, 5U);
    EXPECT_NEAR(found[0].drive_ohm, 80.0, 25.0);
    EXPECT_FALSE(has(rig.conductance().status, FrameStatus::line_fault)) << "reported alone";
  }
}

TEST(LineFaultMonitor, tells_an_open_row_from_one_shorted_to_ground) {
  for (const bool grounded : {false, true}) {
    LineFaults faults;
    (grounded ? faults.rows.grounded : faults.rows.open) = {6};
    Rig rig(reference_circuit(16, 16), "multitouch", 9, 400, faults);
    while (rig.next()) continue;
    ASSERT_EQ(rig.monitor().faults().size(), 1U);
    EXPECT_EQ(rig.monitor().faults()[0].grounded, grounded);
    EXPECT_GT(std::abs(rig.monitor().faults()[0].ground_evidence), 5.0);
  }
}

/// A taxel whose reading is 0 whatever presses it, and which conducts or does not.
TEST(LineFaultMonitor, tells_a_taxel_stuck_at_0_from_a_dead_one) {
  for (const bool conducts : {false, true}) {
    LineFaults faults;
    faults.stuck_ratio = 0.0;
    (conducts ? faults.stuck_taxels : faults.dead_taxels) = {"r5c6"};
    Rig rig(reference_circuit(16, 16), "multitouch", 9, 4000, faults);
    while (rig.next()) continue;
    const auto found = rig.monitor().faults();
    ASSERT_EQ(found.size(), 1U) << describe(found, reference_circuit(16, 16));
    EXPECT_EQ(found[0].kind, conducts ? LineFaultKind::stuck_taxel : LineFaultKind::dead_taxel);
    EXPECT_EQ(found[0].place, reference_circuit(16, 16).index(5, 6));
  }
}

/// Counts of a frames.csv without a supply: time, temperature, then the taxels.
std::vector<std::vector<double>> read_counts(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> frames;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    frames.emplace_back(values.begin() + 2, values.end());
  }
  return frames;
}

/// Hour-long recordings of six vendor modules that warm up unloaded (13 x 6 and 14 x 6 taxels, circuit unknown). The
/// unloaded readings are those of the first frames, as a calibration would take them.
TEST(LineFaultMonitor, finds_nothing_on_real_modules_that_warm_up) {
  const std::filesystem::path folder = support::shared_data("dsa_recordings");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << support::not_checked(folder);
  constexpr std::size_t kCalibrationFrames = 50;
  for (int module = 0; module < 6; ++module) {
    SCOPED_TRACE(testing::Message() << "module " << module);
    const auto frames = read_counts(folder / ("unloaded_warmup_m" + std::to_string(module) + ".csv"));
    ASSERT_FALSE(frames.empty());
    ArrayDescription array;
    array.cols = 6;
    array.rows = frames[0].size() / array.cols;
    array.readout.circuit = Circuit::none;
    std::vector<double> unloaded(array.taxel_count(), 0.0);
    for (std::size_t frame = 0; frame < kCalibrationFrames; ++frame) {
      for (std::size_t taxel = 0; taxel < unloaded.size(); ++taxel) {
        unloaded[taxel] += frames[frame][taxel] / array.readout.full_scale_counts() / kCalibrationFrames;
      }
    }
    LineFaultMonitor monitor(array, unloaded);
    auto compensator = Compensator::create(array).value();
    ConditionedFrame conditioned;
    ConductanceFrame conductance;
    conditioned.sigma_ratio = array.readout.adc_noise_counts / array.readout.full_scale_counts();
    for (const std::vector<double>& frame : frames) {
      conditioned.ratio.clear();
      for (const double count : frame) conditioned.ratio.push_back(count / array.readout.full_scale_counts());
      conditioned.taxels.assign(frame.size(), TaxelStatus::ok);
      compensator.process(conditioned, conductance);
      monitor.observe(conditioned, conductance);
      ASSERT_TRUE(monitor.faults().empty()) << describe(monitor.faults(), array);
    }
    EXPECT_TRUE(monitor.sees_silent_row(6));
  }
}

/// Error of the healthy taxels that are pressed, with the fault over without it, same loads and noise.
std::pair<double, double> error_ratios(const ArrayDescription& array, const LineFaults& faults, std::uint64_t seed) {
  constexpr std::size_t kFrames = 400;
  constexpr double kPressedSiemens = 1e-4;
  Rig faulty(array, "multitouch", seed, kFrames, faults);
  Rig healthy(array, "multitouch", seed, kFrames);
  std::vector<double> error_faulty;
  std::vector<double> error_healthy;
  while (faulty.next() && healthy.next()) {
    if (faulty.frames() < 200) continue;  // until it is found
    for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
      const double truth = healthy.true_siemens()[taxel];
      if (faulty.conductance().taxels[taxel] == TaxelStatus::line_fault || truth < kPressedSiemens) continue;
      EXPECT_GE(faulty.conductance().siemens[taxel], 0.0);
      error_faulty.push_back(std::abs(faulty.conductance().siemens[taxel] / truth - 1.0));
      error_healthy.push_back(std::abs(healthy.conductance().siemens[taxel] / truth - 1.0));
    }
  }
  return {quantile(error_faulty, 0.5) / quantile(error_healthy, 0.5),
          quantile(error_faulty, 0.95) / quantile(error_healthy, 0.95)};
}

TEST(FaultySolve, healthy_taxels_stay_right_beside_an_open_line) {
  struct Case {
    Circuit circuit;
    LineFaults faults;
    double most_median;
    double most_p95;
  };
  std::vector<Case> cases;
  const auto add = [&](Circuit circuit, double median, double p95) -> LineFaults& {
    cases.push_back({circuit, {}, median, p95});
    return cases.back().faults;
  };
  add(Circuit::divider, 1.2, 1.2).rows.open = {5};
  add(Circuit::divider, 1.2, 1.2).rows.open = {11};
  add(Circuit::divider, 1.2, 1.3).rows.open = {0};  // an edge: neighbours on one side only
  add(Circuit::divider, 1.2, 1.2).columns.open = {9};
  add(Circuit::divider, 1.05, 1.05).rows.shorted = {7};
  add(Circuit::divider, 1.05, 1.05).columns.shorted = {2};
  add(Circuit::divider, 1.1, 1.1).stuck_taxels = {"r5c5"};
  add(Circuit::divider, 1.1, 1.1).dead_taxels = {"r5c5"};
  add(Circuit::transimpedance, 1.05, 1.05).rows.open = {5};
  add(Circuit::transimpedance, 1.2, 1.2).columns.open = {9};
  add(Circuit::transimpedance, 1.05, 1.05).rows.shorted = {7};
  add(Circuit::transimpedance, 1.05, 1.05).columns.shorted = {2};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto [median, p95] = error_ratios(reference_circuit(16, 16, cases[k].circuit), cases[k].faults, 40 + k);
    EXPECT_LE(median, cases[k].most_median) << "case " << k;
    EXPECT_LE(p95, cases[k].most_p95) << "case " << k;
  }
}

/// Not as exact: a supply that leaks into every scan doubles the noise at least, and what flows into a column at the
/// supply or at 0 V is only estimated.
TEST(FaultySolve, healthy_taxels_stay_usable_beside_a_line_at_a_rail) {
  LineFaults supplied_row;
  supplied_row.rows.supplied = {5};
  EXPECT_LE(error_ratios(reference_circuit(16, 16), supplied_row, 1).first, 3.0);
  LineFaults supplied_column;
  supplied_column.columns.supplied = {5};
  EXPECT_LE(error_ratios(reference_circuit(16, 16), supplied_column, 2).first, 3.0);
  LineFaults grounded_column;
  grounded_column.columns.grounded = {5};
  EXPECT_LE(error_ratios(reference_circuit(16, 16), grounded_column, 3).first, 4.0);
}

TEST(FaultySolve, every_circuit_stays_finite_with_every_fault) {
  std::vector<ArrayDescription> arrays = {reference_circuit(6, 5), reference_circuit(6, 5, Circuit::flexitac),
                                          reference_circuit(6, 5, Circuit::none), reference_circuit(2, 2),
                                          reference_circuit(1, 3)};
  arrays.push_back(reference_circuit(6, 5));
  arrays.back().readout.idle_columns = IdleColumns::floating;
  arrays.push_back(reference_circuit(6, 5));
  arrays.back().readout.drive_ohm.assign(6, 0.0);
  arrays.push_back(reference_circuit(6, 5, Circuit::transimpedance));
  arrays.back().readout.idle_rows = IdleRows::floating;
  for (std::size_t which = 0; which < arrays.size(); ++which) {
    const ArrayDescription& array = arrays[which];
    SCOPED_TRACE(testing::Message() << "array " << which);
    Random random(which);
    auto compensator = Compensator::create(array).value();
    ConditionedFrame conditioned;
    conditioned.sigma_ratio = 1.0 / array.readout.full_scale_counts();
    ConductanceFrame conductance;
    for (int kind = 0; kind < static_cast<int>(LineFaultKind::drifting_driver); ++kind) {
      if (static_cast<LineFaultKind>(kind) == LineFaultKind::shorted_rows && array.rows == 1) continue;
      const LineFault faults[] = {{static_cast<LineFaultKind>(kind), 0, 0, {}, 50.0, 0.0, kind % 2 == 0}};
      compensator.set_faults(faults);
      conditioned.taxels.assign(array.taxel_count(), TaxelStatus::ok);
      conditioned.ratio.clear();
      for (std::size_t k = 0; k < array.taxel_count(); ++k) conditioned.ratio.push_back(random.uniform(0.0, 0.15));
      compensator.process(conditioned, conductance);
      EXPECT_TRUE(has(conductance.status, FrameStatus::line_fault));
      for (const double siemens : conductance.siemens) {
        EXPECT_TRUE(std::isfinite(siemens) && siemens >= 0.0) << "kind " << kind;
      }
    }
    compensator.set_faults({});
    compensator.process(conditioned, conductance);
    EXPECT_FALSE(has(conductance.status, FrameStatus::line_fault));
  }
}

TEST(FaultySolve, allocates_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  LineFaults faults;
  faults.from_frame = 5;
  faults.until_frame = 60;
  faults.rows.open = {3};
  faults.columns.shorted = {8};
  faults.dead_taxels = {"r10c2"};
  Rig faulty(reference_circuit(16, 16), "multitouch", 4, 120, faults);
  ASSERT_TRUE(faulty.next());
  std::size_t allocations = 0;
  while (true) {
    if (!faulty.next()) break;  // the simulator allocates, the frame processed once more does not
    const support::AllocationGuard guard;
    faulty.process();
    allocations += guard.count();
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_GT(faulty.changes(), 2);
}

}  // namespace
}  // namespace dermis::touch::compensation
