// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/frames.hpp"

#include <algorithm>
#include <cmath>

#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::benchmarks {
namespace {

constexpr int kContacts = 4;
constexpr double kRampFrames = 10.0;

struct Contact {
  double row = 0.0;
  double col = 0.0;
  double row_speed = 0.0;  // taxels a frame
  double col_speed = 0.0;
  double width = 1.0;
  double siemens = 0.0;
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] double at(double frame, double taxel_row, double taxel_col) const {
    const double age = frame - begin;
    const double press = std::clamp(std::min(age, end - frame) / kRampFrames, 0.0, 1.0);
    const double down = taxel_row - row - row_speed * age;
    const double across = taxel_col - col - col_speed * age;
    return siemens * press * std::exp(-(down * down + across * across) / (2.0 * width * width));
  }
};

Contact new_contact(double size, double frame, Random& random) {
  Contact contact;
  contact.row = random.uniform(0.0, size);
  contact.col = random.uniform(0.0, size);
  contact.row_speed = random.uniform(-0.05, 0.05);
  contact.col_speed = random.uniform(-0.05, 0.05);
  contact.width = random.uniform(0.5, 1.5);
  contact.siemens = 1.0 / random.log_uniform(400.0, 2000.0);
  contact.begin = frame + random.uniform(0.0, 20.0);
  contact.end = contact.begin + random.uniform(50.0, 110.0);
  return contact;
}

}  // namespace

std::vector<std::vector<double>> touch_sequence(const ArrayDescription& array, std::size_t frames) {
  Random random(1);
  const auto circuit = learn::simulation::ReadoutCircuit::create(array);
  std::vector<double> idle(array.taxel_count());
  for (double& siemens : idle) siemens = 1.0 / random.log_uniform(150e3, 300e3);
  std::vector<Contact> contacts(kContacts);
  std::vector<std::vector<double>> sequence;
  const double counts = array.readout.full_scale_counts();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const auto time = static_cast<double>(frame);
    for (Contact& contact : contacts) {
      if (time >= contact.end) contact = new_contact(static_cast<double>(array.rows), time, random);
    }
    std::vector<double> siemens = idle;
    for (std::size_t k = 0; k < siemens.size(); ++k) {
      const std::size_t line = k / array.cols;
      const auto row = static_cast<double>(line);
      const auto col = static_cast<double>(k % array.cols);
      for (const Contact& contact : contacts) siemens[k] += contact.at(time, row, col);
    }
    std::vector<double> ratio(siemens.size());
    circuit->ratios(siemens, ratio);
    for (double& reading : ratio) reading = std::max(0.0, std::round(reading * counts + random.normal())) / counts;
    sequence.push_back(std::move(ratio));
  }
  return sequence;
}

}  // namespace dermis::benchmarks
