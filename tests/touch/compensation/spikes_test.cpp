// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/circuits.hpp"
#include "support/inversion_campaign.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kCount = 1.0 / 4095.0;

/// Frames of an array whose readings have noise, 10 ms apart.
class Stream {
 public:
  Stream(const ArrayDescription& array, std::uint64_t seed)
      : siemens(array.taxel_count()), array_(array), compensator_(Compensator::create(array).value()), random_(seed) {
    for (double& value : siemens) value = 1.0 / random_.log_uniform(1e5, 5e5);
    unloaded_ = siemens;
    frame_.sigma_ratio = kCount;
  }

  [[nodiscard]] Random& random() { return random_; }

  double& taxel(std::size_t row, std::size_t col) { return siemens[array_.index(row, col)]; }

  /// One to nine contacts of 1 to 9 taxels that touch, beside `standing`.
  void press(const std::vector<double>& standing) {
    siemens = standing;
    for (auto contacts = 1 + random_.below(9); contacts > 0; --contacts) {
      const std::size_t height = 1 + random_.below(3);
      const std::size_t width = 1 + random_.below(3);
      const std::size_t top = random_.below(array_.rows - height + 1);
      const std::size_t left = random_.below(array_.cols - width + 1);
      const double ohm = random_.log_uniform(800.0, 3e4);
      for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
        const std::size_t row = taxel / array_.cols;
        const std::size_t col = taxel % array_.cols;
        if (row < top || row >= top + height || col < left || col >= left + width) continue;
        siemens[taxel] = 1.0 / (ohm * random_.log_uniform(0.7, 1.4));
      }
    }
  }

  void lift() { siemens = unloaded_; }

  /// Its taxels without a conductance, where `reading` replaces that of a taxel.
  std::size_t next(std::optional<double> reading = {}, std::size_t at = 0,
                   Nanos after = std::chrono::milliseconds(10)) {
    frame_.ratio = support::model_ratios(array_, siemens);
    for (double& ratio : frame_.ratio) ratio = std::max(ratio + kCount * random_.normal(), 0.0);
    if (reading) frame_.ratio[at] = *reading;
    frame_.time += after;
    frame_.taxels.assign(array_.taxel_count(), TaxelStatus::ok);
    compensator_.process(frame_, solved_);
    return static_cast<std::size_t>(std::count(solved_.taxels.begin(), solved_.taxels.end(), TaxelStatus::invalid));
  }

  [[nodiscard]] const ConductanceFrame& solved() const { return solved_; }
  [[nodiscard]] bool is_taken(std::size_t taxel) const { return solved_.taxels[taxel] == TaxelStatus::invalid; }
  [[nodiscard]] const std::vector<double>& ratio() const { return frame_.ratio; }

  std::vector<double> siemens;

 private:
  ArrayDescription array_;
  Compensator compensator_;
  Random random_;
  std::vector<double> unloaded_;
  ConditionedFrame frame_;
  ConductanceFrame solved_;
};

class EveryCircuitWithDrivers : public testing::TestWithParam<support::NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(Spikes, EveryCircuitWithDrivers, testing::ValuesIn(support::all_circuits()),
                         [](const auto& circuit) { return circuit.param.name; });

TEST_P(EveryCircuitWithDrivers, loses_no_taxel_by_presses_of_one_frame) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Stream stream(support::random_array(GetParam(), 8, 6, random), seed);
    const std::vector<double> unloaded = stream.siemens;
    std::vector<double> standing = unloaded;
    stream.next();
    for (int press = 0; press < 12; ++press) {
      stream.press(standing);
      EXPECT_EQ(stream.next(), 0U) << "press " << press;
      if (press % 4 == 1) standing = press % 8 == 1 ? stream.siemens : unloaded;
      stream.siemens = standing;
      if (press % 3 == 0) {
        EXPECT_EQ(stream.next(), 0U) << "after press " << press;
      }
    }
  }
}

class EveryCircuitThatTells : public testing::TestWithParam<support::NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(Spikes, EveryCircuitThatTells,
                         testing::Values(support::NamedCircuit{"divider"},
                                         support::NamedCircuit{"one_load", Circuit::divider, IdleRows::grounded,
                                                               IdleColumns::floating},
                                         support::NamedCircuit{"flexitac", Circuit::flexitac}),
                         [](const auto& circuit) { return circuit.param.name; });

TEST_P(EveryCircuitThatTells, finds_readings_that_jump_though_nothing_pressed) {
  constexpr std::uint64_t kSeed = 5;
  ArrayDescription array = support::reference_circuit(10, 8, GetParam().circuit);
  array.readout.idle_columns = GetParam().idle_columns;
  array.readout.load_ohm.assign(array.sensed_lines(), 1000.0);
  Stream stream(array, kSeed);
  std::size_t found = 0;
  constexpr std::size_t kSpikes = 200;
  for (std::size_t spike = 0; spike < kSpikes; ++spike) {
    if (spike % 20 == 10) stream.press(stream.siemens);
    if (spike % 40 == 0) stream.lift();
    stream.next();
    const std::size_t at = stream.random().below(array.taxel_count());
    const double reading = stream.ratio()[at] + (0.95 - stream.ratio()[at]) * stream.random().uniform(0.2, 1.0);
    stream.next(reading, at);
    found += stream.is_taken(at) ? 1 : 0;
  }
  EXPECT_GT(found, kSpikes * 95 / 100) << "seed " << kSeed;
}

constexpr std::size_t kAt = 9 * 16 + 10;

/// A divider of 16x16 taxels with one load that stays, at r4c10.
Stream with_a_load() {
  Stream stream(support::reference_circuit(), 7);
  stream.taxel(4, 10) = 3e-3;
  stream.next();
  return stream;
}

TEST(Spikes, a_jump_that_stays_is_believed_after_three_frames) {
  Stream stream = with_a_load();
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(stream.next(0.4, kAt), 1U);
    EXPECT_TRUE(stream.is_taken(kAt));
  }
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(stream.next(0.4, kAt), 0U);
}

TEST(Spikes, that_come_back_are_found_every_time) {
  Stream stream = with_a_load();
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_EQ(stream.next(), 0U);
    EXPECT_EQ(stream.next(0.4, kAt), 1U);
  }
}

TEST(Spikes, leave_the_others_of_their_line_as_they_were) {
  Stream stream = with_a_load();
  stream.next(0.4, kAt);
  EXPECT_NEAR(stream.solved().siemens[4 * 16 + 10], 3e-3, 3e-5);
}

TEST(Spikes, frames_that_are_far_apart_are_not_compared) {
  Stream stream = with_a_load();
  EXPECT_EQ(stream.next(0.4, kAt, std::chrono::milliseconds(100)), 0U);
}

TEST(Spikes, of_which_too_little_is_seen_are_doubtful_and_their_sigma_says_so) {
  ArrayDescription array = support::reference_circuit(3, 16);
  Stream stream(array, 7);
  stream.next();
  const std::size_t at = 16 + 10;
  const double before = stream.solved().siemens[at];
  EXPECT_EQ(stream.next(0.5, at), 0U);
  EXPECT_TRUE(has(stream.solved().status, FrameStatus::doubtful));
  EXPECT_GT(2.0 * stream.solved().sigma_siemens[at], stream.solved().siemens[at] - before);
  EXPECT_EQ(stream.next(), 0U);
  EXPECT_FALSE(has(stream.solved().status, FrameStatus::doubtful));
}

}  // namespace
}  // namespace dermis::touch::compensation
