// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/grounded_rows_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/film_columns.hpp"
#include "touch/compensation/film_terms.hpp"
#include "touch/compensation/matrix_product.hpp"
#include "touch/compensation/shorted_crossings.hpp"

#ifdef __wasm__
#define HWY_COMPILE_ONLY_EMU128  // Highway 1.0.3 has no vectors of double there
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "touch/compensation/grounded_rows_kernels.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

#ifndef DERMIS_COMPENSATION_GROUNDED_ROWS_VIEW
#define DERMIS_COMPENSATION_GROUNDED_ROWS_VIEW
namespace dermis::touch::compensation {
/// The arrays of the state. Kernels take them by value. Stores of vectors may alias all that is reached through a
/// pointer. So pointers behind one would be loaded anew after each store. Many members: the symbols of the state.
struct GroundedRowsView {
  explicit GroundedRowsView(GroundedRowsState& state)
      : rows(state.rows),
        cols(state.cols),
        stride(state.stride),
        idle_columns(state.idle_columns),
        drive_ohm(state.drive_ohm.data()),
        column_ohm(state.column_ohm.data()),
        certificate_ratio(state.certificate_ratio.data()),
        measured(state.measured.data()),
        explained(state.explained.data()),
        dropped(state.dropped.data()),
        estimate(state.estimate.data()),
        kept_siemens(state.kept_siemens.data()),
        kept_drawn(state.kept_drawn.data()),
        siemens(state.siemens.data()),
        shunted(state.shunted.data()),
        returned(state.returned.data()),
        line_gain(state.line_gain.data()),
        line_part(state.line_part.data()),
        noise_gain(state.noise_gain.data()),
        column_part(state.column_part.data()),
        column_scale(state.column_scale.data()) {}

  std::size_t rows;
  std::size_t cols;
  std::size_t stride;
  IdleColumns idle_columns;
  const double* drive_ohm;
  const double* column_ohm;
  const double* certificate_ratio;
  double* measured;
  double* explained;
  double* dropped;
  double* estimate;
  const double* kept_siemens;
  const double* kept_drawn;
  double* siemens;
  double* shunted;
  double* returned;
  double* line_gain;
  double* line_part;
  double* noise_gain;
  double* column_part;
  double* column_scale;
};
}  // namespace dermis::touch::compensation
#endif

HWY_BEFORE_NAMESPACE();
namespace dermis::touch::compensation::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Whole vectors of any instruction set fill a row of `stride` values.
using D = hn::CappedTag<double, 8>;
using Vec = hn::Vec<D>;
using View = GroundedRowsView;

constexpr double kLeastShare = 1e-6;  // The share of the supply that a column leaves stays positive under noise.
constexpr double kMostLogResidual = 2.302585092994046;  // ln 10
constexpr double kLeastLineRatio = 0.05;  // The least share of the supply that a row leaves, for the estimate.

/// (c): `sum` of Z; for one loaded column the mean of Rd y weighted by Z+ is `drop` over `weight`. Kept taxels draw
/// G w, with the w that this gives.
HWY_INLINE Vec column_scale(D d, const View state, std::size_t col, Vec sum, Vec drop, Vec weight) {
  const Vec one = hn::Set(d, 1.0);
  const Vec ohm = hn::LoadU(d, state.column_ohm + col);
  Vec share = hn::NegMulAdd(ohm, hn::Sub(sum, hn::LoadU(d, state.kept_drawn + col)), one);
  if (state.idle_columns == IdleColumns::floating) {
    share = hn::Sub(share, hn::IfThenElseZero(hn::Gt(weight, hn::Zero(d)), hn::Div(drop, weight)));
  }
  const Vec kept = hn::MulAdd(ohm, hn::LoadU(d, state.kept_siemens + col), one);
  return hn::Div(kept, hn::Max(share, hn::Set(d, kLeastShare)));
}

void estimate_kernel(const View state) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const Vec zero = hn::Zero(d);
  for (std::size_t col = 0; col < state.stride; col += lanes) {
    Vec sum = zero;
    Vec drop = zero;
    for (std::size_t row = 0; row < state.rows; ++row) {
      const Vec y = hn::Max(hn::LoadU(d, &state.measured[row * state.stride + col]), zero);
      sum = hn::Add(sum, y);
      drop = hn::MulAdd(hn::Mul(hn::Set(d, state.drive_ohm[row]), y), y, drop);
    }
    const Vec scale = column_scale(d, state, col, sum, drop, sum);
    hn::StoreU(scale, d, &state.column_scale[col]);
    for (std::size_t row = 0; row < state.rows; ++row) {
      const std::size_t k = row * state.stride + col;
      hn::StoreU(hn::Mul(hn::Max(hn::LoadU(d, &state.measured[k]), zero), scale), d, &state.estimate[k]);
    }
  }
  for (std::size_t row = 0; row < state.rows; ++row) {
    double* const line = &state.estimate[row * state.stride];
    Vec sum = zero;
    for (std::size_t col = 0; col < state.stride; col += lanes) sum = hn::Add(sum, hn::LoadU(d, line + col));
    const double line_ratio = 1.0 - state.drive_ohm[row] * hn::GetLane(hn::SumOfLanes(d, sum));
    const Vec gain = hn::Set(d, 1.0 / std::max(line_ratio, kLeastLineRatio));
    for (std::size_t col = 0; col < state.stride; col += lanes) {
      hn::StoreU(hn::Mul(hn::LoadU(d, line + col), gain), d, line + col);
    }
  }
}

void warm_kernel(const View state, const double* HWY_RESTRICT last_estimate) {
  const D d;
  const Vec zero = hn::Zero(d);
  for (std::size_t k = 0; k < state.rows * state.stride; k += hn::Lanes(d)) {
    const Vec y = hn::LoadU(d, &state.measured[k]);
    const Vec last = hn::LoadU(d, &state.siemens[k]);
    const Vec explained = hn::LoadU(d, &state.explained[k]);
    const auto held = hn::And(hn::Eq(last, zero), hn::Gt(explained, y));
    const Vec moved = hn::Add(last, hn::Sub(hn::LoadU(d, &state.estimate[k]), hn::LoadU(d, last_estimate + k)));
    hn::StoreU(hn::IfThenZeroElse(held, hn::Max(moved, zero)), d, &state.siemens[k]);
    hn::StoreU(hn::IfThenElse(held, explained, y), d, &state.explained[k]);
  }
}

void refresh_kernel(const View state) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const Vec zero = hn::Zero(d);
  const Vec one = hn::Set(d, 1.0);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const Vec drive = hn::Set(d, state.drive_ohm[row]);
    Vec sum = zero;
    for (std::size_t col = 0; col < state.stride; col += lanes) {
      const std::size_t k = row * state.stride + col;
      sum = hn::Add(sum, hn::LoadU(d, &state.siemens[k]));
      hn::StoreU(hn::Mul(drive, hn::LoadU(d, &state.explained[k])), d, &state.dropped[k]);
    }
    state.line_gain[row] = 1.0 + state.drive_ohm[row] * hn::GetLane(hn::SumOfLanes(d, sum));
    state.line_part[row] = 1.0 / state.line_gain[row];
  }
  const bool one_loaded = state.idle_columns == IdleColumns::floating;
  for (std::size_t col = 0; col < state.stride; col += lanes) {
    Vec sum = zero;
    Vec drop = zero;
    for (std::size_t k = col; k < state.rows * state.stride; k += state.stride) {
      const Vec g = hn::LoadU(d, &state.siemens[k]);
      sum = hn::Add(sum, g);
      if (one_loaded) drop = hn::MulAdd(g, hn::LoadU(d, &state.dropped[k]), drop);
    }
    const Vec ohm = hn::LoadU(d, &state.column_ohm[col]);
    Vec part = hn::Div(one, hn::MulAdd(ohm, sum, one));
    Vec eta = hn::Mul(ohm, part);
    if (one_loaded) {
      eta = hn::IfThenElseZero(hn::Gt(sum, zero), hn::Div(one, sum));
      part = hn::Mul(part, hn::NegMulAdd(drop, eta, one));
    }
    hn::StoreU(part, d, &state.column_part[col]);
    for (std::size_t k = col; k < state.rows * state.stride; k += state.stride) {
      hn::StoreU(hn::Mul(hn::LoadU(d, &state.siemens[k]), eta), d, &state.shunted[k]);
    }
  }
}

double assess_kernel(const View state) {
  const D d;
  const Vec zero = hn::Zero(d);
  Vec largest = zero;
  Vec total = zero;
  for (std::size_t col = 0; col < state.stride; col += hn::Lanes(d)) {
    const Vec part = hn::LoadU(d, &state.column_part[col]);
    Vec sum = zero;
    Vec drop = zero;
    Vec weight = zero;
    Vec worst = zero;
    Vec spread = zero;
    for (std::size_t row = 0; row < state.rows; ++row) {
      const std::size_t k = row * state.stride + col;
      const Vec gain = hn::Set(d, state.line_gain[row]);
      const Vec off_diagonal = hn::Set(d, 1.0 - state.line_part[row]);
      const Vec returned = hn::LoadU(d, &state.returned[k]);
      const Vec z = hn::MulSub(gain, hn::LoadU(d, &state.explained[k]), returned);
      const Vec positive = hn::Max(z, zero);
      sum = hn::Add(sum, z);
      weight = hn::Add(weight, positive);
      drop = hn::MulAdd(positive, hn::LoadU(d, &state.dropped[k]), drop);
      const Vec residual = hn::Abs(hn::NegMulAdd(hn::LoadU(d, &state.siemens[k]), part, z));
      worst = hn::Max(worst, residual);
      spread = hn::MulAdd(residual, off_diagonal, spread);
    }
    hn::StoreU(column_scale(d, state, col, sum, drop, weight), d, &state.column_scale[col]);
    const Vec bound = hn::Mul(hn::Add(worst, spread), hn::LoadU(d, &state.certificate_ratio[col]));
    largest = hn::Max(largest, bound);
    total = hn::Add(total, bound);
  }
  // Max() may drop what is not a number; the sum does not.
  if (!std::isfinite(hn::GetLane(hn::SumOfLanes(d, total)))) return std::numeric_limits<double>::infinity();
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

void advance_kernel(const View state) {
  const D d;
  const Vec zero = hn::Zero(d);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const Vec gain = hn::Set(d, state.line_gain[row]);
    const Vec inverse_gain = hn::Set(d, state.line_part[row]);
    for (std::size_t col = 0; col < state.stride; col += hn::Lanes(d)) {
      const std::size_t k = row * state.stride + col;
      const Vec y = hn::LoadU(d, &state.measured[k]);
      const Vec returned = hn::LoadU(d, &state.returned[k]);
      const Vec z = hn::Max(hn::MulSub(gain, y, returned), zero);
      hn::StoreU(hn::Mul(z, hn::LoadU(d, &state.column_scale[col])), d, &state.siemens[k]);
      hn::StoreU(hn::Max(y, hn::Mul(returned, inverse_gain)), d, &state.explained[k]);
    }
  }
}

void logarithm_kernel(const double* HWY_RESTRICT siemens, std::size_t count, double* HWY_RESTRICT log_siemens) {
  const D d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const Vec present = hn::Max(hn::LoadU(d, siemens + k), hn::Set(d, kLeastSiemens));
    hn::StoreU(hn::Log(d, present), d, log_siemens + k);
  }
}

void mixed_step_kernel(const View state, const double* HWY_RESTRICT log_siemens) {
  const D d;
  const Vec least = hn::Set(d, std::log(kLeastSiemens));
  for (std::size_t row = 0; row < state.rows; ++row) {
    const Vec part = hn::Set(d, state.line_part[row]);
    for (std::size_t k = row * state.stride; k < (row + 1) * state.stride; k += hn::Lanes(d)) {
      const Vec logarithm = hn::LoadU(d, log_siemens + k);
      const auto held = hn::Le(logarithm, least);
      const Vec y = hn::LoadU(d, &state.measured[k]);
      const Vec caused = hn::Mul(hn::LoadU(d, &state.returned[k]), part);
      hn::StoreU(hn::IfThenZeroElse(held, hn::Exp(d, logarithm)), d, &state.siemens[k]);
      hn::StoreU(hn::IfThenElse(held, hn::Max(y, caused), y), d, &state.explained[k]);
    }
  }
}

/// Whether all changes are below the most.
bool log_step_kernel(const View state, double* HWY_RESTRICT log_step) {
  const D d;
  const Vec least = hn::Set(d, kLeastSiemens);
  const Vec most = hn::Set(d, kMostLogResidual);
  Vec largest = hn::Zero(d);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const Vec gain = hn::Set(d, state.line_gain[row]);
    for (std::size_t col = 0; col < state.stride; col += hn::Lanes(d)) {
      const std::size_t k = row * state.stride + col;
      const Vec undriven = hn::MulSub(gain, hn::LoadU(d, &state.measured[k]), hn::LoadU(d, &state.returned[k]));
      const Vec next = hn::Max(hn::Mul(hn::LoadU(d, &state.column_scale[col]), undriven), least);
      const Vec change = hn::Log(d, hn::Div(next, hn::Max(hn::LoadU(d, &state.siemens[k]), least)));
      largest = hn::Max(largest, hn::Abs(change));
      hn::StoreU(hn::Min(hn::Max(change, hn::Neg(most)), most), d, log_step + k);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest)) < kMostLogResidual;
}

/// Base of column j: what noise of y_ij alone makes of G_ij, but for the line gain a_i.
HWY_INLINE Vec column_noise(D d, const View state, const double* HWY_RESTRICT sigma, std::size_t col) {
  return hn::Div(hn::LoadU(d, sigma + col), hn::LoadU(d, &state.column_part[col]));
}

/// As many of the lanes as there are columns from `col` on.
HWY_INLINE void store_columns(D d, Vec lanes, std::size_t col, std::size_t cols, double* HWY_RESTRICT row) {
  if (col + hn::Lanes(d) <= cols) return hn::StoreU(lanes, d, row + col);
  double last[hn::MaxLanes(d)];
  hn::StoreU(lanes, d, last);
  std::copy_n(last, cols - std::min(col, cols), row + col);
}

void noise_kernel(const View state, const double* HWY_RESTRICT sigma, double* HWY_RESTRICT out) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const Vec one = hn::Set(d, 1.0);
  Vec columns = hn::Zero(d);
  for (std::size_t col = 0; col < state.stride; col += lanes) {
    const Vec base = column_noise(d, state, sigma, col);
    columns = hn::MulAdd(base, base, columns);
  }
  const Vec all_columns = hn::Set(d, hn::GetLane(hn::SumOfLanes(d, columns)));
  double all_rows = 0.0;
  for (std::size_t row = 0; row < state.rows; ++row) {
    Vec returned = hn::Zero(d);
    for (std::size_t k = row * state.stride; k < (row + 1) * state.stride; k += lanes) {
      returned = hn::MulAdd(hn::LoadU(d, &state.siemens[k]), hn::LoadU(d, &state.shunted[k]), returned);
    }
    const double own = state.line_gain[row] - state.drive_ohm[row] * hn::GetLane(hn::SumOfLanes(d, returned));
    state.noise_gain[row] = state.drive_ohm[row] < kOpenOhm ? own * own : 0.0;  // else it has no reading
    all_rows += state.noise_gain[row];
  }
  for (std::size_t col = 0; col < state.stride; col += lanes) {
    const Vec base = column_noise(d, state, sigma, col);
    const Vec square = hn::Mul(base, base);
    const Vec other_columns = hn::Sub(all_columns, square);
    const Vec ohm = hn::LoadU(d, &state.column_ohm[col]);
    for (std::size_t row = 0; row < state.rows; ++row) {
      const std::size_t k = row * state.stride + col;
      const double gain = state.noise_gain[row];
      const Vec g = hn::LoadU(d, &state.siemens[k]);
      const Vec p = hn::Mul(hn::Set(d, state.drive_ohm[row]), g);
      const Vec w = hn::Mul(ohm, g);
      const Vec own = hn::Add(one, hn::Add(p, w));
      Vec variance = hn::Mul(hn::Mul(hn::Set(d, gain), square), hn::Mul(own, own));
      variance = hn::MulAdd(hn::Mul(p, p), hn::Mul(hn::Set(d, gain), other_columns), variance);
      variance = hn::MulAdd(hn::Mul(w, w), hn::Mul(hn::Set(d, all_rows - gain), square), variance);
      store_columns(d, hn::Sqrt(variance), col, state.cols, out + row * state.cols);
    }
  }
}

}  // namespace dermis::touch::compensation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::touch::compensation {

namespace {

constexpr std::size_t kMostLanes = 8;

DERMIS_PROCESSOR_CLONES void convert(const std::vector<double>& from, std::vector<float>& to) {
  for (std::size_t k = 0; k < to.size(); ++k) to[k] = static_cast<float>(from[k]);
}

DERMIS_PROCESSOR_CLONES void convert(const std::vector<float>& from, std::vector<double>& to) {
  for (std::size_t k = 0; k < to.size(); ++k) to[k] = static_cast<double>(from[k]);
}

/// G diag(eta) G^T Rd y' from its factors; under a film it has C^-1 in the place of diag(eta).
template <typename Factors, typename Real>
void multiply_factors(const GroundedRowsState& state, const Factors& factors, std::vector<Real>& coupling,
                      std::vector<Real>& returned) {
  const auto [rows, cols, stride] = std::tuple(state.rows, state.cols, state.stride);
  const std::vector<Real>& left = state.film != nullptr ? factors.siemens : factors.shunted;
  multiply(StridedMatrix<Real>{left.data(), 1, stride}, factors.dropped.data(), cols, rows, stride, coupling.data());
  if (state.film != nullptr) divide_by_columns(state, coupling);
  multiply(StridedMatrix<Real>{factors.siemens.data(), stride, 1}, coupling.data(), rows, cols, stride,
           returned.data());
}

void find_returned(GroundedRowsState& state, Precision precision) {
  if (precision == Precision::full) return multiply_factors(state, state, state.coupling, state.returned);
  auto& [dropped, shunted, siemens, coupling, returned] = state.single;
  convert(state.dropped, dropped);
  convert(state.shunted, shunted);
  convert(state.siemens, siemens);
  multiply_factors(state, state.single, coupling, returned);
  convert(returned, state.returned);
}

}  // namespace

HWY_EXPORT(estimate_kernel);
HWY_EXPORT(warm_kernel);
HWY_EXPORT(refresh_kernel);
HWY_EXPORT(assess_kernel);
HWY_EXPORT(advance_kernel);
HWY_EXPORT(noise_kernel);
HWY_EXPORT(logarithm_kernel);
HWY_EXPORT(mixed_step_kernel);
HWY_EXPORT(log_step_kernel);

GroundedRowsState::SinglePrecision::SinglePrecision(std::size_t size, std::size_t coupling_size)
    : dropped(size), shunted(size), siemens(size), coupling(coupling_size), returned(size) {}

GroundedRowsState::GroundedRowsState(std::size_t row_count, std::size_t col_count, IdleColumns columns)
    : rows(row_count),
      cols(col_count),
      stride((col_count + kMostLanes - 1) / kMostLanes * kMostLanes),
      idle_columns(columns),
      drive_ohm(rows),
      column_ohm(stride),
      certificate_ratio(stride),
      measured(rows * stride),
      explained(rows * stride),
      dropped(rows * stride),
      estimate(rows * stride),
      kept_siemens(stride),
      kept_drawn(stride),
      siemens(rows * stride),
      shunted(rows * stride),
      coupling(cols * stride),
      returned(rows * stride),
      single(rows * stride, cols * stride),
      line_gain(rows),
      line_part(rows),
      noise_gain(rows),
      column_part(stride),
      column_scale(stride) {}

void estimate_from_readings(GroundedRowsState& state) noexcept {
  std::fill(state.kept_siemens.begin(), state.kept_siemens.end(), 0.0);
  std::fill(state.kept_drawn.begin(), state.kept_drawn.end(), 0.0);
  for (const auto& [row, col, siemens] : state.kept) {
    state.kept_siemens[col] += siemens;
    state.measured[row * state.stride + col] = 0.0;
  }
  if (state.film != nullptr) {
    estimate_with_film(state);
  } else {
    HWY_DYNAMIC_DISPATCH(estimate_kernel)(GroundedRowsView(state));
  }
  if (!state.shorted.empty()) estimate_with_shorted(state);
  std::fill(state.line_gain.begin(), state.line_gain.end(), 1.0);
  for (const auto& [row, col, siemens] : state.kept) state.line_gain[row] += state.drive_ohm[row] * siemens;
  for (const auto& [row, col, siemens] : state.kept) {
    const std::size_t k = row * state.stride + col;
    state.estimate[k] = siemens;
    state.measured[k] = siemens / (state.column_scale[col] * state.line_gain[row]);
  }
}

void start_cold(GroundedRowsState& state) noexcept {
  state.siemens = state.estimate;
  state.explained = state.measured;
  refresh(state);
}

void start_warm(GroundedRowsState& state, const std::vector<double>& last_estimate) noexcept {
  HWY_DYNAMIC_DISPATCH(warm_kernel)(GroundedRowsView(state), last_estimate.data());
  refresh(state);
}

void refresh(GroundedRowsState& state) noexcept {
  for (const auto& [row, col, siemens] : state.kept) state.siemens[row * state.stride + col] = siemens;
  if (!state.shorted.empty()) add_up_nodes(state);
  HWY_DYNAMIC_DISPATCH(refresh_kernel)(GroundedRowsView(state));
  if (!state.shorted.empty()) take_columns_away(state);
  if (state.film != nullptr) put_film_into_lines(state);
}

double assess(GroundedRowsState& state, Precision precision) noexcept {
  find_returned(state, precision);
  if (state.film != nullptr) return assess_with_film(state);
  if (!state.shorted.empty()) return_through_nodes(state);
  std::fill(state.kept_drawn.begin(), state.kept_drawn.end(), 0.0);
  for (const auto& [row, col, siemens] : state.kept) {
    const std::size_t k = row * state.stride + col;
    state.kept_drawn[col] += state.line_gain[row] * state.explained[k] - state.returned[k];
    state.measured[k] = (siemens * state.column_part[col] + state.returned[k]) / state.line_gain[row];
  }
  const double certificate = HWY_DYNAMIC_DISPATCH(assess_kernel)(GroundedRowsView(state));
  if (!state.shorted.empty()) scale_shorted_columns(state);
  return certificate;
}

void advance(GroundedRowsState& state, const std::vector<double>& from) noexcept {
  HWY_DYNAMIC_DISPATCH(advance_kernel)(GroundedRowsView(state));
  if (state.film != nullptr) hasten_with_film(state, from);
  refresh(state);
}

void start_mixing(const std::vector<double>& siemens, std::vector<double>& log_siemens) noexcept {
  HWY_DYNAMIC_DISPATCH(logarithm_kernel)(siemens.data(), siemens.size(), log_siemens.data());
}

void take_mixed_step(GroundedRowsState& state, const std::vector<double>& log_siemens) noexcept {
  HWY_DYNAMIC_DISPATCH(mixed_step_kernel)(GroundedRowsView(state), log_siemens.data());
}

bool find_log_step(GroundedRowsState& state, std::vector<double>& log_step) noexcept {
  return HWY_DYNAMIC_DISPATCH(log_step_kernel)(GroundedRowsView(state), log_step.data());
}

void spread_noise(GroundedRowsState& state, const std::vector<double>& sigma, std::span<double> out) noexcept {
  if (state.film != nullptr) shunt_with_film(state);
  HWY_DYNAMIC_DISPATCH(noise_kernel)(GroundedRowsView(state), sigma.data(), out.data());
}

}  // namespace dermis::touch::compensation
#endif  // HWY_ONCE
