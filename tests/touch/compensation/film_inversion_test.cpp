// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Circuits under a film that conducts from line to line.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/line_faults.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/compensation/line_faults.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/inversion_campaign.hpp"

namespace dermis::touch::compensation {
namespace {

using support::NamedCircuit;

constexpr Film kFilm{50e3, 2e3, 20.0};
constexpr double kTypicalN = 10.0;
constexpr double kUnloadedSiemens = 1.0 / 250e3;

class UnderFilm : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(CrosstalkInversion, UnderFilm, testing::ValuesIn(support::circuits_with_film()),
                         [](const auto& info) { return info.param.name; });

/// An array of this circuit whose taxels have one law, and presses on it.
class Sheet {
 public:
  Sheet(const NamedCircuit& circuit, std::size_t rows, std::size_t cols, const Film& film, Random& random)
      : random_(random), array_(support::random_array(circuit, rows, cols, random)) {
    Readout& readout = array_.readout;
    for (double& ohm : readout.drive_ohm) ohm = random.uniform(0.0, 200.0);
    for (double& ohm : readout.load_ohm) ohm = random.uniform(150.0, 500.0);
    readout.film = film;
    readout.adc_bits = 12;
    typical_.assign(array_.taxel_count(), siemens_of(kTypicalN));
    unloaded_.assign(array_.taxel_count(), kUnloadedSiemens);
    for (const double newtons : {0.1, 0.3, 1.0, 3.0, 6.0, 10.0, 20.0, 40.0, 100.0}) {
      const double share = (siemens_of(newtons) - kUnloadedSiemens) / (siemens_of(kTypicalN) - kUnloadedSiemens);
      loads_.push_back({share, newtons});
    }
  }

  [[nodiscard]] const ArrayDescription& array() const { return array_; }
  [[nodiscard]] ReferenceConductances references() const { return {typical_, unloaded_, loads_}; }

  /// Up to four, of up to 60 N on a taxel.
  [[nodiscard]] std::vector<double> random_presses() {
    std::vector<double> newtons(array_.taxel_count());
    for (std::size_t press = 0; press < 1 + random_.below(4); ++press) {
      const std::size_t row = random_.below(array_.rows);
      const std::size_t col = random_.below(array_.cols);
      const double force = random_.log_uniform(1.0, 60.0);
      for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
        const std::size_t taxel_row = taxel / array_.cols;
        const double down = static_cast<double>(taxel_row) - static_cast<double>(row);
        const double right = static_cast<double>(taxel % array_.cols) - static_cast<double>(col);
        const double here = force * std::exp(-0.3 * (down * down + right * right));
        if (here > 0.05) newtons[taxel] = std::min(newtons[taxel] + here, 60.0);
      }
    }
    return newtons;
  }

  [[nodiscard]] static std::vector<double> siemens(const std::vector<double>& newtons) {
    std::vector<double> siemens;
    for (const double force : newtons) siemens.push_back(siemens_of(force));
    return siemens;
  }

  [[nodiscard]] std::vector<double> ratio(const std::vector<double>& newtons) const {
    std::vector<double> ratio(newtons.size());
    learn::simulation::ReadoutCircuit::create(array_)->ratios(siemens(newtons), newtons, ratio);
    return ratio;
  }

  /// As an ADC with noise reads them.
  [[nodiscard]] std::vector<double> noisy_ratio(const std::vector<double>& newtons) {
    std::vector<double> noisy = ratio(newtons);
    for (double& value : noisy) value = std::round(4095.0 * value + random_.normal()) / 4095.0;
    return noisy;
  }

 private:
  static double siemens_of(double newtons) {
    return newtons > 0.0 ? kUnloadedSiemens + 1.0 / (1000.0 * std::pow(newtons / 10.0, -0.9) + 60.0) : kUnloadedSiemens;
  }

  Random& random_;
  ArrayDescription array_;
  std::vector<double> typical_;
  std::vector<double> unloaded_;
  std::vector<LoadPoint> loads_;
};

std::unique_ptr<CrosstalkInversion> inversion_for(const Sheet& sheet, double tolerance) {
  InversionOptions options;
  options.tolerance_ratio = tolerance;
  options.references = sheet.references();
  auto inversion = make_crosstalk_inversion(sheet.array(), options);
  EXPECT_TRUE(inversion) << inversion.error().message;
  return std::move(*inversion);
}

/// The middle of |inverted / siemens - 1| over the pressed taxels.
double error_of(const std::vector<double>& inverted, const std::vector<double>& newtons) {
  const std::vector<double> siemens = Sheet::siemens(newtons);
  std::vector<double> errors;
  for (std::size_t k = 0; k < newtons.size(); ++k) {
    if (newtons[k] > 1.0) errors.push_back(std::abs(inverted[k] / siemens[k] - 1.0));
  }
  std::sort(errors.begin(), errors.end());
  return errors.empty() ? 0.0 : errors[errors.size() / 2];
}

TEST_P(UnderFilm, every_taxel_of_random_arrays_comes_back) {
  for (const std::size_t size : {2U, 5U, 9U}) {
    SCOPED_TRACE(testing::Message() << size << 'x' << size << ", seeds 1 to 10");
    EXPECT_EQ(support::campaign_of(GetParam(), size, size, 10).failed, 0);
  }
}

TEST_P(UnderFilm, the_film_follows_the_presses) {
  Random random(1);
  Sheet sheet(GetParam(), 8, 8, kFilm, random);
  const auto following = inversion_for(sheet, 1e-9);
  const auto unloaded = inversion_for(sheet, 1e-9);
  unloaded->hold_film([&] {
    FilmConductances film(8, 8);
    film.set(kFilm, std::vector<double>(64));
    return film;
  }());
  double followed = 0.0;
  double held = 0.0;
  std::vector<double> inverted(64);
  for (int frame = 0; frame < 10; ++frame) {
    SCOPED_TRACE(testing::Message() << "seed 1, frame " << frame);
    const auto newtons = sheet.random_presses();
    EXPECT_TRUE(following->invert(sheet.ratio(newtons), inverted).solved);
    followed = std::max(followed, error_of(inverted, newtons));
    (void)unloaded->invert(sheet.ratio(newtons), inverted);
    held = std::max(held, error_of(inverted, newtons));
  }
  EXPECT_LT(followed, 0.02);
  EXPECT_GT(held, 2.0 * followed);
}

TEST_P(UnderFilm, a_film_that_is_told_is_solved_with) {
  Random random(2);
  const Sheet sheet(GetParam(), 6, 7, kFilm, random);
  FilmConductances film(6, 7);
  for (double& siemens : film.between_rows) siemens = random.uniform(0.0, 3e-3);
  for (double& siemens : film.between_cols) siemens = random.uniform(0.0, 3e-3);
  const auto siemens = support::random_siemens(sheet.array(), random, 500.0, 1e5);
  auto model = CircuitModel::create(sheet.array());
  ASSERT_TRUE(model);
  model->set_film(film);
  model->solve(siemens);
  const auto inversion = inversion_for(sheet, 0.0);
  inversion->hold_film(film);
  std::vector<double> inverted(siemens.size());
  EXPECT_TRUE(inversion->invert(model->ratio(), inverted).solved);
  EXPECT_LE(support::distance(inverted, siemens), 1e-6);
}

TEST_P(UnderFilm, noisy_frames_of_any_press_are_solved) {
  for (const Film& film : {kFilm, Film{5e3, 5e3}}) {
    Random random(3);
    Sheet sheet(GetParam(), 10, 8, film, random);
    const auto inversion = inversion_for(sheet, 0.01 / 4095.0);
    std::vector<double> inverted(80);
    for (int frame = 0; frame < 40; ++frame) {
      SCOPED_TRACE(testing::Message() << "seed 3, film of " << film.loaded_ohm << " ohm, frame " << frame);
      EXPECT_TRUE(inversion->invert(sheet.noisy_ratio(sheet.random_presses()), inverted).solved);
      for (const double value : inverted) ASSERT_TRUE(std::isfinite(value) && value >= 0.0) << value;
    }
  }
}

TEST_P(UnderFilm, a_taxel_without_a_reading_is_kept_and_the_others_are_solved) {
  Random random(8);
  const Sheet sheet(GetParam(), 6, 5, Film{5e3, 5e3}, random);
  const auto siemens = support::random_siemens(sheet.array(), random, 1e3, 1e5);
  auto ratio = support::model_ratios(sheet.array(), siemens);
  std::vector<double> inverted(siemens.size());
  for (const std::size_t taxel : {7U, 8U, 29U}) {
    ratio[taxel] = std::nan("");
    inverted[taxel] = siemens[taxel];
  }
  EXPECT_TRUE(inversion_for(sheet, 1e-10)->invert(ratio, inverted).solved);
  EXPECT_LE(support::distance(inverted, siemens), 1e-4);
}

/// Its film conducts more than its taxels, many of which noise takes to 0 S.
TEST_P(UnderFilm, an_unloaded_sheet_is_solved_within_the_certificate) {
  Random random(9);
  Sheet sheet(GetParam(), 8, 8, Film{5e3, 5e3}, random);
  const auto inversion = inversion_for(sheet, 0.01 / 4095.0);
  std::vector<double> inverted(64);
  for (int frame = 0; frame < 20; ++frame) {
    const auto ratio = sheet.noisy_ratio(std::vector<double>(64));
    const InversionResult result = inversion->invert(ratio, inverted);
    EXPECT_TRUE(result.solved) << "seed 9, frame " << frame;
    const auto model = support::model_ratios(sheet.array(), inverted);
    for (std::size_t k = 0; k < ratio.size(); ++k) {
      const double lacking = ratio[k] - model[k];
      EXPECT_LE(inverted[k] > 0.0 ? std::abs(lacking) : lacking, result.residual_ratio + 1e-12) << frame << " " << k;
    }
  }
}

/// By its derivative, reading by reading.
TEST_P(UnderFilm, noise_is_that_of_the_readings) {
  Random random(10);
  Sheet sheet(GetParam(), 5, 6, Film{5e3, 5e3}, random);
  constexpr double kStep = 1e-7;
  const auto ratio = support::model_ratios(sheet.array(), support::random_siemens(sheet.array(), random, 1e3, 1e4));
  const auto inversion = inversion_for(sheet, 1e-12);
  std::vector<double> inverted(30);
  std::vector<double> moved(30);
  std::vector<double> sigma(30);
  std::vector<double> square(30);
  ASSERT_TRUE(inversion->invert(ratio, inverted).solved);
  inversion->propagate_noise(kStep, sigma);
  for (std::size_t reading = 0; reading < 30; ++reading) {
    auto other = ratio;
    other[reading] += kStep;
    ASSERT_TRUE(inversion->invert(other, moved).solved);
    for (std::size_t k = 0; k < 30; ++k) square[k] += (moved[k] - inverted[k]) * (moved[k] - inverted[k]);
  }
  for (std::size_t k = 0; k < 30; ++k) EXPECT_NEAR(sigma[k] / std::sqrt(square[k]), 1.0, 0.4) << k;
}

TEST_P(UnderFilm, later_frames_allocate_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(4);
  Sheet sheet(GetParam(), 9, 8, kFilm, random);
  const auto inversion = inversion_for(sheet, 1e-6);
  const auto first = sheet.noisy_ratio(sheet.random_presses());
  const auto second = sheet.noisy_ratio(sheet.random_presses());
  const FilmConductances film(9, 8);
  std::vector<double> inverted(72);
  std::vector<double> sigma(72);
  EXPECT_TRUE(inversion->invert(first, inverted).solved);
  inversion->propagate_noise(1e-4, sigma);
  const support::AllocationGuard guard;
  EXPECT_TRUE(inversion->invert(second, inverted).solved);
  inversion->propagate_noise(1e-4, sigma);
  inversion->hold_film(film);
  EXPECT_EQ(guard.count(), 0);
}

TEST_P(UnderFilm, a_weak_supply_is_undone_with_it) {
  if (GetParam().real_amplifiers) return;
  Random random(5);
  auto array = support::random_array(GetParam(), 5, 6, random);
  array.readout.supply_ohm = 10.0;
  const auto siemens = support::random_siemens(array, random, 1e3, 1e5);
  auto inversion = make_crosstalk_inversion(array, {.tolerance_ratio = 0.0});
  ASSERT_TRUE(inversion);
  std::vector<double> inverted(siemens.size());
  EXPECT_TRUE((*inversion)->invert(support::model_ratios(array, siemens), inverted).solved);
  EXPECT_LE(support::distance(inverted, siemens), 1e-6);
}

/// The faults that are found in so many frames of presses and pauses, and whether no reading was called impossible.
std::string faults_of(Sheet& sheet, int frames) {
  auto compensator = Compensator::create(sheet.array(), sheet.references()).value();
  LineFaultMonitor monitor(sheet.array(), sheet.references().unloaded);
  ConditionedFrame conditioned;
  ConductanceFrame conductance;
  conditioned.sigma_ratio = 1.04 / 4095.0;
  std::string text;
  std::vector<double> newtons(sheet.array().taxel_count());
  for (int frame = 0; frame < frames; ++frame) {
    if (frame % 6 == 0) newtons = sheet.random_presses();
    if (frame % 6 == 4) newtons.assign(newtons.size(), 0.0);
    conditioned.time = std::chrono::milliseconds(100 * frame);
    conditioned.ratio = sheet.noisy_ratio(newtons);
    for (double& value : conditioned.ratio) value = std::clamp(value, 0.0, 1.0);
    conditioned.taxels.assign(newtons.size(), TaxelStatus::ok);
    compensator.process(conditioned, conductance);
    if (has(conductance.status, FrameStatus::not_converged)) text += "unsolved; ";
    for (const TaxelStatus status : conductance.taxels) text += status == TaxelStatus::invalid ? "invalid; " : "";
    monitor.observe(conditioned, conductance);
    for (const LineFault& fault : monitor.faults()) text += place_name(fault, sheet.array()) + "; ";
  }
  return text;
}

TEST_P(UnderFilm, a_healthy_array_has_no_faults) {
  for (const Film& film : {kFilm, Film{20e3, 20e3}}) {
    Random random(6);
    Sheet sheet(GetParam(), 7, 8, film, random);
    EXPECT_EQ(faults_of(sheet, 200), "") << "seed 6, film of " << film.loaded_ohm << " ohm";
  }
}

/// The film still feeds it, but no reading tells of its taxels.
TEST(FaultUnderFilm, an_open_row_leaves_the_others_right) {
  for (const Film& film : {kFilm, Film{50e3, 50e3}}) {
    SCOPED_TRACE(testing::Message() << "seed 7, film of " << film.loaded_ohm << " ohm");
    Random random(7);
    Sheet sheet({"", Circuit::divider, IdleRows::floating}, 8, 8, film, random);
    learn::simulation::LineFaults faults;
    faults.rows.open = {2};
    const auto circuit = learn::simulation::FaultyCircuit::create(sheet.array(), faults).value();
    auto compensator = Compensator::create(sheet.array(), sheet.references()).value();
    const LineFault open{.kind = LineFaultKind::silent_row, .place = 2};
    compensator.set_faults({&open, 1});
    ConditionedFrame conditioned;
    ConductanceFrame conductance;
    conditioned.sigma_ratio = 1e-4;
    conditioned.taxels.assign(64, TaxelStatus::ok);
    conditioned.ratio.resize(64);
    std::vector<double> errors;
    for (int frame = 0; frame < 20; ++frame) {
      auto newtons = sheet.random_presses();
      for (std::size_t taxel = 8; taxel < 32; ++taxel) newtons[taxel] = 0.0;  // on it, and beside it
      circuit.ratios(Sheet::siemens(newtons), newtons, 0, conditioned.ratio);
      conditioned.time = std::chrono::milliseconds(100 * frame);
      compensator.process(conditioned, conductance);
      EXPECT_FALSE(has(conductance.status, FrameStatus::not_converged)) << "frame " << frame;
      errors.push_back(error_of(conductance.siemens, newtons));
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.02);
  }
}

}  // namespace
}  // namespace dermis::touch::compensation
