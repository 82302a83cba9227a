// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "dermis/learn/recognition/dataset.hpp"
#include "fuzz_table.hpp"

namespace dermis::fuzz {

/// parse(table, labels): each split learns from labels that are there, and from none that it answers for.
template <typename Parse>
void fuzz_splits(const std::uint8_t* data, std::size_t size, const Parse& parse) {
  std::vector<dermis::learn::recognition::Label> labels;
  for (const char id : {'a', 'b', 'c', 'd'}) labels.push_back({.id = std::string(1, id)});
  const auto table = table_of(data, size);
  if (!table) return;
  const Result<std::vector<dermis::learn::recognition::Split>> splits = parse(*table, labels);
  if (!splits) return check_error(splits.error());
  for (const dermis::learn::recognition::Split& split : *splits) {
    const std::set<std::size_t> taught(split.taught.begin(), split.taught.end());
    if (!taught.empty() && *taught.rbegin() >= labels.size()) std::abort();
    for (const std::size_t label : split.asked) {
      if (label >= labels.size() || taught.contains(label)) std::abort();
    }
  }
}

}  // namespace dermis::fuzz
