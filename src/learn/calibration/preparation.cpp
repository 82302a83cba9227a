// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/preparation.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "dermis/learn/calibration/calibrate.hpp"
#include "learn/calibration/circuit_fit/circuit_trial.hpp"
#include "learn/calibration/labels/flicker.hpp"
#include "learn/calibration/labels/label_check.hpp"
#include "learn/calibration/labels/labels.hpp"
#include "learn/calibration/labels/rail_search.hpp"
#include "learn/calibration/labels/reading_check.hpp"
#include "learn/calibration/samples/inverted_frames.hpp"
#include "learn/calibration/samples/sample_choice.hpp"
#include "learn/calibration/sheet/felt_loads.hpp"
#include "learn/calibration/sheet/film_fit.hpp"

namespace dermis::learn::calibration {
namespace {

/// Those of the frames that become samples: no more are kept in memory.
std::vector<Load> loads_of_samples(std::size_t taxels, std::span<const Load> loads, std::size_t frame_count) {
  const std::vector<bool> is_chosen = choose_samples(taxels, LoadsOfFrames(loads, frame_count));
  std::vector<Load> chosen;
  std::copy_if(loads.begin(), loads.end(), std::back_inserter(chosen),
               [&](const Load& load) { return is_chosen[load.frame]; });
  return chosen;
}

/// Takes the taxels that flicker for ones that the sheet does not have: their readings would make those of their lines
/// impossible.
std::optional<std::string> leave_out_flickering(std::span<const RawFrame> frames, std::span<const Load> loads,
                                                ArrayDescription& array) {
  const std::vector<std::size_t> taxels = find_flickering_taxels(array, frames, loads);
  if (taxels.empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const std::size_t taxel : taxels) names.push_back(array.taxel_name(taxel));
  array.absent.insert(array.absent.end(), taxels.begin(), taxels.end());
  std::sort(array.absent.begin(), array.absent.end());
  return fmt::format("{} flicker{} while nothing presses: left out as if absent; check the contact",
                     fmt::join(names, ", "), taxels.size() == 1 ? "s" : "");
}

bool has_floating_lines(const Readout& readout) {
  if (readout.circuit != Circuit::divider) return false;
  return readout.idle_rows == IdleRows::floating || readout.idle_columns == IdleColumns::floating;
}

/// A whole calibration of an array whose circuit is known.
std::optional<touch::pipeline::Model> train(const ArrayDescription& array, std::span<const RawFrame> frames,
                                            std::span<const Load> loads, Nanos settle_time) {
  const Result<SampleDatabase> database = invert_frames(array, frames, loads, settle_time, {}, {});
  if (!database) return std::nullopt;
  Result<Calibration> calibration = calibrate(*database, frames);
  return calibration ? std::optional(std::move(calibration->model)) : std::nullopt;
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Preparation::Preparation(const ArrayDescription& array, std::span<const RawFrame> frames, std::span<const Load> loads,
                         Nanos settle_time)
    : described_(array), frames_(frames), loads_(loads), settle_time_(settle_time), known_(array) {}

Status Preparation::check_labels() {
  if (Status checked = check_loads(described_, frames_.size(), loads_); !checked) return checked;
  if (Status checked = check_readings(described_, frames_, loads_); !checked) return checked;
  if (auto flickering = leave_out_flickering(frames_, loads_, known_)) remarks_.push_back(*std::move(flickering));
  const LabelCheck labels = calibration::check_labels(known_, frames_, loads_, settle_time_);
  if (labels.turn) return bad_input(*labels.turn);
  append(remarks_, labels.remarks);
  if (labels.pressed_frames.empty()) return Done{};
  std::copy_if(loads_.begin(), loads_.end(), std::back_inserter(kept_),
               [&](const Load& load) { return !labels.is_pressed(load.frame); });
  loads_ = kept_;
  return Done{};
}

void Preparation::find_rail() {
  if (known_.readout.rail_counts) return;
  known_.readout.rail_counts = calibration::find_rail(known_, frames_, loads_);
  if (!known_.readout.rail_counts) return;
  remarks_.push_back(
      fmt::format("readings end at {} counts under whatever load: taken for saturated there (rail_counts)",
                  *known_.readout.rail_counts));
}

void Preparation::find_settling() {
  chosen_ = loads_of_samples(described_.taxel_count(), loads_, frames_.size());
  InstrumentFit settling = fit_settling(known_, frames_, chosen_);
  append(remarks_, settling.statements);
  asks_for_instrument_ = calibration::asks_for_instrument(settling.array.readout);
  known_ = without_unknown_instrument(std::move(settling.array));
  if (!known_.readout.film || !known_.readout.film->is_unknown()) return;
  lacking_film_ = "";
  known_.readout.film.reset();
}

void Preparation::take_cover(const std::optional<Cover>& cover) {
  known_.cover = cover;
  felt_ = cover ? well_felt_loads(known_, surface_) : std::vector<Load>{};
  loads_ = cover ? std::span<const Load>(felt_) : surface_;
  chosen_ = loads_of_samples(described_.taxel_count(), loads_, frames_.size());
}

void Preparation::find_cover() {
  surface_ = loads_;
  if (known_.cover && !known_.cover->is_unknown()) return take_cover(known_.cover);
  cover_ = fit_cover(known_, frames_, surface_, settle_time_);
  take_cover(cover_.cover);
}

/// A film under floating lines that explains what is read also confirms their circuit.
Status Preparation::find_circuit() {
  if (!known_.has_unknown_circuit()) {
    if (!has_floating_lines(described_.readout)) return Done{};
    find_film();
    if (known_.readout.film) return Done{};
  }
  Result<CircuitFit> fit = fit_circuit(known_, frames_, loads_, settle_time_);
  if (!fit) return fit.error();
  known_ = fit->array;
  if (!fit->statements.empty()) circuit_ = *std::move(fit);
  if (cover_.is_guessed) {
    cover_ = fit_cover(known_, frames_, surface_, settle_time_);
    take_cover(cover_.cover);
  }
  return Done{};
}

/// A film feels what a cover hands on, and looks like one where lines float: it comes first.
void Preparation::find_film() {
  if (known_.readout.film || known_.readout.circuit == Circuit::none) return;
  const bool is_cover_told = described_.cover && !described_.cover->is_unknown();
  ArrayDescription array = known_;
  if (!is_cover_told) array.cover.reset();
  const FilmFit film = fit_film(array, frames_, surface_, settle_time_);
  known_.readout.film = film.film;
  if (film.film && !is_cover_told) {
    known_.cover = film.cover;
    cover_ = fit_cover(known_, frames_, surface_, settle_time_);
    take_cover(cover_.cover);
  }
  if (film.film) remarks_.push_back(film.sentence);
  if (lacking_film_) lacking_film_ = film.sentence;
}

Trainable Preparation::trainable() const {
  return {frames_, chosen_, settle_time_, [this](const ArrayDescription& array, std::span<const Load> kept) {
            return train(array, frames_, kept, settle_time_);
          }};
}

void Preparation::judge_instrument() {
  instrument_ = calibration::judge_instrument(known_, trainable(), asks_for_instrument_);
  append(remarks_, instrument_.statements);
  known_ = instrument_.array;
}

/// Not where a film that was found confirms it: under films other circuits with floating lines take long to try.
void Preparation::doubt_circuit() {
  const bool is_confirmed = has_floating_lines(described_.readout) && known_.readout.film &&
                            (!described_.readout.film || described_.readout.film->is_unknown());
  if (is_confirmed) return;
  if (described_.readout.circuit != Circuit::automatic) calibration::doubt_circuit(trainable(), instrument_);
}

Result<SampleDatabase> Preparation::invert(const std::function<void(double)>& progress) {
  const auto invert_as_found = [&] {
    return invert_frames(instrument_.array, frames_, loads_, settle_time_, instrument_.doubts, progress);
  };
  Result<SampleDatabase> database = invert_as_found();
  if (!database && described_.readout.circuit == Circuit::automatic && known_.readout.circuit != Circuit::none) {
    circuit_->statements.push_back("the circuit that was found does not do: " + database.error().message +
                                   "; readings are taken as they are");
    circuit_->array = without_circuit(known_);
    instrument_.array = circuit_->array;
    database = invert_as_found();
  }
  if (!database) return database;
  database->lacks_proof = instrument_.lacks_proof;
  database->unexplained_share = instrument_.unexplained;
  database->circuit_fit = std::move(circuit_);
  database->cover_error = cover_.error;
  if (!cover_.sentence.empty()) remarks_.push_back(cover_.sentence);
  if (lacking_film_ && !known_.readout.film) {
    constexpr const char* kNone = "no film conducts between the lines, as far as presses tell";
    remarks_.push_back(lacking_film_->empty() ? kNone : *lacking_film_);
  }
  std::move(remarks_.begin(), remarks_.end(), std::back_inserter(database->remarks));
  return database;
}

}  // namespace dermis::learn::calibration
