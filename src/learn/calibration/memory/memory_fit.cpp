// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/memory/memory_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/network/levenberg_marquardt.hpp"
#include "learn/calibration/even_choice.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kFramesPerTask = 1024;
constexpr std::size_t kMostLoads = 20'000;  // to fit seven numbers to
constexpr double kStep = 2e-3;              // of a derivative by differences
constexpr double kMostError = 1.0;          // relative; counts as this
constexpr int kMaxIterations = 60;
constexpr double kRelativeReduction = 1e-5;
constexpr double kPriorWeight = 0.05;   // of the prior against all loads
constexpr double kUnlikeShare = 0.05;   // of a creep element or a stop, from the mean of them
constexpr double kExpectedShare = 0.5;  // of all of them

constexpr std::size_t kShares =
    touch::fusion::MemoryLaw::kCreepSeconds.size() + touch::fusion::MemoryLaw::kStopReach.size();

/// The free parameters are roots of the shares, which are not negative: of creep and, where there are stops, of gaps.
touch::fusion::MemoryLaw law_of(std::span<const double> free) {
  touch::fusion::MemoryLaw law;
  std::size_t k = 0;
  for (float& share : law.creep) share = static_cast<float>(free[k] * free[k]), ++k;
  if (k == free.size()) return law;
  for (float& share : law.gap) share = static_cast<float>(free[k] * free[k]), ++k;
  return law;
}

std::vector<double> free_of(const touch::fusion::MemoryLaw& law) {
  constexpr float kLeast = 1e-3F;  // at zero the derivative is zero
  std::vector<double> free;
  for (const float share : law.creep) free.push_back(std::sqrt(std::max(share, kLeast)));
  if (law.gap == decltype(law.gap){}) return free;
  for (const float share : law.gap) free.push_back(std::sqrt(std::max(share, kLeast)));
  return free;
}

/// Which gain a load has: that of its taxel, or that of all totals.
std::vector<std::size_t> gain_groups(std::span<const KnownLoad> loads, std::size_t taxels) {
  std::vector<std::size_t> groups;
  for (const KnownLoad& load : loads) groups.push_back(load.total ? taxels : load.taxels.front());
  return groups;
}

std::vector<KnownLoad> some_of(std::span<const KnownLoad> loads) {
  std::vector<KnownLoad> chosen;
  for (const std::size_t k : even_choice(loads.size(), kMostLoads)) chosen.push_back(loads[k]);
  return chosen;
}

class MemoryProblem {
 public:
  MemoryProblem(const MaterialHistory& material, std::vector<KnownLoad> loads)
      : taxels_(material.taxels),
        loads_(std::move(loads)),
        groups_(gain_groups(loads_, material.taxels)),
        felt_(material, loads_) {
    double log_newtons = 0.0;
    for (const KnownLoad& load : loads_) log_newtons += std::log(load.newtons) / static_cast<double>(loads_.size());
    floor_newtons_ = kFloorShare * std::exp(log_newtons);
  }

  [[nodiscard]] std::size_t residual_count() const { return loads_.size() + kShares; }

  /// The error of each load, about relative.
  void errors(const touch::fusion::MemoryLaw& law, std::span<double> errors) const {
    const std::vector<FreedLoad> freed = felt_.freed(law);
    const std::vector<double> gain = gains(freed);
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      const double error = weight(k) * (gain[groups_[k]] * freed[k].newtons - loads_[k].newtons);
      errors[k] = kMostError * std::tanh(error / kMostError);
    }
  }

  [[nodiscard]] double misfit(const touch::fusion::MemoryLaw& law) const {
    std::vector<double> errors(loads_.size());
    this->errors(law, errors);
    double square = 0.0;
    for (const double error : errors) square += error * error;
    return std::sqrt(square / static_cast<double>(errors.size()));
  }

  void residuals(std::span<const double> free, std::span<double> residuals) const {
    const touch::fusion::MemoryLaw law = law_of(free);
    if (!law.is_consistent()) {
      std::fill(residuals.begin(), residuals.end(), std::numeric_limits<double>::infinity());
      return;
    }
    errors(law, residuals.first(loads_.size()));
    prior(law.creep, residuals.subspan(loads_.size(), law.creep.size()));
    prior(law.gap, residuals.subspan(loads_.size() + law.creep.size()));
  }

 private:
  /// Material creeps with the logarithm of time, and slides with that of force: shares are alike where the loads do not
  /// tell, and small.
  template <typename Shares>
  void prior(const Shares& shares, std::span<double> residuals) const {
    const double scale = kPriorWeight * kExpectedError * std::sqrt(static_cast<double>(loads_.size()));
    double mean = 0.0;
    for (const float share : shares) mean += static_cast<double>(share) / static_cast<double>(shares.size());
    for (std::size_t k = 0; k < shares.size(); ++k) {
      residuals[k] = scale * ((static_cast<double>(shares[k]) - mean) / kUnlikeShare + mean / kExpectedShare);
    }
  }

  static constexpr double kFloorShare = 0.3;      // of a typical load: lighter ones count less
  static constexpr double kExpectedError = 0.05;  // relative

  [[nodiscard]] double weight(std::size_t k) const { return 1.0 / (loads_[k].newtons + floor_newtons_); }

  /// The gain of each taxel, and of the totals.
  [[nodiscard]] std::vector<double> gains(const std::vector<FreedLoad>& freed) const {
    std::vector<double> above(taxels_ + 1);
    std::vector<double> below(taxels_ + 1);
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      const double square = std::pow(weight(k), 2);
      above[groups_[k]] += square * freed[k].newtons * loads_[k].newtons;
      below[groups_[k]] += square * freed[k].newtons * freed[k].newtons;
    }
    for (std::size_t k = 0; k < above.size(); ++k) above[k] = below[k] > 0.0 ? above[k] / below[k] : 1.0;
    return above;
  }

  std::size_t taxels_;
  std::vector<KnownLoad> loads_;
  std::vector<std::size_t> groups_;  // [loads]
  FeltLoads felt_;
  double floor_newtons_ = 0.0;
};

}  // namespace

MaterialHistory material_history(const SiemensHistory& history, const touch::fusion::ForceNetworks& networks) {
  const std::size_t frames = history.time.size();
  MaterialHistory material;
  material.time = history.time;
  material.taxels = history.taxels;
  material.newtons.resize(frames * history.taxels);
  parallel_for((frames + kFramesPerTask - 1) / kFramesPerTask, [&](std::size_t task) {
    touch::fusion::ForceFusion fusion(networks);
    ConductanceFrame conductance;
    conductance.sigma_siemens.assign(history.taxels, 0.0);
    conductance.taxels.assign(history.taxels, TaxelStatus::ok);
    ForceFrame force;
    const std::size_t end = std::min(frames, (task + 1) * kFramesPerTask);
    for (std::size_t k = task * kFramesPerTask; k < end; ++k) {
      const std::span<const float> siemens = history.siemens_of(k);
      conductance.siemens.assign(siemens.begin(), siemens.end());
      conductance.temperature_celsius = history.temperature_celsius[k];
      const std::span<const float> celsius = history.taxel_celsius_of(k);
      conductance.taxel_celsius.assign(celsius.begin(), celsius.end());
      fusion.process(conductance, force);
      std::copy(force.newtons.begin(), force.newtons.end(),
                material.newtons.begin() + static_cast<std::ptrdiff_t>(k * history.taxels));
    }
  });
  return material;
}

std::vector<KnownLoad> known_loads(const SampleDatabase& database, const SiemensHistory& history) {
  std::vector<KnownLoad> loads;
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    const Sample& sample = database.samples[k];
    const auto found = std::lower_bound(history.frame.begin(), history.frame.end(), sample.frame);
    if (found == history.frame.end() || *found != sample.frame) continue;
    const auto place = static_cast<std::size_t>(found - history.frame.begin());
    for (std::size_t taxel = 0; taxel < sample.known_newtons.size(); ++taxel) {
      const auto newtons = static_cast<double>(sample.known_newtons[taxel]);
      if (newtons > 0.0) loads.push_back({k, place, {taxel}, newtons, std::nullopt});
    }
    for (std::size_t total = 0; total < sample.totals.size(); ++total) {
      const auto& [taxels, newtons, material_share] = sample.totals[total];
      if (newtons > 0.0) loads.push_back({k, place, taxels, newtons, total});
    }
  }
  return loads;
}

FeltLoads::FeltLoads(const MaterialHistory& material, std::span<const KnownLoad> loads) {
  const std::size_t frames = loads.empty() ? 0 : loads.back().place + 1;
  const auto newtons_of = [&](std::size_t frame, std::size_t taxel) {
    return material.newtons[frame * material.taxels + taxel];
  };
  std::vector<bool> is_asked(material.taxels);
  for (const KnownLoad& load : loads) {
    for (const std::size_t taxel : load.taxels) is_asked[taxel] = true;
  }
  std::vector<std::size_t> taxels;
  std::vector<std::size_t> column(material.taxels, material.taxels);
  for (std::size_t taxel = 0; taxel < material.taxels; ++taxel) {
    bool is_felt = false;
    for (std::size_t frame = 0; is_asked[taxel] && frame < frames && !is_felt; ++frame)
      is_felt = newtons_of(frame, taxel) > 0.0F;
    if (!is_felt) continue;
    column[taxel] = taxels.size();
    taxels.push_back(taxel);
  }
  columns_ = taxels.size();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (const std::size_t taxel : taxels) newtons_.push_back(newtons_of(frame, taxel));
    const bool is_first = frame == 0 || material.time[frame] < material.time[frame - 1];
    approach_.emplace_back();
    if (!is_first)
      approach_.back() = touch::fusion::MaterialMemory::approach(material.time[frame] - material.time[frame - 1]);
  }
  for (const KnownLoad& load : loads) {
    Felt& felt = loads_.emplace_back(Felt{load.place, {}, 0.0});
    for (const std::size_t taxel : load.taxels) {
      const float newtons = newtons_of(load.place, taxel);
      if (std::isnan(newtons)) continue;
      felt.material_newtons += static_cast<double>(newtons);
      if (column[taxel] != material.taxels) felt.columns.push_back(column[taxel]);
    }
  }
}

std::vector<FreedLoad> FeltLoads::freed(const touch::fusion::MemoryLaw& law) const {
  touch::fusion::MaterialMemory memory(law, columns_);
  std::vector<float> newtons(columns_);
  std::vector<FreedLoad> freed;
  for (std::size_t frame = 0; frame < approach_.size(); ++frame) {
    std::copy_n(newtons_.begin() + static_cast<std::ptrdiff_t>(frame * columns_), columns_, newtons.begin());
    memory.process(newtons, approach_[frame]);
    for (; freed.size() < loads_.size() && loads_[freed.size()].place == frame;) {
      const Felt& felt = loads_[freed.size()];
      double sum = 0.0;
      for (const std::size_t column : felt.columns) sum += static_cast<double>(newtons[column]);
      freed.push_back({felt.material_newtons, sum});
    }
  }
  return freed;
}

std::vector<FreedLoad> freed_loads(const MaterialHistory& material, std::span<const KnownLoad> loads,
                                   const touch::fusion::MemoryLaw& law) {
  return FeltLoads(material, loads).freed(law);
}

double memory_misfit(const MaterialHistory& material, std::span<const KnownLoad> loads,
                     const touch::fusion::MemoryLaw& law) {
  return MemoryProblem(material, some_of(loads)).misfit(law);
}

touch::fusion::MemoryLaw fit_memory(const MaterialHistory& material, std::span<const KnownLoad> loads,
                                    const touch::fusion::MemoryLaw& start) {
  const MemoryProblem problem(material, some_of(loads));
  const auto function = [&](std::span<const double> free, std::span<double> residuals, std::span<double> jacobian) {
    if (jacobian.empty()) return problem.residuals(free, residuals);
    const std::size_t count = problem.residual_count();
    const std::size_t parameters = free.size();
    std::vector<std::vector<double>> moved(parameters + 1);  // by a step of each parameter, and the one that is asked
    parallel_for(moved.size(), [&](std::size_t k) {
      std::vector<double> there(free.begin(), free.end());
      if (k < parameters) there[k] += kStep;
      moved[k].resize(count);
      problem.residuals(there, moved[k]);
    });
    std::copy(moved.back().begin(), moved.back().end(), residuals.begin());
    for (std::size_t row = 0; row < count; ++row) {
      for (std::size_t k = 0; k < parameters; ++k) {
        jacobian[row * parameters + k] = (moved[k][row] - residuals[row]) / kStep;
      }
    }
  };
  touch::network::LevenbergMarquardtOptions options;
  options.max_iterations = kMaxIterations;
  options.relative_reduction = kRelativeReduction;
  std::vector<double> free = free_of(start);
  touch::network::minimise(function, problem.residual_count(), free, options);
  touch::fusion::MemoryLaw law = law_of(free);
  return law.is_consistent() ? law : start;
}

}  // namespace dermis::learn::calibration
