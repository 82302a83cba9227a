// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "dermis/learn/recognition/dataset.hpp"
#include "fuzz_table.hpp"

// Labels that pass the checks name frames that are there.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kFrames = 100;
  const auto table = dermis::fuzz::table_of(data, size);
  if (!table) return 0;
  auto labels = dermis::learn::recognition::labels_of(*table, "class");
  if (!labels) {
    dermis::fuzz::check_error(labels.error());
    return 0;
  }
  const dermis::learn::recognition::LabelledFrames frames{
      {.arrays = {{.name = "skin"}}, .readings = 1}, std::vector<float>(kFrames), {}, *std::move(labels)};
  if (!frames.check_labels()) return 0;
  for (const auto& label : frames.labels) {
    if (label.name.empty() || frames.segment(label).frames.size() != label.last - label.first + 1) std::abort();
  }
  return 0;
}
