// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"

namespace dermis::out::datasets {

/// Taxels without a value while others had one.
struct FaultyTaxels {
  std::vector<std::size_t> always;     ///< In every such frame.
  std::vector<std::size_t> sometimes;  ///< In some of them.
};
[[nodiscard]] FaultyTaxels faulty_taxels(const ArrayTally& array);

/// For a person who is going to train, one line each: the episodes, what is held out, and each array.
[[nodiscard]] std::vector<std::string> summary_lines(const EpisodeTally& tally);

/// The same at length as a page of HTML, with the first and the last picture of each array. `title`: names the dataset.
[[nodiscard]] std::string summary_page(const EpisodeTally& tally, const std::string& title);

/// The same for programs: JSON with the split, the episodes and the masks of faulty taxels.
[[nodiscard]] std::string summary_json(const EpisodeTally& tally);

/// The first episode and the one after the last: "0:8". They are the held-out ones, or the others.
[[nodiscard]] std::string split_text(const EpisodeTally& tally, bool held_out);

}  // namespace dermis::out::datasets
