// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Watches random arrays without a fault (docs/reasons/health.md, "How well"), for ten minutes where they are touched,
// else for 1000 frames. Of two thirds of them the circuit is given. The others are calibrated, by right labels or by
// people's, with the circuit given or without ("auto"), and run through the whole pipeline. The counts of all are
// examined alone, too. healthy_campaign [ARRAYS [MOST_FRAMES [FIRST_SEED]]]
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/learn/health/raw_examination.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/healthy_arrays.hpp"

namespace {

using dermis::Circuit;
using dermis::Load;
using dermis::LoadKind;
using dermis::Random;
using dermis::support::HealthyArray;

constexpr std::size_t kArraysAtOnce = 20;
constexpr std::size_t kTenMinutes = 6000;  // frames of touches
constexpr std::size_t kOtherFrames = 1000;
constexpr double kMistakes = 0.1;  // share of the labels

enum class Knowledge { circuit_given, calibrated, calibrated_without_circuit };
constexpr std::size_t kKnowledges = 3;

Knowledge knowledge_of(std::uint64_t seed) {
  switch (seed % 6) {
    case 4: return Knowledge::calibrated;
    case 5: return Knowledge::calibrated_without_circuit;
    default: return Knowledge::circuit_given;
  }
}

struct Recording {
  std::vector<dermis::RawFrame> frames;
  std::vector<Load> loads;
};

/// Small, of a circuit that "auto" knows, with resistors that differ by per cents.
void give_circuit_to_be_found(Random& random, HealthyArray& healthy) {
  const auto circuits = dermis::support::all_circuits();
  constexpr std::array kFound = {0, 1, 2, 4, 8};  // lumped, without real amplifiers
  const auto& circuit = circuits[static_cast<std::size_t>(kFound[random.below(kFound.size())])];
  dermis::ArrayDescription& array = healthy.array;
  dermis::Readout& readout = array.readout;
  array.rows = 3 + random.below(6);
  array.cols = 3 + random.below(6);
  const int bits = readout.adc_bits;
  const double noise = readout.adc_noise_counts;
  readout = {};
  readout.circuit = circuit.circuit;
  readout.idle_rows = circuit.idle_rows;
  readout.idle_columns = circuit.idle_columns;
  readout.adc_bits = bits;
  readout.adc_noise_counts = noise;
  const auto resistors = [&](std::size_t lines, double ohm) {
    std::vector<double> ohms(lines);
    for (double& value : ohms) value = ohm * std::exp(0.03 * random.normal());
    return ohms;
  };
  readout.drive_ohm = resistors(array.driven_lines(), random.log_uniform(5.0, 100.0));
  readout.load_ohm = resistors(array.sensed_lines(), random.log_uniform(100.0, 1e4));
  healthy.words =
      circuit.name + ' ' + std::to_string(array.rows) + 'x' + std::to_string(array.cols) + " for " + healthy.words;
}

/// Wrong force, wrong taxel, or said to be unloaded.
void mistake(const dermis::ArrayDescription& array, Random& random, Load& load) {
  switch (random.below(3)) {
    case 0: load.value *= random.log_uniform(0.3, 3.0); break;
    case 1: {
      const std::size_t row = random.below(array.rows);
      const std::size_t col = random.below(array.cols);
      load.where = {row, col, row, col};
      break;
    }
    default: load = {load.frame, LoadKind::force, dermis::all_taxels(array), 0.0};
  }
}

/// Every taxel alone under some forces, in half of the recordings all of them under an air bladder, too.
Recording calibration_of(const HealthyArray& healthy, Random& random) {
  const bool is_dirty = random.below(2) == 0;
  const bool has_uniform = random.below(2) == 0;
  constexpr std::size_t kUnloaded = 20;
  Recording recording;
  const auto record = [&](const std::string& scene, const auto& is_kept) {
    const auto simulator = dermis::support::play(healthy, scene, healthy.seed + 3, 0);
    dermis::RawFrame raw;
    for (std::size_t frame = 0; *simulator->next(raw); ++frame) {
      if (!is_kept(frame)) continue;
      dermis::support::cut_off(healthy, raw);
      raw.time = std::chrono::seconds(recording.frames.size());
      for (Load load : simulator->loads()) {
        load.frame = recording.frames.size();
        if (is_dirty && load.value > 0.0 && random.uniform() < kMistakes) mistake(healthy.array, random, load);
        recording.loads.push_back(load);
      }
      recording.frames.push_back(raw);
    }
  };
  record("paper_calibration", [&](std::size_t frame) {
    return frame < kUnloaded || (frame - kUnloaded) / healthy.array.taxel_count() % 3 == 1;
  });
  if (has_uniform) record("uniform", [](std::size_t frame) { return frame % 5 == 0; });
  return recording;
}

/// As dermis::support::found_faults(), with what a calibration makes of the array.
std::string found_faults_after_calibration(const HealthyArray& healthy, const dermis::ArrayDescription& known,
                                           Random& random, std::size_t frames, std::string& refusal) {
  const Recording recording = calibration_of(healthy, random);
  const auto calibration = dermis::learn::calibration::calibrate(known, recording.frames, recording.loads);
  if (!calibration) {
    refusal = calibration.error().message;
    return {};
  }
  auto created = dermis::touch::pipeline::Pipeline::create(calibration->model);
  if (!created) {
    refusal = created.error().message;
    return {};
  }
  auto& pipeline = *created;
  dermis::ForceFrame force;
  std::string text;
  for (const dermis::RawFrame& raw : dermis::support::stream_of(healthy, frames)) {
    pipeline.process(raw, force);
    dermis::support::name_faults(pipeline.line_faults().faults(), healthy.array, text);
  }
  return text;
}

struct Outcome {
  Knowledge knowledge = Knowledge::circuit_given;
  std::string words;
  std::string found;
  std::string refusal;              // of the calibration
  std::vector<std::string> doubts;  // by the counts alone
};

std::vector<std::string> doubts_of(const HealthyArray& healthy, std::size_t frames) {
  dermis::learn::health::RawExamination examination({healthy.array.rows, healthy.array.cols}, healthy.array.readout);
  for (const dermis::RawFrame& raw : dermis::support::stream_of(healthy, frames)) examination.add(raw);
  return examination.diagnosis().problems();
}

Outcome watch(std::uint64_t seed, std::size_t most_frames) {
  HealthyArray healthy = dermis::support::random_healthy_array(seed);
  const std::size_t frames = std::min(most_frames, healthy.scene == "touches" ? kTenMinutes : kOtherFrames);
  const Knowledge knowledge = knowledge_of(seed);
  if (knowledge == Knowledge::circuit_given) {
    return {knowledge, healthy.words, dermis::support::found_faults(healthy, frames), {}, doubts_of(healthy, frames)};
  }
  Random random = Random::stream(seed, 2);
  give_circuit_to_be_found(random, healthy);
  dermis::ArrayDescription known = healthy.array;
  if (knowledge == Knowledge::calibrated_without_circuit) {
    known.readout = {};
    known.readout.circuit = Circuit::automatic;
    known.readout.adc_bits = healthy.array.readout.adc_bits;
  }
  Outcome outcome{knowledge, healthy.words, {}, {}, doubts_of(healthy, frames)};
  outcome.found = found_faults_after_calibration(healthy, known, random, frames, outcome.refusal);
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int k, std::size_t otherwise) {
    return argc > k ? static_cast<std::size_t>(std::strtoull(argv[k], nullptr, 10)) : otherwise;
  };
  const std::size_t arrays = argument(1, 200);
  const std::size_t most_frames = argument(2, kTenMinutes);
  const std::size_t first_seed = argument(3, 1);
  constexpr const char* kWords[] = {"circuit given", "calibrated", "calibrated without circuit"};
  std::array<std::size_t, kKnowledges> watched{};
  std::array<std::size_t, kKnowledges> masked{};
  std::size_t doubted = 0;
  for (std::size_t first = 0; first < arrays; first += kArraysAtOnce) {
    std::vector<Outcome> outcomes(std::min(kArraysAtOnce, arrays - first));
    dermis::learn::calibration::parallel_for(
        outcomes.size(), [&](std::size_t k) { outcomes[k] = watch(first_seed + first + k, most_frames); });
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
      const auto knowledge = static_cast<std::size_t>(outcomes[k].knowledge);
      doubted += outcomes[k].doubts.empty() ? 0 : 1;
      for (const std::string& doubt : outcomes[k].doubts) {
        fmt::print("seed {}, {}: {}\n", first_seed + first + k, outcomes[k].words, doubt);
      }
      if (!outcomes[k].refusal.empty()) {
        fmt::print("seed {}, {}: not calibrated: {}\n", first_seed + first + k, outcomes[k].words, outcomes[k].refusal);
        continue;
      }
      ++watched[knowledge];
      if (outcomes[k].found.empty()) continue;
      ++masked[knowledge];
      fmt::print("seed {}, {}, {}: {}\n", first_seed + first + k, kWords[knowledge], outcomes[k].words,
                 outcomes[k].found);
    }
    std::fflush(stdout);
  }
  std::size_t all_masked = 0;
  for (std::size_t k = 0; k < kKnowledges; ++k) {
    fmt::print("{:<28} {} of {} healthy arrays have masked taxels\n", kWords[k], masked[k], watched[k]);
    all_masked += masked[k];
  }
  fmt::print("{:<28} {} of {} healthy arrays are doubted\n", "counts alone", doubted, arrays);
  return all_masked + doubted == 0 ? 0 : 1;
}
