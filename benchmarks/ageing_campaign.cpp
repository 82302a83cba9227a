// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Sheets that age, and sheets that do not. Each is calibrated when it is new. Part 1 changes its gains by 10 % from
// taxel to taxel, and counts the touches of unknown force until that is found. Part 2 changes them by 10 % in common,
// either way, and puts one known weight on. Part 3 uses the healthy sheet for hours, while temperature and unloaded
// conductances drift, and counts the minutes in which an alarm stands and the weights, one an hour, that raise one.
// Usage: ageing_campaign SHEETS HOURS [rubber]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibrated_model.hpp"
#include "dermis/learn/health/ageing_monitor.hpp"
#include "dermis/learn/health/weight_check.hpp"
#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/reference_array.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/learn/simulation/scene.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis {
namespace {

constexpr double kChange = 0.1;
constexpr double kWeightN = 5.0;
constexpr double kRateHz = 10.0;
constexpr double kWeightSeconds = 5.0;
constexpr double kFootPitches = 1.5;  // of the weight, a bell
constexpr double kSwingCelsius = 10.0;
constexpr double kDriftAnHour = 0.02;  // of the unloaded conductance of a taxel, standard deviation
constexpr double kSecondsOfHour = 3600.0;
constexpr double kSupplyV = 5.0;

learn::simulation::RubberOptions sheet(std::uint64_t seed, bool remembers) {
  learn::simulation::RubberOptions rubber;
  rubber.seed = seed;
  if (remembers) rubber.memory.emplace();
  return rubber;
}

/// Of the new sheet: every taxel under single presses at 20 C and others, or under two weights where it remembers.
touch::pipeline::Model calibrated(const ArrayDescription& array, const learn::simulation::RubberOptions& rubber) {
  learn::simulation::SimulationOptions options;
  options.rubber = rubber;
  if (rubber.memory) options.scene = {kRateHz, array.taxel_count()};
  const char* const scene = rubber.memory ? "two_weights" : "calibration";
  const auto simulator = need(learn::simulation::Simulator::create(array, options, scene, rubber.seed + 1));
  return calibrated_model(array, *simulator);
}

/// A sheet at work, and those who watch its age.
class SheetAtWork {
 public:
  SheetAtWork(const touch::pipeline::Model& model, const learn::simulation::RubberOptions& rubber, std::uint64_t seed)
      : model_(model),
        random_(seed),
        rubber_(need(learn::simulation::ConductiveRubber::create(rubber, model.array.rows, model.array.cols, seed))),
        circuit_(need(learn::simulation::ReadoutCircuit::create(model.array))),
        adc_(model.array.readout, 1.0),
        pipeline_(need(touch::pipeline::Pipeline::create(model))),
        monitor_(model),
        tracker_(model.array),
        drift_(model.array.taxel_count()) {
    pipeline_.drift().set_options({.track = true});
  }

  void step(const std::vector<double>& newtons, double celsius) {
    seconds_ += 1.0 / kRateHz;
    rubber_.press(newtons, 1.0 / kRateHz);
    std::vector<double> siemens(newtons.size());
    rubber_.read(celsius, siemens);
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      drift_[k] += kDriftAnHour * std::sqrt(1.0 / kRateHz / kSecondsOfHour) * random_.normal();
      siemens[k] += drift_[k] / 200e3;
    }
    std::vector<double> ratio(siemens.size());
    circuit_.ratios(siemens, ratio);
    RawFrame raw;
    raw.time = Nanos(std::llround(seconds_ * 1e9));
    raw.temperature_celsius = celsius + 0.3 * random_.normal();
    raw.supply_v = kSupplyV;
    raw.counts.resize(siemens.size());
    adc_.convert(ratio, kSupplyV, random_, raw.counts);
    pipeline_.process(raw, force_);
    monitor_.add(force_);
    tracker_.process(force_, report_);
    for (const Contact& contact : report_.contacts) touches_ = std::max(touches_, contact.id);
  }

  /// Puts the weight on once, anywhere.
  [[nodiscard]] learn::health::WeightFinding weigh(double celsius) {
    learn::health::WeightCheck check(model_, kWeightN);
    const std::size_t lines = model_.array.cols;
    const double x = random_.uniform(3.0, static_cast<double>(lines) - 4.0);
    const double y = random_.uniform(3.0, static_cast<double>(lines) - 4.0);
    std::vector<double> foot(lines * lines);
    double sum = 0.0;
    for (std::size_t k = 0; k < foot.size(); ++k) {
      const std::size_t row = k / lines;
      const double dx = static_cast<double>(k % lines) - x;
      const double dy = static_cast<double>(row) - y;
      foot[k] = std::exp(-(dx * dx + dy * dy) / (2.0 * kFootPitches * kFootPitches));
      if (foot[k] < 0.01) foot[k] = 0.0;
      sum += foot[k];
    }
    for (double& newtons : foot) newtons *= kWeightN / sum;
    const std::vector<double> nothing(foot.size());
    const auto hold = [&](const std::vector<double>& newtons, double seconds) {
      for (double left = seconds; left > 0.0; left -= 1.0 / kRateHz) {
        step(newtons, celsius);
        check.add(force_);
      }
    };
    hold(nothing, 1.0);
    hold(foot, kWeightSeconds);
    hold(nothing, 1.0);
    return check.finding();
  }

  [[nodiscard]] learn::health::AgeingEvidence evidence() const { return monitor_.evidence(); }
  [[nodiscard]] std::size_t touches() const { return touches_; }

 private:
  const touch::pipeline::Model& model_;
  Random random_;
  learn::simulation::ConductiveRubber rubber_;
  learn::simulation::ReadoutCircuit circuit_;
  learn::simulation::Adc adc_;
  touch::pipeline::Pipeline pipeline_;
  learn::health::AgeingMonitor monitor_;
  touch::contacts::ContactTracker tracker_;
  std::vector<double> drift_;
  double seconds_ = 0.0;
  ForceFrame force_;
  ContactReport report_;
  std::uint32_t touches_ = 0;
};

/// The touches of an hour, of which each has its own.
class Touches {
 public:
  Touches(const ArrayDescription& array, std::uint64_t seed)
      : scene_(need(learn::simulation::Scene::create(
            "touches", array, {}, seed, static_cast<std::size_t>(kSecondsOfHour * kRateHz), {kRateHz, {}}))) {}

  [[nodiscard]] std::size_t frames() const { return scene_.frame_count(); }
  const std::vector<double>& newtons(std::size_t frame) {
    scene_.frame(frame, frame_);
    return frame_.force_n;
  }

 private:
  learn::simulation::Scene scene_;
  learn::simulation::SceneFrame frame_;
};

/// Touches until the change is found; none within an hour: empty.
std::optional<std::size_t> touches_until_found(const touch::pipeline::Model& model,
                                               learn::simulation::RubberOptions rubber,
                                               learn::health::AgeingEvidence& evidence) {
  rubber.gain_spread = kChange;
  SheetAtWork work(model, rubber, rubber.seed + 100);
  Touches touches(model.array, rubber.seed + 200);
  for (std::size_t frame = 0; frame < touches.frames(); ++frame) {
    work.step(touches.newtons(frame), 22.0);
    evidence = work.evidence();
    if (evidence.has_aged()) return work.touches();
  }
  return std::nullopt;
}

void weigh_aged(const touch::pipeline::Model& model, learn::simulation::RubberOptions rubber) {
  for (const double change : {kChange, -kChange}) {
    rubber.gain = 1.0 + change;
    SheetAtWork work(model, rubber, rubber.seed + 300);
    const learn::health::WeightFinding finding = work.weigh(22.0);
    fmt::print("  gain {:+.0f} %: one weight reads {:+.1f} % (+- {:.1f} %), {}\n", 100.0 * change,
               100.0 * (finding.ratio - 1.0), 100.0 * finding.sigma, finding.has_aged() ? "found" : "not found");
  }
}

void use(const touch::pipeline::Model& model, const learn::simulation::RubberOptions& rubber, std::size_t hours) {
  SheetAtWork work(model, rubber, rubber.seed + 400);
  std::size_t alarm_minutes = 0;
  std::size_t alarm_weights = 0;
  for (std::size_t hour = 0; hour < hours; ++hour) {
    Touches touches(model.array, rubber.seed + 500 + hour);
    const auto celsius = [&](double share) {
      return 22.0 + kSwingCelsius * std::sin(2.0 * std::numbers::pi * (static_cast<double>(hour) + share) / 24.0);
    };
    for (std::size_t frame = 0; frame < touches.frames(); ++frame) {
      work.step(touches.newtons(frame), celsius(static_cast<double>(frame) / static_cast<double>(touches.frames())));
      const bool is_minute = frame % static_cast<std::size_t>(60.0 * kRateHz) == 0;
      if (is_minute && work.evidence().has_aged()) ++alarm_minutes;
    }
    if (work.weigh(celsius(1.0)).has_aged()) ++alarm_weights;
  }
  const learn::health::AgeingEvidence evidence = work.evidence();
  fmt::print(
      "  healthy, {} h, {} touches: {} minutes with an alarm, {} of {} weights; gains differ by {:.1f} % (+- {:.1f} "
      "%)\n",
      hours, work.touches(), alarm_minutes, alarm_weights, hours, 100.0 * evidence.gain_spread.value_or(0.0),
      100.0 * evidence.spread_sigma);
}

int run(std::size_t sheets, std::size_t hours, bool remembers) {
  const std::size_t lines = remembers ? 8 : 16;  // two weights on every taxel take their time
  const ArrayDescription array = learn::simulation::reference_array({lines, lines});
  for (std::size_t seed = 1; seed <= sheets; ++seed) {
    const learn::simulation::RubberOptions rubber = sheet(seed, remembers);
    const touch::pipeline::Model model = calibrated(array, rubber);
    fmt::print("sheet {}: calibrated to {:.1f} %\n", seed,
               100.0 * learn::health::AgeingMonitor(model).evidence().calibrated_spread);
    learn::health::AgeingEvidence evidence;
    const std::optional<std::size_t> touches = touches_until_found(model, rubber, evidence);
    fmt::print("  gains {:.0f} % apart: {} touches; {}\n", 100.0 * kChange,
               touches ? std::to_string(*touches) : "not found in all", learn::health::describe(evidence));
    weigh_aged(model, rubber);
    if (hours > 0) use(model, rubber, hours);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: ageing_campaign SHEETS HOURS [rubber]\n");
    return 2;
  }
  return dermis::run(std::strtoul(argv[1], nullptr, 10), std::strtoul(argv[2], nullptr, 10),
                     argc > 3 && std::string(argv[3]) == "rubber");
}
