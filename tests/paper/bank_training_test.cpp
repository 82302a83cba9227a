// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/bank_training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/paper/paper_bank_file.hpp"
#include "learn/calibration/simulated.hpp"
#include "support/temporary_folder.hpp"
#include "support/thread_ranks.hpp"

namespace dermis::paper {
namespace {

using learn::calibration::record;
using learn::calibration::Recording;
using learn::calibration::reference_array;
using learn::calibration::Sample;
using learn::calibration::SampleDatabase;
using support::on_ranks;
using support::TemporaryFolder;

SampleDatabase database_of(const ArrayDescription& array, const char* scene) {
  const Recording recording = record(array, scene, 1);
  return learn::calibration::build_sample_database(array, recording.frames, recording.loads).value();
}

std::vector<float> parameters_of(const PaperBank& bank, std::size_t network) {
  std::vector<float> parameters(bank.networks().shape().parameter_count());
  bank.networks().parameters(network, parameters);
  return parameters;
}

TEST(BankTraining, normalises_the_database_to_the_unit_interval) {
  const SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  BankTraining training = BankTraining::create(database, 1).value();
  std::vector<float> least(16, 2.0F);
  std::vector<float> greatest(16, -1.0F);
  std::vector<float> inputs(16);
  for (const Sample& sample : database.samples) {
    training.bank().normalise(std::vector<double>(sample.ratio.begin(), sample.ratio.end()), sample.temperature_celsius,
                              inputs);
    for (std::size_t k = 0; k < 16; ++k) {
      least[k] = std::min(least[k], inputs[k]);
      greatest[k] = std::max(greatest[k], inputs[k]);
    }
  }
  EXPECT_EQ(least, std::vector<float>(16, 0.0F));
  EXPECT_EQ(greatest, std::vector<float>(16, 1.0F));
  EXPECT_EQ(training.bank().heaviest_newtons(), 50.0);
}

TEST(BankTraining, temperature_is_an_input_where_the_calibration_spans_some) {
  EXPECT_FALSE(BankTraining::create(database_of(reference_array(4, 4), "paper_calibration"), 1)->bank().celsius());
  EXPECT_TRUE(BankTraining::create(database_of(reference_array(4, 4), "calibration"), 1)->bank().celsius());
}

TEST(BankTraining, every_start_lowers_its_error_under_gradient_descent) {
  const SampleDatabase database = database_of(reference_array(4, 4), "calibration");
  BankTraining training = BankTraining::create(database, 1).value();
  for (const BankStart start : {BankStart::structured, BankStart::nguyen_widrow, BankStart::xavier}) {
    training.start(start);
    double first = 0.0;
    double last = 0.0;
    for (int k = 0; k < 400; ++k) {
      BankStep step;
      step.rate = 2.0F;
      const double error = training.step(step);
      if (k < 40) first += error;
      if (k >= 360) last += error;
    }
    EXPECT_LT(last, 0.9 * first) << static_cast<int>(start);
  }
}

TEST(BankTraining, the_same_seed_gives_the_same_bank_and_another_seed_another) {
  const SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  const TrainedBank trained = train_paper_bank(database, {.steps = 5, .seed = 1}).value();
  EXPECT_EQ(parameters_of(train_paper_bank(database, {.steps = 5, .seed = 1})->bank, 3),
            parameters_of(trained.bank, 3));
  EXPECT_NE(parameters_of(train_paper_bank(database, {.steps = 5, .seed = 2})->bank, 3),
            parameters_of(trained.bank, 3));
}

TEST(BankTraining, reaches_the_papers_five_percent_on_its_points) {
  const ArrayDescription array = reference_array(5, 4);
  const SampleDatabase database = database_of(array, "paper_calibration");
  TrainedBank trained = train_paper_bank(database, {.steps = 5000}).value();
  EXPECT_EQ(trained.report.unknowns, paper_bank_unknowns(20));
  const Recording presses = record(array, "paper_calibration", 1);
  const learn::calibration::Calibration calibrated =
      learn::calibration::calibrate(array, presses.frames, presses.loads).value();
  const Recording points = record(array, "paper", 3);
  const learn::calibration::Evaluation evaluation =
      learn::calibration::evaluate(calibrated.model, points.frames, points.loads, &trained.bank).value();
  EXPECT_EQ(evaluation.estimators.back().name, kPaperBankName);
  EXPECT_EQ(evaluation.estimators.back().relative_error.count, 48U);
  EXPECT_LE(evaluation.estimators.back().relative_error.max, 0.05);
}

TEST(BankTraining, leaves_out_what_the_samples_do_not_tell) {
  SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  for (Sample& sample : database.samples) sample.known_newtons[6] = std::numeric_limits<float>::quiet_NaN();
  BankTraining training = BankTraining::create(database, 1).value();
  training.start(BankStart::structured);
  const std::vector<float> start = parameters_of(training.bank(), 6);
  EXPECT_TRUE(std::isfinite(training.step({})));
  EXPECT_EQ(parameters_of(training.bank(), 6), start);
}

TEST(BankTraining, says_which_taxels_were_never_loaded_and_which_never_change) {
  SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  for (Sample& sample : database.samples) {
    sample.ratio[3] = 0.25;
    if (sample.known_newtons[6] > 0.0F) sample.known_newtons[6] = std::numeric_limits<float>::quiet_NaN();
  }
  const BankTrainingReport report = train_paper_bank(database, {.steps = 2})->report;
  EXPECT_EQ(report.never_loaded, std::vector<std::size_t>{6});
  EXPECT_EQ(report.constant_readings, std::vector<std::size_t>{3});
}

TEST(BankTraining, refuses_loads_that_tell_no_taxel_of_its_own) {
  SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  for (Sample& sample : database.samples) {
    for (float& newtons : sample.known_newtons) newtons = newtons > 0.0F ? std::nanf("") : newtons;
  }
  const Result<BankTraining> refused = BankTraining::create(database, 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("single taxels"), std::string::npos);
}

TEST(BankTraining, refuses_an_array_whose_bank_would_not_fit_into_memory) {
  SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  database.array = reference_array(64, 64);
  const Result<BankTraining> refused = BankTraining::create(database, 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("4096 taxels"), std::string::npos);
}

TEST(BankTraining, refuses_more_ranks_than_networks) {
  const SampleDatabase database = database_of(reference_array(2, 2), "paper_calibration");
  on_ranks(5, [&](Ranks& ranks) {
    const Result<BankTraining> refused = BankTraining::create(database, 1, ranks);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("5 ranks"), std::string::npos);
  });
}

/// Trains on so many ranks, of which the first alone has the samples, and returns the bytes of the bank's file.
std::string bytes_of_bank(const SampleDatabase& database, const BankTrainingOptions& options, std::size_t count) {
  const TemporaryFolder folder;
  on_ranks(count, [&](Ranks& ranks) {
    SampleDatabase own = ranks.rank() == 0 ? database : SampleDatabase{};
    broadcast_samples(own, ranks);
    const Result<TrainedBank> trained = train_paper_bank(own, options, ranks);
    ASSERT_TRUE(trained) << trained.error().message;
    EXPECT_EQ(trained->report.curve.size(), options.steps);
    EXPECT_EQ(trained->bank.part().count, own_part(ranks, database.array.taxel_count()).count);
    ASSERT_TRUE(write_paper_bank(folder.file("bank"), trained->bank, ranks));
  });
  EXPECT_EQ(folder.file_count(), 1U);
  return support::read_bytes(folder.file("bank"));
}

// The networks of the first lie in lanes, where there are as many as lanes; those of the second in panels, with
// padding.
const std::vector<std::pair<std::size_t, std::size_t>> kSizes = {{4, 4}, {7, 7}};

TEST(BankTraining, any_number_of_ranks_gives_the_same_bits) {
  for (const auto& [rows, cols] : kSizes) {
    const SampleDatabase database = database_of(reference_array(rows, cols), "calibration");
    const std::string alone = bytes_of_bank(database, {.steps = 20}, 1);
    for (const std::size_t count : {2U, 3U, 4U, 5U}) {
      EXPECT_TRUE(bytes_of_bank(database, {.steps = 20}, count) == alone) << count << " ranks";
    }
  }
}

TEST(BankTraining, goes_on_from_a_checkpoint_with_the_bits_of_one_run) {
  for (const auto& [rows, cols] : kSizes) {
    const SampleDatabase database = database_of(reference_array(rows, cols), "calibration");
    const std::string at_once = bytes_of_bank(database, {.steps = 20}, 1);
    for (const auto& [before, after] : {std::pair{1U, 1U}, std::pair{3U, 3U}, std::pair{1U, 4U}, std::pair{2U, 1U}}) {
      const TemporaryFolder folder;
      BankTrainingOptions options{.steps = 20, .checkpoint = folder.file("checkpoint"), .interval = 8};
      // The last checkpoint is that of step 16; to go on from it stands for an end between it and step 20.
      EXPECT_TRUE(bytes_of_bank(database, options, before) == at_once);
      EXPECT_EQ(folder.file_count(), 1U);
      std::size_t steps = 0;
      options.progress = [&](double /*share*/) { ++steps; };
      on_ranks(after, [&](Ranks& ranks) {
        BankTrainingOptions own = options;
        if (ranks.rank() > 0) own.progress = {};
        const Result<TrainedBank> trained = train_paper_bank(database, own, ranks);
        ASSERT_TRUE(trained) << trained.error().message;
        EXPECT_EQ(trained->report.resumed_at, 16U);
        ASSERT_TRUE(write_paper_bank(folder.file("bank"), trained->bank, ranks));
      });
      EXPECT_EQ(steps, 4U);
      EXPECT_TRUE(support::read_bytes(folder.file("bank")) == at_once) << before << " ranks, then " << after;
    }
  }
}

TEST(BankTraining, refuses_the_checkpoint_of_another_training) {
  const TemporaryFolder folder;
  SampleDatabase database = database_of(reference_array(4, 4), "paper_calibration");
  const BankTrainingOptions options{.steps = 4, .checkpoint = folder.file("checkpoint"), .interval = 2};
  ASSERT_TRUE(train_paper_bank(database, options));
  const auto expect_refused = [&](const BankTrainingOptions& other, const char* why) {
    const Result<TrainedBank> refused = train_paper_bank(database, other);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::bad_input);
    EXPECT_NE(refused.error().message.find(folder.file("checkpoint") + ": "), std::string::npos);
    EXPECT_NE(refused.error().message.find(why), std::string::npos) << refused.error().message;
  };
  BankTrainingOptions other = options;
  other.steps = 5;
  expect_refused(other, "not of this training");
  other = options;
  other.batch = 8;
  expect_refused(other, "not of this training");
  other = options;
  other.seed = 2;
  expect_refused(other, "not of this training");
  std::string bytes = support::read_bytes(options.checkpoint);
  bytes[bytes.size() / 2] ^= 1;
  support::write_bytes(options.checkpoint, bytes);
  expect_refused(options, "is damaged");
  bytes[bytes.size() / 2] ^= 1;
  support::write_bytes(options.checkpoint, bytes.substr(0, bytes.size() - 1));
  expect_refused(options, "is damaged");
  support::write_bytes(options.checkpoint, bytes);
  database.samples.front().ratio.front() += 0.01F;
  expect_refused(options, "not of this training");
  support::write_bytes(options.checkpoint, "");
  expect_refused(options, "not of this training");
}

TEST(BankTraining, refuses_options_that_are_out_of_range) {
  EXPECT_EQ(BankTrainingOptions{.steps = 0}.validate().error().field, "steps");
  EXPECT_EQ(BankTrainingOptions{.batch = 0}.validate().error().field, "batch");
  EXPECT_EQ(BankTrainingOptions{.interval = 0}.validate().error().field, "interval");
  const SampleDatabase database = database_of(reference_array(2, 2), "paper_calibration");
  EXPECT_FALSE(train_paper_bank(database, {.steps = 0}));
}

}  // namespace
}  // namespace dermis::paper
