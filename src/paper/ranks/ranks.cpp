// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/ranks.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "paper/ranks/one_process.hpp"

namespace dermis::paper {

Ranks& one_process() noexcept {
  static OneProcess alone;
  return alone;
}

Part part_of(std::size_t items, std::size_t rank, std::size_t ranks) noexcept {
  const std::size_t first = items * rank / ranks;
  return {first, items * (rank + 1) / ranks - first};
}

Status agreed(Ranks& ranks, const Status& own) {
  std::vector<std::uint8_t> has_failed(ranks.count());
  has_failed[ranks.rank()] = own ? 0 : 1;
  gather(ranks, std::span(has_failed));
  const auto first = std::find(has_failed.begin(), has_failed.end(), 1);
  if (first == has_failed.end()) return Done{};
  const auto root = static_cast<std::size_t>(first - has_failed.begin());
  Error error = root == ranks.rank() ? own.error() : Error{};
  broadcast_value(ranks, error.kind, root);
  broadcast_list(ranks, error.message, root);
  broadcast_list(ranks, error.field, root);
  if (root == 0) return error;
  return Error{error.kind, "rank " + std::to_string(root) + ": " + error.message};
}

}  // namespace dermis::paper
