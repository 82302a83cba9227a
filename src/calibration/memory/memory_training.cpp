// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/memory/memory_training.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "calibration/memory/load_history.hpp"
#include "calibration/memory/memory_fit.hpp"
#include "dermis/calibration/force_training.hpp"
#include "dermis/core/quantile.hpp"

namespace dermis::calibration {
namespace {

constexpr std::size_t kLeastLoads = 50;
constexpr Nanos kMostInterval = std::chrono::milliseconds(100);  // between frames
constexpr double kWorthwhile = 0.95;                             // of the error without a law
constexpr double kMostError = 1.0;                               // relative; counts as this
constexpr int kRounds = 2;                                       // of law and networks in turn
constexpr int kRoundsOfFold = 1;
constexpr std::size_t kFolds = 2;
constexpr std::size_t kPiecesOfFold = 4;  // of the recording, in time order
constexpr double kShortHoldSeconds = 5.0;
constexpr double kSameLoad = 1.03;
constexpr double kLighter = 0.9;
constexpr Nanos kOneTouch = std::chrono::seconds(1);  // between labels of one touch
constexpr Nanos kPause = std::chrono::seconds(1);     // between frames: others may be missing
constexpr fusion::MemoryLaw kStart{{0.04F, 0.04F, 0.04F, 0.04F}, {0.02F, 0.02F, 0.02F}};

/// The same samples with what the material felt under their loads: as much more or less than the load as a law that was
/// fitted to about these forces says. Loads that it does not see are unknown.
SampleDatabase felt_database(const SampleDatabase& database, const std::vector<KnownLoad>& loads,
                             const std::vector<FreedLoad>& freed) {
  SampleDatabase felt = database;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  for (Sample& sample : felt.samples) {
    sample.felt_share.assign(sample.known_newtons.size(), static_cast<float>(kUnknown));
    for (TotalForce& total : sample.totals) total.felt_share = kUnknown;
  }
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (!(std::min(freed[k].felt_newtons, freed[k].newtons) > 0.0)) continue;
    const double share = freed[k].felt_newtons / freed[k].newtons;
    Sample& sample = felt.samples[loads[k].sample];
    if (loads[k].total) {
      sample.totals[*loads[k].total].felt_share = share;
    } else {
      sample.felt_share[loads[k].taxels.front()] = static_cast<float>(share);
    }
  }
  return felt;
}

double mean_error(const std::vector<KnownLoad>& loads, const std::vector<FreedLoad>& freed) {
  double sum = 0.0;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    sum += std::min(std::abs(freed[k].newtons / loads[k].newtons - 1.0), kMostError);
  }
  return loads.empty() ? 0.0 : sum / static_cast<double>(loads.size());
}

/// Networks and a law that fit each other.
struct Fitted {
  fusion::MemoryLaw law;
  SampleDatabase felt;
  ForceTraining training;
};

/// From networks that know of no law. Empty where networks cannot be trained, or where not even the loads that it is
/// fitted to gain by a law.
std::optional<Fitted> fit(const SampleDatabase& database, const LoadHistory& history,
                          const fusion::ForceNetworks& plain, const fusion::MemoryLaw& start, int rounds) {
  const std::vector<KnownLoad> loads = known_loads(database, history);
  Fitted fitted{start, {}, {}};
  for (int round = 0; round < rounds; ++round) {
    const FeltHistory felt = felt_history(history, round == 0 ? plain : fitted.training.networks);
    fitted.law = fit_memory(felt, loads, fitted.law);
    if (memory_misfit(felt, loads, fitted.law) > kWorthwhile * memory_misfit(felt, loads, {})) return std::nullopt;
    fitted.felt = felt_database(database, loads, freed_loads(felt, loads, fitted.law));
    Result<ForceTraining> training = train_force_networks(fitted.felt);
    if (!training) return std::nullopt;
    fitted.training = std::move(*training);
  }
  return fitted;
}

/// The loads of every second piece of the recording.
std::vector<KnownLoad> loads_of_fold(const std::vector<KnownLoad>& loads, std::size_t fold) {
  constexpr std::size_t kPieces = kFolds * kPiecesOfFold;
  std::vector<KnownLoad> of_fold;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (k * kPieces / loads.size() % kFolds == fold) of_fold.push_back(loads[k]);
  }
  return of_fold;
}

SampleDatabase without(const SampleDatabase& database, const std::vector<KnownLoad>& loads) {
  std::vector<bool> is_left_out(database.samples.size());
  for (const KnownLoad& load : loads) is_left_out[load.sample] = true;
  SampleDatabase kept;
  kept.array = database.array;
  kept.siemens_per_count = database.siemens_per_count;
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    if (!is_left_out[k]) kept.samples.push_back(database.samples[k]);
  }
  return kept;
}

struct HeldOutErrors {
  double without = 0.0;
  double with = 0.0;
};

/// Of fits to the other pieces.
std::optional<HeldOutErrors> held_out_errors(const SampleDatabase& database, const LoadHistory& history,
                                             const fusion::MemoryLaw& start) {
  const std::vector<KnownLoad> loads = known_loads(database, history);
  HeldOutErrors errors;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const std::vector<KnownLoad> held_out = loads_of_fold(loads, fold);
    const SampleDatabase kept = without(database, held_out);
    const Result<ForceTraining> plain = train_force_networks(kept);
    if (!plain) return std::nullopt;
    const std::optional<Fitted> fitted = fit(kept, history, plain->networks, start, kRoundsOfFold);
    if (!fitted) return std::nullopt;
    const FeltHistory of_plain = felt_history(history, plain->networks);
    const FeltHistory felt = felt_history(history, fitted->training.networks);
    errors.without += mean_error(held_out, freed_loads(of_plain, held_out, {})) / kFolds;
    errors.with += mean_error(held_out, freed_loads(felt, held_out, fitted->law)) / kFolds;
  }
  return errors;
}

/// Each piece after a pause is told as a recording of its own, which begins earlier than the last one ended.
std::vector<Nanos> times_of_pieces(const std::vector<Nanos>& times) {
  std::vector<Nanos> of_pieces;
  Nanos begin = times.front();
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (k > 0 && times[k] - times[k - 1] > kPause) begin = times[k];
    of_pieces.push_back(times[k] - begin);
  }
  return of_pieces;
}

/// Recordings of single presses that were put together have pauses that nobody waited. So a pause counts as unknown
/// past where the loads agree better without it.
std::vector<Nanos> likelier_times(const LoadHistory& history, const std::vector<KnownLoad>& loads,
                                  const fusion::ForceNetworks& plain, const fusion::MemoryLaw& start) {
  const std::vector<Nanos> of_pieces = times_of_pieces(history.time);
  if (of_pieces.back() == history.time.back() - history.time.front()) return history.time;
  FeltHistory felt = felt_history(history, plain);
  const double misfit = memory_misfit(felt, loads, fit_memory(felt, loads, start));
  felt.time = of_pieces;
  const double misfit_of_pieces = memory_misfit(felt, loads, fit_memory(felt, loads, start));
  return misfit_of_pieces < misfit ? of_pieces : history.time;
}

/// What the recording can tell of time and of unloading.
void observe_loads(const std::vector<KnownLoad>& loads, const LoadHistory& history, LearnedMemory& memory) {
  struct Hold {
    Nanos begin{};
    Nanos last{};
    double newtons = 0.0;
  };
  std::map<std::vector<std::size_t>, Hold> holds;  // of each place
  for (const KnownLoad& load : loads) {
    const Nanos time = history.time[load.place];
    Hold& hold = holds[load.taxels];
    const bool is_one_touch = hold.newtons > 0.0 && time - hold.last <= kOneTouch;
    const auto [least, most] = std::minmax(load.newtons, hold.newtons);
    if (is_one_touch && load.newtons < kLighter * hold.newtons) memory.has_unloading = true;
    if (!is_one_touch || most > kSameLoad * least) hold = {time, time, load.newtons};
    hold.last = time;
    memory.longest_hold_seconds =
        std::max(memory.longest_hold_seconds, std::chrono::duration<double>(time - hold.begin).count());
  }
}

}  // namespace

std::string describe(const LearnedMemory& memory) {
  // What one newton is felt as, so long after it was put on.
  const auto felt_after = [&](double seconds) {
    double felt = 1.0;
    for (std::size_t k = 0; k < memory.law.creep.size(); ++k) {
      felt -= static_cast<double>(memory.law.creep[k]) * std::exp(-seconds / fusion::MemoryLaw::kCreepSeconds[k]);
    }
    return felt;
  };
  double gap = 0.0;
  for (const float share : memory.law.gap) gap += static_cast<double>(share);
  std::string text =
      fmt::format("the material remembers: a load that lies still reads {:.0f} % more after ten seconds than after one",
                  100.0 * (felt_after(10.0) / felt_after(1.0) - 1.0));
  if (gap > 0.0) text += fmt::format(", and {:.0f} % more when unloading than when loading", 100.0 * gap);
  text += fmt::format("; this is undone: loads left out are {:.1f} % off, without it {:.1f} %",
                      100.0 * memory.error_with, 100.0 * memory.error_without);
  if (memory.longest_hold_seconds < kShortHoldSeconds) {
    text += fmt::format("; no load lies still for more than {:.2g} s: what comes after is not known",
                        memory.longest_hold_seconds);
  }
  if (!memory.has_unloading) text += "; no load gets lighter without going: unloading is not known";
  return text;
}

bool is_continuous(std::span<const RawFrame> frames) {
  std::vector<Nanos> intervals;
  for (std::size_t k = 1; k < frames.size(); ++k) intervals.push_back(frames[k].time - frames[k - 1].time);
  return !intervals.empty() && upper_median(std::move(intervals)) <= kMostInterval;
}

std::optional<LearnedMemory> learn_memory(const SampleDatabase& database, std::span<const RawFrame> frames,
                                          const ForceTraining& plain) {
  Result<LoadHistory> history = read_history(database, frames);
  if (!history) return std::nullopt;
  const std::vector<KnownLoad> loads = known_loads(database, *history);
  if (loads.size() < kLeastLoads) return std::nullopt;
  LearnedMemory memory;
  observe_loads(loads, *history, memory);
  fusion::MemoryLaw start = kStart;
  if (!memory.has_unloading) start.gap = {};  // a loop of which one side was not seen would be a guess
  history->time = likelier_times(*history, loads, plain.networks, start);
  std::optional<Fitted> fitted = fit(database, *history, plain.networks, start, kRounds);
  if (!fitted) return std::nullopt;
  const std::optional<HeldOutErrors> errors = held_out_errors(database, *history, start);
  if (!errors || errors->with > kWorthwhile * errors->without) return std::nullopt;
  memory.law = fitted->law;
  memory.felt = std::move(fitted->felt);
  memory.training = std::move(fitted->training);
  memory.error_without = errors->without;
  memory.error_with = errors->with;
  return memory;
}

}  // namespace dermis::calibration
