// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/proposals/proposals.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::proposals {

struct DraftArray {
  std::string name{};  ///< Empty where there is but one.
  FrameShape shape;
  std::optional<std::uint64_t> id{};
};

/// A layout that may be right.
struct Draft {
  std::vector<DraftArray> arrays;
  std::string line{};                 ///< The pattern of text,
  std::string head{};                 ///< The pattern of the lines that begin a frame; empty: there are none.
  std::vector<std::string> packet{};  ///< or the fields of a packet.
  std::vector<std::pair<std::string, std::string>> keys{};  ///< Further keys, with their values in TOML.
  std::vector<std::string> reasons{};
  std::vector<std::string> doubts{};
  std::vector<std::string> left_over{};  ///< As in a proposal.
  std::vector<Part> parts{};             ///< Of the first bytes.
  std::string look{};                    ///< "60 lines of 81 numbers"
  bool has_certain_shape = false;
  bool has_certain_unit = false;
  bool is_weak = false;  ///< Nothing but its readings speaks for it.
  double merit = 0.0;    ///< What speaks for it beside the frames: checksums, counters, what is known.
};

[[nodiscard]] std::string toml_of(const Draft& draft);

}  // namespace dermis::bytes::proposals
