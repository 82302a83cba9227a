// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "machine_limits.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <numeric>

#include "dermis/learn/calibration/parallel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "benchmarks/paper/machine_limits.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"
#include "touch/network/activation-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::benchmarks::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Twelve chains of multiply-adds, more than two units of a latency of five need. Returns the operations done.
template <typename Real>
double multiply_add(std::size_t rounds, Real& result) {
  const hn::ScalableTag<Real> d;
  const auto factor = hn::Set(d, result);
  // Different starts, so that no compiler finds two chains to be one.
  const auto start = [&](int chain) { return hn::Set(d, result + static_cast<Real>(chain)); };
  auto a = start(1), b = start(2), c = start(3), e = start(4), f = start(5), g = start(6);
  auto h = start(7), i = start(8), j = start(9), k = start(10), l = start(11), m = start(12);
  for (std::size_t round = 0; round < rounds; ++round) {
    a = hn::MulAdd(a, factor, factor), b = hn::MulAdd(b, factor, factor), c = hn::MulAdd(c, factor, factor);
    e = hn::MulAdd(e, factor, factor), f = hn::MulAdd(f, factor, factor), g = hn::MulAdd(g, factor, factor);
    h = hn::MulAdd(h, factor, factor), i = hn::MulAdd(i, factor, factor), j = hn::MulAdd(j, factor, factor);
    k = hn::MulAdd(k, factor, factor), l = hn::MulAdd(l, factor, factor), m = hn::MulAdd(m, factor, factor);
  }
  const auto sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(f, g), hn::Add(h, i)));
  result = hn::GetLane(hn::SumOfLanes(d, hn::Add(sum, hn::Add(hn::Add(j, k), hn::Add(l, m)))));
  return 24.0 * static_cast<double>(rounds * hn::Lanes(d));
}

double multiply_add_float(std::size_t rounds, float& result) {
  return multiply_add(rounds, result);
}

double multiply_add_double(std::size_t rounds, double& result) {
  return multiply_add(rounds, result);
}

template <typename Real>
void sigmoids(Real* values, std::size_t count) {
  const hn::ScalableTag<Real> d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    hn::StoreU(touch::network::HWY_NAMESPACE::log_sigmoid(d, hn::LoadU(d, values + k)), d, values + k);
  }
}

void float_sigmoids(float* values, std::size_t count) {
  sigmoids(values, count);
}

void double_sigmoids(double* values, std::size_t count) {
  sigmoids(values, count);
}

void float_tanhs(float* values, std::size_t count) {
  const hn::ScalableTag<float> d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    hn::StoreU(touch::network::HWY_NAMESPACE::tanh(d, hn::LoadU(d, values + k)), d, values + k);
  }
}

/// In two streams, each in two chains of additions: of the ways tried, that with the greatest bandwidth.
float sum_of(const float* values, std::size_t count) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t half = count / 2 / (2 * lanes) * (2 * lanes);
  auto a = hn::Zero(d), b = a, c = a, e = a;
  for (std::size_t k = 0; k < half; k += 2 * lanes) {
    a = hn::Add(a, hn::LoadU(d, values + k)), b = hn::Add(b, hn::LoadU(d, values + k + lanes));
    c = hn::Add(c, hn::LoadU(d, values + half + k)), e = hn::Add(e, hn::LoadU(d, values + half + k + lanes));
  }
  float total = hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
  for (std::size_t k = 2 * half; k < count; ++k) total += values[k];
  return total;
}

}  // namespace dermis::benchmarks::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::benchmarks {
namespace {

HWY_EXPORT(multiply_add_float);
HWY_EXPORT(multiply_add_double);
HWY_EXPORT(float_sigmoids);
HWY_EXPORT(double_sigmoids);
HWY_EXPORT(float_tanhs);
HWY_EXPORT(sum_of);

constexpr std::size_t kLargestVector = 64;  // elements; arrays are multiples of it

double seconds_of_call(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Mean time of an element over many passes through an array of 16 KiB.
template <typename Real>
double seconds_an_element(void (*function)(Real*, std::size_t)) {
  constexpr std::size_t kPasses = 1000;
  std::vector<Real> values(16384 / sizeof(Real), Real{0.5});
  function(values.data(), values.size());
  const double seconds = seconds_of_call([&] {
    for (std::size_t pass = 0; pass < kPasses; ++pass) function(values.data(), values.size());
  });
  return seconds / static_cast<double>(kPasses * values.size());
}

double multiply_add(std::size_t rounds, float& result) {
  return HWY_DYNAMIC_DISPATCH(multiply_add_float)(rounds, result);
}

double multiply_add(std::size_t rounds, double& result) {
  return HWY_DYNAMIC_DISPATCH(multiply_add_double)(rounds, result);
}

}  // namespace

template <typename Real>
double operations_per_second(int threads) {
  constexpr std::size_t kRounds = 1'000'000;
  struct alignas(64) Slot {
    Real result{};
    double operations = 0.0;
  };
  std::vector<Slot> slots(static_cast<std::size_t>(threads));
  const auto all = [&] {
    learn::calibration::parallel_for(slots.size(), [&](std::size_t t) {
      slots[t].result = Real{0.5};
      slots[t].operations = multiply_add(kRounds, slots[t].result);
    });
  };
  all();  // wakes the threads
  const double seconds = seconds_of_call(all);
  double operations = 0.0;
  for (const Slot& slot : slots) operations += slot.operations;
  return operations / seconds;
}

template double operations_per_second<float>(int threads);
template double operations_per_second<double>(int threads);

double seconds_of(Function function) {
  switch (function) {
    case Function::float_sigmoid: return seconds_an_element<float>(HWY_DYNAMIC_DISPATCH(float_sigmoids));
    case Function::double_sigmoid: return seconds_an_element<double>(HWY_DYNAMIC_DISPATCH(double_sigmoids));
    case Function::float_tanh: return seconds_an_element<float>(HWY_DYNAMIC_DISPATCH(float_tanhs));
  }
  return 0.0;
}

void sigmoid_in_place(std::span<float> values) {
  const std::size_t whole = values.size() / kLargestVector * kLargestVector;
  HWY_DYNAMIC_DISPATCH(float_sigmoids)(values.data(), whole);
  float rest[kLargestVector] = {};
  std::copy(values.begin() + static_cast<std::ptrdiff_t>(whole), values.end(), rest);
  HWY_DYNAMIC_DISPATCH(float_sigmoids)(rest, kLargestVector);
  std::copy_n(rest, values.size() - whole, values.begin() + static_cast<std::ptrdiff_t>(whole));
}

HugePages::HugePages(std::size_t floats)
    : floats_(floats),
      bytes_((floats * sizeof(float) + (std::size_t{1} << 21U) - 1) & ~((std::size_t{1} << 21U) - 1)),
      data_(static_cast<float*>(std::aligned_alloc(std::size_t{1} << 21U, bytes_))) {
  madvise(data_, bytes_, MADV_HUGEPAGE);
  std::fill_n(data_, floats, 1.0F);
}

HugePages::~HugePages() {
  std::free(data_);
}

float sum(std::span<const float> values, int threads) {
  constexpr std::size_t kPiece = std::size_t{1} << 17U;  // the threads stay close together
  std::vector<float> sums(static_cast<std::size_t>(threads));
  std::atomic<std::size_t> next = 0;
  learn::calibration::parallel_for(sums.size(), [&](std::size_t t) {
    float own = 0.0F;
    for (std::size_t first = next.fetch_add(kPiece); first < values.size(); first = next.fetch_add(kPiece)) {
      own += HWY_DYNAMIC_DISPATCH(sum_of)(values.data() + first, std::min(kPiece, values.size() - first));
    }
    sums[t] = own;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0F);
}

}  // namespace dermis::benchmarks
#endif
