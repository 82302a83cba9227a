// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/memory/memory_training.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/even_choice.hpp"
#include "learn/calibration/memory/memory_fit.hpp"
#include "learn/calibration/memory/siemens_history.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastLoads = 50;
constexpr Nanos kMostInterval = std::chrono::milliseconds(100);  // between frames of a continuous recording
constexpr Nanos kMostStep = std::chrono::milliseconds(1500);     // between loads that follow each other
constexpr double kWorthwhile = 0.95;                             // of the error without a law
constexpr double kMostError = 1.0;                               // relative; counts as this
constexpr int kRounds = 6;                                       // of law and networks in turn, at most
constexpr float kSameShare = 2e-3F;                              // of a law that no longer changes
constexpr int kRoundsOfFold = 1;
constexpr std::size_t kMostSharesToTry = 50'000;  // of taxels in the loads that they share
constexpr std::size_t kFolds = 2;
constexpr std::size_t kPiecesOfFold = 4;  // of the recording, in time order
constexpr double kShortHoldSeconds = 5.0;
constexpr double kSameLoad = 1.03;
constexpr double kLighter = 0.9;
constexpr Nanos kOneTouch = std::chrono::seconds(1);    // between labels of one touch
constexpr Nanos kLeastPause = std::chrono::seconds(1);  // between frames: others may be missing
constexpr int kIntervalsOfPause = 2;
constexpr touch::fusion::MemoryLaw kStart{{0.04F, 0.04F, 0.04F, 0.04F}, {0.02F, 0.02F, 0.02F}};

/// The same samples with the forces that the material felt under their loads. The ratio to the load is that of a law
/// that was fitted to about these forces. Loads that the law does not cover are unknown.
SampleDatabase material_database(const SampleDatabase& database, const std::vector<KnownLoad>& loads,
                                 const std::vector<FreedLoad>& freed) {
  SampleDatabase material = database;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  for (Sample& sample : material.samples) {
    sample.material_share.assign(sample.known_newtons.size(), static_cast<float>(kUnknown));
    for (TotalForce& total : sample.totals) total.material_share = kUnknown;
  }
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (!(std::min(freed[k].material_newtons, freed[k].newtons) > 0.0)) continue;
    const double share = freed[k].material_newtons / freed[k].newtons;
    Sample& sample = material.samples[loads[k].sample];
    if (loads[k].total) {
      sample.totals[*loads[k].total].material_share = share;
    } else {
      sample.material_share[loads[k].taxels.front()] = static_cast<float>(share);
    }
  }
  return material;
}

double mean_error(const std::vector<KnownLoad>& loads, const std::vector<FreedLoad>& freed) {
  double sum = 0.0;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    sum += std::min(std::abs(freed[k].newtons / loads[k].newtons - 1.0), kMostError);
  }
  return loads.empty() ? 0.0 : sum / static_cast<double>(loads.size());
}

SampleDatabase without(const SampleDatabase& database, const std::vector<bool>& is_left_out) {
  SampleDatabase kept;
  kept.array = database.array;
  kept.siemens_per_count = database.siemens_per_count;
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    if (!is_left_out[k]) kept.samples.push_back(database.samples[k]);
  }
  return kept;
}

/// Frames of one hold say nearly the same. So where many taxels share their loads, which makes the training slow, some
/// of them do to try a law: evenly chosen.
Result<ForceTraining> train_on_some(const SampleDatabase& database) {
  std::vector<std::size_t> shared;  // samples
  std::size_t shares = 0;
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    if (database.samples[k].totals.empty()) continue;
    shared.push_back(k);
    for (const TotalForce& total : database.samples[k].totals) shares += total.taxels.size();
  }
  if (shares <= kMostSharesToTry) return train_force_networks(database);
  std::vector<bool> is_left_out(database.samples.size());
  for (const std::size_t k : shared) is_left_out[k] = true;
  for (const std::size_t k : even_choice(shared.size(), shared.size() * kMostSharesToTry / shares + 1)) {
    is_left_out[shared[k]] = false;
  }
  return train_force_networks(without(database, is_left_out));
}

bool are_same(const touch::fusion::MemoryLaw& a, const touch::fusion::MemoryLaw& b) {
  const auto is_near = [](float x, float y) { return std::abs(x - y) < kSameShare; };
  return std::equal(a.creep.begin(), a.creep.end(), b.creep.begin(), is_near) &&
         std::equal(a.gap.begin(), a.gap.end(), b.gap.begin(), is_near);
}

/// A law, and what the material felt by it.
struct Fitted {
  touch::fusion::MemoryLaw law;
  SampleDatabase material;
};

/// From networks that know of no law, in rounds of law and networks in turn. Empty where networks cannot be trained, or
/// where not even the loads that it is fitted to gain by a law.
std::optional<Fitted> fit(const SampleDatabase& database, const SiemensHistory& history,
                          const touch::fusion::ForceNetworks& plain, const touch::fusion::MemoryLaw& start,
                          int rounds) {
  const std::vector<KnownLoad> loads = known_loads(database, history);
  Fitted fitted{start, {}};
  touch::fusion::ForceNetworks networks = plain;
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) {
      Result<ForceTraining> training = train_on_some(fitted.material);
      if (!training) return std::nullopt;
      networks = std::move(training->networks);
    }
    const MaterialHistory material = material_history(history, networks);
    const touch::fusion::MemoryLaw last = std::exchange(fitted.law, fit_memory(material, loads, fitted.law));
    if (memory_misfit(material, loads, fitted.law) > kWorthwhile * memory_misfit(material, loads, {}))
      return std::nullopt;
    fitted.material = material_database(database, loads, freed_loads(material, loads, fitted.law));
    if (round > 0 && are_same(last, fitted.law)) break;
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

struct HeldOutErrors {
  double without = 0.0;
  double with = 0.0;
};

/// The errors of fits to the other pieces.
std::optional<HeldOutErrors> held_out_errors(const SampleDatabase& database, const SiemensHistory& history,
                                             const touch::fusion::MemoryLaw& start) {
  const std::vector<KnownLoad> loads = known_loads(database, history);
  HeldOutErrors errors;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const std::vector<KnownLoad> held_out = loads_of_fold(loads, fold);
    std::vector<bool> is_left_out(database.samples.size());
    for (const KnownLoad& load : held_out) is_left_out[load.sample] = true;
    const SampleDatabase kept = without(database, is_left_out);
    const Result<ForceTraining> plain = train_on_some(kept);
    if (!plain) return std::nullopt;
    const std::optional<Fitted> fitted = fit(kept, history, plain->networks, start, kRoundsOfFold);
    if (!fitted) return std::nullopt;
    const Result<ForceTraining> training = train_on_some(fitted->material);
    if (!training) return std::nullopt;
    const MaterialHistory of_plain = material_history(history, plain->networks);
    const MaterialHistory material = material_history(history, training->networks);
    errors.without += mean_error(held_out, freed_loads(of_plain, held_out, {})) / kFolds;
    errors.with += mean_error(held_out, freed_loads(material, held_out, fitted->law)) / kFolds;
  }
  return errors;
}

Nanos usual_interval(const std::vector<Nanos>& times) {
  std::vector<Nanos> intervals;
  for (std::size_t k = 1; k < times.size(); ++k) intervals.push_back(times[k] - times[k - 1]);
  return intervals.empty() ? Nanos{} : upper_median(std::move(intervals));
}

/// Each piece after a pause counts as a recording of its own, which begins earlier than the last one ended.
std::vector<Nanos> times_of_pieces(const std::vector<Nanos>& times) {
  const Nanos pause = std::max(kLeastPause, kIntervalsOfPause * usual_interval(times));
  std::vector<Nanos> of_pieces;
  Nanos begin = times.front();
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (k > 0 && times[k] - times[k - 1] > pause) begin = times[k];
    of_pieces.push_back(times[k] - begin);
  }
  return of_pieces;
}

/// Recordings of single presses that were put together have pauses that nobody waited. So a pause counts as unknown
/// past where the loads agree better without it.
std::vector<Nanos> likelier_times(const SiemensHistory& history, const std::vector<KnownLoad>& loads,
                                  const touch::fusion::ForceNetworks& plain, const touch::fusion::MemoryLaw& start) {
  const std::vector<Nanos> of_pieces = times_of_pieces(history.time);
  if (of_pieces.back() == history.time.back() - history.time.front()) return history.time;
  MaterialHistory material = material_history(history, plain);
  const double misfit = memory_misfit(material, loads, fit_memory(material, loads, start));
  material.time = of_pieces;
  const double misfit_of_pieces = memory_misfit(material, loads, fit_memory(material, loads, start));
  return misfit_of_pieces < misfit ? of_pieces : history.time;
}

/// The evidence of the recording on time and unloading.
void observe_loads(const std::vector<KnownLoad>& loads, const SiemensHistory& history, LearnedMemory& memory) {
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

/// Some taxel is known to carry a load in both.
bool is_pressed_in_both(const Sample& before, const Sample& sample) {
  for (std::size_t taxel = 0; taxel < sample.known_newtons.size(); ++taxel) {
    if (before.known_newtons[taxel] > 0.0F && sample.known_newtons[taxel] > 0.0F) return true;
  }
  return false;
}

}  // namespace

std::string describe(const LearnedMemory& memory) {
  // The felt share of one newton, so long after it was put on.
  const auto material_after = [&](double seconds) {
    double material = 1.0;
    for (std::size_t k = 0; k < memory.law.creep.size(); ++k) {
      material -=
          static_cast<double>(memory.law.creep[k]) * std::exp(-seconds / touch::fusion::MemoryLaw::kCreepSeconds[k]);
    }
    return material;
  };
  double gap = 0.0;
  for (const float share : memory.law.gap) gap += static_cast<double>(share);
  std::string text =
      fmt::format("the material remembers: a load that lies still reads {:.0f} % more after ten seconds than after one",
                  100.0 * (material_after(10.0) / material_after(1.0) - 1.0));
  if (gap > 0.0) text += fmt::format(", and {:.0f} % more when unloading than when loading", 100.0 * gap);
  text += fmt::format("; this is undone: loads left out are {:.1f} % off, without it {:.1f} %",
                      100.0 * memory.error_with, 100.0 * memory.error_without);
  if (memory.longest_hold_seconds < kShortHoldSeconds) {
    text += fmt::format("; no load lies still for more than {:.2g} s: what comes after is not known",
                        memory.longest_hold_seconds);
  }
  if (memory.interval_seconds > std::chrono::duration<double>(kMostInterval).count()) {
    text += fmt::format("; frames are {:.2g} s apart: what comes sooner is not known", memory.interval_seconds);
  }
  if (!memory.has_unloading) text += "; no load gets lighter without going: unloading is not known";
  return text;
}

bool loads_follow_each_other(const SampleDatabase& database, std::span<const RawFrame> frames) {
  if (frames.empty()) return false;
  std::size_t following = 0;
  for (std::size_t k = 1; k < database.samples.size(); ++k) {
    const Sample& sample = database.samples[k];
    const Sample& before = database.samples[k - 1];
    const Nanos step = frames[sample.frame].time - frames[before.frame].time;
    if (step <= kMostStep && is_pressed_in_both(before, sample)) ++following;
  }
  return following >= kLeastLoads;
}

bool is_continuous(std::span<const RawFrame> frames) {
  std::vector<Nanos> times;
  for (const RawFrame& frame : frames) times.push_back(frame.time);
  return times.size() > 1 && usual_interval(times) <= kMostInterval;
}

std::optional<LearnedMemory> learn_memory(const SampleDatabase& database, std::span<const RawFrame> frames,
                                          const ForceTraining& plain) {
  Result<SiemensHistory> history = read_history(database, frames, plain.networks);
  if (!history) return std::nullopt;
  const std::vector<KnownLoad> loads = known_loads(database, *history);
  if (loads.size() < kLeastLoads) return std::nullopt;
  LearnedMemory memory;
  observe_loads(loads, *history, memory);
  memory.interval_seconds = std::chrono::duration<double>(usual_interval(history->time)).count();
  touch::fusion::MemoryLaw start = kStart;
  if (!memory.has_unloading) start.gap = {};  // a loop of which one side was not seen would be a guess
  history->time = likelier_times(*history, loads, plain.networks, start);
  std::optional<Fitted> fitted = fit(database, *history, plain.networks, start, kRounds);
  if (!fitted) return std::nullopt;
  const std::optional<HeldOutErrors> errors = held_out_errors(database, *history, start);
  if (!errors || errors->with > kWorthwhile * errors->without) return std::nullopt;
  Result<ForceTraining> training = train_force_networks(fitted->material);
  if (!training) return std::nullopt;
  memory.law = fitted->law;
  memory.material = std::move(fitted->material);
  memory.training = std::move(*training);
  memory.error_without = errors->without;
  memory.error_with = errors->with;
  return memory;
}

}  // namespace dermis::learn::calibration
