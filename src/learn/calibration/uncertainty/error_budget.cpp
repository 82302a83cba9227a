// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/uncertainty/error_budget.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/even_choice.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostLoads = 4000;  // more do not make the estimates better
constexpr std::size_t kLoadsPerTask = 100;
constexpr double kLeastPairs = 20.0;

/// Units 3 and 4 with a given error of the supply and networks that have hardly any of their own.
class ErrorBudget {
 public:
  static Result<ErrorBudget> create(touch::pipeline::Model model, double supply_noise) {
    model.array.readout.supply_noise = supply_noise;
    Result<touch::compensation::Compensator> compensator =
        touch::pipeline::make_compensator(model.array, model.networks);
    if (!compensator) return compensator.error();
    std::fill(model.networks.relative_sigma.begin(), model.networks.relative_sigma.end(), 1e-6F);
    std::fill(model.networks.heaviest_newtons.begin(), model.networks.heaviest_newtons.end(),
              std::numeric_limits<float>::infinity());  // noise beyond the heaviest load is no extrapolation
    return ErrorBudget(std::move(*compensator), std::move(model.networks));
  }

  /// Again the same where the sample is the last one.
  const ForceFrame& forces(const Sample& sample, double sigma_ratio) {
    if (&sample == last_) return force_;
    last_ = &sample;
    conditioned_.ratio.assign(sample.ratio.begin(), sample.ratio.end());
    conditioned_.sigma_ratio = sigma_ratio;
    conditioned_.temperature_celsius = sample.temperature_celsius;
    conditioned_.taxel_celsius = sample.taxel_celsius;
    conditioned_.taxels = sample.taxels;
    compensator_.forget();
    compensator_.process(conditioned_, conductance_);
    conductance_.taxels.assign(sample.ratio.size(), TaxelStatus::ok);  // what is estimated was trained on, too
    fusion_.process(conductance_, force_);
    return force_;
  }

 private:
  ErrorBudget(touch::compensation::Compensator compensator, touch::fusion::ForceNetworks networks)
      : compensator_(std::move(compensator)), fusion_(std::move(networks)) {}

  touch::compensation::Compensator compensator_;
  touch::fusion::ForceFusion fusion_;
  const Sample* last_ = nullptr;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
  ForceFrame force_;
};

JudgedLoad judge(const TestedLoad& load, const touch::fusion::ForceNetworks& networks, const ForceFrame& without_supply,
                 const ForceFrame& with_supply) {
  JudgedLoad judged;
  judged.tested = &load;
  judged.square_noise = load.noise_n * load.noise_n;
  judged.square_error = load.error_n * load.error_n;
  judged.newtons = load.newtons;
  double supply_n = 0.0;
  for (const std::size_t taxel : load.taxels) {
    const auto newtons = static_cast<double>(without_supply.newtons[taxel]);
    const double square = std::pow(static_cast<double>(without_supply.sigma_newtons[taxel]), 2);
    const double square_with_supply = std::pow(static_cast<double>(with_supply.sigma_newtons[taxel]), 2);
    judged.instruments += square;
    const double place = networks.sigma_place(std::log(without_supply.newtons[taxel]));
    for (std::size_t k = 0; k < judged.material.size(); ++k) {
      const double weight = std::max(1.0 - std::abs(place - static_cast<double>(k)), 0.0);
      judged.material[k] += weight * newtons * newtons;
    }
    supply_n += std::sqrt(std::max(square_with_supply - square, 0.0));
  }
  judged.supply = supply_n * supply_n;
  return judged;
}

/// Those of one sample in a row.
std::vector<const TestedLoad*> some_of(const std::vector<TestedLoad>& loads) {
  std::vector<const TestedLoad*> chosen;
  for (const std::size_t k : even_choice(loads.size(), kMostLoads)) chosen.push_back(&loads[k]);
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const TestedLoad* a, const TestedLoad* b) { return a->sample < b->sample; });
  return chosen;
}

}  // namespace

double JudgedLoad::variance(double supply_noise, const VarianceProfile& profile) const {
  const double known = instruments + std::pow(supply_noise / kUnitSupplyNoise, 2) * supply;
  return std::inner_product(profile.begin(), profile.end(), material.begin(), known);
}

std::optional<double> most_supply_noise(const std::vector<JudgedLoad>& loads) {
  std::map<std::pair<std::size_t, std::size_t>, double> last;  // residual, by touch and first taxel
  double scatter = 0.0;
  double of_unit = 0.0;
  double pairs = 0.0;
  for (const JudgedLoad& load : loads) {
    const TestedLoad& tested = *load.tested;
    const auto [before, is_first] = last.try_emplace({tested.touch, tested.taxels.front()}, tested.residual_n);
    if (is_first) continue;
    scatter += 0.5 * std::pow(tested.residual_n - std::exchange(before->second, tested.residual_n), 2);
    of_unit += load.supply;
    pairs += 1.0;
  }
  if (pairs < kLeastPairs || of_unit <= 0.0) return std::nullopt;
  return JudgedLoad::kUnitSupplyNoise * std::sqrt(scatter / of_unit);
}

Result<std::vector<JudgedLoad>> judge_loads(const SampleDatabase& database, const std::vector<TestedLoad>& loads,
                                            const touch::pipeline::Model& model) {
  const double noise_ratio = model.array.readout.adc_noise_counts / database.array.readout.adc_noise_counts;
  const Result<ErrorBudget> checked = ErrorBudget::create(model, 0.0);
  if (!checked) return checked.error();
  const std::vector<const TestedLoad*> chosen = some_of(loads);
  const std::size_t count = chosen.size();
  std::vector<JudgedLoad> judged(count);
  parallel_for((count + kLoadsPerTask - 1) / kLoadsPerTask, [&](std::size_t task) {
    Result<ErrorBudget> without_supply = ErrorBudget::create(model, 0.0);
    Result<ErrorBudget> with_supply = ErrorBudget::create(model, JudgedLoad::kUnitSupplyNoise);
    const std::size_t end = std::min(count, (task + 1) * kLoadsPerTask);
    for (std::size_t k = task * kLoadsPerTask; k < end; ++k) {
      const TestedLoad& load = *chosen[k];
      const Sample& sample = database.samples[load.sample];
      const double sigma_ratio = noise_ratio * sample.sigma_ratio;
      judged[k] = judge(load, model.networks, without_supply->forces(sample, sigma_ratio),
                        with_supply->forces(sample, sigma_ratio));
    }
  });
  VarianceProfile one;
  one.fill(1.0);
  std::erase_if(judged, [&](const JudgedLoad& load) {
    return !std::isfinite(load.variance(1.0, one)) || load.variance(0.0, one) <= load.instruments;
  });
  return judged;
}

}  // namespace dermis::learn::calibration
