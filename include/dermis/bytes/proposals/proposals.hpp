// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/frame_source.hpp"

/// Layouts (docs/layouts.md) of bytes that nobody has described.
namespace dermis::bytes::proposals {

/// Facts on an array that are known beside its bytes.
struct Known {
  std::optional<std::size_t> rows{};
  std::optional<std::size_t> cols{};
  std::string unit{};     ///< Of a reading, as in a layout; empty: not known.
  std::string start{};    ///< What the device was sent before it began, as in a layout,
  std::string request{};  ///< or before each of its answers.
};

/// Bytes of a stream that hold the same thing.
struct Part {
  std::size_t begin = 0;
  std::size_t end = 0;
  layouts::Role role = layouts::Role::literal;
};

/// A layout, and what speaks for it.
struct Proposal {
  std::string toml;                    ///< As layouts::layout_from_toml() reads it.
  std::string summary;                 ///< "60 lines of 81 numbers: a frame a line? then rows=9, cols=9"
  std::vector<std::string> reasons;    ///< Sentences.
  std::vector<std::string> doubts;     ///< Sentences on what may be otherwise.
  std::vector<std::string> left_over;  ///< Sentences on bytes that belong to no frame.
  std::vector<Part> parts;             ///< Of the first bytes, in order; those between them are text or left over.
  std::vector<std::string> open;       ///< Keys that the bytes cannot tell: "rows", "cols", "unit".
  double merit = 0.0;                  ///< The greater, the better than another proposal of the same bytes.
  std::size_t arrays = 1;
  std::size_t frames = 0;      ///< Of the first array.
  double left_share = 0.0;     ///< Of the bytes, 0 to 1.
  std::vector<float> example;  ///< Of the first frames of the first array that whose readings differ most, row-major.
  FrameShape shape;            ///< Of it.
};

/// The most bytes that are looked at.
inline constexpr std::size_t kMostBytes = std::size_t{256} << 10U;
inline constexpr std::size_t kMostProposals = 3;

/// At most kMostProposals, the best first; none where no layout reads most of the bytes. Each was tried on the bytes.
[[nodiscard]] std::vector<Proposal> propose(std::span<const std::uint8_t> bytes, const Known& known);

}  // namespace dermis::bytes::proposals
