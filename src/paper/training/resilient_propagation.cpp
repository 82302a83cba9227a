// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>

#include "paper/training/algorithm.hpp"

namespace dermis::paper {
namespace {

constexpr double kLeastStepSize = 1e-6;
constexpr double kGreatestStepSize = 50.0;
constexpr double kStepSizeIncrease = 1.2;
constexpr double kStepSizeDecrease = 0.5;

template <std::floating_point Real>
class ResilientPropagation final : public Algorithm<Real> {
 public:
  bool run_epoch(TrainingPoint<Real>& point) override {
    const std::span<Real> last = point.memory_row(0);
    const std::span<Real> size = point.memory_row(1);
    for (std::size_t i = 0; i < point.gradient.size(); ++i) {
      const Real agreement = last[i] * point.gradient[i];
      last[i] = point.gradient[i];
      if (agreement > Real{0}) {
        size[i] = std::min(size[i] * static_cast<Real>(kStepSizeIncrease), static_cast<Real>(kGreatestStepSize));
      } else if (agreement < Real{0}) {
        size[i] = std::max(size[i] * static_cast<Real>(kStepSizeDecrease), static_cast<Real>(kLeastStepSize));
        last[i] = Real{0};
      }
      if (last[i] != Real{0}) point.state.parameters[i] -= std::copysign(size[i], last[i]);
    }
    point.update();
    return true;
  }
};

}  // namespace

template <std::floating_point Real>
std::unique_ptr<Algorithm<Real>> make_resilient_propagation() {
  return std::make_unique<ResilientPropagation<Real>>();
}

template std::unique_ptr<Algorithm<float>> make_resilient_propagation();
template std::unique_ptr<Algorithm<double>> make_resilient_propagation();

}  // namespace dermis::paper
