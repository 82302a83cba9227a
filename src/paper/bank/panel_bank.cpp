// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/panel_bank.hpp"

#include <algorithm>

#include "paper/bank/bank_workers.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/bank/panel_bank.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "network/activation-inl.hpp"
#include "paper/bank/adam-inl.hpp"
#include "paper/bank/panel_evaluate-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace dermis::paper::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using network::HWY_NAMESPACE::slope_from_output;

// A tile of a product lies in registers: 16 of the 32 of AVX-512, 8 of the 16 elsewhere.
constexpr std::size_t kTileRows = kVectorLanes == kLanes ? 8 : 4;
constexpr std::size_t kTileVectors = 2;

using FullVector = hn::Vec<FullTag>;

struct NoPrefetch {
  HWY_INLINE void next() const {}
};

/// Fetches memory that is needed soon into the second-level cache, a quarter of a cache line at every step of a
/// product. Harmless beyond the end of the bank.
class Prefetch {
 public:
  explicit Prefetch(const float* place) : place_(place) {}

  HWY_INLINE void next() {
    __builtin_prefetch(place_, 0, 2);
    place_ += 4;
  }

 private:
  const float* place_;
};

/// sums[r][v] += sum over `steps` of a[r * a_row + step * a_step] * vector v of b[step * b_step].
template <std::size_t Rows, std::size_t Vectors, class Fetch = NoPrefetch>
HWY_INLINE void accumulate(const float* HWY_RESTRICT a, std::size_t a_row, std::size_t a_step,
                           const float* HWY_RESTRICT b, std::size_t b_step, std::size_t steps,
                           FullVector (&sums)[Rows][Vectors], Fetch fetch = {}) {
  const FullTag d;
  for (std::size_t step = 0; step < steps; ++step, a += a_step, b += b_step) {
    fetch.next();
    FullVector right[Vectors];
    for (std::size_t v = 0; v < Vectors; ++v) right[v] = hn::Load(d, b + v * kVectorLanes);
    for (std::size_t r = 0; r < Rows; ++r) {
      const auto left = hn::Set(d, a[r * a_row]);
      for (std::size_t v = 0; v < Vectors; ++v) sums[r][v] = hn::MulAdd(left, right[v], sums[r][v]);
    }
  }
}

template <std::size_t Rows, std::size_t Vectors>
HWY_INLINE void clear(FullVector (&sums)[Rows][Vectors]) {
  for (auto& row : sums) {
    for (auto& sum : row) sum = hn::Zero(FullTag());
  }
}

/// Calls tile(row) with as many rows at a time as Rows, then with the halves for the rest.
template <std::size_t Rows, class Tile>
HWY_INLINE void for_each_tile(std::size_t row, std::size_t rows, const Tile& tile) {
  for (; row + Rows <= rows; row += Rows) tile(std::integral_constant<std::size_t, Rows>(), row);
  if constexpr (Rows > 1) for_each_tile<Rows / 2>(row, rows, tile);
}

/// A batch of one network's patterns between two levels.
struct Level {
  float* values;
  std::size_t stride;
};

/// Outputs of the units of Vectors vectors for all patterns. Meanwhile the panel behind this one is fetched: a batch
/// takes 4 % less time.
template <std::size_t Vectors, std::size_t Width>
void forward_columns(const PanelLayer& layer, const float* weights, const float* below, std::size_t below_stride,
                     std::size_t rows, Level above) {
  const FullTag d;
  const std::size_t panel = layer.steps() * Width;
  for (std::size_t row = 0; row < rows; row += kTileRows) {
    FullVector sums[kTileRows][Vectors];
    clear(sums);
    const Prefetch next_panel(weights + panel + panel / kBlock * (row % kBlock));
    accumulate(below + row * below_stride, below_stride, 1, weights, Width, layer.steps(), sums, next_panel);
    for (std::size_t r = 0; r < kTileRows; ++r) {
      for (std::size_t v = 0; v < Vectors; ++v) {
        hn::Store(sums[r][v], d, above.values + (row + r) * above.stride + v * kVectorLanes);
      }
    }
    for (std::size_t r = 0; r < kTileRows; ++r) {
      for (std::size_t v = 0; v < Vectors; ++v) {
        float* place = above.values + (row + r) * above.stride + v * kVectorLanes;
        hn::Store(activate(d, layer.activation, hn::Load(d, place)), d, place);
      }
    }
  }
}

/// Calls columns(vectors, width, first unit, its weights) for tiles of columns of a panel that starts with `unit`.
template <std::size_t Width, class Columns>
HWY_INLINE void for_each_panel_columns(const PanelLayer& layer, std::size_t unit, const Columns& columns) {
  constexpr std::integral_constant<std::size_t, Width> kWidth;
  constexpr std::integral_constant<std::size_t, std::min(kTileVectors, Width / kVectorLanes)> kVectors;
  for (std::size_t column = 0; column < Width; column += kVectors() * kVectorLanes) {
    columns(kVectors, kWidth, unit + column, layer.panel(unit) + column);
  }
}

/// The same for all panels of a layer.
template <class Columns>
HWY_INLINE void for_each_columns(const PanelLayer& layer, const Columns& columns) {
  std::size_t unit = 0;
  for (; unit + kPanelUnits <= layer.padded_units(); unit += kPanelUnits) {
    for_each_panel_columns<kPanelUnits>(layer, unit, columns);
  }
  if (unit < layer.padded_units()) for_each_panel_columns<kLanes>(layer, unit, columns);
}

/// Eq. (4) for all patterns.
void forward_layer(const PanelLayer& layer, const float* parameters, const float* below, std::size_t below_stride,
                   std::size_t rows, Level above) {
  if (layer.is_row()) {
    for (std::size_t row = 0; row < rows; ++row) {
      above.values[row * above.stride] = evaluate_row(layer, parameters + layer.first, below + row * below_stride);
    }
  } else {
    for_each_columns(layer, [&](auto vectors, auto width, std::size_t unit, std::size_t place) {
      forward_columns<vectors(), width()>(layer, parameters + place, below, below_stride, rows,
                                          {above.values + unit, above.stride});
    });
  }
  for (std::size_t row = 0; row < rows; ++row) end_row(above.values + row * above.stride, layer.units);
}

void forward(const PanelLayout& layout, const float* parameters, const float* inputs, std::size_t input_stride,
             std::size_t rows, PatternSpace& space) {
  const float* below = inputs;
  std::size_t below_stride = input_stride;
  for (std::size_t l = 0; l < layout.layers().size(); ++l) {
    const Level above{space.level(l + 1), space.stride(l + 1)};
    forward_layer(layout.layers()[l], parameters, below, below_stride, rows, above);
    below = above.values;
    below_stride = above.stride;
  }
}

/// Calls write(tag, values, column, row) for four values of a column at a time, those of rows row ... row + 3: stored
/// as a row they make the transpose. `rows` and `columns` are rounded up to blocks of four.
template <class Write>
HWY_INLINE void transpose(Level from, std::size_t rows, std::size_t columns, const Write& write) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      write(FullTag(), hn::Load(FullTag(), from.values + row * from.stride + column), column, row);
    }
  }
#else
  const hn::FixedTag<float, 4> d;
  for (std::size_t row = 0; row < rows; row += 4) {
    for (std::size_t column = 0; column < columns; column += 4) {
      const float* block = from.values + row * from.stride + column;
      const auto row0 = hn::Load(d, block);
      const auto row1 = hn::Load(d, block + from.stride);
      const auto row2 = hn::Load(d, block + 2 * from.stride);
      const auto row3 = hn::Load(d, block + 3 * from.stride);
      const auto even_low = hn::InterleaveLower(d, row0, row2);
      const auto even_high = hn::InterleaveUpper(d, row0, row2);
      const auto odd_low = hn::InterleaveLower(d, row1, row3);
      const auto odd_high = hn::InterleaveUpper(d, row1, row3);
      write(d, hn::InterleaveLower(d, even_low, odd_low), column, row);
      write(d, hn::InterleaveUpper(d, even_low, odd_low), column + 1, row);
      write(d, hn::InterleaveLower(d, even_high, odd_high), column + 2, row);
      write(d, hn::InterleaveUpper(d, even_high, odd_high), column + 3, row);
    }
  }
#endif
}

/// columns_below[k][p] = sum over the units j of w_jk delta_pj.
void propagate(const PanelLayer& layer, const float* parameters, PatternSpace& space) {
  const FullTag d;
  const std::size_t stride = space.column_stride();
  const auto tile = [&](auto rows, auto vectors, std::size_t k, std::size_t pattern) {
    FullVector sums[rows()][vectors()];
    clear(sums);
    for (std::size_t unit = 0; unit < layer.units; unit += kPanelUnits) {
      const std::size_t width = layer.width(unit);
      accumulate(parameters + layer.panel(unit) + k * width, width, 1, space.columns() + unit * stride + pattern,
                 stride, std::min(width, layer.units - unit), sums);
    }
    for (std::size_t r = 0; r < rows(); ++r) {
      for (std::size_t v = 0; v < vectors(); ++v) {
        hn::Store(sums[r][v], d, space.columns_below() + (k + r) * stride + pattern + v * kVectorLanes);
      }
    }
  };
  std::size_t pattern = 0;
  for (; pattern + kTileVectors * kVectorLanes <= space.rows(); pattern += kTileVectors * kVectorLanes) {
    for_each_tile<kTileRows>(0, layer.fan_in, [&](auto rows, std::size_t k) {
      tile(rows, std::integral_constant<std::size_t, kTileVectors>(), k, pattern);
    });
  }
  for (; pattern < space.rows(); pattern += kVectorLanes) {
    for_each_tile<kTileRows>(0, layer.fan_in, [&](auto rows, std::size_t k) {
      tile(rows, std::integral_constant<std::size_t, 1>(), k, pattern);
    });
  }
}

/// w -= rate * gradient.
class DescentRule {
 public:
  DescentRule(const PanelParameters& parameters, float rate)
      : values_(parameters.values), rate_(hn::Set(FullTag(), rate)) {}

  /// The weights have just been used.
  HWY_INLINE void prefetch(std::size_t /*place*/) const {}
  HWY_INLINE void move(std::size_t place, FullVector gradient) const {
    const FullTag d;
    hn::Store(hn::NegMulAdd(rate_, gradient, hn::Load(d, values_ + place)), d, values_ + place);
  }

 private:
  float* HWY_RESTRICT values_;
  FullVector rate_;
};

class AdamRule {
 public:
  AdamRule(const PanelParameters& parameters, const BankStep& step, const AdamScales& scales)
      : parameters_(parameters),
        step_(FullTag(), hn::Set(FullTag(), scales.rate), hn::Set(FullTag(), scales.second_scale), step) {}

  /// The moments come from memory while the gradient is summed: a step takes 5 % less time.
  HWY_INLINE void prefetch(std::size_t place) const {
    hwy::Prefetch(parameters_.first_moments + place);
    hwy::Prefetch(parameters_.second_moments + place);
  }
  HWY_INLINE void move(std::size_t place, FullVector gradient) const {
    step_.move(gradient, parameters_.values + place, parameters_.first_moments + place,
               parameters_.second_moments + place);
  }

 private:
  PanelParameters parameters_;
  AdamStep<FullTag> step_;
};

/// The gradient of every weight, sum over the patterns of x_pk delta_pj, tile by tile, each applied at once.
template <class Rule>
void move_panels(const PanelLayer& layer, const Rule& rule, Level below, Level delta, std::size_t patterns) {
  for_each_columns(layer, [&](auto vectors, auto width, std::size_t unit, std::size_t place) {
    for_each_tile<kTileRows>(0, layer.steps(), [&](auto rows, std::size_t step) {
      const auto place_of = [&](std::size_t r, std::size_t v) {
        return place + (step + r) * width() + v * kVectorLanes;
      };
      for (std::size_t r = 0; r < rows(); ++r) {
        for (std::size_t v = 0; v < vectors(); ++v) rule.prefetch(place_of(r, v));
      }
      FullVector sums[rows()][vectors()];
      clear(sums);
      accumulate(below.values + step, 1, below.stride, delta.values + unit, delta.stride, patterns, sums);
      for (std::size_t r = 0; r < rows(); ++r) {
        for (std::size_t v = 0; v < vectors(); ++v) {
          rule.move(place_of(r, v), sums[r][v]);
        }
      }
    });
  });
}

/// A layer of one unit: moves its weights and, unless it is the lowest, turns what the layer below put out into its
/// deltas, both in one pass.
template <class Rule>
void move_row(const PanelLayer& layer, const float* weights, const Rule& rule, const PanelLayer* layer_below,
              Level below, Level delta, std::size_t rows) {
  const FullTag d;
  for (std::size_t k = 0; k < layer.size(); k += kVectorLanes) {
    const auto weight = hn::Load(d, weights + k);
    auto gradient = hn::Zero(d);
    for (std::size_t row = 0; row < rows; ++row) {
      float* place = below.values + row * below.stride + k;
      const auto output = hn::Load(d, place);
      const auto own = hn::Set(d, delta.values[row * delta.stride]);
      gradient = hn::MulAdd(own, output, gradient);
      if (layer_below == nullptr) continue;
      hn::Store(hn::Mul(hn::Mul(own, weight), slope_from_output(d, layer_below->activation, output)), d, place);
    }
    rule.move(layer.first + k, gradient);
  }
}

template <class Rule>
void backward(const PanelLayout& layout, const float* parameters, const Rule& rule, PatternSpace& space,
              std::size_t patterns) {
  for (std::size_t l = layout.layers().size(); l-- > 0;) {
    const PanelLayer& layer = layout.layers()[l];
    const PanelLayer* layer_below = l == 0 ? nullptr : &layout.layers()[l - 1];
    const Level below{space.level(l), space.stride(l)};
    const Level delta{space.level(l + 1), space.stride(l + 1)};
    if (layer.is_row()) {
      move_row(layer, parameters + layer.first, rule, layer_below, below, delta, space.rows());
    } else {
      if (layer_below != nullptr) {
        transpose(delta, space.rows(), layer.units, [&](auto d, auto values, std::size_t unit, std::size_t pattern) {
          hn::Store(values, d, space.columns() + unit * space.column_stride() + pattern);
        });
        propagate(layer, parameters, space);
      }
      move_panels(layer, rule, below, delta, patterns);
      if (layer_below != nullptr) {
        transpose({space.columns_below(), space.column_stride()}, layer.fan_in, space.rows(),
                  [&](auto d, auto values, std::size_t pattern, std::size_t unit) {
                    float* place = below.values + pattern * below.stride + unit;
                    const auto slope = slope_from_output(d, layer_below->activation, hn::Load(d, place));
                    hn::Store(hn::Mul(values, slope), d, place);
                  });
      }
    }
    for (std::size_t row = 0; layer_below != nullptr && row < space.rows(); ++row) {
      std::fill(below.values + row * below.stride + layer.fan_in, below.values + (row + 1) * below.stride, 0.0F);
    }
  }
}

/// The error of the batch from what the network puts out, which becomes the deltas of its last layer.
float take_error(const PanelLayer& layer, Level outputs, PatternSpace& space, std::size_t patterns) {
  double error = 0.0;
  for (std::size_t p = 0; p < space.rows(); ++p) {
    float* row = outputs.values + p * outputs.stride;
    const std::size_t units = p < patterns ? layer.units : 0;
    for (std::size_t k = 0; k < units; ++k) {
      const float difference = row[k] - space.targets[p * units + k];
      const float scaled = space.weights[p] * difference;
      error += 0.5 * double{scaled} * double{difference};
      row[k] = scaled * network::slope_from_output(layer.activation, row[k]);
    }
    std::fill(row + units, row + outputs.stride, 0.0F);
  }
  return static_cast<float>(error);
}

void evaluate_frame(const PanelLayout& layout, const float* parameters, const float* inputs, float* space,
                    float* outputs) {
  evaluate_network(layout, parameters, inputs, space, outputs);
}

/// One step on the patterns that the space holds; the error before it.
float train_patterns(const PanelLayout& layout, const PanelParameters& parameters, const BankStep& step,
                     const AdamScales& scales, std::size_t patterns, PatternSpace& space) {
  forward(layout, parameters.values, space.level(0), space.stride(0), space.rows(), space);
  const std::size_t top = layout.layers().size();
  const float error = take_error(layout.layers().back(), {space.level(top), space.stride(top)}, space, patterns);
  if (step.rule == BankStep::Rule::adam) {
    backward(layout, parameters.values, AdamRule(parameters, step, scales), space, patterns);
  } else {
    backward(layout, parameters.values, DescentRule(parameters, step.rate), space, patterns);
  }
  return error;
}

}  // namespace
}  // namespace dermis::paper::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::paper {

HWY_EXPORT(evaluate_frame);
HWY_EXPORT(forward);
HWY_EXPORT(train_patterns);

namespace {

/// Patterns of evaluate_batch() between two readings of all weights.
constexpr std::size_t kPackedPatterns = 1024;

/// Rows of work spaces start at odd multiples of a cache line: at powers of two they would displace each other.
std::size_t row_stride(std::size_t values) {
  return (round_up(values + 1, kLanes) / kLanes | 1U) * kLanes;
}

}  // namespace

PatternSpace::PatternSpace(const PanelLayout& layout, std::size_t patterns)
    : targets(patterns * layout.outputs()),
      weights(patterns),
      rows_(round_up(patterns, kLanes)),
      column_stride_(row_stride(rows_)) {
  std::size_t size = 0;
  const auto reserve = [&](std::size_t values) { return std::exchange(size, size + values); };
  const auto add_level = [&](std::size_t values) {
    strides_.push_back(row_stride(values));
    starts_.push_back(reserve(rows_ * strides_.back()));
  };
  add_level(layout.inputs());
  for (const PanelLayer& layer : layout.layers()) add_level(layer.units);
  columns_ = reserve(layout.widest() * column_stride_);
  columns_below_ = reserve(layout.widest() * column_stride_);
  values_.resize(size);
}

PanelBank::PanelBank(const NetworkShape& shape, std::size_t networks)
    : layout_(shape), networks_(networks), values_(networks * layout_.size()), adam_steps_(networks) {}

PanelParameters PanelBank::of(std::size_t network) {
  const std::size_t first = network * layout_.size();
  const bool has_moments = !first_moments_.empty();
  return {values_.data() + first, has_moments ? first_moments_.data() + first : nullptr,
          has_moments ? second_moments_.data() + first : nullptr};
}

void PanelBank::set_parameters(std::size_t network, std::span<const float> parameters) {
  const PanelParameters own = of(network);
  for (float* values : {own.values, own.first_moments, own.second_moments}) {
    if (values != nullptr) std::fill_n(values, layout_.size(), 0.0F);
  }
  adam_steps_[network] = 0;
  layout_.for_each_parameter([&](std::size_t index, std::size_t place) { own.values[place] = parameters[index]; });
}

void PanelBank::parameters(std::size_t network, std::span<float> parameters) const {
  const float* own = values_.data() + network * layout_.size();
  layout_.for_each_parameter([&](std::size_t index, std::size_t place) { parameters[index] = own[place]; });
}

void PanelBank::evaluate(std::span<const float> inputs, std::span<float> outputs) {
  const std::size_t workers = worker_count(values_.size());
  frame_.prepare(layout_, inputs, workers);
  share_among_workers(networks_, workers, [&](std::size_t item, std::size_t worker) {
    const std::size_t network = frame_.network(item, networks_);
    HWY_DYNAMIC_DISPATCH(evaluate_frame)
    (layout_, of(network).values, frame_.inputs(), frame_.rows(worker), outputs.data() + network * layout_.outputs());
  });
}

void PanelBank::reserve(std::vector<PatternSpace>& spaces, std::size_t workers, std::size_t patterns) const {
  if (spaces.size() >= workers && spaces.front().weights.size() == patterns) return;
  spaces.assign(workers, PatternSpace(layout_, patterns));
}

void PanelBank::evaluate_batch(std::span<const float> inputs, std::span<float> outputs) {
  const std::size_t count = inputs.size() / layout_.inputs();
  const std::size_t workers = worker_count(values_.size() * count);
  const std::size_t stride = row_stride(layout_.inputs());
  reserve(block_spaces_, workers, kBlock);
  for (std::size_t first = 0; first < count; first += kPackedPatterns) {
    const std::size_t packed = std::min(kPackedPatterns, count - first);
    packed_.resize(std::max(packed_.size(), round_up(packed, kLanes) * stride));
    for (std::size_t p = 0; p < packed; ++p) {
      pack_row(inputs.subspan((first + p) * layout_.inputs(), layout_.inputs()),
               std::span(packed_).subspan(p * stride, stride));
    }
    share_among_workers(networks_, workers, [&](std::size_t network, std::size_t worker) {
      PatternSpace& own = block_spaces_[worker];
      for (std::size_t block = 0; block < packed; block += kBlock) {
        const std::size_t rows = std::min(kBlock, packed - block);
        HWY_DYNAMIC_DISPATCH(forward)
        (layout_, of(network).values, packed_.data() + block * stride, stride, round_up(rows, 8), own);
        const std::size_t top = layout_.layers().size();
        for (std::size_t p = 0; p < rows; ++p) {
          std::copy_n(own.level(top) + p * own.stride(top), layout_.outputs(),
                      &outputs[((first + block + p) * networks_ + network) * layout_.outputs()]);
        }
      }
    });
  }
}

void PanelBank::train_step(const BankBatch& batch, const BankStep& step, std::span<float> errors) {
  const std::size_t workers = worker_count(values_.size() * batch.batch);
  reserve(batch_spaces_, workers, batch.batch);
  if (step.rule == BankStep::Rule::adam) {
    first_moments_.resize(values_.size());
    second_moments_.resize(values_.size());
  }
  share_among_workers(networks_, workers, [&](std::size_t network, std::size_t worker) {
    errors[network] = train_network(batch, step, network, batch_spaces_[worker]);
  });
}

float PanelBank::train_network(const BankBatch& batch, const BankStep& step, std::size_t network, PatternSpace& space) {
  const std::size_t outputs = layout_.outputs();
  for (std::size_t p = 0; p < batch.batch; ++p) {
    const std::size_t row = batch.chosen[network * batch.batch + p];
    pack_row(batch.inputs.subspan(row * layout_.inputs(), layout_.inputs()),
             {space.level(0) + p * space.stride(0), space.stride(0)});
    std::copy_n(&batch.targets[(row * networks_ + network) * outputs], outputs, &space.targets[p * outputs]);
    const float weight = batch.weights.empty() ? 1.0F : batch.weights[network * batch.batch + p];
    space.weights[p] = weight / static_cast<float>(batch.batch);
  }
  const bool is_adam = step.rule == BankStep::Rule::adam;
  const AdamScales scales = is_adam ? adam_scales(step, ++adam_steps_[network]) : AdamScales{step.rate};
  return HWY_DYNAMIC_DISPATCH(train_patterns)(layout_, of(network), step, scales, batch.batch, space);
}

}  // namespace dermis::paper
#endif
