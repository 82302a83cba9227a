// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "dermis/touch/compensation/line_fault.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::touch::compensation {

/// The conductances of the taxels by the calibration.
struct ReferenceConductances {
  std::span<const double> typical = {};   ///< Under one same force, in any unit; > 0 [rows, cols], or empty.
  std::span<const double> unloaded = {};  ///< [S], 0 or less where it is not known [rows, cols], or empty.
  std::span<const LoadPoint> loads = {};  ///< Rising, or empty; `typical` is in S then. A film follows these loads.
};

struct InversionOptions {
  /// A frame is solved once its certificate is this good (InversionResult::residual_ratio), >= 0; 0: to rounding.
  /// Empty: a hundredth of a count of the ADC, far below its noise.
  std::optional<double> tolerance_ratio;
  /// Floating lines and lines with resistance: twelve samples give the noise of each taxel to a fifth. Otherwise it is
  /// exact up to 400 taxels, which takes rows^3 cols^3 multiplications a frame.
  bool samples_noise = false;
  /// Floating lines and lines with resistance: steps of Newton's method on a frame before it counts as unsolved, >= 1.
  /// Readings that have a solution mostly take 1 to 20. Empty: as long as they converge, on large arrays for seconds.
  std::optional<int> most_steps = std::nullopt;
  /// propagate_noise() adds the effect of the drivers' error, readout.drive_error_ohm.
  bool counts_driver_errors = false;
  /// The steps of one frame are few: start_frame() allows what the frames before have saved. Otherwise each call of
  /// invert() goes on as long as it converges.
  bool is_bounded = false;
  /// By which a film under load (Readout::film) is found from the taxels' conductances. To outlive the making only.
  ReferenceConductances references = {};
};

/// How the inversion of a frame ended.
struct InversionResult {
  bool solved = false;  ///< Within the tolerance, and possible in this circuit.
  /// Certificate: no reading differs from the circuit's reading at `siemens` by more than this. Where a taxel is held
  /// at 0 S its reading may lie below the circuit's by more.
  double residual_ratio = 0.0;
  bool cut_short = false;  ///< Not solved, as the work that the frame may take was done. The next begins there.
};

/// Inverts one kind of readout circuit: readings with crosstalk -> the conductance of every taxel. A new circuit is a
/// new class behind make_crosstalk_inversion(); the pipeline does not change. Not thread-safe: one per thread.
class CrosstalkInversion {
 public:
  CrosstalkInversion() = default;
  CrosstalkInversion(const CrosstalkInversion&) = delete;
  CrosstalkInversion& operator=(const CrosstalkInversion&) = delete;
  virtual ~CrosstalkInversion() = default;

  /// ratio [rows, cols] (reading / supply) -> siemens [rows, cols], finite and >= 0. Starts from the last frame's
  /// solution where there is one. A reading below what the neighbours alone explain gives 0 S. Where a reading is not a
  /// number (NaN), the taxel keeps its conductance in `siemens`, finite and >= 0, and the others are solved with it.
  /// Where the readings have no solution in this circuit, or are infinite, `solved` is false and `siemens` holds the
  /// best attempt. Allocates nothing.
  [[nodiscard]] virtual InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept = 0;

  /// The next calls of invert() are of the frame at `time`. Whether those before have left enough for several attempts.
  virtual bool start_frame(Nanos /*time*/) noexcept { return true; }

  /// They together may take this share of what is left of the work that the frame may take.
  virtual void start_attempt(double /*share*/) noexcept {}

  /// From the next frame on, the row and the column of each of these taxels are one node, and their own conductances
  /// are not solved. A second call replaces the first. false: this circuit is not solved so. The taxels are to be kept
  /// at the conductance of a short, or none of their readings used. Allocates nothing.
  [[nodiscard]] virtual bool set_shorted(std::span<const std::size_t> taxels) noexcept { return taxels.empty(); }

  /// From the next frame on, these lines are broken: silent, at the supply, or joined with the next one. The readings
  /// of silent lines and of columns at the supply are not used, those of joined lines must agree. A second call
  /// replaces the first; other kinds of fault do not matter. false: this circuit is not solved so. Allocates nothing.
  [[nodiscard]] virtual bool set_broken(std::span<const LineFault> faults) noexcept { return faults.empty(); }

  /// The array has this film until further notice: its loads are known. Without a call it has the film that its taxels'
  /// conductances tell by InversionOptions::references, or an unloaded one. Arrays without a film do not listen.
  virtual void hold_film(const FilmConductances& /*film*/) noexcept {}

  /// Forgets the last frame: the next one does not depend on it, not in the last bit.
  virtual void forget() noexcept {}

  /// Standard deviation of every taxel [rows, cols] of the last solved frame, to first order. Each reading has
  /// independent noise of standard deviation `sigma_ratio`. Allocates nothing.
  virtual void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept = 0;

  /// Rise of an unloaded taxel's conductance for a rise of its ratio [S], the largest of all sensed lines. It turns the
  /// noise of a reading into that of a conductance.
  [[nodiscard]] virtual double siemens_per_ratio() const noexcept = 0;
};

/// The inversion for the array's circuit. Errors: a circuit with unknown resistances.
[[nodiscard]] Result<std::unique_ptr<CrosstalkInversion>> make_crosstalk_inversion(
    const ArrayDescription& array, const InversionOptions& options = {});

class FaultInversion;
class PossibleReadings;
class SharedErrors;
class Spikes;
class SupplyError;

/// Unit 3 of the paper, the Compensation Unit: it corrects data "that deviate from the actual values by a known
/// relationship" by that relationship. Not thread-safe: one per stream.
class Compensator {
 public:
  [[nodiscard]] static Result<Compensator> create(const ArrayDescription& array,
                                                  const ReferenceConductances& references = {});
  Compensator(Compensator&&) noexcept;
  Compensator& operator=(Compensator&&) noexcept;
  ~Compensator();

  /// From the next frame on, masks the taxels that these faults spoil (TaxelStatus::line_fault) and solves the rest
  /// with the faults in the circuit. An empty list ends this. Allocates nothing.
  void set_faults(std::span<const LineFault> faults);

  /// Taxels without a reading (TaxelStatus::invalid) are estimated from their neighbours, so that the others are
  /// solved. So are spikes, and readings that the circuit cannot give, whatever the taxels are; they become invalid.
  /// A jump that may be a spike keeps its conductance, with a sigma that says so (FrameStatus::doubtful). If it has no
  /// solution with the saturated taxels (at most half), or with the largest readings, these follow. A frame that is cut
  /// short near its solution has a sigma that covers what is left, and is doubtful, too. Allocates nothing
  /// once `conductance` has the array's size.
  void process(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept;

  /// See CrosstalkInversion.
  void hold_film(const FilmConductances& film) noexcept;
  void forget() noexcept;
  [[nodiscard]] double siemens_per_ratio() const noexcept { return inversion_->siemens_per_ratio(); }

 private:
  Compensator(const ArrayDescription& array, std::unique_ptr<CrosstalkInversion> inversion,
              const ReferenceConductances& references);
  InversionResult attempt(const ConditionedFrame& conditioned, ConductanceFrame& conductance, bool is_first) noexcept;
  InversionResult invert(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept;
  InversionResult invert_possible(const ConditionedFrame& conditioned, ConductanceFrame& conductance) noexcept;
  void prepare_errors(std::size_t taxels, ConductanceErrors& errors) const noexcept;
  void note_errors(const ConditionedFrame& conditioned, double sigma_ratio,
                   ConductanceFrame& conductance) const noexcept;
  void mask_faulty_taxels(ConductanceFrame& conductance) const noexcept;

  std::unique_ptr<CrosstalkInversion> inversion_;
  std::unique_ptr<PossibleReadings> possible_;
  std::unique_ptr<Spikes> spikes_;
  std::unique_ptr<SupplyError> supply_error_;
  std::shared_ptr<const SharedErrors> shared_errors_;
  std::unique_ptr<FaultInversion> faults_;
  int solving_attempt_ = 0;  // of the last frame
  int frames_begun_ = 0;     // where work was scarce
};

}  // namespace dermis::touch::compensation
