// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/bank_checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/content_hash.hpp"

namespace dermis::paper {
namespace {

constexpr double kNotYet = std::numeric_limits<double>::quiet_NaN();
// Parameters come first: those that a network gets start its moments anew.
constexpr std::size_t kParameters = 0;
constexpr std::size_t kFirstMoments = 1;
constexpr std::array<const char*, 3> kTensors{"parameters", "parameters_first_moment", "parameters_second_moment"};

AdamMoment moment_of(std::size_t tensor) {
  return tensor == kFirstMoments ? AdamMoment::first : AdamMoment::second;
}

template <typename T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

std::string hash_of(const learn::calibration::SampleDatabase& database) {
  bytes::files::ContentHash hash;
  for (const learn::calibration::Sample& sample : database.samples) {
    const double celsius = sample.temperature_celsius.value_or(kNotYet);
    hash.add(bytes_of(std::span(&celsius, 1)));
    hash.add(bytes_of(std::span(sample.ratio)));
    hash.add(bytes_of(std::span(sample.known_newtons)));
  }
  return hash.text();
}

}  // namespace

BankCheckpoint::BankCheckpoint(const learn::calibration::SampleDatabase& database, const BankTrainingOptions& options,
                               Ranks& ranks)
    : options_(options), ranks_(ranks), taxels_(database.array.taxel_count()), samples_(hash_of(database)) {}

BankRowsFile BankCheckpoint::file_of(const NetworkBank& networks, std::vector<double> curve) const {
  curve.resize(options_.steps, kNotYet);
  bytes::files::SafetensorsFile first;
  first.metadata = {{"format", "dermis paper bank checkpoint 1"},
                    {"samples", samples_},
                    {"batch", std::to_string(options_.batch)},
                    {"seed", std::to_string(options_.seed)}};
  first.tensors["curve"] = {{options_.steps}, std::move(curve)};
  return {first, {{kTensors.begin(), kTensors.end()}, taxels_, networks.shape().parameter_count()}, ranks_};
}

Status BankCheckpoint::write(const NetworkBank& networks, const std::vector<double>& curve) const {
  return file_of(networks, curve)
      .write(options_.checkpoint, [&](std::size_t tensor, std::size_t network, std::span<float> values) {
        if (tensor == kParameters) {
          networks.parameters(network, values);
        } else {
          networks.moment(moment_of(tensor), network, values);
        }
      });
}

Result<std::vector<double>> BankCheckpoint::read(NetworkBank& networks) const {
  std::error_code error;
  bool is_there = ranks_.rank() == 0 && std::filesystem::exists(options_.checkpoint, error);
  broadcast_value(ranks_, is_there);
  if (!is_there) return std::vector<double>{};
  const Result<std::string> read =
      file_of(networks, {})
          .read(
              options_.checkpoint,
              "is not of this training, but of other samples, steps, batches or another seed; remove it to begin anew",
              [&](std::size_t tensor, std::size_t network, std::span<float> values) {
                if (tensor == kParameters) {
                  networks.set_parameters(network, values);
                } else {
                  networks.set_moment(moment_of(tensor), network, values);
                }
              });
  if (!read) return read.error();
  std::vector<double> curve(options_.steps);
  std::memcpy(curve.data(), read->data(), read->size());
  curve.erase(std::find_if(curve.begin(), curve.end(), [](double value) { return !std::isfinite(value); }),
              curve.end());
  networks.set_adam_steps(curve.size());
  return curve;
}

}  // namespace dermis::paper
