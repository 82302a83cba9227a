// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Highway's lanes without an instruction set, but with the vectors of WebAssembly for pairs of double: Highway 1.0.3 has
// none there, and the loops over its arrays do not become vectors. Comparisons with NaN choose as those of x86 do.
#include_next "hwy/ops/emu128-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwy {
namespace HWY_NAMESPACE {

using PairOfDoubles = Vec128<double, 2>;
using MaskOfPair = Mask128<double, 2>;

namespace detail {

using PairVector = double __attribute__((vector_size(16)));
using PairBits = long long __attribute__((vector_size(16)));

HWY_INLINE PairVector vector_of(const PairOfDoubles v) { return __builtin_bit_cast(PairVector, v.raw); }
HWY_INLINE PairBits bits_of(const MaskOfPair mask) { return __builtin_bit_cast(PairBits, mask.bits); }
HWY_INLINE PairOfDoubles pair_of(const PairVector v) {
  PairOfDoubles pair;
  __builtin_memcpy(pair.raw, &v, sizeof v);
  return pair;
}
HWY_INLINE MaskOfPair mask_of(const PairBits bits) {
  MaskOfPair mask;
  __builtin_memcpy(mask.bits, &bits, sizeof bits);
  return mask;
}
HWY_INLINE PairOfDoubles choose(const PairBits mask, const PairVector yes, const PairVector no) {
  return pair_of(__builtin_bit_cast(
      PairVector, (mask & __builtin_bit_cast(PairBits, yes)) | (~mask & __builtin_bit_cast(PairBits, no))));
}

}  // namespace detail

HWY_API PairOfDoubles Set(Simd<double, 2, 0> /* tag */, double value) {
  return detail::pair_of(detail::PairVector{value, value});
}
HWY_API PairOfDoubles operator+(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::pair_of(detail::vector_of(a) + detail::vector_of(b));
}
HWY_API PairOfDoubles operator-(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::pair_of(detail::vector_of(a) - detail::vector_of(b));
}
HWY_API PairOfDoubles operator*(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::pair_of(detail::vector_of(a) * detail::vector_of(b));
}
HWY_API PairOfDoubles operator/(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::pair_of(detail::vector_of(a) / detail::vector_of(b));
}
HWY_API MaskOfPair operator==(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::mask_of(detail::vector_of(a) == detail::vector_of(b));
}
HWY_API MaskOfPair operator<(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::mask_of(detail::vector_of(a) < detail::vector_of(b));
}
HWY_API MaskOfPair operator>(const PairOfDoubles a, const PairOfDoubles b) { return b < a; }
HWY_API MaskOfPair operator<=(const PairOfDoubles a, const PairOfDoubles b) {
  return detail::mask_of(detail::vector_of(a) <= detail::vector_of(b));
}
HWY_API MaskOfPair operator>=(const PairOfDoubles a, const PairOfDoubles b) { return b <= a; }
HWY_API MaskOfPair And(const MaskOfPair a, const MaskOfPair b) {
  return detail::mask_of(detail::bits_of(a) & detail::bits_of(b));
}
HWY_API PairOfDoubles IfThenElse(const MaskOfPair mask, const PairOfDoubles yes, const PairOfDoubles no) {
  return detail::choose(detail::bits_of(mask), detail::vector_of(yes), detail::vector_of(no));
}
HWY_API PairOfDoubles IfThenElseZero(const MaskOfPair mask, const PairOfDoubles yes) {
  return detail::choose(detail::bits_of(mask), detail::vector_of(yes), detail::PairVector{});
}
HWY_API PairOfDoubles IfThenZeroElse(const MaskOfPair mask, const PairOfDoubles no) {
  return detail::choose(detail::bits_of(mask), detail::PairVector{}, detail::vector_of(no));
}
HWY_API PairOfDoubles Max(const PairOfDoubles a, const PairOfDoubles b) { return IfThenElse(b < a, a, b); }
HWY_API PairOfDoubles Min(const PairOfDoubles a, const PairOfDoubles b) { return IfThenElse(a < b, a, b); }
HWY_API PairOfDoubles Abs(const PairOfDoubles v) {
  return detail::pair_of(__builtin_elementwise_abs(detail::vector_of(v)));
}
HWY_API PairOfDoubles Neg(const PairOfDoubles v) { return detail::pair_of(-detail::vector_of(v)); }

}  // namespace HWY_NAMESPACE
}  // namespace hwy
HWY_AFTER_NAMESPACE();
