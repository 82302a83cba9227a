// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>

#include "dermis/paper/network_bank.hpp"

namespace dermis::paper {

/// How the parameters of a bank lie in memory, and the passes over them. The functions are those of NetworkBank.
class BankStorage {
 public:
  BankStorage() = default;
  BankStorage(const BankStorage&) = delete;
  BankStorage& operator=(const BankStorage&) = delete;
  virtual ~BankStorage() = default;

  virtual void set_parameters(std::size_t network, std::span<const float> parameters) = 0;
  virtual void parameters(std::size_t network, std::span<float> parameters) const = 0;
  virtual void moment(AdamMoment which, std::size_t network, std::span<float> values) const = 0;
  virtual void set_moment(AdamMoment which, std::size_t network, std::span<const float> values) = 0;
  virtual void set_adam_steps(std::size_t steps) = 0;
  virtual void evaluate(std::span<const float> inputs, std::span<float> outputs) = 0;
  virtual void evaluate_batch(std::span<const float> inputs, std::span<float> outputs) = 0;
  virtual void train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) = 0;
};

}  // namespace dermis::paper
