// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: process_frames CIRCUIT <frames >forces
// A frame is its temperature [C], its supply [V] and its counts, all in single precision. Its forces are one status,
// the newtons and the sigmas of the taxels, and the place of the strongest contact (NaN where there is none).
// At the end stderr gets the median time of a frame, to newtons and contacts [us].
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "circuits.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

bool read(std::vector<float>& numbers) {
  return std::fread(numbers.data(), sizeof(float), numbers.size(), stdin) == numbers.size();
}

void write(const std::vector<float>& numbers) {
  std::fwrite(numbers.data(), sizeof(float), numbers.size(), stdout);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.empty() ? 0.0 : *middle;
}

std::vector<float> place_of_strongest(const dermis::ContactReport& report) {
  const auto weaker = [](const dermis::Contact& a, const dermis::Contact& b) { return a.force_n < b.force_n; };
  const auto strongest = std::ranges::max_element(report.contacts, weaker);
  if (strongest == report.contacts.end()) return {kNone, kNone};
  return {static_cast<float>(strongest->position.x), static_cast<float>(strongest->position.y)};
}

}  // namespace

int main(int argument_count, char** arguments) {
  const auto array = dermis::wasm::described_array(argument_count > 1 ? arguments[1] : "");
  if (!array) return 2;
  auto pipeline = dermis::touch::pipeline::Pipeline::create(dermis::wasm::model_of(*array));
  if (!pipeline) return 1;
  dermis::touch::contacts::ContactTracker tracker(*array);
  std::vector<float> numbers(2 + array->taxel_count());
  dermis::RawFrame raw;
  dermis::ForceFrame force;
  dermis::ContactReport report;
  std::vector<double> times_us;
  while (read(numbers)) {
    raw.time += std::chrono::milliseconds(10);
    raw.temperature_celsius = static_cast<double>(numbers[0]);
    raw.supply_v = static_cast<double>(numbers[1]);
    raw.counts.assign(numbers.begin() + 2, numbers.end());
    const auto begin = std::chrono::steady_clock::now();
    pipeline->process(raw, force);
    tracker.process(force, report);
    times_us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    write({static_cast<float>(force.status)});
    write(force.newtons);
    write(force.sigma_newtons);
    write(place_of_strongest(report));
  }
  std::fprintf(stderr, "%.1f\n", median(std::move(times_us)));
  return 0;
}
