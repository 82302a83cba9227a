// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/evaluation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "calibration/labels.hpp"
#include "calibration/noise_bound.hpp"
#include "dermis/calibration/sample_database.hpp"
#include "dermis/core/neighbours.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "dermis/preprocessing/conditioner.hpp"

namespace dermis::calibration {
namespace {

constexpr std::size_t kMaxExamples = 3;
constexpr double kSigmas68 = 0.99446;  // a normal error is within so many standard deviations with 68 % probability
constexpr double kSigmas95 = 1.95996;

/// Errors of every estimator, gathered while the frames go by.
struct Errors {
  std::vector<std::vector<double>> ghost_n;         // [estimators]
  std::vector<std::vector<double>> total_n;         // [estimators], signed
  std::vector<std::vector<double>> total_relative;  // [estimators]

  explicit Errors(std::size_t estimators) : ghost_n(estimators), total_n(estimators), total_relative(estimators) {}
};

/// All estimators on one frame.
class EstimatorRow {
 public:
  EstimatorRow(const pipeline::Model& model, pipeline::Pipeline pipeline, fusion::PaperBank* bank)
      : model_(model), pipeline_(std::move(pipeline)), bank_(bank), reading_(model.array.taxel_count()) {
    names_.emplace_back("dermis");
    for (const fusion::LookUpTables& tables : model.baselines) names_.push_back(tables.name);
    if (bank != nullptr) names_.emplace_back(kPaperBankName);
    newtons_.assign(names_.size(), std::vector<float>(model.array.taxel_count()));
  }

  /// Returns false where the frame is rejected.
  bool run(const RawFrame& raw) {
    pipeline_.process(raw, force_);
    if (has(force_.status, FrameStatus::rejected)) return false;
    newtons_[0] = force_.newtons;
    preprocessing::bare_readings(model_.array, raw, reading_);
    for (std::size_t k = 0; k < model_.baselines.size(); ++k) {
      const fusion::LookUpTables& tables = model_.baselines[k];
      const bool bare = tables.signal == fusion::LookUpSignal::reading;
      tables.estimate(bare ? reading_ : pipeline_.conductance().siemens, raw.temperature_celsius, newtons_[k + 1]);
    }
    if (bank_ != nullptr) bank_->estimate(pipeline_.conditioned().ratio, raw.temperature_celsius, newtons_.back());
    return true;
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<std::vector<float>>& newtons() const { return newtons_; }
  [[nodiscard]] const ForceFrame& force() const { return force_; }
  [[nodiscard]] const pipeline::Pipeline& pipeline() const { return pipeline_; }
  [[nodiscard]] const std::vector<float>& sigma_newtons() const { return force_.sigma_newtons; }
  [[nodiscard]] const std::vector<double>& reading() const { return reading_; }
  [[nodiscard]] const std::vector<double>& siemens() const { return pipeline_.conductance().siemens; }

 private:
  const pipeline::Model& model_;
  pipeline::Pipeline pipeline_;
  fusion::PaperBank* bank_;
  ForceFrame force_;
  std::vector<std::string> names_;  // [estimators]
  std::vector<double> reading_;
  std::vector<std::vector<float>> newtons_;  // [estimators][taxels]
};

/// Separate stressed areas (8-connected) of a frame; taxels of unknown share count as stressed.
std::size_t count_contacts(const std::vector<float>& known_newtons, std::size_t rows, std::size_t cols) {
  std::vector<bool> open(known_newtons.size());
  for (std::size_t taxel = 0; taxel < open.size(); ++taxel) open[taxel] = !(known_newtons[taxel] == 0.0F);
  std::size_t contacts = 0;
  std::vector<std::size_t> stack;
  for (std::size_t seed = 0; seed < open.size(); ++seed) {
    if (!open[seed]) continue;
    ++contacts;
    open[seed] = false;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::size_t taxel = stack.back();
      stack.pop_back();
      for (const std::size_t near : Neighbours(rows, cols, taxel)) {
        if (!open[near]) continue;
        open[near] = false;
        stack.push_back(near);
      }
    }
  }
  return contacts;
}

bool has_finite_sigma(const JudgedTaxel& taxel) {
  return std::isfinite(taxel.sigma_newtons);
}

double relative_error(double estimate, double truth) {
  return std::abs(estimate / truth - 1.0);
}

void judge_taxels(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row,
                  Evaluation& evaluation, Errors& errors) {
  const std::size_t contacts = count_contacts(truth.known_newtons, evaluation.array.rows, evaluation.array.cols);
  for (std::size_t taxel = 0; taxel < truth.known_newtons.size(); ++taxel) {
    const double newtons = truth.known_newtons[taxel];
    if (newtons == 0.0) {
      for (std::size_t k = 0; k < row.newtons().size(); ++k) {
        const float ghost = row.newtons()[k][taxel];
        if (!std::isnan(ghost)) errors.ghost_n[k].push_back(ghost);  // no force is no ghost
      }
    } else if (newtons >= kJudgedNewtons) {
      JudgedTaxel judged{frame, taxel, newtons, raw.temperature_celsius, raw.supply_v, contacts, {}, 0.0F};
      for (const std::vector<float>& forces : row.newtons()) judged.newtons.push_back(forces[taxel]);
      judged.sigma_newtons = row.sigma_newtons()[taxel];
      evaluation.taxels.push_back(std::move(judged));
    }
  }
}

void judge_totals(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row,
                  Evaluation& evaluation, Errors& errors) {
  for (const TotalForce& total : truth.totals) {
    JudgedTotal judged{frame, total.newtons, raw.temperature_celsius, {}};
    for (std::size_t k = 0; k < row.newtons().size(); ++k) {
      double sum = 0.0;
      for (const std::size_t taxel : total.taxels) {
        const auto newtons = static_cast<double>(row.newtons()[k][taxel]);
        if (!std::isnan(newtons)) sum += newtons;  // a dead taxel carries what it carries: the total is short of it
      }
      errors.total_n[k].push_back(sum - total.newtons);
      errors.total_relative[k].push_back(relative_error(sum, total.newtons));
      judged.newtons.push_back(sum);
    }
    evaluation.totals.push_back(std::move(judged));
  }
}

std::optional<double> root_mean_square(const std::vector<double>& errors) {
  if (errors.empty()) return std::nullopt;
  double square = 0.0;
  for (const double error : errors) square += error * error;
  return std::sqrt(square / static_cast<double>(errors.size()));
}

std::vector<EstimatorResult> summarise_estimators(const std::vector<std::string>& names, const Evaluation& evaluation,
                                                  Errors& errors) {
  std::vector<EstimatorResult> results;
  for (std::size_t k = 0; k < names.size(); ++k) {
    EstimatorResult result;
    result.name = names[k];
    std::vector<double> relative;
    for (const JudgedTaxel& taxel : evaluation.taxels) {
      relative.push_back(relative_error(static_cast<double>(taxel.newtons[k]), taxel.true_newtons));
    }
    result.relative_error = summarise(std::move(relative));
    result.ghost_n = summarise(std::move(errors.ghost_n[k]));
    result.totals_judged = errors.total_n[k].size();
    result.total_rmse_n = root_mean_square(errors.total_n[k]);
    result.total_relative_error = summarise(std::move(errors.total_relative[k]));
    results.push_back(std::move(result));
  }
  return results;
}

Coverage coverage_of(std::span<const JudgedTaxel> taxels) {
  const std::vector<double> shares = covered_shares(taxels, std::array{kSigmas68, kSigmas95});
  Coverage coverage;
  if (shares.empty()) return coverage;
  coverage.count = static_cast<std::size_t>(std::count_if(taxels.begin(), taxels.end(), has_finite_sigma));
  coverage.share_68 = shares[0];
  coverage.share_95 = shares[1];
  return coverage;
}

/// Bins of the judged taxels (of the totals, where no taxel is judged) by `quantity`, a function of either that gives
/// an optional<double>. Bins without anything in them are left out.
template <typename Quantity>
std::vector<BreakdownBin> break_down(const Evaluation& evaluation, const std::vector<double>& edges,
                                     Quantity quantity) {
  std::vector<BreakdownBin> bins;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    BreakdownBin bin{edges[b], edges[b + 1], {}, {}};
    std::vector<JudgedTaxel> taxels;
    std::vector<std::vector<double>> errors(evaluation.estimators.size());
    const auto gather = [&](const auto& judged) {
      const std::optional<double> value = quantity(judged);
      if (!value || *value < bin.low || *value >= bin.high) return;
      for (std::size_t k = 0; k < errors.size(); ++k) {
        errors[k].push_back(relative_error(static_cast<double>(judged.newtons[k]), judged.true_newtons));
      }
      if constexpr (std::is_same_v<std::decay_t<decltype(judged)>, JudgedTaxel>) taxels.push_back(judged);
    };
    if (evaluation.taxels.empty()) {
      std::for_each(evaluation.totals.begin(), evaluation.totals.end(), gather);
    } else {
      std::for_each(evaluation.taxels.begin(), evaluation.taxels.end(), gather);
    }
    if (errors.empty() || errors.front().empty()) continue;
    for (std::vector<double>& of_estimator : errors) bin.relative_error.push_back(summarise(std::move(of_estimator)));
    bin.coverage = coverage_of(taxels);
    bins.push_back(std::move(bin));
  }
  return bins;
}

/// `count` equal bins over the values that the judged taxels take.
std::vector<double> equal_edges(const std::vector<JudgedTaxel>& taxels, std::size_t count,
                                std::optional<double> JudgedTaxel::*quantity) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const JudgedTaxel& taxel : taxels) {
    if (!(taxel.*quantity)) continue;
    lowest = std::min(lowest, *(taxel.*quantity));
    highest = std::max(highest, *(taxel.*quantity));
  }
  if (!(lowest < highest)) return lowest == highest ? std::vector<double>{lowest, lowest + 1.0} : std::vector<double>{};
  std::vector<double> edges;
  const double width = (highest - lowest) / static_cast<double>(count);
  for (std::size_t b = 0; b <= count; ++b) edges.push_back(lowest + width * static_cast<double>(b));
  edges.back() = std::nextafter(highest, std::numeric_limits<double>::infinity());
  return edges;
}

/// One bin for every number of contacts.
std::vector<double> contact_edges(const std::vector<JudgedTaxel>& taxels) {
  std::size_t most = 0;
  for (const JudgedTaxel& taxel : taxels) most = std::max(most, taxel.contacts);
  std::vector<double> edges;
  for (std::size_t contacts = 1; contacts <= most + 1; ++contacts) edges.push_back(static_cast<double>(contacts));
  return edges;
}

void break_down_all(Evaluation& evaluation) {
  const auto force = [](const auto& judged) { return std::optional<double>(judged.true_newtons); };
  const auto temperature = [](const auto& judged) { return judged.temperature_celsius; };
  evaluation.by_force = break_down(evaluation, {0, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 1e6}, force);
  evaluation.by_temperature =
      break_down(evaluation, {-273, -20, -10, 0, 10, 20, 30, 40, 50, 60, 70, 85, 100, 1000}, temperature);
  if (evaluation.taxels.empty()) return;
  const auto of_taxel = [&](auto quantity, const std::vector<double>& edges) {
    return break_down(evaluation, edges, [&](const auto& judged) -> std::optional<double> {
      if constexpr (requires { judged.taxel; }) return quantity(judged);
      return std::nullopt;
    });
  };
  evaluation.by_supply = of_taxel([](const JudgedTaxel& taxel) { return taxel.supply_v; },
                                  equal_edges(evaluation.taxels, 5, &JudgedTaxel::supply_v));
  evaluation.by_contacts = of_taxel([](const JudgedTaxel& taxel) { return static_cast<double>(taxel.contacts); },
                                    contact_edges(evaluation.taxels));
}

/// Compares dermis with the bound on every so many of the labelled frames.
class BoundCollector {
 public:
  BoundCollector(const pipeline::Model& model, std::size_t labelled) : bound_(NoiseBound::create(model)) {
    if (bound_) stride_ = std::max<std::size_t>(labelled / bound_->affordable_frames(), 1);
  }

  /// To be called for every labelled frame that was accepted.
  void offer(const Sample& truth, const EstimatorRow& row) {
    if (!bound_ || offered_++ % stride_ != 0) return;
    const auto is_judged = [](float newtons) { return newtons >= kJudgedNewtons; };
    if (std::none_of(truth.known_newtons.begin(), truth.known_newtons.end(), is_judged)) return;
    const std::vector<float> bound =
        bound_->newtons(row.pipeline().conductance(), row.pipeline().conditioned().sigma_ratio);
    ++frames_;
    for (std::size_t taxel = 0; taxel < bound.size(); ++taxel) {
      const double newtons = truth.known_newtons[taxel];
      if (!(newtons >= kJudgedNewtons) || !std::isfinite(bound[taxel])) continue;
      const double error = static_cast<double>(row.force().newtons[taxel]) - newtons;
      bounds_.push_back(static_cast<double>(bound[taxel]) / newtons);
      errors_.push_back(std::abs(error) / newtons);
    }
  }

  [[nodiscard]] BoundComparison comparison() const {
    if (bounds_.empty()) return {};
    double square = 0.0;
    for (std::size_t k = 0; k < bounds_.size(); ++k) square += std::pow(errors_[k] / bounds_[k], 2);
    constexpr double kMedianOfNormal = 0.67449;
    return {frames_, bounds_.size(), *summarise(bounds_).median, *summarise(errors_).median / kMedianOfNormal,
            std::sqrt(square / static_cast<double>(bounds_.size()))};
  }

 private:
  std::optional<NoiseBound> bound_;
  std::size_t stride_ = 1;
  std::size_t offered_ = 0;
  std::size_t frames_ = 0;
  std::vector<double> bounds_;  // over the true force
  std::vector<double> errors_;  // over the true force
};

/// Frames for pictures: the first ones that press several taxels, or else the first ones that press any.
class ExampleChoice {
 public:
  void offer(std::size_t frame, const Sample& truth, const EstimatorRow& row) {
    if (!truth.totals.empty()) return;
    const auto loaded = std::count_if(truth.known_newtons.begin(), truth.known_newtons.end(),
                                      [](float newtons) { return newtons >= kJudgedNewtons; });
    std::vector<TactileExample>& examples = loaded >= kSeveral ? rich_ : plain_;
    if (loaded > 0 && examples.size() < kMaxExamples) examples.push_back(make_example(frame, truth, row));
  }

  [[nodiscard]] std::vector<TactileExample> chosen() && { return std::move(rich_.empty() ? plain_ : rich_); }

 private:
  static constexpr std::ptrdiff_t kSeveral = 4;

  static TactileExample make_example(std::size_t frame, const Sample& truth, const EstimatorRow& row) {
    return {frame, row.reading(), row.siemens(), row.newtons()[0],
            std::vector<double>(truth.known_newtons.begin(), truth.known_newtons.end())};
  }

  std::vector<TactileExample> rich_;
  std::vector<TactileExample> plain_;
};

}  // namespace

std::vector<double> covered_shares(std::span<const JudgedTaxel> taxels, std::span<const double> sigmas) {
  std::vector<double> shares(sigmas.size(), 0.0);
  double count = 0.0;
  for (const JudgedTaxel& taxel : taxels) {
    if (!has_finite_sigma(taxel)) continue;
    const double error = std::abs(static_cast<double>(taxel.newtons.front()) - taxel.true_newtons);
    for (std::size_t k = 0; k < sigmas.size(); ++k) {
      if (error <= sigmas[k] * static_cast<double>(taxel.sigma_newtons)) shares[k] += 1.0;
    }
    count += 1.0;
  }
  if (count == 0.0) return {};
  for (double& share : shares) share /= count;
  return shares;
}

ErrorSummary summarise(std::vector<double> errors) {
  ErrorSummary summary;
  summary.count = errors.size();
  if (errors.empty()) return summary;
  for (double& error : errors) {
    if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
  }
  std::sort(errors.begin(), errors.end());
  const auto percentile = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(errors.size())));
    return errors[std::max<std::size_t>(rank, 1) - 1];
  };
  summary.median = percentile(0.50);
  summary.p95 = percentile(0.95);
  summary.p99 = percentile(0.99);
  summary.max = errors.back();
  return summary;
}

Result<Evaluation> evaluate(const pipeline::Model& model, std::span<const RawFrame> frames, std::span<const Load> loads,
                            fusion::PaperBank* bank) {
  if (Status checked = check_loads(model.array, frames.size(), loads); !checked) return checked.error();
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  if (bank != nullptr && bank->taxel_count() != model.array.taxel_count()) {
    return bad_input(fmt::format("the paper's bank is for {} taxels, the model for {}", bank->taxel_count(),
                                 model.array.taxel_count()));
  }

  Evaluation evaluation;
  evaluation.array = model.array;
  EstimatorRow row(model, std::move(*pipeline), bank);
  Errors errors(row.names().size());
  ExampleChoice examples;
  const std::vector<std::vector<Load>> loads_of = group_by_frame(loads, frames.size());
  const auto labelled = std::count_if(loads_of.begin(), loads_of.end(), [](const auto& some) { return !some.empty(); });
  BoundCollector bound(model, static_cast<std::size_t>(labelled));
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const bool accepted = row.run(frames[frame]);
    if (loads_of[frame].empty()) continue;
    if (!accepted) {
      ++evaluation.frames_rejected;
      continue;
    }
    ++evaluation.frames;
    Sample truth;
    expand_loads(model.array, loads_of[frame], truth);
    judge_taxels(frame, frames[frame], truth, row, evaluation, errors);
    judge_totals(frame, frames[frame], truth, row, evaluation, errors);
    examples.offer(frame, truth, row);
    bound.offer(truth, row);
  }
  if (evaluation.frames == 0) return bad_input("no labelled frame fits the model's array");
  evaluation.estimators = summarise_estimators(row.names(), evaluation, errors);
  evaluation.bound = bound.comparison();
  evaluation.coverage = coverage_of(evaluation.taxels);
  evaluation.examples = std::move(examples).chosen();
  break_down_all(evaluation);
  return evaluation;
}

}  // namespace dermis::calibration
