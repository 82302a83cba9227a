// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/paper_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/out/report/estimator_table.hpp"
#include "dermis/out/report/files.hpp"
#include "dermis/out/report/page.hpp"
#include "dermis/out/report/wording.hpp"
#include "paper/report/paper_claims.hpp"
#include "paper/report/paper_figures.hpp"
#include "paper/report/paper_points.hpp"

namespace dermis::paper {

using out::report::Cell;
using out::report::counted;
using out::report::Fact;
using out::report::Figure;
using out::report::fine_percent;
using out::report::grouped;
using out::report::kPaperTolerance;
using out::report::Page;
using out::report::percent;
using out::report::Row;
using out::report::Table;
using out::report::three_digits;
using out::report::Tile;

namespace {

struct Figures {
  Figure peaks_network;
  Figure peaks_surface;
  Figure peaks_maps;
  Figure peaks_training;
  Figure hidden_units;
  Figure bank_network;
  Figure log_sigmoid;
  Figure convergence;
  Figure bank_training;
  std::vector<Figure> points;
};

Figures all_figures(const PaperReproduction& reproduction) {
  const PeaksReproduction& peaks = reproduction.peaks;
  return {peaks_network_figure(),
          peaks_surface_figure(peaks),
          peaks_maps_figure(peaks),
          peaks_training_figure(peaks),
          hidden_units_figure(peaks),
          bank_network_figure(reproduction.rows * reproduction.cols),
          log_sigmoid_figure(),
          convergence_figure(reproduction),
          bank_training_figure(reproduction),
          point_figures(reproduction)};
}

// The summary.

Tile peaks_tile(const PeaksReproduction& peaks) {
  const std::string name = "Peaks by 2-5-1, traingdx: E";
  if (peaks.adaptive_rate_starts == 0) return {name, "-", "not judged"};
  const double mse = peaks.adaptive_rate_best_mse;
  return {name, three_digits(mse),
          fmt::format("goal {:.3g}: {}", peaks.goal, mse > 0.0 && mse <= peaks.goal ? "reached" : "not reached")};
}

Tile hidden_tile(const PeaksReproduction& peaks) {
  const auto words = [](const std::optional<std::size_t>& hidden) { return hidden ? std::to_string(*hidden) : "none"; };
  const std::string name = "hidden units for the goal";
  if (peaks.by_hidden.empty()) return {name, "-", "not judged"};
  return {name, words(peaks.smallest_hidden_raw),
          fmt::format("targets in [0, 1]: {}; the\u00a0paper:\u00a05", words(peaks.smallest_hidden_normalised))};
}

Tile unknowns_tile(const PaperReproduction& reproduction) {
  const std::string name = "unknowns of the bank";
  if (reproduction.unknowns == 0) return {name, "-", "not counted"};
  return {name, grouped(reproduction.unknowns),
          reproduction.unknowns == kPaperUnknowns ? "as the paper says" : "the paper: " + grouped(kPaperUnknowns)};
}

Tile error_tile(const PaperReproduction& reproduction, std::string name, PointError error) {
  if (reproduction.points.empty()) return {std::move(name), "-", "not judged"};
  return {std::move(name), percent(worst_error(reproduction.points, error)), worst_by_level(reproduction, error)};
}

std::string count_of(const std::vector<Claim>& claims, Verdict verdict, const char* one, const char* many) {
  const auto count =
      std::count_if(claims.begin(), claims.end(), [&](const Claim& claim) { return claim.verdict == verdict; });
  return count == 0 ? "" : fmt::format("{} {}", count, count == 1 ? one : many);
}

/// "Of 10 statements of the paper, 5 hold, 4 do not hold and 1 cannot be judged."
std::string verdict_sentence(const std::vector<Claim>& claims) {
  std::vector<std::string> parts = {
      count_of(claims, Verdict::holds, "holds", "hold"),
      count_of(claims, Verdict::holds_scaled, "holds on scaled targets only", "hold on scaled targets only"),
      count_of(claims, Verdict::fails, "does not hold", "do not hold"),
      count_of(claims, Verdict::open, "is not judged", "are not judged")};
  std::erase(parts, "");
  std::string sentence = fmt::format("Of {} statements, ", claims.size()) + parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) sentence += (i + 1 < parts.size() ? ", " : " and ") + parts[i];
  return sentence + ".";
}

Table claims_table(const std::vector<Claim>& claims) {
  Table table{"claims", {}, {"where", "the paper says", "found", "verdict"}, {}};
  for (const Claim& claim : claims) {
    table.rows.push_back(
        {std::nullopt, claim.where, {{claim.claimed, ""}, {claim.found, ""}, {to_words(claim.verdict), "verdict"}}});
  }
  return table;
}

void add_summary(Page& page, const PaperReproduction& reproduction) {
  const std::vector<Claim> claims = judge(reproduction);
  page.paragraph(
      "\u201cIntelligent Fusion Method Based on BP Neural Network for Robot Suit Pressure Sensing Array Data\u201d, "
      "point by point.",
      "muted");
  page.tiles({peaks_tile(reproduction.peaks), hidden_tile(reproduction.peaks), unknowns_tile(reproduction),
              error_tile(reproduction, "largest error: bank", bank_error),
              error_tile(reproduction, "largest error: dermis", dermis_error)});
  page.paragraph(
      fmt::format("Everything here was computed from the paper's equations, with its measurements replaced by a "
                  "simulated array of {} x {} taxels: the paper does not list them. {}",
                  reproduction.rows, reproduction.cols, verdict_sentence(claims)));
  page.heading("What the paper says, and what was found");
  page.table(claims_table(claims));
}

// Peaks.

std::string positive(double value) {
  return value > 0.0 ? three_digits(value) : "-";
}

Table hidden_table(const PeaksReproduction& peaks) {
  Table table{"numbers compact",
              {{"", 1}, {"best E, eq. (2)", 2}},
              {"hidden units", "starts", "in the units of Peaks", "targets in [0, 1]"},
              {}};
  const auto style = [&](double mse) { return mse > 0.0 && mse <= peaks.goal ? "best" : ""; };
  for (const HiddenLayerFit& fit : peaks.by_hidden) {
    table.rows.push_back({std::nullopt,
                          std::to_string(fit.hidden),
                          {{grouped(fit.starts), ""},
                           {positive(fit.best_mse), style(fit.best_mse)},
                           {positive(fit.best_mse_normalised), style(fit.best_mse_normalised)}}});
  }
  return table;
}

void add_peaks(Page& page, const PeaksReproduction& peaks, const Figures& figures) {
  page.heading("Peaks: eq. (1) and (2), Fig. 5 and 6");
  page.figures({figures.peaks_network, figures.peaks_surface});
  page.figure(figures.peaks_maps);
  page.figures({figures.peaks_training, figures.hidden_units});
  if (peaks.by_hidden.empty()) return;
  page.table(hidden_table(peaks));
  page.paragraph("Bold: the goal is reached. The starts of a size end soon after one has reached it.", "note");
}

// The bank and its start.

Table unknowns_table(const PaperReproduction& reproduction) {
  const UnknownCount count = count_unknowns(reproduction.rows * reproduction.cols);
  const auto row = [&](const char* name, const char* formula, std::size_t all) {
    return Row{std::nullopt, name, {{formula, ""}, {grouped(all / count.n), ""}, {grouped(all), ""}}};
  };
  Table table{"numbers compact",
              {},
              {"unknowns", "formula", "one network", fmt::format("all {} networks", grouped(count.n))},
              {}};
  table.rows = {row("connections", "2N\u00b3 + N\u00b2", count.connections),
                row("thresholds", "2N\u00b2 + N", count.thresholds),
                row("together", "2N\u00b3 + 3N\u00b2 + N", count.connections + count.thresholds)};
  if (reproduction.unknowns > 0) {
    table.rows.push_back(
        {std::nullopt, "counted in the bank", {{"", ""}, {"", ""}, {grouped(reproduction.unknowns), "best"}}});
  }
  return table;
}

std::string signed_digits(double value) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.5g}", value + 0.0);
}

Table start_table(const std::vector<StartSystem>& systems) {
  Table table{"numbers compact",
              {},
              {"system", "position", "neighbours", "\u03c9_A or \u03c9", "\u03c9_B", "\u03c9_C", "\u03b8", "deviation"},
              {}};
  const auto optional = [](const std::optional<double>& value) { return value ? signed_digits(*value) : "-"; };
  for (const StartSystem& system : systems) {
    table.rows.push_back({std::nullopt,
                          system.equation,
                          {{system.where, ""},
                           {system.neighbour ? std::to_string(system.neighbours) : "-", ""},
                           {signed_digits(system.same), ""},
                           {optional(system.neighbour), ""},
                           {optional(system.other), ""},
                           {signed_digits(system.threshold), ""},
                           {three_digits(system.residual), ""}}});
  }
  return table;
}

void add_bank(Page& page, const PaperReproduction& reproduction, const Figures& figures) {
  page.heading("The bank of networks: eq. (3) to (6), Fig. 8 and 10");
  page.figures({figures.bank_network, figures.log_sigmoid});
  page.table(unknowns_table(reproduction));
  page.paragraph(
      "The paper's count is that of N networks N-N-N-1, not of one: its 2N\u00b3 + N\u00b2 connections are N times "
      "N\u00b2 + "
      "N\u00b2 + N.",
      "note");
  page.heading("The structured start: eq. (7) to (15), Fig. 9");
  if (reproduction.start.empty()) {
    page.paragraph("The systems of the structured start were not solved.");
  } else {
    page.table(start_table(reproduction.start));
    page.paragraph(
        "Inputs are scaled to 0 ... 1, so that x_max is 1. Deviation: the largest by which the solution misses the "
        "printed equations. At an edge a position has five neighbours and in a corner three; the paper has eight "
        "throughout.",
        "note");
  }
  page.figures({figures.convergence, figures.bank_training});
}

// Fig. 11 to 13.

Table level_table(const PaperReproduction& reproduction) {
  Table table{
      "numbers",
      {{"", 1}, {"mean voltage [V]", 2}, {"the paper's bank", 2}, {"dermis", 2}},
      {"force", "points", "output", "calibration", "largest error", "within 5 %", "largest error", "within 5 %"},
      {}};
  for (const PaperLevel& level : paper_levels(reproduction)) {
    if (level.points.empty()) continue;
    const auto voltage = [&](double PaperPoint::*field) {
      const double mean = mean_of(level.points, field);
      return Cell{std::isfinite(mean) ? fmt::format("{:.3f}", mean) : "-", ""};
    };
    const auto within = [&](PointError error) {
      return Cell{fmt::format("{} of {}", count_within(level.points, error), level.points.size()), ""};
    };
    const auto worst = [&](PointError error) {
      const double largest = worst_error(level.points, error);
      return Cell{fine_percent(largest), largest <= kPaperTolerance ? "" : "beyond"};
    };
    table.rows.push_back({std::nullopt,
                          fmt::format("{:.4g} N", level.newtons),
                          {{std::to_string(level.points.size()), ""},
                           voltage(&PaperPoint::output_v),
                           voltage(&PaperPoint::calibration_v),
                           worst(bank_error),
                           within(bank_error),
                           worst(dermis_error),
                           within(dermis_error)}});
  }
  return table;
}

Cell error_cell(double error) {
  const double value = 100.0 * error;
  if (!std::isfinite(value)) return {"no force", "beyond"};
  return {fmt::format("{:+.2f} %", value), std::abs(error) <= kPaperTolerance ? "" : "beyond"};
}

Table points_table(const std::vector<PaperPoint>& points) {
  const auto number = [](double value, int digits) {
    return Cell{std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-", ""};
  };
  Table table{"numbers dense",
              {{"", 1}, {"voltage [V]", 3}, {"the paper's bank", 2}, {"dermis", 2}},
              {"taxel", "force [N]", "output", "calibration", "difference", "force [N]", "error", "force [N]", "error"},
              {}};
  for (const PaperPoint& point : points) {
    table.rows.push_back({std::nullopt,
                          point.taxel,
                          {{three_digits(point.true_newtons), ""},
                           number(point.output_v, 3),
                           number(point.calibration_v, 3),
                           error_cell(voltage_error(point)),
                           number(point.bank_newtons, 2),
                           error_cell(bank_error(point)),
                           number(point.dermis_newtons, 2),
                           error_cell(dermis_error(point))}});
  }
  return table;
}

void add_points(Page& page, const PaperReproduction& reproduction, const Figures& figures) {
  page.heading("Experimental test: Fig. 11 to 13");
  page.paragraph(
      "10, 20 and 50 N at 20 \u00b0C, each on 16 action points. The paper gives the output voltages 3.635 V and 2.410 "
      "V "
      "for the three forces, without saying which belongs to which; the figures here show the voltages of the "
      "simulated "
      "array instead.");
  for (const Figure& figure : figures.points) page.figure(figure);
  if (reproduction.points.empty()) return;
  page.table(level_table(reproduction));
  page.paragraph("Underlined: beyond the 5\u00a0% that the paper claims.", "note");
  if (const Table table = out::report::estimator_table(reproduction.evaluation); !table.rows.empty()) {
    page.heading("All estimators on the same points");
    page.table(table);
    if (reproduction.model.array.taxel_count() > 0) {
      out::report::add_estimator_legend(page, reproduction.evaluation, reproduction.model);
    }
  }
  page.heading(fmt::format("The {}", counted(reproduction.points.size(), "point")));
  page.table(points_table(reproduction.points));
}

// The rest.

void add_reading(Page& page) {
  page.heading("Where the paper's text and its equations disagree");
  page.facts(
      {{"N",
        "The count of unknowns takes N for the number of taxels (256); eq. (7) to (15), with N\u00b2 - 9 units beyond "
        "a "
        "position and its eight neighbours, take N for the side of the array (16). Each is read as it is meant."},
       {"one network or N",
        "\u201cThe feed forward network\u201d of the count is a bank of N networks with one output each."},
       {"eq. (3), (4)", "The text calls the log-sigmoid Eq. (2) and the output of a neuron Eq. (3)."},
       {"eq. (6)", "It is called the average error, and is the sum over all patterns."},
       {"eq. (11), (15)",
        "They follow from (7) to (10), not from (9) and (5), and from (13) and (14), not from (12) and (13)."},
       {"eq. (12)",
        "It is (11) with 0.25 in the place of 0 and 0.75 in that of x_max; the text has it the other way round."},
       {"Fig. 11 to 13", "Three forces, two voltages."}});
  page.paragraph(
      "Fig. 1 to 4 and 7 show the sensor, the readout and the arrangement of the units; there is nothing to compute "
      "in them.",
      "note");
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  return seconds < 1.0 ? three_digits(1000.0 * seconds) + " ms" : three_digits(seconds) + " s";
}

void add_times(Page& page, const std::vector<std::pair<std::string, double>>& seconds) {
  if (seconds.empty()) return;
  page.heading("Times");
  std::vector<Fact> facts;
  double sum = 0.0;
  for (const auto& [part, time] : seconds) {
    facts.emplace_back(part, duration(time));
    sum += time;
  }
  facts.emplace_back("together", duration(sum));
  page.facts(facts);
}

std::string page_of(const PaperReproduction& reproduction, const Figures& figures) {
  Page page("dermis: the paper, reproduced", "The paper, reproduced and judged");
  add_summary(page, reproduction);
  add_peaks(page, reproduction.peaks, figures);
  add_bank(page, reproduction, figures);
  add_points(page, reproduction, figures);
  add_reading(page);
  add_times(page, reproduction.seconds);
  return std::move(page).html();
}

}  // namespace

std::string paper_page(const PaperReproduction& reproduction) {
  return page_of(reproduction, all_figures(reproduction));
}

Status write_paper_report(const std::string& directory, const PaperReproduction& reproduction) {
  const Figures figures = all_figures(reproduction);
  std::vector<Figure> files = {figures.peaks_network,  figures.peaks_surface, figures.peaks_maps,
                               figures.peaks_training, figures.hidden_units,  figures.bank_network,
                               figures.log_sigmoid,    figures.convergence,   figures.bank_training};
  files.insert(files.end(), figures.points.begin(), figures.points.end());
  return out::report::write_files(directory, files, page_of(reproduction, figures));
}

}  // namespace dermis::paper
