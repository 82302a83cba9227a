// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <sstream>
#include <string>

#include "check_error.hpp"
#include "dermis/bytes/formats/import_options.hpp"

namespace dermis::fuzz {

/// Reads all frames that an importer finds in the bytes.
template <typename Open>
int import_frames(Open open, std::span<const std::uint8_t> data, dermis::bytes::formats::ImportOptions options = {}) {
  options.notice = options.loss = [](const std::string& line) {
    if (line.find('\n') != std::string::npos) std::abort();
  };
  auto bytes = std::make_unique<std::istringstream>(std::string(data.begin(), data.end()));
  const auto source = open(std::move(bytes), "fuzz", options);
  if (!source) {
    check_error(source.error());
    return 0;
  }
  RawFrame frame;
  while (true) {
    const Result<bool> more = (*source)->next(frame);
    if (!more) check_error(more.error());
    if (!more || !*more) return 0;
    if (frame.counts.size() != (*source)->shape()->taxel_count()) std::abort();
  }
}

}  // namespace dermis::fuzz
