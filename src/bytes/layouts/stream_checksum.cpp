// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/stream_checksum.hpp"

#include <algorithm>

namespace dermis::bytes::layouts {
namespace {

std::uint32_t looked_up(const std::array<std::array<std::uint32_t, 256>, 4>& tables, std::uint32_t value) noexcept {
  return tables[0][value & 0xFFU] ^ tables[1][value >> 8U & 0xFFU] ^ tables[2][value >> 16U & 0xFFU] ^
         tables[3][value >> 24U];
}

}  // namespace

std::uint32_t StreamChecksum::operator()(std::span<const std::uint8_t> bytes, std::uint64_t position) {
  const std::size_t from = checksum_.checksum().from;
  if (bytes.size() < from) return 0;
  bytes = bytes.subspan(from);
  position += from;
  const bool is_seen = position < seen_end_;
  seen_end_ = std::max(seen_end_, position + bytes.size());
  const std::uint32_t after = is_seen ? of_seen(bytes, position) : checksum_.add(checksum_.first_register(), bytes);
  return checksum_.result(after);
}

/// From the registers before and behind them. A CRC is linear: what stands before the bytes adds its own remainder.
std::uint32_t StreamChecksum::of_seen(std::span<const std::uint8_t> bytes, std::uint64_t position) {
  look_at(bytes, position);
  const std::uint32_t* const first = registers_.data() + (position - begin_);
  const std::uint32_t before = *first;
  const std::uint32_t after = first[bytes.size()];
  switch (checksum_.checksum().kind) {
    case Checksum::Kind::sum: return after - before;
    case Checksum::Kind::exclusive_or: return after ^ before;
    case Checksum::Kind::crc: break;
  }
  return after ^ after_zeros(before ^ checksum_.first_register(), bytes.size());
}

/// Makes the registers of the bytes known. Those that are far behind are forgotten.
void StreamChecksum::look_at(std::span<const std::uint8_t> bytes, std::uint64_t position) {
  if (registers_.empty() || position >= begin_ + registers_.size()) {
    begin_ = position;
    registers_.assign(1, checksum_.first_register());
  }
  if (position - begin_ > registers_.size() / 2) {
    registers_.erase(registers_.begin(), registers_.begin() + static_cast<std::ptrdiff_t>(position - begin_));
    begin_ = position;
  }
  for (std::size_t k = begin_ + registers_.size() - 1 - position; k < bytes.size(); ++k)
    registers_.push_back(checksum_.add(registers_.back(), bytes.subspan(k, 1)));
}

std::uint32_t StreamChecksum::after_zeros(std::uint32_t before, std::size_t count) {
  for (std::size_t k = 0; count >> k != 0; ++k) {
    if (k == powers_.size()) add_power();
    if ((count >> k & 1U) != 0) before = looked_up(powers_[k], before);
  }
  return before;
}

void StreamChecksum::add_power() {
  ByteTables next;
  constexpr std::array<std::uint8_t, 1> kZero = {0};
  for (unsigned place = 0; place < next.size(); ++place) {
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t value = byte << 8U * place;
      next[place][byte] =
          powers_.empty() ? checksum_.add(value, kZero) : looked_up(powers_.back(), looked_up(powers_.back(), value));
    }
  }
  powers_.push_back(next);
}

}  // namespace dermis::bytes::layouts
