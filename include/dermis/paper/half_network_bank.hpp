// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "dermis/core/result.hpp"
#include "dermis/paper/network_bank.hpp"

namespace dermis::paper {

class HalfPanels;

/// The networks of a NetworkBank with parameters rounded to 16 bits (IEEE 754 binary16, relative error 2^-11), for
/// evaluation only. The memory to read is halved, and reading it takes most of the time of a frame of a large bank.
/// Sums and activations are single precision. Results do not depend on the number of threads. An object holds work
/// space: one call at a time. Inputs must be finite.
class HalfNetworkBank {
 public:
  /// Fails where a parameter is not a number that 16 bits hold: beyond +-65,504 or not finite.
  [[nodiscard]] static Result<HalfNetworkBank> from(const NetworkBank& bank);
  ~HalfNetworkBank();
  HalfNetworkBank(HalfNetworkBank&&) noexcept;
  HalfNetworkBank& operator=(HalfNetworkBank&&) noexcept;

  [[nodiscard]] const NetworkShape& shape() const noexcept { return shape_; }
  [[nodiscard]] std::size_t network_count() const noexcept { return networks_; }

  /// One frame: inputs [inputs], the same for all networks -> outputs [networks, outputs].
  void evaluate(std::span<const float> inputs, std::span<float> outputs);

 private:
  explicit HalfNetworkBank(const NetworkBank& bank);

  NetworkShape shape_;
  std::size_t networks_;
  std::unique_ptr<HalfPanels> panels_;
};

}  // namespace dermis::paper
