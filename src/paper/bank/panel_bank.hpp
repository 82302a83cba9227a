// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "paper/bank/bank_storage.hpp"
#include "paper/bank/frame_space.hpp"
#include "paper/bank/huge_vector.hpp"
#include "paper/bank/panel_layout.hpp"

namespace dermis::paper {

/// Patterns that evaluating takes through the layers together: what they put out and a layer's weights stay in the
/// cache.
inline constexpr std::size_t kBlock = 64;

/// Work space of one thread for a batch of patterns: what each layer puts out, [patterns, stride], pattern by pattern.
class PatternSpace {
 public:
  PatternSpace(const PanelLayout& layout, std::size_t patterns);

  /// Rows that a batch of this size occupies: whole lanes.
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Level 0 holds the inputs, level l + 1 what layer l puts out and, on the way back, its deltas.
  [[nodiscard]] float* level(std::size_t level) { return values_.data() + starts_[level]; }
  [[nodiscard]] std::size_t stride(std::size_t level) const { return strides_[level]; }
  /// Deltas of a layer with the patterns side by side, [units, column_stride].
  [[nodiscard]] float* columns() { return values_.data() + columns_; }
  /// What they give for the layer below, of the same form.
  [[nodiscard]] float* columns_below() { return values_.data() + columns_below_; }
  [[nodiscard]] std::size_t column_stride() const { return column_stride_; }

  std::vector<float> targets;  ///< [patterns, outputs]
  std::vector<float> weights;  ///< [patterns], over the number of patterns.

 private:
  std::size_t rows_;
  std::size_t column_stride_;
  std::size_t columns_ = 0;
  std::size_t columns_below_ = 0;
  std::vector<std::size_t> strides_;
  std::vector<std::size_t> starts_;
  HugeVector<float> values_;
};

/// The parameters of one network and, for Adam, the moments of their gradients.
struct PanelParameters {
  float* values;
  float* first_moments;
  float* second_moments;
};

/// One network after the other, each a row of matrix panels (PanelLayout): for layers wider than the vectors.
class PanelBank final : public BankStorage {
 public:
  PanelBank(const NetworkShape& shape, std::size_t networks);

  void set_parameters(std::size_t network, std::span<const float> parameters) override;
  void parameters(std::size_t network, std::span<float> parameters) const override;
  void evaluate(std::span<const float> inputs, std::span<float> outputs) override;
  void evaluate_batch(std::span<const float> inputs, std::span<float> outputs) override;
  void train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) override;

 private:
  void reserve(std::vector<PatternSpace>& spaces, std::size_t workers, std::size_t patterns) const;
  PanelParameters of(std::size_t network);
  float train_network(const BankBatch& batch, const BankStep& step, std::size_t network, PatternSpace& space);

  PanelLayout layout_;
  std::size_t networks_;
  HugeVector<float> values_;         ///< [networks, layout.size]
  HugeVector<float> first_moments_;  ///< Of the same form; empty before the first step of Adam.
  HugeVector<float> second_moments_;
  std::vector<std::size_t> adam_steps_;  ///< [networks]
  FrameSpace frame_;
  HugeVector<float> packed_;                ///< Patterns of evaluate_batch(), each as pack_row() leaves it.
  std::vector<PatternSpace> block_spaces_;  ///< Of evaluate_batch(), one a worker, for kBlock patterns.
  std::vector<PatternSpace> batch_spaces_;  ///< Of train_step(), one a worker, for the last batch's patterns.
};

}  // namespace dermis::paper
