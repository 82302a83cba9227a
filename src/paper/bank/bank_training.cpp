// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/bank_training.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "dermis/paper/initialisation.hpp"
#include "dermis/paper/structured_start.hpp"
#include "paper/bank/bank_checkpoint.hpp"

namespace dermis::paper {

using learn::calibration::Sample;
using learn::calibration::SampleDatabase;

namespace {

constexpr std::size_t kMostBatch = 65'536;
constexpr double kRelativeDownTo = 0.5;  // of the heaviest force
constexpr double kRateOfSum = 2.0;       // of N connections together in a step: more breaks up the paper's start
constexpr double kHighestRate = 0.05;
constexpr double kLowestRate = 1e-5;
constexpr std::size_t kOtherBytes = std::size_t{16} << 20U;  // buffers of MPI, and rows of files
constexpr float kSecondDecay = 0.97F;                        // 0.999 takes twice the steps

/// The range of each taxel over all samples; a taxel that never changes gets a range of 1.
std::vector<PaperBank::Range> ratio_ranges(const SampleDatabase& database) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<PaperBank::Range> ranges(database.array.taxel_count(), {kInfinity, -kInfinity});
  for (const Sample& sample : database.samples) {
    for (std::size_t taxel = 0; taxel < ranges.size(); ++taxel) {
      const auto ratio = static_cast<double>(sample.ratio[taxel]);
      ranges[taxel].low = std::min(ranges[taxel].low, ratio);
      ranges[taxel].high = std::max(ranges[taxel].high, ratio);
    }
  }
  for (PaperBank::Range& range : ranges) {
    if (!(range.low < range.high)) range.high = range.low + 1.0;
  }
  return ranges;
}

std::vector<std::size_t> constant_readings(const SampleDatabase& database) {
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < database.array.taxel_count(); ++taxel) {
    const float first = database.samples.front().ratio[taxel];
    const bool is_constant = std::all_of(database.samples.begin(), database.samples.end(),
                                         [&](const Sample& sample) { return sample.ratio[taxel] == first; });
    if (is_constant) taxels.push_back(taxel);
  }
  return taxels;
}

double heaviest_force(const SampleDatabase& database) {
  double heaviest = 0.0;
  for (const Sample& sample : database.samples) {
    for (const float newtons : sample.known_newtons) {
      if (newtons > heaviest) heaviest = newtons;
    }
  }
  return heaviest;
}

std::optional<PaperBank::Range> temperature_range(const SampleDatabase& database) {
  const learn::calibration::SampleTemperatures temperatures = learn::calibration::sample_temperatures(database);
  if (!temperatures.is_input) return std::nullopt;
  const TemperatureSpan& span = temperatures.span;
  return PaperBank::Range{span.centre_celsius - span.half_span_celsius, span.centre_celsius + span.half_span_celsius};
}

/// The paper's start knows no temperature: an input more in the first layer, of `inputs` neurons, with weights of 0.
std::vector<float> with_further_input(const std::vector<float>& parameters, std::size_t inputs) {
  std::vector<float> widened;
  widened.reserve(parameters.size() + inputs);
  const auto rest = parameters.begin() + static_cast<std::ptrdiff_t>(inputs * inputs);
  for (auto row = parameters.begin(); row != rest; row += static_cast<std::ptrdiff_t>(inputs)) {
    widened.insert(widened.end(), row, row + static_cast<std::ptrdiff_t>(inputs));
    widened.push_back(0.0F);
  }
  widened.insert(widened.end(), rest, parameters.end());
  return widened;
}

/// Taxels that no sample loads.
std::vector<std::size_t> never_loaded(const SampleDatabase& database) {
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < database.array.taxel_count(); ++taxel) {
    const bool is_loaded = std::any_of(database.samples.begin(), database.samples.end(),
                                       [&](const Sample& sample) { return sample.known_newtons[taxel] > 0.0F; });
    if (!is_loaded) taxels.push_back(taxel);
  }
  return taxels;
}

/// The rate of a step, which falls along a cosine.
float rate_at(std::size_t step, std::size_t steps, std::size_t taxels) {
  const double highest = std::min(kRateOfSum / static_cast<double>(taxels), kHighestRate);
  const double share = static_cast<double>(step) / static_cast<double>(steps);
  return static_cast<float>(kLowestRate + (highest - kLowestRate) * 0.5 * (1.0 + std::cos(std::numbers::pi * share)));
}

Status check_bank_samples(const SampleDatabase& database, const Ranks& ranks) {
  if (heaviest_force(database) <= 0.0) {
    return bad_input("the paper's bank needs loads on single taxels; these loads tell only totals or none");
  }
  const std::size_t unknowns = paper_bank_unknowns(database.array.taxel_count());
  if (unknowns > kMostUnknowns) {
    return bad_input(
        fmt::format("the paper's bank of {} taxels has {} unknowns, more than the {} it may have: its size "
                    "rises with the third power of the taxels",
                    database.array.taxel_count(), unknowns, kMostUnknowns));
  }
  if (ranks.count() > database.array.taxel_count()) {
    return bad_input(fmt::format("the paper's bank of {} taxels has too few networks for {} ranks",
                                 database.array.taxel_count(), ranks.count()));
  }
  return Done{};
}

}  // namespace

Status BankTrainingOptions::validate() const {
  if (steps < 1) return bad_field("steps", "must be 1 or more, is 0");
  if (batch < 1 || batch > kMostBatch) {
    return bad_field("batch", fmt::format("must be 1 to {}, is {}", kMostBatch, batch));
  }
  if (interval < 1) return bad_field("interval", "must be 1 or more, is 0");
  return Done{};
}

Result<BankTraining> BankTraining::create(const SampleDatabase& database, std::uint64_t seed, Ranks& ranks,
                                          std::size_t batch) {
  if (Status checked = check_bank_samples(database, ranks); !checked) return checked.error();
  const Part part = own_part(ranks, database.array.taxel_count());
  PaperBank bank(ratio_ranges(database), temperature_range(database), heaviest_force(database), part);
  return BankTraining(database, std::move(bank), seed, ranks, batch);
}

BankTraining::BankTraining(const SampleDatabase& database, PaperBank bank, std::uint64_t seed, Ranks& ranks,
                           std::size_t batch)
    : ranks_(&ranks),
      bank_(std::move(bank)),
      rows_(database.array.rows),
      cols_(database.array.cols),
      seed_(seed),
      batch_(batch),
      chosen_(bank_.part().count * batch),
      chosen_weights_(chosen_.size()),
      errors_(bank_.taxel_count()) {
  fill_patterns(database);
}

void BankTraining::fill_patterns(const SampleDatabase& database) {
  const Part part = bank_.part();
  const std::size_t networks = part.count;
  const std::size_t width = bank_.networks().shape().inputs;
  const double floor_n = kRelativeDownTo * bank_.heaviest_newtons();
  inputs_.resize(database.samples.size() * width);
  targets_.resize(database.samples.size() * networks);
  weights_.resize(targets_.size());
  choices_.assign(networks, {{}, {}, Random(0)});
  for (std::size_t p = 0; p < database.samples.size(); ++p) {
    const Sample& sample = database.samples[p];
    const std::vector<double> ratio(sample.ratio.begin(), sample.ratio.end());
    bank_.normalise(ratio, sample.temperature_celsius, std::span(inputs_).subspan(p * width, width));
    for (std::size_t network = 0; network < networks; ++network) {
      const double newtons = sample.known_newtons[part.first + network];
      if (std::isnan(newtons)) continue;
      targets_[p * networks + network] = bank_.target(newtons);
      const double relative = floor_n / std::max(newtons, floor_n);
      weights_[p * networks + network] = static_cast<float>(relative * relative);
      Choice& choice = choices_[network];
      (newtons > 0.0 ? choice.loaded : choice.unloaded).push_back(static_cast<std::uint32_t>(p));
    }
  }
}

void BankTraining::start(BankStart start) {
  learn::calibration::parallel_for(choices_.size(), [&](std::size_t network) {
    Random random = Random::stream(seed_, bank_.part().first + network);
    bank_.networks().set_parameters(network, start_parameters(start, random.bits()));
    choices_[network].random = random;
  });
}

std::vector<float> BankTraining::start_parameters(BankStart start, std::uint64_t seed) const {
  const NetworkShape& shape = bank_.networks().shape();
  if (start == BankStart::xavier) return xavier_start<float>(shape, seed);
  if (start == BankStart::nguyen_widrow) {
    return nguyen_widrow_start<float>(shape, std::vector<InputRange>(shape.inputs, {0.0, 1.0}), seed);
  }
  StructuredStart grid;
  grid.rows = rows_;
  grid.cols = cols_;
  grid.seed = seed;
  std::vector<float> parameters = structured_start<float>(grid);
  return bank_.celsius() ? with_further_input(parameters, bank_.taxel_count()) : parameters;
}

void BankTraining::draw_batch() {
  const std::size_t networks = choices_.size();
  for (std::size_t network = 0; network < networks; ++network) {
    Choice& choice = choices_[network];
    for (std::size_t k = 0; k < batch_; ++k) {
      const bool want_loaded = (k < batch_ / 2 && !choice.loaded.empty()) || choice.unloaded.empty();
      const std::vector<std::uint32_t>& from = want_loaded ? choice.loaded : choice.unloaded;
      if (from.empty()) break;  // no sample has this taxel: its chosen weights stay 0
      const std::uint32_t sample = from[choice.random.below(from.size())];
      chosen_[network * batch_ + k] = sample;
      chosen_weights_[network * batch_ + k] = weights_[sample * networks + network];
    }
  }
}

void BankTraining::skip(std::size_t steps) {
  for (std::size_t k = 0; k < steps; ++k) draw_batch();
}

double BankTraining::step(const BankStep& step) {
  draw_batch();
  const Part part = bank_.part();
  bank_.networks().train_step({batch_, inputs_, targets_, chosen_, chosen_weights_}, step,
                              std::span(errors_).subspan(part.first, part.count));
  gather(*ranks_, std::span(errors_));
  return std::accumulate(errors_.begin(), errors_.end(), 0.0) / static_cast<double>(errors_.size());
}

Result<TrainedBank> train_paper_bank(const SampleDatabase& database, const BankTrainingOptions& options, Ranks& ranks) {
  if (Status valid = options.validate(); !valid) return valid.error();
  Result<BankTraining> training = BankTraining::create(database, options.seed, ranks, options.batch);
  if (!training) return training.error();
  training->start(BankStart::structured);
  const std::size_t taxels = database.array.taxel_count();
  NetworkBank& networks = training->bank().networks();
  BankTrainingReport report;
  report.unknowns = taxels * networks.shape().parameter_count();
  report.steps = options.steps;
  report.never_loaded = never_loaded(database);
  report.constant_readings = constant_readings(database);

  std::optional<BankCheckpoint> checkpoint;
  if (!options.checkpoint.empty()) {
    checkpoint.emplace(database, options, ranks);
    Result<std::vector<double>> curve = checkpoint->read(networks);
    if (!curve) return curve.error();
    report.curve = *std::move(curve);
    report.resumed_at = report.curve.size();
    training->skip(report.resumed_at);
  }
  for (std::size_t k = report.resumed_at; k < options.steps; ++k) {
    BankStep step;
    step.rule = BankStep::Rule::adam;
    step.second_decay = kSecondDecay;
    step.rate = rate_at(k, options.steps, taxels);
    report.curve.push_back(training->step(step));
    if (!std::isfinite(report.curve.back())) return failed("the training of the paper's bank diverged");
    if (options.progress) options.progress(static_cast<double>(k + 1) / static_cast<double>(options.steps));
    if (!checkpoint || (k + 1) % options.interval != 0 || k + 1 == options.steps) continue;
    if (Status written = checkpoint->write(networks, report.curve); !written) return written.error();
  }
  return TrainedBank{std::move(training->bank()), std::move(report)};
}

std::size_t bank_training_bytes(const SampleDatabase& database, std::size_t batch, const Ranks& ranks) {
  const std::size_t taxels = database.array.taxel_count();
  const std::size_t networks = own_part(ranks, taxels).count;
  const NetworkShape shape = paper_network_shape(taxels, temperature_range(database).has_value());
  // Inputs; target, weight and twice the index, as a vector grows, of each network.
  const std::size_t patterns = database.samples.size() * (shape.inputs + 4 * networks) * sizeof(float);
  const std::size_t drawn = 2 * networks * batch * sizeof(float);
  return patterns + drawn + NetworkBank::training_bytes(shape, networks, taxels, batch) + kOtherBytes;
}

}  // namespace dermis::paper
