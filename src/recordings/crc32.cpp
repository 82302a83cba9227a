// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recordings/crc32.hpp"

#include <zlib.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recordings/crc32.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::recordings::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The CRC of the blocks of 64 bytes at the beginning of `bytes`, by carry-less multiplication (V. Gopal et al., Fast
/// CRC Computation for Generic Polynomials Using PCLMULQDQ Instruction, Intel, 2009): a block is congruent to what it
/// becomes when it is multiplied by powers of x modulo the polynomial and added to a later one, so all of them fold
/// into the last 16 bytes. `done` is set to the number of bytes; 0 where the processor has no such instruction.
std::uint32_t crc32_of_blocks(std::uint32_t crc, [[maybe_unused]] std::span<const std::uint8_t> bytes,
                              std::size_t& done) {
  done = 0;
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SSE2 && HWY_TARGET != HWY_SSSE3
  constexpr std::size_t kLanes = 4;
  constexpr std::size_t kLaneBytes = 16;
  constexpr std::size_t kBlockBytes = kLanes * kLaneBytes;
  if (bytes.size() < kBlockBytes) return crc;
  const hn::FixedTag<std::uint64_t, 2> d;
  const hn::FixedTag<std::uint8_t, kLaneBytes> d8;
  const auto load = [&](std::size_t place) { return hn::BitCast(d, hn::LoadU(d8, bytes.data() + place)); };
  const auto fold = [](auto lane, auto powers, auto next) {
    return hn::Xor3(hn::CLMulLower(lane, powers), hn::CLMulUpper(lane, powers), next);
  };
  // x^(4 * 128 +- 32) and x^(128 +- 32) modulo the polynomial, reflected and shifted by one (Gopal et al., table 1).
  alignas(16) constexpr std::uint64_t kFourLanes[] = {0x154442BD4, 0x1C6E41596};
  alignas(16) constexpr std::uint64_t kOneLane[] = {0x1751997D0, 0x0CCAA009E};
  const auto four_lanes = hn::Load(d, kFourLanes);
  const auto one_lane = hn::Load(d, kOneLane);
  alignas(kLaneBytes) const std::uint64_t shift_register[] = {std::uint32_t(~crc), 0};
  auto a = hn::Xor(load(0), hn::Load(d, shift_register));
  auto b = load(kLaneBytes);
  auto c = load(2 * kLaneBytes);
  auto e = load(3 * kLaneBytes);
  for (done = kBlockBytes; done + kBlockBytes <= bytes.size(); done += kBlockBytes) {
    a = fold(a, four_lanes, load(done));
    b = fold(b, four_lanes, load(done + kLaneBytes));
    c = fold(c, four_lanes, load(done + 2 * kLaneBytes));
    e = fold(e, four_lanes, load(done + 3 * kLaneBytes));
  }
  alignas(kLaneBytes) std::uint64_t rest[2];
  hn::Store(fold(fold(fold(a, one_lane, b), one_lane, c), one_lane, e), d, rest);
  constexpr std::uint32_t kEmptyRegister = 0xFFFFFFFF;  // zlib inverts it
  return static_cast<std::uint32_t>(::crc32_z(kEmptyRegister, reinterpret_cast<const Bytef*>(rest), sizeof(rest)));
#else
  return crc;
#endif
}

}  // namespace dermis::recordings::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::recordings {

HWY_EXPORT(crc32_of_blocks);

std::uint32_t crc32(std::uint32_t crc, std::span<const std::uint8_t> bytes) noexcept {
  std::size_t done = 0;
  crc = HWY_DYNAMIC_DISPATCH(crc32_of_blocks)(crc, bytes, done);
  const std::span<const std::uint8_t> rest = bytes.subspan(done);
  return static_cast<std::uint32_t>(::crc32_z(crc, rest.data(), rest.size()));
}

}  // namespace dermis::recordings
#endif
