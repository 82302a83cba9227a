// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/circuit_advice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kSparsePatterns = 4;
constexpr std::size_t kSparseShare = 10;  // one taxel in ten
constexpr double kTolerableGrowth = 1.1;  // of the error, for the sake of cheap drivers
constexpr int kBisections = 12;
constexpr int kOtherTrials = 10;  // the circuit as it is, loads near the best, ideal drivers: about that many

struct Pattern {
  std::vector<double> siemens;
  std::vector<std::size_t> pressed;
};

/// Everything at its greatest resistance but the pressed taxels.
class PatternMaker {
 public:
  PatternMaker(const ArrayDescription& array, const TaxelRange& taxels) : array_(array), taxels_(taxels) {}

  std::vector<Pattern> make() {
    std::vector<Pattern> patterns;
    patterns.push_back(random([](std::size_t, std::size_t) { return true; }));
    for (std::size_t k = 0; k < kSparsePatterns; ++k) {
      patterns.push_back(random([this](std::size_t, std::size_t) { return random_.below(kSparseShare) == 0; }));
    }
    patterns.push_back(random([this](std::size_t row, std::size_t) { return row == array_.rows / 2; }));
    patterns.push_back(random([this](std::size_t, std::size_t col) { return col == array_.cols / 2; }));
    Pattern firm = random([](std::size_t row, std::size_t col) { return row == 0 && col == 0; });
    firm.siemens[0] = 1.0 / taxels_.least_ohm;
    patterns.push_back(std::move(firm));
    return patterns;
  }

 private:
  template <typename IsPressed>
  Pattern random(const IsPressed& is_pressed) {
    Pattern pattern{std::vector<double>(array_.taxel_count(), 1.0 / taxels_.most_ohm), {}};
    for (std::size_t row = 0; row < array_.rows; ++row) {
      for (std::size_t col = 0; col < array_.cols; ++col) {
        if (!is_pressed(row, col)) continue;
        pattern.pressed.push_back(array_.index(row, col));
        pattern.siemens[array_.index(row, col)] = 1.0 / random_.log_uniform(taxels_.least_ohm, taxels_.most_ohm);
      }
    }
    return pattern;
  }

  const ArrayDescription& array_;
  const TaxelRange& taxels_;
  Random random_{1};
};

Precision precision_of(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  double sum_of_logarithms = 0.0;
  for (const double error : errors) sum_of_logarithms += std::log(error);
  const std::size_t last = errors.size() - 1;
  return {std::exp(sum_of_logarithms / static_cast<double>(errors.size())), errors[last / 2], errors[last * 95 / 100],
          errors[last]};
}

/// Judges circuits that differ in their resistances.
class Judge {
 public:
  Judge(const ArrayDescription& array, const TaxelRange& taxels, double noise_ratio, std::function<void()> judged)
      : judged_(std::move(judged)),
        patterns_(PatternMaker(array, taxels).make()),
        noise_ratio_(noise_ratio),
        reading_(array.taxel_count()),
        siemens_(array.taxel_count()),
        sigma_(array.taxel_count()) {}

  Result<std::optional<Precision>> judge(const ArrayDescription& array) {
    judged_();
    const Result<simulation::ReadoutCircuit> circuit = simulation::ReadoutCircuit::create(array);
    if (!circuit) return circuit.error();
    auto inversion = touch::compensation::make_crosstalk_inversion(array);
    if (!inversion) return inversion.error();
    std::vector<double> errors;
    for (const Pattern& pattern : patterns_) {
      circuit->ratios(pattern.siemens, reading_);
      if (is_saturated(array.readout)) return std::optional<Precision>();
      if (!array.readout.pressure_raises_reading) {
        for (double& reading : reading_) reading = 1.0 - reading;
      }
      if (!(*inversion)->invert(reading_, siemens_).solved) return std::optional<Precision>();
      (*inversion)->propagate_noise(noise_ratio_, sigma_);
      for (const std::size_t taxel : pattern.pressed) errors.push_back(sigma_[taxel] / pattern.siemens[taxel]);
    }
    return std::optional(precision_of(std::move(errors)));
  }

 private:
  [[nodiscard]] bool is_saturated(const Readout& readout) const {
    const double full_scale =
        readout.adc_reference_v && readout.supply_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
    return std::any_of(reading_.begin(), reading_.end(), [&](double reading) { return reading > full_scale; });
  }

  std::function<void()> judged_;  // is called for every circuit
  std::vector<Pattern> patterns_;
  double noise_ratio_;
  std::vector<double> reading_;
  std::vector<double> siemens_;
  std::vector<double> sigma_;
};

ArrayDescription with_load(ArrayDescription array, double load_ohm) {
  array.readout.load_ohm.assign(array.sensed_lines(), load_ohm);
  return array;
}

ArrayDescription with_drive(ArrayDescription array, double drive_ohm) {
  array.readout.drive_ohm.assign(array.driven_lines(), drive_ohm);
  return array;
}

/// Values of a series of `steps` values a decade (E3, E12) from `least` to `most`, with two digits as they are sold.
std::vector<double> series(int steps, double least, double most) {
  static const std::vector<double> kE12{1.0, 1.2, 1.5, 1.8, 2.2, 2.7, 3.3, 3.9, 4.7, 5.6, 6.8, 8.2};
  constexpr double kRounding = 1e-9;
  std::vector<double> values;
  for (int exponent = static_cast<int>(std::floor(std::log10(least))); std::pow(10.0, exponent) <= most; ++exponent) {
    for (std::size_t k = 0; k < kE12.size(); k += kE12.size() / static_cast<std::size_t>(steps)) {
      const double value = std::pow(10.0, exponent) * kE12[k];
      if (value >= least * (1.0 - kRounding) && value <= most * (1.0 + kRounding)) values.push_back(value);
    }
  }
  return values;
}

bool is_better(const ResistorChoice& a, const ResistorChoice& b) {
  if (!a.precision || !b.precision) return a.precision.has_value() && !b.precision.has_value();
  return a.precision->mean < b.precision->mean;
}

Status try_loads(const ArrayDescription& array, const std::vector<double>& ohms, Judge& judge, CircuitAdvice& advice) {
  for (const double ohm : ohms) {
    const Result<std::optional<Precision>> precision = judge.judge(with_load(array, ohm));
    if (!precision) return precision.error();
    advice.loads.push_back({ohm, *precision});
  }
  std::sort(advice.loads.begin(), advice.loads.end(),
            [](const ResistorChoice& a, const ResistorChoice& b) { return a.load_ohm < b.load_ohm; });
  const auto same = [](const ResistorChoice& a, const ResistorChoice& b) { return b.load_ohm < 1.01 * a.load_ohm; };
  advice.loads.erase(std::unique(advice.loads.begin(), advice.loads.end(), same), advice.loads.end());
  const auto best = std::min_element(advice.loads.begin(), advice.loads.end(), is_better);
  advice.best = static_cast<std::size_t>(best - advice.loads.begin());
  return Done{};
}

/// The drive resistance at which the error is kTolerableGrowth times that of ideal drivers, by bisection of its
/// logarithm.
Result<double> most_drive(const ArrayDescription& array, double ideal_mean, double most_ohm, Judge& judge) {
  double low = 1e-3;
  double high = 10.0 * most_ohm;
  for (int step = 0; step < kBisections; ++step) {
    const double ohm = std::sqrt(low * high);
    const Result<std::optional<Precision>> precision = judge.judge(with_drive(array, ohm));
    if (!precision) return precision.error();
    const bool is_tolerable = *precision && (*precision)->mean <= kTolerableGrowth * ideal_mean;
    (is_tolerable ? low : high) = ohm;
  }
  return low;
}

}  // namespace

Result<double> adc_noise_ratio(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  if (readout.adc_reference_v && !readout.supply_v) {
    return bad_input("readout.supply_v: is missing; the noise of an ADC with a reference in volts depends on it");
  }
  const double full_scale = readout.adc_reference_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
  return readout.adc_noise_counts * full_scale / readout.full_scale_counts();
}

Result<CircuitAdvice> advise_circuit(const ArrayDescription& array, const TaxelRange& taxels,
                                     const std::function<void(double share)>& progress) {
  const Result<double> noise_ratio = adc_noise_ratio(array);
  if (!noise_ratio) return noise_ratio.error();
  const std::vector<double> coarse = series(3, taxels.least_ohm / 100.0, 10.0 * taxels.most_ohm);
  const double expected = static_cast<double>(coarse.size()) + kBisections + kOtherTrials;
  double judged = 0.0;
  Judge judge(array, taxels, *noise_ratio, [&] { progress(std::min(1.0, judged++ / expected)); });
  CircuitAdvice advice;
  advice.taxels = taxels;
  advice.noise_ratio = *noise_ratio;
  const Result<std::optional<Precision>> present = judge.judge(array);
  if (!present) return present.error();
  advice.present = *present;
  if (Status tried = try_loads(array, coarse, judge, advice); !tried) {
    return tried.error();
  }
  if (!advice.loads[advice.best].precision) {
    return failed("no load resistance brings all readings into the range of the ADC; raise its reference");
  }
  const double coarse_ohm = advice.loads[advice.best].load_ohm;
  if (Status tried = try_loads(array, series(12, coarse_ohm / 2.2, coarse_ohm * 2.2), judge, advice); !tried) {
    return tried.error();
  }
  const ArrayDescription best = with_load(array, advice.loads[advice.best].load_ohm);
  const Result<std::optional<Precision>> ideal = judge.judge(with_drive(best, 0.0));
  if (!ideal) return ideal.error();
  advice.ideal_drivers = *ideal;
  if (!advice.ideal_drivers) return advice;
  const Result<double> drive = most_drive(best, advice.ideal_drivers->mean, taxels.most_ohm, judge);
  if (!drive) return drive.error();
  advice.most_drive_ohm = *drive;
  return advice;
}

}  // namespace dermis::learn::health
