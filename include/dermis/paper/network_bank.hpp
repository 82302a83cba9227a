// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "dermis/paper/network_shape.hpp"

namespace dermis::paper {

class BankStorage;

/// A training step of a bank on a database of patterns that all networks share; each network draws its own batch.
struct BankBatch {
  std::size_t batch = 0;                  ///< Patterns a network and step, >= 1.
  std::span<const float> inputs;          ///< The database, [patterns, inputs].
  std::span<const float> targets;         ///< [patterns, networks * outputs].
  std::span<const std::uint32_t> chosen;  ///< Rows of the database, [networks, batch].
  std::span<const float> weights;         ///< Weights of the chosen patterns, >= 0, [networks, batch]; empty: all 1.
};

/// How a step moves the parameters against the gradient of 1/batch times eq. (6) of the batch.
struct BankStep {
  enum class Rule : std::uint8_t { gradient_descent, adam };
  Rule rule = Rule::gradient_descent;
  float rate = 0.1F;         ///< > 0
  float first_decay = 0.9F;  ///< Adam (Kingma and Ba 2015): beta 1, beta 2, epsilon.
  float second_decay = 0.999F;
  float epsilon = 1e-8F;
};

/// Running means that Adam keeps, of the gradient and of its square.
enum class AdamMoment : std::uint8_t { first, second };

/// Many networks of one shape and different weights, evaluated and trained side by side, single precision.
/// The paper's bank is one N-N-N-1 network a taxel. Results do not depend on the number of threads, but those of
/// evaluate_batch() differ from those of evaluate() by rounding. An object holds work space: one call at a time.
/// Nothing is allocated once the work space has grown to the batch, and the moments at the first step of Adam.
///
/// A NaN is never hidden. A network with a NaN parameter gives NaN outputs and a NaN error, step after step, until it
/// gets new parameters. The other networks of the bank are not affected. Inputs, targets and weights of patterns must
/// be finite.
class NetworkBank {
 public:
  /// All parameters 0. The shape must be valid.
  NetworkBank(NetworkShape shape, std::size_t networks);
  /// A part of a bank of `whole` networks, with the bits that these have there.
  NetworkBank(NetworkShape shape, std::size_t networks, std::size_t whole);
  ~NetworkBank();
  NetworkBank(NetworkBank&&) noexcept;
  NetworkBank& operator=(NetworkBank&&) noexcept;

  [[nodiscard]] const NetworkShape& shape() const noexcept { return shape_; }
  [[nodiscard]] std::size_t network_count() const noexcept { return networks_; }
  /// Unknowns of all networks together.
  [[nodiscard]] std::size_t parameter_count() const noexcept { return networks_ * shape_.parameter_count(); }

  /// Parameters of one network as NetworkShape orders them, [shape.parameter_count()]. Its moments of Adam start anew.
  void set_parameters(std::size_t network, std::span<const float> parameters);
  void parameters(std::size_t network, std::span<float> parameters) const;

  /// A moment of one network, in the order of its parameters; 0 before the first step of Adam.
  void moment(AdamMoment which, std::size_t network, std::span<float> values) const;
  /// With the parameters, both moments and the steps of all networks, a training goes on where another ended.
  void set_moment(AdamMoment which, std::size_t network, std::span<const float> values);
  void set_adam_steps(std::size_t steps);

  /// Memory of such a part while Adam trains it in batches of this size.
  [[nodiscard]] static std::size_t training_bytes(const NetworkShape& shape, std::size_t networks, std::size_t whole,
                                                  std::size_t batch);

  /// One frame: inputs [inputs], the same for all networks -> outputs [networks, outputs].
  void evaluate(std::span<const float> inputs, std::span<float> outputs);
  /// inputs [count, inputs] -> outputs [count, networks, outputs].
  void evaluate_batch(std::span<const float> inputs, std::span<float> outputs);

  /// One training step of every network; the error of each before the step, 1/batch times eq. (6), in `errors`
  /// [networks].
  void train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors);

 private:
  NetworkShape shape_;
  std::size_t networks_;
  std::unique_ptr<BankStorage> storage_;
};

}  // namespace dermis::paper
