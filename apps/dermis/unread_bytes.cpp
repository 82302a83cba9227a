// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "unread_bytes.hpp"

#include <algorithm>

#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/proposals/look.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::app {

std::string look_of_unread(std::span<const std::uint8_t> bytes) {
  const std::vector<bytes::proposals::Proposal> proposals = bytes::proposals::propose(bytes, {});
  return proposals.empty() ? std::string() : bytes::proposals::look_of(proposals.front());
}

std::string look_of_unread_file(const std::string& path) {
  const std::string text = bytes::files::first_bytes_of(path, bytes::proposals::kMostBytes);
  const std::string_view kind = bytes::files::kind_of(text);
  if (!kind.empty() && kind != bytes::files::kTableKind) return {};
  const std::string look = look_of_unread({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return look.empty() ? look : look + more_by_describe(path);
}

std::string more_by_describe(const std::string& source) {
  return "; 'dermis describe " + source + "' shows more";
}

void FirstBytes::add(std::span<const std::uint8_t> bytes) {
  bytes = bytes.first(std::min(bytes.size(), kMost - bytes_.size()));
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

}  // namespace dermis::app
