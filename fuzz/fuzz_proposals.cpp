// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Rows, columns, then the bytes. Each proposal is a layout, and reads what it says.
#include <cstddef>
#include <cstdint>

#include "decoding.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dermis;
  if (size < 2) return 0;
  dermis::bytes::proposals::Known known;
  if (data[0] > 0) known.rows = data[0];
  if (data[1] > 0) known.cols = data[1];
  const auto proposals = dermis::bytes::proposals::propose({data + 2, size - 2}, known);
  fuzz::require(proposals.size() <= dermis::bytes::proposals::kMostProposals);
  for (const dermis::bytes::proposals::Proposal& proposal : proposals) {
    const auto layout = dermis::bytes::layouts::layout_from_toml(proposal.toml, "fuzz");
    fuzz::require(layout.has_value() && layout->arrays.front().shape == proposal.shape);
    fuzz::require(proposal.frames > 0 && proposal.example.size() == proposal.shape.taxel_count());
    fuzz::require(proposal.left_share >= 0.0 && proposal.left_share <= 1.0);
    for (const dermis::bytes::proposals::Part& part : proposal.parts)
      fuzz::require(part.begin <= part.end && part.end <= size - 2);
  }
  return 0;
}
