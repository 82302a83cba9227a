// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Lines and taxels that read exactly nothing, or all that the ADC has, in every circuit and at every idle level.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "dermis/learn/health/examination.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "support/circuits.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kRows = 8;
constexpr std::size_t kCols = 10;
constexpr std::size_t kFoundWithin = 60;  // frames
constexpr double kLoadOhm = 200.0;

std::vector<support::NamedCircuit> circuits() {
  std::vector<support::NamedCircuit> all = support::all_circuits();
  std::erase_if(
      all, [](const support::NamedCircuit& circuit) { return circuit.real_amplifiers || circuit.resistive_lines; });
  all.push_back({"none", Circuit::none});
  return all;
}

/// An array whose taxels read about `idle` counts of 12 bits untouched, and how it is read.
class Sheet {
 public:
  Sheet(const support::NamedCircuit& named, double idle, std::uint64_t seed)
      : random_(seed), model_(support::hand_made_model(kRows, kCols)) {
    Readout& readout = model_.array.readout;
    readout.circuit = named.circuit;
    readout.idle_rows = named.idle_rows;
    readout.idle_columns = named.idle_columns;
    readout.adc_bits = 12;
    readout.drive_ohm.assign(model_.array.driven_lines(), 20.0);
    readout.load_ohm.assign(model_.array.sensed_lines(), kLoadOhm);
    const double unknown = named.circuit == Circuit::none ? simulation::ReadoutCircuit::kUnknownCircuitOhm : 1.0;
    const double ohm = named.circuit == Circuit::none ? unknown : kLoadOhm;
    auto& networks = model_.networks;
    for (std::size_t taxel = 0; taxel < kRows * kCols; ++taxel) {
      unloaded_.push_back(idle / 4095.0 / ohm * std::exp(0.12 * random_.normal()));
      networks.unloaded.offset_siemens[taxel] = unknown * unloaded_.back();
      networks.unloaded.per_celsius[taxel] = 0.0;
      networks.offset_sigma_siemens[taxel] = static_cast<float>(0.1 / 4095.0 / ohm * unknown);
      networks.reference_siemens[taxel] = static_cast<float>(unknown * 1e-3);
      networks.heaviest_siemens[taxel] = static_cast<float>(unknown * 6e-3);
    }
    if (named.circuit == Circuit::none) readout.drive_ohm = readout.load_ohm = {};
  }

  [[nodiscard]] const touch::pipeline::Model& model() const { return model_; }
  [[nodiscard]] Random& random() { return random_; }

  /// Touches of one to four neighbours that last 20 frames, with 10 of rest, from frame 40 on.
  RawFrame frame(std::size_t number) {
    if (number % 30 == 10) place_ = kCols * random_.below(kRows - 1) + random_.below(kCols - 2);
    std::vector<double> siemens = unloaded_;
    if (number >= 40 && number % 30 >= 10) {
      for (const std::size_t next : {0U, 1U, 10U, 11U}) {
        siemens[place_ + next] += (1e-3 + 4.0 * unloaded_[place_]) / (1.0 + 0.1 * static_cast<double>(next));
      }
    }
    std::vector<double> ratio(siemens.size());
    simulation::ReadoutCircuit::create(model_.array)->ratios(siemens, ratio);
    RawFrame raw;
    raw.time = number * std::chrono::milliseconds(20);
    raw.temperature_celsius = 25.0;
    raw.supply_v = 5.0;
    raw.counts.resize(siemens.size());
    simulation::Adc(model_.array.readout, 0.8).convert(ratio, 5.0, random_, raw.counts);
    return raw;
  }

 private:
  Random random_;
  touch::pipeline::Model model_;
  std::vector<double> unloaded_;
  std::size_t place_ = 0;
};

/// What is dead: so many lines, or one taxel.
struct Dead {
  std::string name;
  Axis axis = Axis::row;
  std::size_t lines = 0;  ///< 0: a taxel.
};

std::vector<Dead> all_dead() {
  return {{"row", Axis::row, 1},
          {"column", Axis::column, 1},
          {"half of the rows", Axis::row, kRows / 2},
          {"half of the columns", Axis::column, kCols / 2},
          {"taxel", Axis::row, 0}};
}

/// The findings, of which each dead place has to have one.
struct Outcome {
  std::vector<std::string> findings;
  std::vector<std::string> unnamed;
};

Outcome examine(Sheet& sheet, const Dead& dead, float reading, std::size_t from) {
  const ArrayDescription& array = sheet.model().array;
  std::vector<std::string> names;
  std::vector<std::size_t> taxels;
  if (dead.lines == 0) {
    taxels.push_back(sheet.random().below(array.taxel_count()));
    names.push_back("taxel " + array.taxel_name(taxels.front()));
  }
  const std::size_t first = sheet.random().below(line_count(array, dead.axis) - dead.lines + 1);
  for (std::size_t line = first; line < first + dead.lines; ++line) {
    names.push_back(std::string(to_string(dead.axis)) + " " + std::to_string(line) + " ");
    for (std::size_t k = 0; k < line_length(array, dead.axis); ++k) {
      taxels.push_back(taxel_on_line(array, dead.axis, line, k));
    }
  }
  auto pipeline = touch::pipeline::Pipeline::create(sheet.model()).value();
  Examination examination(sheet.model());
  ForceFrame force;
  for (std::size_t number = 0; number < from + kFoundWithin; ++number) {
    RawFrame raw = sheet.frame(number);
    for (const std::size_t taxel : taxels) {
      if (number < from) continue;
      // 1 of noise where it is nearly at the end
      raw.counts[taxel] = reading > 1.0F && reading < 4095.0F ? reading + static_cast<float>(number % 3) : reading;
    }
    pipeline.process(raw, force);
    examination.add(raw, force, pipeline);
  }
  Outcome outcome{examination.diagnosis(pipeline).findings, {}};
  for (const std::string& name : names) {
    const bool is_named = std::ranges::any_of(
        outcome.findings, [&](const std::string& finding) { return (finding + " ").find(name) != std::string::npos; });
    if (!is_named) outcome.unnamed.push_back(name);
  }
  return outcome;
}

class DeadLines : public testing::TestWithParam<support::NamedCircuit> {};

TEST_P(DeadLines, are_named_within_60_frames_at_each_idle_level) {
  std::uint64_t seed = 1;
  for (const double idle : {1.0, 3.0, 20.0, 100.0, 400.0}) {
    for (const Dead& dead : all_dead()) {
      for (const float reading : {0.0F, 4095.0F, 4090.0F}) {
        for (const std::size_t from : {0U, 75U}) {
          Sheet sheet(GetParam(), idle, ++seed);
          const Outcome outcome = examine(sheet, dead, reading, from);
          EXPECT_TRUE(outcome.unnamed.empty())
              << dead.name << " at " << reading << " from " << from << ", idle at " << idle << ": "
              << outcome.unnamed.size() << " without a name, " << testing::PrintToString(outcome.findings);
        }
      }
    }
  }
}

TEST_P(DeadLines, are_none_where_all_work) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Sheet sheet(GetParam(), random.log_uniform(1.0, 400.0), 100 + seed);
    auto pipeline = touch::pipeline::Pipeline::create(sheet.model()).value();
    Examination examination(sheet.model());
    ForceFrame force;
    for (std::size_t number = 0; number < 300; ++number) {
      const RawFrame raw = sheet.frame(number);
      pipeline.process(raw, force);
      examination.add(raw, force, pipeline);
    }
    const Diagnosis diagnosis = examination.diagnosis(pipeline);
    EXPECT_TRUE(diagnosis.faults.empty());
    EXPECT_TRUE(diagnosis.findings.empty()) << seed << ": " << diagnosis.findings.front();
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryCircuit, DeadLines, testing::ValuesIn(circuits()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace dermis::learn::health
