// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/summary.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "dermis/touch/frames/array_description.hpp"
#include "out/datasets/tally_numbers.hpp"

namespace dermis::out::datasets {
namespace {

using Json = nlohmann::ordered_json;

std::string named(const ArrayTally& array, const std::vector<std::size_t>& taxels) {
  constexpr std::size_t kMostNames = 8;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(kMostNames, taxels.size()); ++k) {
    names.push_back(taxel_name(taxels[k] / array.cols, taxels[k] % array.cols));
  }
  const std::size_t more = taxels.size() - names.size();
  return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// true where a taxel is one of these [rows, cols].
Json mask_of(const ArrayTally& array, const std::vector<std::size_t>& taxels) {
  Json mask = Json::array();
  for (std::size_t row = 0; row < array.rows; ++row) mask.push_back(Json(std::vector<bool>(array.cols)));
  for (const std::size_t taxel : taxels) mask[taxel / array.cols][taxel % array.cols] = true;
  return mask;
}

Json array_json(const ArrayTally& array) {
  FaultyTaxels faulty = faulty_taxels(array);
  const Json always = mask_of(array, faulty.always);
  faulty.sometimes.insert(faulty.sometimes.end(), faulty.always.begin(), faulty.always.end());
  return {{"unit", unit_of(array)},
          {"frames", array.frames},
          {"frames_a_second", rate_of(array)},
          {"frames_in_no_window", array.missed},
          {"frames_without_any_value", array.empty_frames},
          {"mean_age_s", mean_age_s(array)},
          {"largest_age_s", seconds_of(array.oldest)},
          {"steps_without_a_new_frame", array.stale_steps},
          {"lowest", array.lowest},
          {"highest", array.highest},
          {"always_faulty", always},
          {"ever_faulty", mask_of(array, faulty.sometimes)}};
}

}  // namespace

FaultyTaxels faulty_taxels(const ArrayTally& array) {
  FaultyTaxels faulty;
  for (std::size_t k = 0; k < array.invalid.size(); ++k) {
    if (array.invalid[k] == 0) continue;
    const bool is_always = array.invalid[k] == array.frames - array.late_frames - array.empty_frames;
    (is_always ? faulty.always : faulty.sometimes).push_back(k);
  }
  return faulty;
}

std::string faulty_text(const ArrayTally& array) {
  const FaultyTaxels faulty = faulty_taxels(array);
  if (faulty.always.empty() && faulty.sometimes.empty()) return "none";
  std::vector<std::string> parts;
  if (!faulty.always.empty()) parts.push_back(named(array, faulty.always) + " always");
  if (!faulty.sometimes.empty()) parts.push_back(named(array, faulty.sometimes) + " at times");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string split_text(const EpisodeTally& tally, bool held_out) {
  const std::uint64_t trained = tally.episodes - tally.held_out;
  return held_out ? fmt::format("{}:{}", trained, tally.episodes) : fmt::format("0:{}", trained);
}

std::vector<std::string> summary_lines(const EpisodeTally& tally) {
  std::vector<std::string> lines;
  if (tally.held_out > 0) {
    const std::uint64_t first = tally.episodes - tally.held_out;
    lines.push_back(tally.held_out == 1 ? fmt::format("held out: episode {}", first)
                                        : fmt::format("held out: episodes {} to {}", first, tally.episodes - 1));
  }
  if (tally.gaps > 0) {
    lines.push_back(fmt::format("{} gap{} of more than 10 s ended an episode", tally.gaps, tally.gaps == 1 ? "" : "s"));
  }
  for (const ArrayTally& array : tally.arrays) {
    const std::string faulty = faulty_text(array);
    lines.push_back(fmt::format(
        "{}: {}x{}, {:.4g} to {:.4g} {}, {:.3g} frames a second, the newest {:.3g} ms old "
        "(at most {:.3g} ms){}",
        array.name, array.rows, array.cols, array.lowest, array.highest, unit_of(array), rate_of(array),
        1e3 * mean_age_s(array), 1e3 * seconds_of(array.oldest), faulty == "none" ? "" : "; faulty: " + faulty));
  }
  return lines;
}

std::string summary_json(const EpisodeTally& tally) {
  Json arrays = Json::object();
  for (const ArrayTally& array : tally.arrays) arrays[array.name] = array_json(array);
  Json episodes = Json::array();
  for (const EpisodeSource& source : tally.sources) {
    episodes.push_back({{"recording", source.recording},
                        {"steps", source.steps},
                        {"first_ns", source.first.count()},
                        {"last_ns", source.last.count()}});
    if (!source.label.empty()) episodes.back()["label"] = source.label;
  }
  Json splits = {{"train", split_text(tally, false)}};
  if (tally.held_out > 0) splits["val"] = split_text(tally, true);
  // Names of recordings may be bytes that are not UTF-8.
  Json how = Json::object();
  for (const auto& [name, words] : tally.how) how[name] = words;
  Json all = {{"how", how},       {"steps", tally.steps}, {"gaps", tally.gaps},
              {"splits", splits}, {"arrays", arrays},     {"episodes", episodes}};
  if (!tally.labels.empty()) all["labels"] = tally.labels;
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace dermis::out::datasets
