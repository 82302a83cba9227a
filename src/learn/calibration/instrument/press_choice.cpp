// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/press_choice.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostTaxels = 6;
constexpr std::size_t kLawPresses = 5;  // of a taxel, for its law

std::optional<Press> press_of(const CircuitFrame& frame) {
  Press press{&frame, {}, 0.0};
  for (std::size_t taxel = 0; taxel < frame.newtons.size(); ++taxel) {
    if (!(frame.newtons[taxel] > 0.0F)) continue;
    press.taxels.push_back(taxel);
    press.newtons += static_cast<double>(frame.newtons[taxel]);
  }
  for (const TotalForce& total : frame.totals) {
    press.taxels.insert(press.taxels.end(), total.taxels.begin(), total.taxels.end());
    press.newtons += total.newtons;
  }
  if (press.taxels.empty() || !(press.newtons > 0.0)) return std::nullopt;
  return press;
}

double lightest_of(const std::vector<Press>& single) {
  double lightest = std::numeric_limits<double>::infinity();
  for (const Press& press : single) lightest = std::min(lightest, press.newtons);
  return lightest;
}

/// A press on few taxels, each as heavy as single presses are: below those nobody knows the law.
bool is_well_known(const Press& press, double lightest) {
  if (press.taxels.size() > kMostTaxels) return false;
  const std::vector<float>& newtons = press.frame->newtons;
  const bool is_heavy = press.newtons >= static_cast<double>(press.taxels.size()) * lightest;
  return is_heavy && std::all_of(press.taxels.begin(), press.taxels.end(), [&](std::size_t taxel) {
           return !(static_cast<double>(newtons[taxel]) < lightest);  // not a number: the total alone is known
         });
}

std::set<std::size_t> taxels_of(std::span<const Press> presses) {
  std::set<std::size_t> taxels;
  for (const Press& press : presses) taxels.insert(press.taxels.begin(), press.taxels.end());
  return taxels;
}

void sort_by_place(std::vector<Press>& presses) {
  std::sort(presses.begin(), presses.end(), [](const Press& a, const Press& b) {
    return std::tie(a.taxels, a.newtons, a.frame->temperature, a.frame->ratio) <
           std::tie(b.taxels, b.newtons, b.frame->temperature, b.frame->ratio);
  });
}

std::vector<std::span<const Press>> by_place(std::span<const Press> sorted) {
  std::vector<std::span<const Press>> places;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t last = first + 1;
    while (last < sorted.size() && sorted[last].taxels == sorted[first].taxels) ++last;
    places.push_back(sorted.subspan(first, last - first));
    first = last;
  }
  return places;
}

/// `count` of the presses of a place, evenly over their forces. Both ends are in it; where only one is taken, each
/// place gives another.
void take_evenly(std::span<const Press> place, std::size_t number, std::size_t count, std::vector<Press>& taken) {
  for (std::size_t k = 0; k < count; ++k) {
    taken.push_back(place[count == 1 ? number % place.size() : k * (place.size() - 1) / (count - 1)]);
  }
}

/// As many of each place, as far as there are.
std::vector<Press> thinned_out(const std::vector<Press>& sorted, std::size_t most) {
  if (sorted.size() <= most) return sorted;
  const std::vector<std::span<const Press>> places = by_place(sorted);
  std::vector<Press> taken;
  if (places.size() > most) {
    for (std::size_t k = 0; k < most; ++k) take_evenly(places[k * places.size() / most], k, 1, taken);
    return taken;
  }
  std::size_t of_each = 0;
  for (std::size_t sum = 0; sum <= most;) {
    ++of_each;
    sum = 0;
    for (const auto& place : places) sum += std::min(place.size(), of_each);
  }
  --of_each;
  for (std::size_t k = 0; k < places.size(); ++k) {
    take_evenly(places[k], k, std::min(places[k].size(), of_each), taken);
  }
  return taken;
}

/// The first presses in an even order that do not press more than `most` taxels.
std::vector<Press> on_few_taxels(const std::vector<Press>& presses, std::size_t most) {
  constexpr std::size_t kRounds = 16;
  std::set<std::size_t> pressed;
  std::vector<Press> kept;
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t k = round; k < presses.size(); k += kRounds) {
      std::set<std::size_t> with_it = pressed;
      with_it.insert(presses[k].taxels.begin(), presses[k].taxels.end());
      if (with_it.size() > most) continue;
      pressed = std::move(with_it);
      kept.push_back(presses[k]);
    }
  }
  sort_by_place(kept);
  return kept;
}

/// First those of taxels whose laws the presses on several ask for.
void thin_out_single(Presses& presses, std::size_t most) {
  const std::set<std::size_t> asked = taxels_of(presses.several);
  const auto is_asked = [&](const Press& press) { return asked.contains(press.taxels.front()); };
  const auto others = std::stable_partition(presses.single.begin(), presses.single.end(), is_asked);
  const std::vector<Press> rest(others, presses.single.end());
  presses.single.erase(others, presses.single.end());
  presses.single = thinned_out(presses.single, most);
  const std::vector<Press> further = thinned_out(rest, most - presses.single.size());
  presses.single.insert(presses.single.end(), further.begin(), further.end());
}

}  // namespace

Presses sort_presses(const CircuitFrames& frames, std::size_t most) {
  Presses presses;
  for (const CircuitFrame& frame : frames.frames) {
    std::optional<Press> press = press_of(frame);
    if (!press) continue;
    (press->taxels.size() == 1 ? presses.single : presses.several).push_back(*std::move(press));
  }
  const std::set<std::size_t> alone = taxels_of(presses.single);
  const double lightest = lightest_of(presses.single);
  std::erase_if(presses.several, [&](const Press& press) {
    const bool are_alone =
        std::all_of(press.taxels.begin(), press.taxels.end(), [&](std::size_t taxel) { return alone.contains(taxel); });
    return !are_alone || !is_well_known(press, lightest);
  });
  sort_by_place(presses.single);
  sort_by_place(presses.several);
  presses.several = on_few_taxels(thinned_out(presses.several, most), most / kLawPresses);
  thin_out_single(presses, most);
  return presses;
}

std::vector<const CircuitFrame*> frames_of(const Presses& presses) {
  std::vector<const CircuitFrame*> frames;
  for (const Press& press : presses.single) frames.push_back(press.frame);
  for (const Press& press : presses.several) frames.push_back(press.frame);
  return frames;
}

}  // namespace dermis::learn::calibration
