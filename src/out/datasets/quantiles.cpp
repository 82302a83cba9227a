// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/quantiles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace dermis::out::datasets {
namespace {

constexpr std::uint32_t kExponentBits = 23;  // of float: sign and exponent stand above
constexpr std::uint32_t kPartBits = 13;
constexpr std::size_t kExponents = 256;
constexpr std::size_t kParts = 1024;

/// The value of a part that is next to 0.
double value_of(std::size_t exponent, std::size_t part) {
  return std::bit_cast<float>(static_cast<std::uint32_t>((exponent << kExponentBits) | (part << kPartBits)));
}

}  // namespace

void Quantiles::add(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if (counts_.empty()) counts_.resize(2 * kExponents);
  std::vector<std::uint64_t>& parts = counts_[bits >> kExponentBits];
  if (parts.empty()) parts.resize(kParts);
  ++parts[(bits >> kPartBits) % kParts];
  ++count_;
}

void Quantiles::add(const Quantiles& others) {
  if (others.count_ == 0) return;
  if (counts_.empty()) counts_.resize(2 * kExponents);
  for (std::size_t exponent = 0; exponent < others.counts_.size(); ++exponent) {
    const std::vector<std::uint64_t>& from = others.counts_[exponent];
    if (from.empty()) continue;
    counts_[exponent].resize(kParts);
    for (std::size_t part = 0; part < kParts; ++part) counts_[exponent][part] += from[part];
  }
  count_ += others.count_;
}

double Quantiles::at(double share) const {
  if (count_ == 0) return 0.0;
  const auto rank = static_cast<std::uint64_t>(std::max(1.0, std::ceil(share * static_cast<double>(count_))));
  std::uint64_t below = 0;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const bool is_negative = k < kExponents;  // the largest of them come first
    const std::size_t exponent = is_negative ? 2 * kExponents - 1 - k : k - kExponents;
    const std::vector<std::uint64_t>& parts = counts_[exponent];
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const std::size_t part = is_negative ? kParts - 1 - j : j;
      below += parts[part];
      if (below >= rank) return value_of(exponent, part);
    }
  }
  return 0.0;
}

}  // namespace dermis::out::datasets
