// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/compensation/line_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/compensation/crosstalk.hpp"
#include "dermis/core/random.hpp"
#include "dermis/simulation/simulator.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::compensation {
namespace {

using simulation::LineFaults;

ArrayDescription make_array(std::size_t rows, std::size_t cols, Circuit circuit = Circuit::divider) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  array.readout.circuit = circuit;
  array.readout.drive_ohm.assign(array.driven_lines(), 20.0);
  array.readout.load_ohm.assign(array.sensed_lines(), 200.0);
  return array;
}

/// A simulated array with the monitor and the compensation that act on what it finds.
class Rig {
 public:
  Rig(const ArrayDescription& array, const std::string& scene, std::uint64_t seed, std::size_t frames,
      const LineFaults& faults = {})
      : array_(array), compensator_(Compensator::create(array).value()) {
    simulation::SimulationOptions options;
    options.faults = faults;
    simulator_ = simulation::Simulator::create(array, options, scene, seed, frames).value();
    std::vector<double> unloaded;
    for (std::size_t k = 0; k < array.taxel_count(); ++k) {
      const auto& rubber = simulator_->rubber();
      unloaded.push_back(array.readout.circuit == Circuit::none
                             ? simulation::ReadoutCircuit::kUnknownCircuitOhm * rubber.conductance_from_force(k, 0, 25)
                             : rubber.conductance_from_force(k, 0.0, 25.0));
    }
    std::vector<double> typical;
    for (std::size_t k = 0; k < array.taxel_count(); ++k) {
      typical.push_back(simulator_->rubber().conductance_from_force(k, 10.0, 25.0));
    }
    compensator_ = Compensator::create(array, typical).value();
    monitor_ = std::make_unique<LineFaultMonitor>(array, unloaded);
  }

  bool next() {
    if (!*simulator_->next(raw_)) return false;
    const double full_scale = array_.readout.full_scale_counts();
    conditioned_.time = raw_.time;
    conditioned_.sigma_ratio = array_.readout.adc_noise_counts / full_scale;
    conditioned_.ratio.resize(raw_.counts.size());
    conditioned_.taxels.assign(raw_.counts.size(), TaxelStatus::ok);
    for (std::size_t k = 0; k < raw_.counts.size(); ++k) {
      conditioned_.ratio[k] = static_cast<double>(raw_.counts[k]) / full_scale;
      if (static_cast<double>(raw_.counts[k]) > full_scale - 0.5) conditioned_.taxels[k] = TaxelStatus::saturated;
    }
    compensator_.process(conditioned_, conductance_);
    if (monitor_->observe(conditioned_, conductance_)) {
      ++changes_;
      compensator_.set_faults(monitor_->faults());
      compensator_.process(conditioned_, conductance_);
    }
    ++frame_;
    return true;
  }

  [[nodiscard]] const LineFaultMonitor& monitor() const { return *monitor_; }
  [[nodiscard]] const ConductanceFrame& conductance() const { return conductance_; }
  [[nodiscard]] const std::vector<double>& true_siemens() const { return simulator_->true_siemens(); }
  [[nodiscard]] std::size_t frame() const { return frame_; }
  [[nodiscard]] int changes() const { return changes_; }

 private:
  ArrayDescription array_;
  Compensator compensator_;
  std::unique_ptr<simulation::Simulator> simulator_;
  std::unique_ptr<LineFaultMonitor> monitor_;
  RawFrame raw_;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
  std::size_t frame_ = 0;
  int changes_ = 0;
};

std::string names(std::span<const LineFault> faults, const ArrayDescription& array) {
  std::string text;
  for (const LineFault& fault : faults) {
    text += place_name(fault, array) + "(kind " + std::to_string(static_cast<int>(fault.kind)) + ", frame " +
            std::to_string(fault.frame) + ", " + std::to_string(fault.drive_ohm + fault.ground_evidence) + ") ";
  }
  return text;
}

TEST(Explore, Faults) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (const char* scene : {"multitouch", "idle"}) {
      for (int k = 0; k < 12; ++k) { if (getenv("K") && atoi(getenv("K")) != k) continue;
        ArrayDescription array = make_array(16, 16, circuit);
        LineFaults faults;
        faults.from_frame = 20;
        if (k == 0) faults.open_rows = {5};
        if (k == 1) faults.open_columns = {5};
        if (k == 2) faults.grounded_rows = {5};
        if (k == 3) faults.grounded_columns = {5};
        if (k == 4) faults.supplied_rows = {5};
        if (k == 5) faults.supplied_columns = {5};
        if (k == 6) faults.shorted_rows = {5};
        if (k == 7) faults.shorted_columns = {5};
        if (k == 8) faults.dead_taxels = {"r5c5"};
        if (k == 9) faults.stuck_taxels = {"r5c5"};
        if (k == 10) { faults.drifting_rows = {5}; faults.drift_ohm = 60; }
        Rig rig(array, scene, 3, getenv("N") ? atoi(getenv("N")) : 400, faults);
        std::printf("%s %s %d: ", to_string(circuit), scene, k);
        int before = 0;
        int unsolved = 0;
        while (rig.next()) {
          if (rig.changes() != before && rig.changes() < 5) std::printf("@%zu %.200s| ", rig.frame() - 1, names(rig.monitor().faults(), array).c_str());
          before = rig.changes();
          if (has(rig.conductance().status, FrameStatus::not_converged)) ++unsolved;
        }
        std::printf(" changes %d unsolved %d end: %.200s\n", rig.changes(), unsolved, names(rig.monitor().faults(), array).c_str());
      }
    }
  }
}

TEST(Explore, Accuracy) {
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance}) {
    for (int k = 0; k < 9; ++k) { if (getenv("K") && atoi(getenv("K")) != k) continue;
      ArrayDescription array = make_array(16, 16, circuit);
      LineFaults faults;
      if (k == 0) faults.open_rows = {getenv("ROW") ? static_cast<std::size_t>(atoi(getenv("ROW"))) : 5};
      if (k == 1) faults.open_columns = {5};
      if (k == 2) faults.grounded_rows = {5};
      if (k == 3) faults.grounded_columns = {5};
      if (k == 4) faults.supplied_rows = {5};
      if (k == 5) faults.supplied_columns = {5};
      if (k == 6) faults.shorted_rows = {5};
      if (k == 7) faults.shorted_columns = {5};
      if (k == 8) faults.stuck_taxels = {"r5c5"};
      Rig rig(array, "multitouch", 3, 1000, faults);
      Rig good(array, "multitouch", 3, 1000);
      std::vector<double> e[2];
      while (rig.next() && good.next()) {
        if (rig.frame() < 60) continue;
        for (std::size_t t = 0; t < 256; ++t) {
          if (rig.conductance().taxels[t] != TaxelStatus::ok || rig.true_siemens()[t] < 1e-4) continue;
          e[0].push_back(std::abs(good.conductance().siemens[t] / good.true_siemens()[t] - 1.0));
          e[1].push_back(std::abs(rig.conductance().siemens[t] / good.true_siemens()[t] - 1.0));
        }
      }
      for (auto& v : e) std::sort(v.begin(), v.end());
      const auto q = [&](int i, double p) { return e[i][static_cast<std::size_t>(p * static_cast<double>(e[i].size() - 1))]; };
      std::printf("%s %d n %zu median %.5f %.5f %.2f p95 %.5f %.5f %.2f p99 %.2f\n", to_string(circuit), k, e[0].size(), q(0, 0.5), q(1, 0.5), q(1, .5) / q(0, .5), q(0, .95), q(1, .95), q(1, .95) / q(0, .95), q(1, .99) / q(0, .99));
    }
  }
}

}  // namespace
}  // namespace dermis::compensation
namespace dermis::compensation { namespace {
TEST(Explore, Healthy) {
  const std::size_t n = getenv("N") ? static_cast<std::size_t>(atol(getenv("N"))) : 10000;
  for (const Circuit circuit : {Circuit::divider, Circuit::transimpedance, Circuit::none}) {
    for (const char* scene : {"multitouch", "idle"}) {
      for (std::size_t size : {8UL, 16UL}) {
        Rig rig(make_array(size, size, circuit), scene, 77, n);
        int before = 0;
        while (rig.next()) {
          if (rig.changes() != before && before < 5) std::printf("%s %s %zu @%zu %.300s\n", to_string(circuit), scene, size, rig.frame() - 1, names(rig.monitor().faults(), make_array(size, size, circuit)).c_str());
          before = rig.changes();
        }
        std::printf("%s %s %zu: %d changes in %zu\n", to_string(circuit), scene, size, rig.changes(), rig.frame());
      }
    }
  }
}
}}
