// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/message_id.hpp"

#include <charconv>
#include <optional>
#include <string_view>

namespace dermis::live::fleet {
namespace {

std::optional<std::uint64_t> number_of(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number >> 62U != 0) return std::nullopt;
  return number;
}

}  // namespace

std::string begin_of_id(std::uint64_t session, const std::string& array) {
  return "s" + std::to_string(session) + "." + array + "-";
}

MessageId parse_message_id(const std::string& text) {
  const std::string_view all = text;
  const std::size_t session_end = all.find('.');
  if (!all.starts_with('s') || session_end == std::string_view::npos) return {};
  const std::optional<std::uint64_t> session = number_of(all.substr(1, session_end - 1));
  if (!session) return {};
  MessageId id{.session = *session};
  const std::string_view numbers = all.substr(all.rfind('-') + 1);
  const std::size_t first_end = numbers.find('.');
  if (first_end == std::string_view::npos) return id;
  const std::optional<std::uint64_t> first = number_of(numbers.substr(0, first_end));
  const std::optional<std::uint64_t> frames = number_of(numbers.substr(first_end + 1));
  if (!first || !frames) return id;
  id.first = *first;
  id.frames = *frames;
  return id;
}

}  // namespace dermis::live::fleet
