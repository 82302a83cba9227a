// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>

namespace dermis::bytes::layouts {

/// A number of a device that counts modulo `modulus`, counted on where it wraps, up to 2^62. 0: it never does.
class Unwrapped {
 public:
  explicit Unwrapped(std::uint64_t modulus = 0) : modulus_(modulus) {}

  /// `most_back`: the number may fall by so much; a larger fall is a restart of the device.
  [[nodiscard]] std::int64_t count(std::uint64_t number, std::int64_t most_back) noexcept {
    const std::int64_t step = step_to(number);
    const bool goes_on = last_.has_value() && step >= -most_back && total_ + step <= kMost;
    total_ = goes_on ? total_ + step : static_cast<std::int64_t>(number);
    last_ = number;
    return total_;
  }

 private:
  [[nodiscard]] std::int64_t step_to(std::uint64_t number) const noexcept {
    const std::uint64_t step = number - last_.value_or(number);
    if (modulus_ == 0) return static_cast<std::int64_t>(step);
    const std::uint64_t forward = number >= last_.value_or(number) ? step : step + modulus_;
    return forward <= modulus_ / 2 ? static_cast<std::int64_t>(forward)
                                   : static_cast<std::int64_t>(forward) - static_cast<std::int64_t>(modulus_);
  }

  static constexpr std::int64_t kMost = std::int64_t{1} << 62U;

  std::uint64_t modulus_;
  std::optional<std::uint64_t> last_;
  std::int64_t total_ = 0;
};

}  // namespace dermis::bytes::layouts
