// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/training_checkpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "dermis/core/random.hpp"
#include "dermis/files/safetensors.hpp"
#include "dermis/paper/initialisation.hpp"
#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::paper {
namespace {

using files::SafetensorsFile;
using support::TemporaryFolder;

const NetworkShape kShape{2, {{3, Activation::log_sigmoid}, {1, Activation::linear}}};

template <typename Real>
struct Data {
  std::vector<Real> inputs;
  std::vector<Real> targets;

  explicit Data(std::uint64_t seed) {
    Random random(seed);
    for (int p = 0; p < 30; ++p) {
      for (int i = 0; i < 2; ++i) inputs.push_back(static_cast<Real>(random.uniform(-1.0, 1.0)));
      targets.push_back(std::sin(Real{3} * inputs[inputs.size() - 1]));
    }
  }

  [[nodiscard]] Samples<Real> view() const { return {30, inputs, targets, {}}; }
};

TrainingOptions options_of(TrainingAlgorithm algorithm, std::uint64_t epochs) {
  const bool takes_batches = algorithm == TrainingAlgorithm::gradient_descent || algorithm == TrainingAlgorithm::adam;
  return {.algorithm = algorithm,
          .batch = takes_batches ? 7U : 0U,
          .epochs = epochs,
          .patience = 1000,
          .seed = 0xFEDC'BA98'7654'3210};
}

template <typename Real>
void train_to(TrainingState<Real>& state, std::uint64_t epochs) {
  const Data<Real> data(1);
  const Data<Real> validation(2);
  const auto report = train(state, data.view(), options_of(state.algorithm, epochs), validation.view());
  ASSERT_TRUE(report) << report.error().message;
}

template <typename Real>
TrainingState<Real> fresh_state(TrainingAlgorithm algorithm) {
  return start_training(kShape, xavier_start<Real>(kShape, 1), options_of(algorithm, 0));
}

template <typename Real>
void expect_resumable_through_a_file(TrainingAlgorithm algorithm) {
  SCOPED_TRACE(name(algorithm));
  const TemporaryFolder folder;
  const std::string path = folder.file("training.safetensors");
  TrainingState<Real> whole = fresh_state<Real>(algorithm);
  train_to(whole, 20);
  for (const std::uint64_t stop : {0U, 1U, 7U, 20U}) {
    TrainingState<Real> stopped = fresh_state<Real>(algorithm);
    if (stop > 0) train_to(stopped, stop);
    ASSERT_TRUE(write_training_checkpoint(path, stopped));
    Result<TrainingState<Real>> read = read_training_checkpoint<Real>(path, kShape);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, stopped);
    train_to(*read, 20);
    EXPECT_EQ(*read, whole) << "stopped at epoch " << stop;
  }
  EXPECT_EQ(folder.file_count(), 1U) << "no temporary file is left";
}

TEST(TrainingCheckpoint, a_training_resumed_through_a_file_gives_the_same_bits_as_one_run) {
  for (const auto algorithm :
       {TrainingAlgorithm::gradient_descent, TrainingAlgorithm::adaptive_rate, TrainingAlgorithm::resilient_propagation,
        TrainingAlgorithm::conjugate_gradient, TrainingAlgorithm::adam}) {
    expect_resumable_through_a_file<float>(algorithm);
    expect_resumable_through_a_file<double>(algorithm);
  }
  expect_resumable_through_a_file<double>(TrainingAlgorithm::levenberg_marquardt);
}

template <typename Real = double>
std::string error_of(const std::string& path, const NetworkShape& shape = kShape) {
  const auto state = read_training_checkpoint<Real>(path, shape);
  if (state) return "no error";
  EXPECT_EQ(state.error().kind, ErrorKind::bad_input);
  return state.error().message;
}

/// What is said of a checkpoint after five epochs whose content was changed.
std::string error_after(const std::function<void(SafetensorsFile&)>& change) {
  const TemporaryFolder folder;
  TrainingState<double> state = fresh_state<double>(TrainingAlgorithm::adam);
  train_to(state, 5);
  const std::string path = folder.file("c");
  EXPECT_TRUE(write_training_checkpoint(path, state));
  SafetensorsFile file = *files::read_safetensors(path);
  change(file);
  EXPECT_TRUE(files::write_safetensors(path, file));
  const std::string message = error_of(path);
  return message.starts_with(path + ": ") ? message.substr(path.size() + 2) : message;
}

TEST(TrainingCheckpoint, refuses_a_training_of_another_shape_and_names_both) {
  const TemporaryFolder folder;
  const std::string path = folder.file("c");
  ASSERT_TRUE(write_training_checkpoint(path, fresh_state<double>(TrainingAlgorithm::adam)));
  EXPECT_EQ(error_of(path, {2, {{4, Activation::log_sigmoid}, {1, Activation::linear}}}),
            path + ": is of a network 2-3-1 log_sigmoid linear, not 2-4-1 log_sigmoid linear");
  EXPECT_EQ(error_of(path, {2, {{3, Activation::tanh}, {1, Activation::linear}}}),
            path + ": is of a network 2-3-1 log_sigmoid linear, not 2-3-1 tanh linear");
  EXPECT_EQ(error_of<float>(path), path + ": tensor 'parameters' is F64 [13], expected F32 [13]");
}

TEST(TrainingCheckpoint, refuses_files_that_are_something_else) {
  const TemporaryFolder folder;
  const std::string path = folder.file("c");
  EXPECT_NE(error_of(path).find(path), std::string::npos) << error_of(path);
  support::write_bytes(path, "parameters\n");
  EXPECT_TRUE(error_of(path).starts_with(path + ": ")) << error_of(path);
  ASSERT_TRUE(files::write_safetensors(path, {}));
  EXPECT_EQ(error_of(path), path + ": is not a dermis training checkpoint of version 1");
  EXPECT_EQ(error_after([](auto& f) { f.metadata["format"] = "dermis training checkpoint 2"; }),
            "is not a dermis training checkpoint of version 1");
  EXPECT_EQ(error_after([](auto& f) { f.metadata["algorithm"] = "guessing"; }), "its algorithm is unknown");
  EXPECT_EQ(error_after([](auto& f) { f.metadata["algorithm"] = "adaptive_rate"; }),
            "training state: has 26 memory, not 13");
}

TEST(TrainingCheckpoint, refuses_content_that_does_not_fit_together) {
  using Doubles = std::vector<double>;
  EXPECT_EQ(error_after([](auto&) {}), "no error");
  EXPECT_EQ(error_after([](auto& f) { f.tensors.erase("memory"); }), "tensor 'memory' is missing");
  EXPECT_EQ(error_after([](auto& f) { f.tensors.erase("counts"); }), "tensor 'counts' is missing");
  EXPECT_EQ(error_after([](auto& f) {
              f.tensors["errors"] = {{4}, Doubles(4)};
            }),
            "tensor 'errors' is F64 [4], expected F64 [3]");
  EXPECT_EQ(error_after([](auto& f) {
              f.tensors["parameters"] = {{12}, Doubles(12)};
            }),
            "training state: has 12 parameters, not 13");
  EXPECT_EQ(error_after([](auto& f) { std::get<Doubles>(f.tensors["memory"].values)[4] = std::nan(""); }),
            "training state: number 4 of its memory is not finite; start again from the best parameters");
  EXPECT_EQ(error_after([](auto& f) { std::get<std::vector<std::int64_t>>(f.tensors["counts"].values)[1] = -3; }),
            "training state: a curve of 6 errors, one in 1, does not fit its epoch 18446744073709551613");
  EXPECT_EQ(error_after([](auto& f) {
              f.tensors["curve"] = {{9}, Doubles(9)};
            }),
            "training state: a curve of 9 errors, one in 1, does not fit its epoch 5");
}

TEST(TrainingCheckpoint, a_damaged_file_is_read_or_refused_in_one_line_and_what_is_read_can_be_trained) {
  const TemporaryFolder folder;
  const std::string good = folder.file("good");
  TrainingState<float> state = fresh_state<float>(TrainingAlgorithm::adaptive_rate);
  train_to(state, 5);
  ASSERT_TRUE(write_training_checkpoint(good, state));
  const std::string bytes = support::read_bytes(good);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::string path = folder.file(std::to_string(seed));  // a new one each: overwriting waits for the disk
    support::write_bytes(path, support::mutated(bytes, seed));
    Result<TrainingState<float>> read = read_training_checkpoint<float>(path, kShape);
    if (read) {
      train_to(*read, std::min<std::uint64_t>(read->epoch, 100) + 3);
    } else {
      EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
      EXPECT_TRUE(read.error().message.starts_with(path + ": ")) << read.error().message;
    }
  }
  for (std::size_t size = 0; size < bytes.size(); size += 13) {
    const std::string path = folder.file("cut" + std::to_string(size));
    support::write_bytes(path, bytes.substr(0, size));
    EXPECT_FALSE(read_training_checkpoint<float>(path, kShape)) << "cut to " << size;
  }
}

TEST(TrainingCheckpoint, says_where_it_cannot_write) {
  const Status status = write_training_checkpoint("/nowhere/c", fresh_state<float>(TrainingAlgorithm::adam));
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("/nowhere/c"), std::string::npos) << status.error().message;
}

}  // namespace
}  // namespace dermis::paper
