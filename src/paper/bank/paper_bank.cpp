// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/paper_bank.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "dermis/out/report/wording.hpp"

namespace dermis::paper {
namespace {

constexpr double kUnloadedOutput = 0.25;  // eq. (14)
constexpr double kHeaviestOutput = 0.75;  // eq. (13)

double share(const PaperBank::Range& range, double value) {
  return (value - range.low) / (range.high - range.low);
}

}  // namespace

NetworkShape paper_network_shape(std::size_t taxels, bool with_temperature) {
  return {taxels + (with_temperature ? 1 : 0),
          {{taxels, Activation::log_sigmoid}, {taxels, Activation::log_sigmoid}, {1, Activation::log_sigmoid}}};
}

PaperBank::PaperBank(std::vector<Range> ratio, std::optional<Range> celsius, double heaviest_newtons,
                     std::optional<Part> taxels)
    : ratio_(std::move(ratio)),
      celsius_(celsius),
      heaviest_newtons_(heaviest_newtons),
      part_(taxels.value_or(Part{0, ratio_.size()})),
      networks_(paper_network_shape(ratio_.size(), celsius.has_value()), part_.count, ratio_.size()),
      inputs_(networks_.shape().inputs) {
  assert(heaviest_newtons > 0.0);
  assert(std::all_of(ratio_.begin(), ratio_.end(), [](const Range& range) { return range.low < range.high; }));
  assert(!celsius || celsius->low < celsius->high);
}

std::string PaperBank::description() const {
  return fmt::format(
      "the paper's bank: one N-N-N-1 network a taxel, N = {}, from the readings of the whole array, and the "
      "temperature where the calibration varies it, to newtons; it is told nothing of the circuit",
      out::report::grouped(taxel_count()));
}

void PaperBank::normalise(std::span<const double> ratio, std::optional<double> temperature_celsius,
                          std::span<float> inputs) const noexcept {
  assert(ratio.size() == ratio_.size() && inputs.size() == inputs_.size());
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    inputs[taxel] = static_cast<float>(share(ratio_[taxel], ratio[taxel]));
  }
  if (celsius_) {
    inputs.back() = temperature_celsius ? static_cast<float>(share(*celsius_, *temperature_celsius)) : 0.5F;
  }
}

float PaperBank::target(double newtons) const noexcept {
  return static_cast<float>(kUnloadedOutput + (kHeaviestOutput - kUnloadedOutput) * newtons / heaviest_newtons_);
}

void PaperBank::estimate(std::span<const double> ratio, std::optional<double> temperature_celsius,
                         std::span<float> newtons) {
  assert(part_.count == ratio_.size());
  normalise(ratio, temperature_celsius, inputs_);
  networks_.evaluate(inputs_, newtons);
  for (float& value : newtons) {
    const double loaded = (double{value} - kUnloadedOutput) / (kHeaviestOutput - kUnloadedOutput);
    value = static_cast<float>(std::max(loaded, 0.0) * heaviest_newtons_);
  }
}

}  // namespace dermis::paper
