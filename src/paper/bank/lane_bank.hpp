// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "paper/bank/bank_storage.hpp"
#include "paper/bank/huge_vector.hpp"

namespace dermis::paper {

/// Networks that lie side by side: as many as the widest vector has lanes.
inline constexpr std::size_t kGroup = 16;
/// Patterns that go through a group together.
inline constexpr std::size_t kTilePatterns = 4;

/// Work space of one thread for a tile of patterns of one group. It holds the outputs of each layer and, on the way
/// back, its deltas, [patterns, units, 16].
class LaneSpace {
 public:
  explicit LaneSpace(const NetworkShape& shape);

  /// Level 0 holds the inputs, level l + 1 what layer l puts out.
  [[nodiscard]] float* level(std::size_t level) { return values_.data() + starts_[level]; }
  [[nodiscard]] float* targets() { return values_.data() + starts_[starts_.size() - 2]; }
  /// Weights of the patterns, over the size of the batch, [patterns, 16].
  [[nodiscard]] float* weights() { return values_.data() + starts_.back(); }

  [[nodiscard]] std::size_t bytes() const { return (values_.size() + gradient.size()) * sizeof(float); }

  HugeVector<float> gradient;  ///< [parameters, 16]

 private:
  std::vector<std::size_t> starts_;
  HugeVector<float> values_;
};

/// Parameters of one group, [parameters, 16], and the moments of their gradients. Also the constants of a step that
/// depend on how many steps a network has made, [16].
struct LaneParameters {
  float* values;
  float* first_moments;
  float* second_moments;
  alignas(64) float rate[kGroup];          ///< Adam: over 1 - first_decay^t.
  alignas(64) float second_scale[kGroup];  ///< 1 over (1 - second_decay^t).
};

/// Sixteen networks at a time, each in its lane of the vectors: for layers too small to fill vectors of their own.
class LaneBank final : public BankStorage {
 public:
  LaneBank(const NetworkShape& shape, std::size_t networks);
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
  void reserve_spaces(std::size_t workers);
  void evaluate_group(std::size_t group, std::size_t first, std::size_t count, LaneSpace& space,
                      std::span<float> outputs);
  LaneParameters of(std::size_t group);
  LaneParameters step_of(std::size_t group, const BankStep& step);
  void gather(const BankBatch& batch, std::size_t group, std::size_t first, LaneSpace& space) const;
  void train_group(const BankBatch& batch, const BankStep& step, std::size_t group, LaneSpace& space,
                   std::span<float> errors);

  NetworkShape shape_;
  std::size_t networks_;
  std::size_t groups_;
  std::size_t group_size_;               ///< Values of a group: parameters * 16.
  HugeVector<float> values_;             ///< [groups, parameters, 16], parameters as NetworkShape orders them.
  HugeVector<float> first_moments_;      ///< Moments in the same form; empty before the first step of Adam.
  HugeVector<float> second_moments_;     ///< Likewise.
  std::vector<std::size_t> adam_steps_;  ///< [groups * 16]
  HugeVector<float> inputs_;             ///< Inputs of a block of patterns, each in all lanes, [patterns, inputs, 16].
  std::vector<LaneSpace> spaces_;        ///< One a worker.
};

}  // namespace dermis::paper
