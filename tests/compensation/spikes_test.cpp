// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/spikes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "dermis/simulation/readout_circuit.hpp"
#include "support/reference_array.hpp"

namespace dermis::compensation {
namespace {

/// A divider of 16x16 taxels with one load that stays, at r4c10.
class Stream {
 public:
  Stream() : array_(support::reference_circuit()), spikes_(array_), siemens_(array_.taxel_count(), 5e-6) {
    taxel(4, 10) = 3e-3;
    frame_.sigma_ratio = 1.0 / 4095.0;
    frame_.ratio.resize(array_.taxel_count());
  }

  double& taxel(std::size_t row, std::size_t col) { return siemens_[array_.index(row, col)]; }

  /// Its spikes, where `reading` replaces that of r9c10.
  std::size_t next(std::optional<double> reading = {}, Nanos after = std::chrono::milliseconds(10)) {
    simulation::ReadoutCircuit::create(array_).value().ratios(siemens_, frame_.ratio);
    if (reading) frame_.ratio[array_.index(9, 10)] = *reading;
    frame_.time += after;
    frame_.taxels.assign(array_.taxel_count(), TaxelStatus::ok);
    spikes_.check(frame_, frame_.taxels);
    return static_cast<std::size_t>(std::count(frame_.taxels.begin(), frame_.taxels.end(), TaxelStatus::invalid));
  }

  [[nodiscard]] bool is_spike_at_r9c10() const { return frame_.taxels[array_.index(9, 10)] == TaxelStatus::invalid; }

 private:
  ArrayDescription array_;
  Spikes spikes_;
  std::vector<double> siemens_;
  ConditionedFrame frame_;
};

TEST(Spikes, a_jump_that_a_loaded_neighbour_does_not_answer_is_a_spike) {
  Stream stream;
  EXPECT_EQ(stream.next(), 0U);
  EXPECT_EQ(stream.next(0.4), 1U);
  EXPECT_TRUE(stream.is_spike_at_r9c10());
  EXPECT_EQ(stream.next(), 0U);
}

TEST(Spikes, a_press_takes_from_its_neighbours_and_is_none) {
  Stream stream;
  stream.next();
  stream.taxel(9, 10) = 5e-3;
  EXPECT_EQ(stream.next(), 0U);
}

TEST(Spikes, a_jump_that_stays_is_believed_after_three_frames) {
  Stream stream;
  stream.next();
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(stream.next(0.4), 1U);
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(stream.next(0.4), 0U);
}

TEST(Spikes, spikes_that_come_back_are_found_every_time) {
  Stream stream;
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_EQ(stream.next(), 0U);
    EXPECT_EQ(stream.next(0.4), 1U);
  }
}

TEST(Spikes, frames_that_are_far_apart_are_not_compared) {
  Stream stream;
  stream.next();
  EXPECT_EQ(stream.next(0.4, std::chrono::milliseconds(100)), 0U);
}

}  // namespace
}  // namespace dermis::compensation
