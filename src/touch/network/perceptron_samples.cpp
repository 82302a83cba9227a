// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/perceptron_samples.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#ifdef __wasm__
#define HWY_COMPILE_ONLY_EMU128  // Highway 1.0.3 has no vectors of double there
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "touch/network/perceptron_samples.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "touch/network/activation-inl.hpp"

#ifndef DERMIS_NETWORK_PERCEPTRON_SAMPLES_CPP
#define DERMIS_NETWORK_PERCEPTRON_SAMPLES_CPP
namespace dermis::touch::network {

inline constexpr std::size_t kLanes = 8;  // of a block, whatever the width of the processor's

struct SamplesView {
  const PerceptronShape& shape;
  const double* parameters;
  bool are_exponentials;
  std::size_t blocks;
  const std::size_t* first_term;
  const double* x;
  const double* factors;
  const double* targets;
  const double* weights;
};

/// What a linearisation adds up, each in kLanes lanes.
struct LinearisedSums {
  double* gradient;  // [parameters]
  double* normal;    // [parameters (parameters + 1) / 2], the lower triangle by rows
};

}  // namespace dermis::touch::network
#endif

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::network::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using Lanes = hn::CappedTag<double, kLanes>;
using Vector = hn::Vec<Lanes>;

/// Some lanes of a block. Derivatives have a stride of kLanes.
class LanesOfBlock {
 public:
  LanesOfBlock(const SamplesView& samples, std::size_t block, std::size_t lane)
      : samples_(samples), block_(block), lane_(lane) {}

  /// The residuals. Their derivatives go to `jacobian` [parameters], unless it is null.
  Vector residuals(double* jacobian) const {
    const Lanes d;
    const std::size_t parameters = samples_.shape.parameter_count();
    if (jacobian != nullptr) {
      for (std::size_t p = 0; p < parameters; ++p) hn::StoreU(hn::Zero(d), d, jacobian + p * kLanes);
    }
    Vector estimate = hn::Zero(d);
    const std::size_t end = samples_.first_term[block_ + 1];
    for (std::size_t term = samples_.first_term[block_]; term < end; ++term) {
      estimate = hn::Add(estimate, jacobian == nullptr ? value(term) : value_and_slopes(term, jacobian));
    }
    const Vector weight = hn::LoadU(d, samples_.weights + block_ * kLanes + lane_);
    if (jacobian != nullptr) finish(weight, jacobian);
    const Vector target = hn::LoadU(d, samples_.targets + block_ * kLanes + lane_);
    return hn::Mul(weight, hn::Sub(estimate, target));
  }

 private:
  Vector parameter(std::size_t k) const { return hn::Set(Lanes(), samples_.parameters[k]); }

  Vector x(std::size_t term, std::size_t input) const {
    return hn::LoadU(Lanes(), samples_.x + (term * samples_.shape.inputs + input) * kLanes + lane_);
  }

  Vector direct_output(std::size_t term) const {
    const PerceptronShape& shape = samples_.shape;
    Vector y = parameter(shape.output_bias());
    for (std::size_t input = 0; input < shape.inputs; ++input)
      y = hn::MulAdd(parameter(shape.direct_weight(input)), x(term, input), y);
    return y;
  }

  Vector activation(std::size_t term, std::size_t unit) const {
    const PerceptronShape& shape = samples_.shape;
    Vector sum = parameter(shape.bias(unit));
    for (std::size_t input = 0; input < shape.inputs; ++input)
      sum = hn::MulAdd(parameter(shape.weight(unit, input)), x(term, input), sum);
    return log_sigmoid(Lanes(), sum);
  }

  Vector estimate_of(std::size_t term, Vector y) const {
    if (!samples_.are_exponentials) return y;
    return hn::Mul(hn::LoadU(Lanes(), samples_.factors + term * kLanes + lane_), exponential(Lanes(), y));
  }

  Vector value(std::size_t term) const {
    const PerceptronShape& shape = samples_.shape;
    Vector y = direct_output(term);
    for (std::size_t unit = 0; unit < shape.hidden; ++unit)
      y = hn::MulAdd(parameter(shape.output_weight(unit)), activation(term, unit), y);
    return estimate_of(term, y);
  }

  /// Adds d value / d parameter, without the factors that finish() knows.
  Vector value_and_slopes(std::size_t term, double* jacobian) const {
    const Lanes d;
    const PerceptronShape& shape = samples_.shape;
    const auto at = [&](std::size_t k) { return jacobian + k * kLanes; };
    const auto add = [&](std::size_t k, Vector more) { hn::StoreU(hn::Add(hn::LoadU(d, at(k)), more), d, at(k)); };
    const auto add_product = [&](std::size_t k, Vector a, Vector b) {
      hn::StoreU(hn::MulAdd(a, b, hn::LoadU(d, at(k))), d, at(k));
    };
    HWY_ALIGN double kept[kMostHidden * kLanes];
    Vector y = direct_output(term);
    for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
      const Vector active = activation(term, unit);
      hn::StoreU(active, d, kept + unit * kLanes);
      y = hn::MulAdd(parameter(shape.output_weight(unit)), active, y);
    }
    const Vector value = estimate_of(term, y);
    const Vector slope = samples_.are_exponentials ? value : hn::Set(d, 1.0);  // d value / d y
    add(shape.output_bias(), slope);
    for (std::size_t input = 0; input < shape.inputs; ++input)
      add_product(shape.direct_weight(input), slope, x(term, input));
    for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
      const Vector active = hn::LoadU(d, kept + unit * kLanes);
      add_product(shape.output_weight(unit), slope, active);
      const Vector back = hn::Mul(slope, slope_from_output(d, Activation::log_sigmoid, active));
      add(shape.bias(unit), back);
      for (std::size_t input = 0; input < shape.inputs; ++input)
        add_product(shape.weight(unit, input), back, x(term, input));
    }
    return value;
  }

  void finish(Vector weight, double* jacobian) const {
    const Lanes d;
    const PerceptronShape& shape = samples_.shape;
    const auto scale = [&](std::size_t k, Vector factor) {
      double* const at = jacobian + k * kLanes;
      hn::StoreU(hn::Mul(hn::LoadU(d, at), factor), d, at);
    };
    for (std::size_t unit = 0; unit < shape.hidden; ++unit) {
      const Vector of_unit = hn::Mul(weight, parameter(shape.output_weight(unit)));
      for (std::size_t k = shape.bias(unit); k < shape.bias(unit + 1); ++k) scale(k, of_unit);
    }
    for (std::size_t k = shape.output_bias(); k < shape.parameter_count(); ++k) scale(k, weight);
  }

  static constexpr std::size_t kMostHidden = 64;

  const SamplesView& samples_;
  std::size_t block_;
  std::size_t lane_;
};

/// Calls work(block, lane) for all lanes.
template <typename Work>
void for_lanes(const SamplesView& samples, Work work) {
  for (std::size_t block = 0; block < samples.blocks; ++block) {
    for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(Lanes())) work(block, lane);
  }
}

void add_product(double* at, Vector a, Vector b) {
  hn::StoreU(hn::MulAdd(a, b, hn::LoadU(Lanes(), at)), Lanes(), at);
}

}  // namespace

void sum_squares(const SamplesView& samples, double* squares) {
  for_lanes(samples, [&](std::size_t block, std::size_t lane) {
    const Vector residual = LanesOfBlock(samples, block, lane).residuals(nullptr);
    add_product(squares + lane, residual, residual);
  });
}

void linearise_samples(const SamplesView& samples, double* jacobian, const LinearisedSums& sums) {
  const std::size_t parameters = samples.shape.parameter_count();
  for_lanes(samples, [&](std::size_t block, std::size_t lane) {
    const Vector residual = LanesOfBlock(samples, block, lane).residuals(jacobian);
    double* normal = sums.normal + lane;
    for (std::size_t p = 0; p < parameters; ++p) {
      const Vector of_row = hn::LoadU(Lanes(), jacobian + p * kLanes);
      add_product(sums.gradient + p * kLanes + lane, of_row, residual);
      for (std::size_t q = 0; q <= p; ++q, normal += kLanes)
        add_product(normal, of_row, hn::LoadU(Lanes(), jacobian + q * kLanes));
    }
  });
}

void residuals_of_block(const SamplesView& samples, std::size_t block, double* residuals, double* jacobian) {
  for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(Lanes())) {
    double* const derivatives = jacobian == nullptr ? nullptr : jacobian + lane;
    hn::StoreU(LanesOfBlock(samples, block, lane).residuals(derivatives), Lanes(), residuals + lane);
  }
}

}  // namespace dermis::touch::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::touch::network {

HWY_EXPORT(sum_squares);
HWY_EXPORT(linearise_samples);
HWY_EXPORT(residuals_of_block);

namespace {

double sum_of_lanes(const double* lanes) {
  return std::accumulate(lanes, lanes + kLanes, 0.0);
}

}  // namespace

PerceptronSamples::PerceptronSamples(std::size_t inputs, Estimate estimate, std::span<const std::size_t> terms)
    : inputs_(inputs), estimate_(estimate), slot_(terms.size()), first_term_{0} {
  std::vector<std::size_t> order(terms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return terms[a] > terms[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    slot_[order[k]] = k;
    if (k % kLanes == 0) first_term_.push_back(first_term_.back() + terms[order[k]]);  // the most of its block
  }
  x_.resize(first_term_.back() * inputs * kLanes);
  factors_.resize(first_term_.back() * kLanes);
  targets_.resize((first_term_.size() - 1) * kLanes);
  weights_.resize(targets_.size());
}

std::size_t PerceptronSamples::place(std::size_t sample, std::size_t term) const {
  const std::size_t block = slot_[sample] / kLanes;
  assert(first_term_[block] + term < first_term_[block + 1]);
  return first_term_[block] + term;
}

void PerceptronSamples::set_target(std::size_t sample, double target, double weight) {
  targets_[slot_[sample]] = target;
  weights_[slot_[sample]] = weight;
}

void PerceptronSamples::set_input(std::size_t sample, std::size_t term, std::span<const double> x) {
  assert(x.size() == inputs_);
  for (std::size_t input = 0; input < inputs_; ++input)
    x_[(place(sample, term) * inputs_ + input) * kLanes + slot_[sample] % kLanes] = x[input];
}

void PerceptronSamples::set_factor(std::size_t sample, std::size_t term, double factor) {
  factors_[place(sample, term) * kLanes + slot_[sample] % kLanes] = factor;
}

SamplesView PerceptronSamples::view(const PerceptronShape& shape, std::span<const double> parameters) const {
  assert(shape.inputs == inputs_ && parameters.size() == shape.parameter_count());
  return {shape,
          parameters.data(),
          estimate_ == Estimate::sum_of_exponentials,
          first_term_.size() - 1,
          first_term_.data(),
          x_.data(),
          factors_.data(),
          targets_.data(),
          weights_.data()};
}

double PerceptronSamples::error(const PerceptronShape& shape, std::span<const double> parameters) const {
  double squares[kLanes] = {};
  HWY_DYNAMIC_DISPATCH(sum_squares)(view(shape, parameters), squares);
  return 0.5 * sum_of_lanes(squares);
}

void PerceptronSamples::linearise(const PerceptronShape& shape, std::span<const double> parameters,
                                  std::span<double> gradient, std::span<double> normal) const {
  const std::size_t n = parameters.size();
  assert(gradient.size() == n && normal.size() == n * n);
  const std::size_t entries = n + n * (n + 1) / 2;
  std::vector<double> lanes((n + entries) * kLanes);
  double* const of_gradient = lanes.data() + n * kLanes;
  double* of_normal = of_gradient + n * kLanes;
  HWY_DYNAMIC_DISPATCH(linearise_samples)(view(shape, parameters), lanes.data(), {of_gradient, of_normal});
  for (std::size_t p = 0; p < n; ++p) {
    gradient[p] = sum_of_lanes(of_gradient + p * kLanes);
    for (std::size_t q = 0; q <= p; ++q, of_normal += kLanes) normal[p * n + q] = sum_of_lanes(of_normal);
  }
}

void PerceptronSamples::residuals(const PerceptronShape& shape, std::span<const double> parameters,
                                  std::span<double> residuals, std::span<double> jacobian) const {
  const std::size_t n = parameters.size();
  assert(residuals.size() == count() && (jacobian.empty() || jacobian.size() == count() * n));
  const SamplesView samples = view(shape, parameters);
  std::vector<double> sorted(samples.blocks * kLanes);
  std::vector<double> derivatives(jacobian.empty() ? 0 : samples.blocks * kLanes * n);
  for (std::size_t block = 0; block < samples.blocks; ++block) {
    double* const of_block = jacobian.empty() ? nullptr : derivatives.data() + block * kLanes * n;
    HWY_DYNAMIC_DISPATCH(residuals_of_block)(samples, block, sorted.data() + block * kLanes, of_block);
  }
  for (std::size_t sample = 0; sample < count(); ++sample) {
    const std::size_t slot = slot_[sample];
    residuals[sample] = sorted[slot];
    for (std::size_t p = 0; p < n && !jacobian.empty(); ++p)
      jacobian[sample * n + p] = derivatives[(slot / kLanes * n + p) * kLanes + slot % kLanes];
  }
}

}  // namespace dermis::touch::network
#endif
