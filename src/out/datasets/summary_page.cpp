// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "dermis/out/datasets/summary.hpp"
#include "dermis/out/report/heat_map.hpp"
#include "dermis/out/report/page.hpp"
#include "dermis/out/report/wording.hpp"
#include "out/datasets/tally_numbers.hpp"

namespace dermis::out::datasets {
namespace {

using report::Page;
using report::Table;

constexpr std::size_t kMostEpisodes = 200;  // rows of their table

std::string duration_text(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.1f} s", seconds);
  return fmt::format("{:.1f} min", seconds / 60.0);
}

void add_tiles(Page& page, const EpisodeTally& tally) {
  double time_s = 0.0;
  for (const EpisodeSource& source : tally.sources) time_s += seconds_of(source.last - source.first);
  std::string held = "none held out";
  if (tally.held_out > 0) held = fmt::format("{} held out", report::grouped(tally.held_out));
  page.tiles({{"episodes", report::grouped(tally.episodes), held},
              {"steps", report::grouped(tally.steps), duration_text(time_s)},
              {"gaps", report::grouped(tally.gaps), "of more than 10 s; each ended an episode"}});
}

void add_arrays(Page& page, const EpisodeTally& tally) {
  page.heading("Arrays");
  Table table{.style = "numbers compact", .groups = {}, .heads = {""}, .rows = {}};
  for (const ArrayTally& array : tally.arrays) table.heads.push_back(array.name);
  const auto add = [&](const char* name, const auto& words) {
    report::Row row{std::nullopt, name, {}};
    for (const ArrayTally& array : tally.arrays) row.cells.push_back({words(array), ""});
    table.rows.push_back(std::move(row));
  };
  const auto age = [](double seconds) { return fmt::format("{:.1f} ms", 1e3 * seconds); };
  add("taxels", [](const ArrayTally& array) { return fmt::format("{}x{}", array.rows, array.cols); });
  add("lowest", [](const ArrayTally& array) { return fmt::format("{:.4g} {}", array.lowest, unit_of(array)); });
  add("highest", [](const ArrayTally& array) { return fmt::format("{:.4g} {}", array.highest, unit_of(array)); });
  add("frames", [](const ArrayTally& array) { return report::grouped(array.frames); });
  add("frames a second", [](const ArrayTally& array) { return report::three_digits(rate_of(array)); });
  add("frames in no window", [](const ArrayTally& array) { return report::grouped(array.missed); });
  add("frames without any value", [](const ArrayTally& array) { return report::grouped(array.empty_frames); });
  add("steps without a new frame", [](const ArrayTally& array) { return report::grouped(array.stale_steps); });
  add("mean age", [&](const ArrayTally& array) { return age(mean_age_s(array)); });
  add("largest age", [&](const ArrayTally& array) { return age(seconds_of(array.oldest)); });
  page.table(table);
  page.paragraph("Ages are those of the newest frame at its step.", "muted");
  page.heading("Faulty taxels");
  std::vector<report::Fact> faulty;
  for (const ArrayTally& array : tally.arrays) faulty.emplace_back(array.name, faulty_text(array));
  page.facts(faulty);
}

/// Crossed out where there is no value.
report::Drawing picture(const ArrayTally& array, const char* which, const std::vector<float>& values) {
  report::HeatMap map;
  map.title = fmt::format("{} [{}]", which, unit_of(array));
  map.rows = array.rows;
  map.cols = array.cols;
  map.values.assign(values.begin(), values.end());
  map.high = std::max(report::heat_map_high({array.first_picture.begin(), array.first_picture.end()}),
                      report::heat_map_high({array.last_picture.begin(), array.last_picture.end()}));
  return report::heat_map(map);
}

void add_pictures(Page& page, const EpisodeTally& tally) {
  page.heading("First and last picture");
  for (const ArrayTally& array : tally.arrays) {
    report::Figure figure{.file = "", .title = array.name, .caption = "", .panels = {}, .columns = 2};
    if (array.first_picture.empty()) {
      figure.caption = "No frame has a value.";
    } else {
      figure.caption = "The first frame that has values, and the newest frame of the last step.";
      figure.panels.push_back(picture(array, "first", array.first_picture));
      figure.panels.push_back(picture(array, "last", array.last_picture));
    }
    page.figure(figure);
  }
}

void add_episodes(Page& page, const EpisodeTally& tally) {
  page.heading("Episodes");
  Table table{.style = "numbers compact",
              .groups = {},
              .heads = {"episode", "recording", "steps", "time", "split"},
              .rows = {}};
  for (std::size_t k = 0; k < std::min(kMostEpisodes, tally.sources.size()); ++k) {
    const EpisodeSource& source = tally.sources[k];
    const bool is_held_out = k >= tally.episodes - tally.held_out;
    table.rows.push_back({std::nullopt,
                          std::to_string(k),
                          {{source.label.empty() ? source.recording : source.recording + ": " + source.label, ""},
                           {report::grouped(source.steps), ""},
                           {duration_text(seconds_of(source.last - source.first)), ""},
                           {is_held_out ? "val" : "train", ""}}});
  }
  page.table(table);
  if (tally.sources.size() > kMostEpisodes) {
    page.paragraph(fmt::format("The first {} of {}.", kMostEpisodes, report::grouped(tally.sources.size())), "muted");
  }
}

}  // namespace

std::string summary_page(const EpisodeTally& tally, const std::string& title) {
  Page page(title, "Dataset " + title);
  add_tiles(page, tally);
  if (!tally.how.empty()) page.facts(tally.how);
  add_arrays(page, tally);
  add_pictures(page, tally);
  add_episodes(page, tally);
  return std::move(page).html();
}

}  // namespace dermis::out::datasets
