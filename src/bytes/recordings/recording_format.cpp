// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/recording_format.hpp"

namespace dermis::bytes::recordings {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

std::string topic_part(const std::string& name) {
  std::string part = name;
  for (char& c : part) {
    if (!is_letter(c) && !(c >= '0' && c <= '9')) c = '_';
  }
  if (part.empty() || !is_letter(part.front())) part.insert(0, "array_");
  return part;
}

std::string attachment_name(const char* of, const std::string& array) {
  return array.empty() ? of : topic_part(array) + '/' + of;
}

}  // namespace dermis::bytes::recordings
