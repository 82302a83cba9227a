// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/out/serve/served_suit.hpp"
#include "learn/calibration/simulated_user.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::out::serve {

inline constexpr std::size_t kRows = 3;
inline constexpr std::size_t kCols = 4;

/// An array that nobody touches, 500 frames a second until it is to stop.
class UntouchedArray final : public FrameSource {
 public:
  UntouchedArray(const ArrayDescription& array, const std::atomic<bool>& stop)
      : handled_(array, {}, 1), force_n_(array.taxel_count()), stop_(stop) {}

  Result<bool> next(RawFrame& frame) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    frame = handled_.frame(force_n_);
    return !stop_;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return FrameShape{kRows, kCols}; }

 private:
  learn::calibration::HandledArray handled_;
  std::vector<double> force_n_;
  const std::atomic<bool>& stop_;
};

/// Arrays of these names.
inline ServedSuit small_suit(const std::vector<std::string>& names, const std::atomic<bool>& stop) {
  ServedSuit suit;
  for (const std::string& name : names) {
    const auto model = std::make_shared<const touch::pipeline::Model>(support::hand_made_model(kRows, kCols));
    suit.arrays.push_back({.name = name,
                           .source = std::make_unique<UntouchedArray>(model->array, stop),
                           .model = model,
                           .surface = ArraySurface::create(model->array).value(),
                           .description = model->array});
  }
  return suit;
}

}  // namespace dermis::out::serve
