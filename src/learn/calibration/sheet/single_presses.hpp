// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {

/// One taxel is labelled, and no other.
struct SinglePress {
  std::size_t taxel = 0;
  double newtons = 0.0;
  double temperature = 0.0;  ///< In [-1, 1] over the recording; 0 where it is not an input.
  std::vector<double> rise;  ///< Conductances above the unloaded ones [taxels] [S].
  std::vector<bool> held;    ///< At 0 S, or the taxel would conduct less than nothing [taxels].
};

/// A sheet as presses of single taxels show it.
struct SinglePresses {
  std::vector<SinglePress> presses;  ///< By taxel, the heaviest first.
  std::vector<double> sigma;         ///< A rise scatters by it from frame to frame [taxels] [S].
};

/// Nothing presses, or one taxel alone.
struct LabelledFrame {
  const CircuitFrame* frame = nullptr;
  std::size_t taxel = 0;
  double newtons = 0.0;  ///< 0: nothing presses.
};

/// Takes out of the conductances in `rise` those of frames in which nothing presses, or far away, and keeps the scatter
/// about them. `idle`: frames in which nothing presses.
void take_out_unloaded(const ArrayDescription& array, const std::vector<SinglePress>& idle, SinglePresses& single);

/// The frames of a recording in which one taxel alone is labelled, or nothing presses. Saturated presses are left out,
/// and of very many presses those that are lighter.
class LabelledPresses {
 public:
  /// Empty: no frame that can be used. `work`: frames times taxels, at most.
  static std::optional<LabelledPresses> create(const ArrayDescription& array, std::span<const RawFrame> frames,
                                               std::span<const Load> loads, Nanos settle_time, double work);

  /// So many of them, whatever their places and forces are, beside all in which nothing presses.
  [[nodiscard]] LabelledPresses some(double work) const;

  /// Unloaded conductances are those of frames in which nothing presses on the lines of a taxel and near it, by the
  /// circuit of `array`. A film over the lines feels what its cover hands on. Empty: too few frames for a word on the
  /// sheet, or a circuit that is not known or cannot give them.
  [[nodiscard]] std::optional<SinglePresses> invert(const ArrayDescription& array) const;

  /// They have labelled() among them.
  [[nodiscard]] const std::shared_ptr<const CircuitFrames>& frames() const noexcept { return circuit_; }
  [[nodiscard]] std::span<const LabelledFrame> labelled() const noexcept { return labelled_; }

 private:
  static std::vector<LabelledFrame> labelled_frames(const ArrayDescription& array, const CircuitFrames& frames,
                                                    const LoadsOfFrames& loads_of);
  static void thin_out(std::vector<LabelledFrame>& labelled, std::size_t most);

  std::shared_ptr<const CircuitFrames> circuit_;
  std::vector<LabelledFrame> labelled_;  // refers to circuit_
};

/// The presses that are affordable once.
[[nodiscard]] std::optional<SinglePresses> single_presses(const ArrayDescription& array,
                                                          std::span<const RawFrame> frames, std::span<const Load> loads,
                                                          Nanos settle_time);

}  // namespace dermis::learn::calibration
