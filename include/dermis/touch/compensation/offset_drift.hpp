// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/unloaded_law.hpp"

namespace dermis::touch::compensation {

/// The unloaded state of the taxels as calibration knows it.
struct UnloadedConductance {
  UnloadedLaw law;
  std::vector<double> sigma_siemens;  ///< Standard deviation of law.offset_siemens [taxels] [S].
};

struct OffsetDriftOptions {
  bool track = false;  ///< Follow the idle taxels; off: only tare() moves the offsets.
};

/// More than this share of its unloaded conductance, no drift adds to a taxel.
inline constexpr double kMostDriftOfUnloaded = 0.5;

/// The change that a tare found from the zero before it [taxels].
struct TareStep {
  std::vector<double> siemens;                ///< Only where it is more than noise [S], >= 0.
  std::vector<std::uint8_t> is_beyond_drift;  ///< 1: more than kMostDriftOfUnloaded u beside the noise.
};

/// Keeps zero at zero. It subtracts from each conductance the change of the unloaded taxel since calibration, by an
/// explicit tare and by following idle taxels slowly. Let u be the unloaded conductance of the taxel (calibration and
/// tare) and s the 1-sigma of a reading. Means over 1 s of n frames decide:
///
/// band       0.1 u + 3 sigma_offset + 5 s / sqrt(min(n, 25))
/// idle       within the band around the tracked offset; or below both this and the calibration, where no load can be
/// pressed    above the band: the taxel and its 8 neighbours are not followed until 10 s after the last pressed second,
///            for rubber creeps back
/// followed   with the mean of a second that lies between idle ones, with a time constant of 30 s, after the first 30 s
///            by no more than 0.01 u + 0.1 s a minute, and in all to at most 0.5 u + 3 (s + sigma_offset) above the
///            offset of the calibration or the last tare
///
/// So a load above the band is never absorbed, however long it lasts. A load that grows into the band by more than 0.02
/// u + 0.2 s a minute loses less than the band. No load loses more than the range. The calibration corrects for
/// temperature meanwhile. Without tracking and tare, frames pass unchanged. Not thread-safe: one per stream.
class OffsetDrift {
 public:
  /// The vectors of `unloaded` have the size of `shape` and hold numbers.
  OffsetDrift(const FrameShape& shape, UnloadedConductance unloaded, const OffsetDriftOptions& options = {});
  OffsetDrift(OffsetDrift&&) noexcept;
  OffsetDrift& operator=(OffsetDrift&&) noexcept;
  ~OffsetDrift();

  /// observe() and correct(). Allocates nothing, as they.
  void process(ConductanceFrame& frame) noexcept;
  /// Learns of zero from a frame that is not corrected yet. True where this ends a tare.
  [[nodiscard]] bool observe(const ConductanceFrame& frame) noexcept;
  /// Corrects `frame.siemens` in place; rejected frames pass.
  void correct(ConductanceFrame& frame) const noexcept;

  /// Takes the mean of every taxel over the next second as its zero, whatever it is. If 10 frames take longer, it waits
  /// for them, at most 10 s. A taxel that has not changed beyond the noise of that mean keeps its offset.
  void tare() noexcept;
  [[nodiscard]] bool taring() const noexcept;
  /// The step of the last tare that has ended.
  [[nodiscard]] const TareStep& tare_step() const noexcept;
  /// Back to the offsets before the last tare that has ended; also ends a tare in progress.
  void undo_tare() noexcept;
  /// Begins at the offsets of an earlier tare [taxels] [S], which are finite.
  void use_offsets(std::span<const double> offsets) noexcept;
  /// Back to the offsets of the calibration; also ends a tare in progress.
  void reset() noexcept;

  void set_options(const OffsetDriftOptions& options) noexcept;
  [[nodiscard]] const OffsetDriftOptions& options() const noexcept;

  /// The offsets that are subtracted now, [rows, cols] [S].
  [[nodiscard]] std::span<const double> offsets() const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::touch::compensation
