// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/wording.hpp"
#include "dermis/paper/paper_bank.hpp"
#include "dermis/touch/network/activation.hpp"
#include "paper/report/network_diagram.hpp"
#include "paper/report/paper_figures.hpp"
#include "paper/report/training_plot.hpp"

namespace dermis::paper {

using out::report::Axis;
using out::report::counted;
using out::report::Figure;
using out::report::grouped;
using out::report::Plot;
using out::report::Point;
using out::report::Scale;
using out::report::steps;

namespace {

constexpr const char* kBankError = "error, eq. (6)";
constexpr const char* kErrorWords =
    "The error is that of eq. (6), half the weighted mean square of a batch, mean of all networks; neighbouring steps "
    "are "
    "drawn as their mean.";

}  // namespace

Figure bank_network_figure(std::size_t n) {
  const std::string last = std::to_string(n);
  const NetworkDiagram diagram{"one network of the bank: N-N-N-1",
                               {{"readings", "N taxels", {"1", "2", "3", "", last}},
                                {"first layer", "N log-sigmoid", {"1", "2", "3", "", last}},
                                {"second layer", "N log-sigmoid", {"1", "2", "3", "", last}},
                                {"output", "1 log-sigmoid", {"F"}}},
                               true};
  return {"paper_fig_08.svg",
          "The network of one taxel (the paper's Fig. 8)",
          fmt::format("There is one such network a taxel, N = {}. Blue: the connections of a position with itself, "
                      "which the structured start gives the weight \u03c9_A; the others begin with \u03c9_B for its "
                      "neighbours and \u03c9_C for the rest.",
                      grouped(n)),
          {network_diagram(diagram)},
          1};
}

Figure log_sigmoid_figure() {
  const double reach = std::log(3.0);
  const Axis x{"input x", Scale::linear, -6.0, 6.0, {-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0}};
  const Axis y{"output f(x)", Scale::linear, 0.0, 1.0, {0.0, 0.25, 0.5, 0.75, 1.0}};
  std::vector<Point> curve;
  for (int i = -60; i <= 60; ++i) {
    const double input = 0.1 * i;
    curve.push_back({input, touch::network::activate(touch::network::Activation::log_sigmoid, input)});
  }
  Plot plot("log-sigmoid, eq. (3)", x, y, 480.0, 350.0);
  plot.region("working range", {{-reach, 0.25}, {reach, 0.25}, {reach, 0.75}, {-reach, 0.75}});
  plot.reference("", {{x.low, 0.25}, {-reach, 0.25}, {-reach, 0.0}});
  plot.reference("", {{x.low, 0.75}, {reach, 0.75}, {reach, 0.0}});
  plot.line("f(x) = 1 / (1 + exp(-x))", 0, std::move(curve));
  plot.label({-reach - 1.25, 0.05}, "-ln 3");
  plot.label({reach, 0.05}, "ln 3");
  return {
      "paper_fig_10.svg",
      "The neuron (the paper's Fig. 10)",
      "Between an input of -ln 3 = -1.0986 and ln 3 the output is between 0.25 and 0.75: the range in which the paper "
      "starts every neuron.",
      {plot.drawing()},
      1};
}

Figure convergence_figure(const PaperReproduction& reproduction) {
  Figure figure{"start_convergence.svg",
                "Training from each start (the loop of the paper's Fig. 9)",
                "No training from different starts is known.",
                {},
                1};
  std::vector<TrainingPlot::Series> series;
  for (std::size_t i = 0; i < reproduction.convergence.size(); ++i) {
    if (has_points(reproduction.convergence[i])) series.push_back({i, &reproduction.convergence[i]});
  }
  if (series.empty()) return figure;
  figure.panels.push_back(training_plot({"gradient descent of the bank", kBankError, std::move(series), std::nullopt}));
  figure.caption = kErrorWords;
  return figure;
}

Figure bank_training_figure(const PaperReproduction& reproduction) {
  Figure figure{"bank_training.svg",
                "The training that Fig. 11 to 13 are judged with",
                "The training of the bank is not known.",
                {},
                1};
  const TrainingCurve& curve = reproduction.bank_training;
  if (!has_points(curve)) return figure;
  figure.panels.push_back(
      training_plot({"training of the bank", kBankError, {{bank_style(reproduction), &curve}}, std::nullopt}));
  figure.caption =
      fmt::format("{} on {}; the own taxel of a network is loaded in {} of them. {}", steps(curve.step.back()),
                  counted(reproduction.bank_samples, "labelled frame"), grouped(reproduction.own_samples), kErrorWords);
  return figure;
}

std::size_t bank_style(const PaperReproduction& reproduction) {
  const auto& estimators = reproduction.evaluation.estimators;
  const auto bank =
      std::find_if(estimators.begin(), estimators.end(),
                   [](const learn::calibration::EstimatorResult& result) { return result.name == kPaperBankName; });
  return bank == estimators.end() ? 1 : static_cast<std::size_t>(bank - estimators.begin());
}

}  // namespace dermis::paper
