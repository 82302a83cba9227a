// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/training_checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/files/safetensors.hpp"

namespace dermis::paper {
namespace {

using files::SafetensorsFile;
using files::Tensor;

constexpr const char* kFormat = "dermis training checkpoint 1";

/// "2-5-1 log_sigmoid linear"
std::string text_of(const NetworkShape& shape) {
  std::string text = shape.describe();
  for (const Layer& layer : shape.layers) text += " " + std::string(name(layer.activation));
  return text;
}

template <typename T>
Tensor row(const std::vector<T>& values) {
  return {{values.size()}, values};
}

Tensor whole_numbers(std::vector<std::uint64_t> values) {
  return row(std::vector<std::int64_t>(values.begin(), values.end()));
}

template <std::floating_point Real>
SafetensorsFile to_file(const TrainingState<Real>& state) {
  SafetensorsFile file;
  file.metadata = {
      {"format", kFormat}, {"network", text_of(state.shape)}, {"algorithm", std::string(name(state.algorithm))}};
  file.tensors["counts"] = whole_numbers({state.seed, state.epoch, state.best_epoch, state.curve.stride});
  file.tensors["errors"] = row(std::vector<double>{state.error, state.validation_error, state.best_error});
  file.tensors["parameters"] = row(state.parameters);
  file.tensors["best_parameters"] = row(state.best_parameters);
  file.tensors["memory"] = row(state.memory);
  file.tensors["numbers"] = row(state.numbers);
  file.tensors["curve"] = row(state.curve.errors);
  file.tensors["validation_curve"] = row(state.curve.validation_errors);
  return file;
}

std::string metadata(const SafetensorsFile& file, const char* key) {
  const auto found = file.metadata.find(key);
  return found == file.metadata.end() ? "" : found->second;
}

Result<TrainingAlgorithm> algorithm_of(const SafetensorsFile& file) {
  const std::string text = metadata(file, "algorithm");
  for (int k = 0; k <= static_cast<int>(TrainingAlgorithm::adam); ++k) {
    if (const auto algorithm = static_cast<TrainingAlgorithm>(k); name(algorithm) == text) return algorithm;
  }
  return bad_input("its algorithm is unknown");
}

/// The first error is kept.
class Reader {
 public:
  explicit Reader(const SafetensorsFile& file) : file_(file) {}

  /// All elements of a tensor, as many as there are.
  template <typename T>
  std::vector<T> take(const std::string& name) {
    const auto found = file_.tensors.find(name);
    return elements<T>(name, found == file_.tensors.end() ? std::vector<std::size_t>{} : found->second.shape);
  }

  /// A tensor of so many elements.
  template <typename T, std::size_t Count>
  std::array<T, Count> take_row(const std::string& name) {
    const std::vector<T> values = elements<T>(name, {Count});
    std::array<T, Count> row{};
    std::copy(values.begin(), values.end(), row.begin());
    return row;
  }

  [[nodiscard]] const Status& status() const { return status_; }

 private:
  template <typename T>
  std::vector<T> elements(const std::string& name, const std::vector<std::size_t>& shape) {
    const Result<std::span<const T>> view = file_.view<T>(name, shape);
    if (view) return {view->begin(), view->end()};
    if (status_) status_ = view.error();
    return {};
  }

  const SafetensorsFile& file_;
  Status status_ = Done{};
};

template <std::floating_point Real>
Result<TrainingState<Real>> from_file(const SafetensorsFile& file, const NetworkShape& shape) {
  if (metadata(file, "format") != kFormat) return bad_input("is not a dermis training checkpoint of version 1");
  if (const std::string network = metadata(file, "network"); network != text_of(shape)) {
    return bad_input("is of a network " + network + ", not " + text_of(shape));
  }
  const Result<TrainingAlgorithm> algorithm = algorithm_of(file);
  if (!algorithm) return algorithm.error();
  Reader reader(file);
  TrainingState<Real> state;
  state.shape = shape;
  state.algorithm = *algorithm;
  const auto counts = reader.take_row<std::int64_t, 4>("counts");
  state.seed = static_cast<std::uint64_t>(counts[0]);
  state.epoch = static_cast<std::uint64_t>(counts[1]);
  state.best_epoch = static_cast<std::uint64_t>(counts[2]);
  state.curve.stride = static_cast<std::uint64_t>(counts[3]);
  const auto errors = reader.take_row<double, 3>("errors");
  state.error = errors[0];
  state.validation_error = errors[1];
  state.best_error = errors[2];
  state.parameters = reader.take<Real>("parameters");
  state.best_parameters = reader.take<Real>("best_parameters");
  state.memory = reader.take<Real>("memory");
  state.numbers = reader.take<double>("numbers");
  state.curve.errors = reader.take<double>("curve");
  state.curve.validation_errors = reader.take<double>("validation_curve");
  if (!reader.status()) return reader.status().error();
  if (const Status good = check_state(state, shape, *algorithm); !good) return good.error();
  return state;
}

}  // namespace

template <std::floating_point Real>
Status write_training_checkpoint(const std::string& path, const TrainingState<Real>& state) {
  return files::write_safetensors(path, to_file(state));
}

template <std::floating_point Real>
Result<TrainingState<Real>> read_training_checkpoint(const std::string& path, const NetworkShape& shape) {
  const Result<SafetensorsFile> file = files::read_safetensors(path);
  if (!file) return file.error();
  Result<TrainingState<Real>> state = from_file<Real>(*file, shape);
  if (!state) return bad_input(path + ": " + state.error().message);
  return state;
}

template Status write_training_checkpoint(const std::string&, const TrainingState<float>&);
template Status write_training_checkpoint(const std::string&, const TrainingState<double>&);
template Result<TrainingState<float>> read_training_checkpoint(const std::string&, const NetworkShape&);
template Result<TrainingState<double>> read_training_checkpoint(const std::string&, const NetworkShape&);

}  // namespace dermis::paper
