// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/instrument_judgement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "learn/calibration/circuit_fit/circuit_doubt.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/instrument/dead_zone.hpp"
#include "learn/calibration/instrument/instrument_fit.hpp"
#include "learn/calibration/instrument/settling.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr const char* kNoPresses = "adc_offset_counts and supply_ohm cannot be told";
constexpr const char* kNothing = "adc_offset_counts and supply_ohm are nothing, as far as presses tell";

using Parts = std::vector<InstrumentPart>;

/// A finding that may be applied, and what whole calibrations with it leave of presses.
struct Applied {
  Parts parts;
  UnseenPresses unseen;
};

std::optional<UnseenPresses> errors_with(const Parts& parts, const ArrayDescription& array, const Trainable& trainable,
                                         const Proof& proof) {
  return proof.errors_of([&](std::span<const Load> kept) -> std::optional<ArrayDescription> {
    if (parts.empty()) return array;
    const Result<CircuitFrames> frames = circuit_frames(array, trainable.frames, kept, trainable.settle_time);
    if (!frames) return std::nullopt;
    std::optional<InstrumentFinding> refit = refit_instrument(array, parts, *frames);
    return refit ? std::optional(std::move(refit->array)) : std::nullopt;
  });
}

/// The parts found, one after another, that better whole calibrations. Those that leave nothing but noise of
/// idle taxels must not make them worse.
std::optional<Applied> proven(const InstrumentFindings& findings, const ArrayDescription& array,
                              const Trainable& trainable, const Proof& proof) {
  std::optional<UnseenPresses> described = errors_with({}, array, trainable, proof);
  if (!described) return std::nullopt;
  Applied best{{}, *std::move(described)};
  for (const InstrumentFinding& finding : findings.found) {
    std::optional<UnseenPresses> unseen = errors_with(finding.parts, array, trainable, proof);
    if (!unseen) continue;
    const bool is_proven =
        proof.is_better(*unseen, best.unseen) || (finding.explains_idle && proof.is_no_worse(*unseen, best.unseen));
    if (is_proven) best = {finding.parts, *std::move(unseen)};
  }
  return best;
}

/// Forces are less sure by a share that nothing explains. Says so, unless as much is said.
void doubt_all(double share, InstrumentFit& fit) {
  if (share <= fit.unexplained) return;
  fit.unexplained = share;
  fit.doubts.push_back(fmt::format(
      "presses on several taxels do not add up: calibrations that have not seen them are farther off than they say; "
      "circuit or ADC are not as described, and forces are said to be {:.1f} % less sure",
      100.0 * share));
}

/// Names what is proven, and applies it but for drivers.
void apply(Applied best, const CircuitFrames& frames, const Proof& proof, InstrumentFit& fit) {
  const ArrayDescription array = fit.array;
  const std::optional<InstrumentFinding> all = refit_instrument(array, best.parts, frames);
  if (!all) return;
  for (std::size_t k = 0; k < all->parts.size(); ++k) {
    (all->parts[k] == InstrumentPart::drivers ? fit.doubts : fit.statements).push_back(all->sentences[k]);
  }
  fit.array = all->array;
  const bool has_drivers = std::erase(best.parts, InstrumentPart::drivers) > 0;
  if (has_drivers) {
    const std::optional<InstrumentFinding> rest = refit_instrument(array, best.parts, frames);
    fit.array = rest ? rest->array : array;
  }
  fit.unexplained = all->loss_by_drivers;
  if (!has_drivers && !Proof::do_not_add_up(best.unseen)) return;
  const std::optional<UnseenPresses> by_singles = proof.errors_by_singles(fit.array);
  doubt_all(proof.unexplained_share(by_singles ? *by_singles : best.unseen), fit);
}

}  // namespace

bool asks_for_instrument(const Readout& readout) {
  return readout.adc_errors.is_unknown() || std::isnan(readout.supply_ohm.value_or(0.0));
}

ArrayDescription without_unknown_instrument(ArrayDescription array) {
  for (std::optional<double>* const value : {&array.readout.adc_errors.offset_counts, &array.readout.supply_ohm}) {
    if (std::isnan(value->value_or(0.0))) value->reset();
  }
  return array;
}

InstrumentFit fit_settling(const ArrayDescription& array, std::span<const RawFrame> frames,
                           std::span<const Load> loads) {
  InstrumentFit fit{.array = array, .statements = {}, .doubts = {}};
  std::optional<double>& settling = fit.array.readout.adc_errors.settling;
  const bool is_asked_for = settling && std::isnan(*settling);
  if (settling && !is_asked_for) return fit;
  settling.reset();
  const std::optional<SettlingEstimate> estimate = measure_settling(fit.array, frames, loads);
  if (estimate && estimate->is_significant()) {
    settling = estimate->share;
    fit.statements.push_back(fmt::format(
        "each reading keeps {:.2f} % (\u00b1 {:.2f}) of the one before it in the scan, which has not settled: "
        "undone (adc_settling)",
        100.0 * estimate->share, 100.0 * estimate->standard_error));
  } else if (is_asked_for) {
    fit.statements.push_back(estimate
                                 ? fmt::format("readings settle: {:.2f} % (\u00b1 {:.2f}) is left of the one before",
                                               100.0 * estimate->share, 100.0 * estimate->standard_error)
                                 : "adc_settling cannot be told: press at least 20 taxels, each alone");
  }
  return fit;
}

InstrumentFit judge_instrument(const ArrayDescription& array, const Trainable& trainable, bool is_asked_for) {
  InstrumentFit fit{.array = array, .statements = {}, .doubts = {}};
  if (array.readout.circuit == Circuit::none) return fit;
  const Result<CircuitFrames> frames = circuit_frames(array, trainable.frames, trainable.loads, trainable.settle_time);
  if (!frames) return fit;  // reported where they become samples, with their place
  const std::optional<std::string> dead_zone = describe_dead_zone(*frames);
  if (dead_zone) fit.doubts.push_back(*dead_zone);
  InstrumentFindings findings = find_instrument(array, *frames);
  fit.lacks_proof = findings.lacks_presses;
  if (dead_zone) findings.found.clear();
  if (!findings.found.empty() || findings.disagree) {
    const Proof proof(array, *frames, trainable);
    std::optional<Applied> best = proven(findings, array, trainable, proof);
    if (best) apply(*std::move(best), *frames, proof, fit);
  }
  if (is_asked_for && fit.statements.empty()) fit.statements.emplace_back(fit.lacks_proof ? kNoPresses : kNothing);
  return fit;
}

void doubt_circuit(const Trainable& trainable, InstrumentFit& instrument) {
  const Result<CircuitFrames> labelled =
      circuit_frames(instrument.array, trainable.frames, trainable.loads, trainable.settle_time);
  if (!labelled) return;
  const std::optional<CircuitDoubt> doubt = doubt_circuit(instrument.array, *labelled);
  if (!doubt) return;
  double share = Proof::kOfWrongCircuit;
  const Proof proof(instrument.array, *labelled, trainable);
  if (const auto described = proof.has_presses() ? errors_with({}, instrument.array, trainable, proof) : std::nullopt) {
    const auto other = errors_with({}, doubt->array, trainable, proof);
    const auto by_singles = proof.errors_by_singles(instrument.array);
    share = proof.unexplained_share(by_singles ? *by_singles : *described);
    if (!other || !proof.is_better(*other, *described)) return doubt_all(share, instrument);
  }
  instrument.doubts.push_back(doubt->sentence);
  instrument.unexplained = std::max(instrument.unexplained, share);
}

}  // namespace dermis::learn::calibration
