// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "paper/bank/bank_storage.hpp"
#include "paper/bank/frame_space.hpp"
#include "paper/bank/huge_vector.hpp"
#include "paper/bank/panel_layout.hpp"
#include "paper/bank/pattern_space.hpp"

namespace dermis::paper {

/// One network after the other, each a row of matrix panels (PanelLayout): for layers wider than the vectors.
class PanelBank final : public BankStorage {
 public:
  PanelBank(const NetworkShape& shape, std::size_t networks);
  /// See NetworkBank::training_bytes().
  [[nodiscard]] static std::size_t training_bytes(const NetworkShape& shape, std::size_t networks, std::size_t batch);

  void set_parameters(std::size_t network, std::span<const float> parameters) override;
  void parameters(std::size_t network, std::span<float> parameters) const override;
  void moment(AdamMoment which, std::size_t network, std::span<float> values) const override;
  void set_moment(AdamMoment which, std::size_t network, std::span<const float> values) override;
  void set_adam_steps(std::size_t steps) override;
  void evaluate(std::span<const float> inputs, std::span<float> outputs) override;
  void evaluate_batch(std::span<const float> inputs, std::span<float> outputs) override;
  void train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) override;

 private:
  void reserve_moments();
  void reserve(std::vector<PatternSpace>& spaces, std::size_t workers, std::size_t patterns) const;
  PanelParameters of(std::size_t network);
  float train_network(const BankBatch& batch, const BankStep& step, std::size_t network, PatternSpace& space);

  PanelLayout layout_;
  std::size_t networks_;
  HugeVector<float> values_;         ///< [networks, layout.size]
  HugeVector<float> first_moments_;  ///< Moments in the same form; empty before the first step of Adam.
  HugeVector<float> second_moments_;
  std::vector<std::size_t> adam_steps_;  ///< [networks]
  FrameSpace frame_;
  HugeVector<float> packed_;                ///< Patterns of evaluate_batch(), each as pack_row() leaves it.
  std::vector<PatternSpace> block_spaces_;  ///< For evaluate_batch(), one a worker, for kBlock patterns.
  std::vector<PatternSpace> batch_spaces_;  ///< For train_step(), one a worker, for the last batch's patterns.
};

}  // namespace dermis::paper
