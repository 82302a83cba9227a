// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/samples.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace dermis::paper {
namespace {

template <typename Real>
Status check_finite(const char* what, std::span<const Real> values, std::size_t per_pattern) {
  const auto bad = std::find_if_not(values.begin(), values.end(), [](Real value) { return std::isfinite(value); });
  if (bad == values.end()) return Done{};
  const auto index = static_cast<std::size_t>(bad - values.begin());
  return bad_input(std::string("samples: ") + what + " " + std::to_string(index % per_pattern) + " of pattern " +
                   std::to_string(index / per_pattern) + " is not a finite number");
}

}  // namespace

template <std::floating_point Real>
Status check_samples(const Samples<Real>& samples, std::size_t inputs, std::size_t outputs) {
  if (samples.count == 0) return bad_input("samples: there is no pattern");
  if (samples.inputs.size() != samples.count * inputs || samples.targets.size() != samples.count * outputs) {
    return bad_input("samples: " + std::to_string(samples.count) + " patterns for a network of " +
                     std::to_string(inputs) + " inputs and " + std::to_string(outputs) + " outputs come with " +
                     std::to_string(samples.inputs.size()) + " inputs and " + std::to_string(samples.targets.size()) +
                     " targets");
  }
  if (Status finite = check_finite("input", samples.inputs, inputs); !finite) return finite;
  if (Status finite = check_finite("target", samples.targets, outputs); !finite) return finite;
  if (samples.weights.empty()) return Done{};
  if (samples.weights.size() != samples.count) return bad_input("samples: the weights must be one a pattern or none");
  if (Status finite = check_finite("weight", samples.weights, 1); !finite) return finite;
  const auto [least, greatest] = std::minmax_element(samples.weights.begin(), samples.weights.end());
  if (*least < Real{0}) return bad_input("samples: a weight is negative");
  if (*greatest == Real{0}) return bad_input("samples: all weights are 0");
  return Done{};
}

template Status check_samples(const Samples<float>&, std::size_t, std::size_t);
template Status check_samples(const Samples<double>&, std::size_t, std::size_t);

}  // namespace dermis::paper
