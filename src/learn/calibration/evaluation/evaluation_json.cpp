// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <nlohmann/json.hpp>

#include "dermis/learn/calibration/evaluation.hpp"

namespace dermis::learn::calibration {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

/// Only dermis, the first estimator, says how sure it is.
void add_coverage(const Coverage& coverage, Json& dermis) {
  dermis["coverage_68"] = number(coverage.share_68);
  dermis["coverage_95"] = number(coverage.share_95);
}

Json estimator_json(const EstimatorResult& result) {
  return {{"name", result.name},
          {"median_relative_error", number(result.relative_error.median)},
          {"p95_relative_error", number(result.relative_error.p95)},
          {"p99_relative_error", number(result.relative_error.p99)},
          {"max_relative_error", number(result.relative_error.max)},
          {"taxels_judged", result.relative_error.count},
          {"ghost_p99_n", number(result.ghost_n.p99)},
          {"ghost_max_n", number(result.ghost_n.max)},
          {"ghost_taxels_judged", result.ghost_n.count},
          {"total_rmse_n", number(result.total_rmse_n)},
          {"total_median_relative_error", number(result.total_relative_error.median)},
          {"total_max_relative_error", number(result.total_relative_error.max)},
          {"totals_judged", result.totals_judged}};
}

Json sums_json(const SumErrors& sums) {
  return {{"untouched_frames", sums.untouched},
          {"untouched_mean_n", number(sums.untouched_mean_n)},
          {"untouched_within_2_sigma", number(sums.untouched_within_2_sigma)},
          {"touched_frames", sums.touched},
          {"relative_bias", number(sums.relative_bias)},
          {"coverage_68", number(sums.share_68)},
          {"coverage_95", number(sums.share_95)}};
}

Json breakdown_json(const Evaluation& evaluation, const std::vector<BreakdownBin>& bins) {
  Json rows = Json::array();
  for (const BreakdownBin& bin : bins) {
    Json estimators = Json::object();
    for (std::size_t k = 0; k < bin.relative_error.size(); ++k) {
      estimators[evaluation.estimators[k].name] = {{"median_relative_error", number(bin.relative_error[k].median)},
                                                   {"p95_relative_error", number(bin.relative_error[k].p95)}};
    }
    add_coverage(bin.coverage, estimators[evaluation.estimators.front().name]);
    rows.push_back({{"from", bin.low},
                    {"to", bin.high},
                    {"count", bin.relative_error.front().count},
                    {"estimators", std::move(estimators)}});
  }
  return rows;
}

Json after_release_json(const Evaluation& evaluation) {
  Json rows = Json::array();
  for (const ReleaseBin& bin : evaluation.after_release) {
    Json estimators = Json::object();
    for (std::size_t k = 0; k < bin.ghost_n.size(); ++k) {
      estimators[evaluation.estimators[k].name] = {{"ghost_median_n", number(bin.ghost_n[k].median)},
                                                   {"ghost_p99_n", number(bin.ghost_n[k].p99)}};
    }
    rows.push_back({{"from", bin.low},
                    {"to", bin.high},
                    {"count", bin.ghost_n.front().count},
                    {"estimators", std::move(estimators)}});
  }
  return rows;
}

}  // namespace

std::string to_json(const Evaluation& evaluation) {
  Json estimators = Json::array();
  for (const EstimatorResult& result : evaluation.estimators) estimators.push_back(estimator_json(result));
  add_coverage(evaluation.coverage, estimators.front());
  estimators.front()["coverage_taxels"] = evaluation.coverage.count;
  Json root = {{"frames", evaluation.frames},
               {"frames_rejected", evaluation.frames_rejected},
               {"judged_from_n", evaluation.judged_from_n},
               {"estimators", std::move(estimators)},
               {"sums", sums_json(evaluation.sums)},
               {"by_force", breakdown_json(evaluation, evaluation.by_force)},
               {"by_temperature", breakdown_json(evaluation, evaluation.by_temperature)},
               {"by_supply", breakdown_json(evaluation, evaluation.by_supply)},
               {"by_contacts", breakdown_json(evaluation, evaluation.by_contacts)},
               {"by_onset", breakdown_json(evaluation, evaluation.by_onset)},
               {"by_direction", breakdown_json(evaluation, evaluation.by_direction)},
               {"after_release", after_release_json(evaluation)}};
  const BoundComparison& bound = evaluation.bound;
  if (bound.frames > 0) {
    root["cramer_rao_bound"] = {{"frames", bound.frames},
                                {"taxels", bound.taxels},
                                {"median_relative_bound", bound.median_bound},
                                {"median_relative_deviation", bound.median_deviation},
                                {"rms_error_over_bound", bound.rms_ratio}};
  }
  return root.dump(2);
}

}  // namespace dermis::learn::calibration
