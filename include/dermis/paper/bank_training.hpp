// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/paper/paper_bank.hpp"
#include "dermis/paper/ranks.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// Where the training of the bank starts.
enum class BankStart {
  structured,     ///< The paper's, eq. (7) to (15).
  nguyen_widrow,  ///< Random, spread over the range of the inputs.
  xavier,         ///< Random, scaled by the number of connections.
};

/// Samples that each network draws for a step; larger batches converge in as many steps.
inline constexpr std::size_t kBankBatch = 16;

/// The training of the paper's bank on a sample database: Fig. 9 for all networks at once, in mini-batches.
///
/// A network's own presses are a few of very many samples (14 of 3,584 if every taxel is pressed alone). So half of
/// each batch is drawn from the samples that load its taxel and half from the others. Squared errors are weighted as
/// relative ones down to half the heaviest force, and evenly below. Samples without a known force of a taxel are left
/// out for its network. Deterministic by seed, for any number of ranks. Each of these trains the networks of its part.
class BankTraining {
 public:
  /// `ranks` must outlive it. Errors: no sample has a known force on a single taxel; more unknowns than kMostUnknowns;
  /// more ranks than networks.
  [[nodiscard]] static Result<BankTraining> create(const learn::calibration::SampleDatabase& database,
                                                   std::uint64_t seed, Ranks& ranks = one_process(),
                                                   std::size_t batch = kBankBatch);

  /// Sets all parameters anew; before the first step.
  void start(BankStart start);
  /// One step of every network; the mean of their errors before it: half a weighted mean square, eq. (6), in units of
  /// the outputs.
  double step(const BankStep& step);
  /// Draws what so many steps would have drawn: after them, the training goes on from parameters that they gave.
  void skip(std::size_t steps);

  /// The networks of this rank.
  [[nodiscard]] PaperBank& bank() noexcept { return bank_; }

 private:
  BankTraining(const learn::calibration::SampleDatabase& database, PaperBank bank, std::uint64_t seed, Ranks& ranks,
               std::size_t batch);
  void fill_patterns(const learn::calibration::SampleDatabase& database);
  [[nodiscard]] std::vector<float> start_parameters(BankStart start, std::uint64_t seed) const;
  void draw_batch();

  /// The samples that one network may draw from.
  struct Choice {
    std::vector<std::uint32_t> loaded;    // samples that load its taxel
    std::vector<std::uint32_t> unloaded;  // samples that do not
    Random random;
  };

  Ranks* ranks_;
  PaperBank bank_;
  std::size_t rows_;
  std::size_t cols_;
  std::uint64_t seed_;
  std::size_t batch_;
  std::vector<Choice> choices_;  // [networks], like all that follows those of the rank, but for the errors
  std::vector<float> inputs_;    // [samples, inputs]
  std::vector<float> targets_;   // [samples, networks]
  std::vector<float> weights_;   // [samples, networks]; 0 where the force is unknown
  std::vector<std::uint32_t> chosen_;
  std::vector<float> chosen_weights_;
  std::vector<float> errors_;
};

/// Steps that bring a bank to the paper's 5 %.
inline constexpr std::size_t kBankSteps = 6000;

struct BankTrainingOptions {
  std::size_t steps = kBankSteps;  ///< >= 1
  std::size_t batch = kBankBatch;  ///< 1 ... 65,536
  std::uint64_t seed = 1;
  std::string checkpoint{};    ///< A file: a training that was ended goes on from there; empty: none.
  std::size_t interval = 500;  ///< >= 1, steps from one writing of that file to the next.
  /// Gets the share that is done.
  std::function<void(double share)> progress{};

  /// Names the first field that is out of its range.
  [[nodiscard]] Status validate() const;
};

/// How a bank was trained.
struct BankTrainingReport {
  std::size_t unknowns = 0;
  std::size_t steps = 0;
  std::size_t resumed_at = 0;                  ///< The step of the checkpoint that the training went on from.
  std::vector<double> curve;                   ///< Error of each step, as BankTraining::step gives it.
  std::vector<std::size_t> never_loaded;       ///< Taxels that no sample loads: their networks know of no force.
  std::vector<std::size_t> constant_readings;  ///< Taxels whose reading is the same in all samples.
};

struct TrainedBank {
  PaperBank bank;  ///< Of each rank its part.
  BankTrainingReport report;
};

/// From the paper's start, Adam with a rate that falls along a cosine. Whether it is interrupted and goes on from its
/// checkpoint, and on how many ranks, does not change a bit. Errors: options, those of BankTraining::create, a
/// checkpoint that cannot be written or is of another training; the training diverges.
[[nodiscard]] Result<TrainedBank> train_paper_bank(const learn::calibration::SampleDatabase& database,
                                                   const BankTrainingOptions& options, Ranks& ranks = one_process());

/// From rank 0 to all: of the samples what the training needs, and the size of the array.
void broadcast_samples(learn::calibration::SampleDatabase& database, Ranks& ranks);

/// The memory that train_paper_bank() takes on this rank besides the database.
[[nodiscard]] std::size_t bank_training_bytes(const learn::calibration::SampleDatabase& database, std::size_t batch,
                                              const Ranks& ranks);

}  // namespace dermis::paper
