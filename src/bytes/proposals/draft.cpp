// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/draft.hpp"

#include <cstdio>

namespace dermis::bytes::proposals {
namespace {

std::string shape_keys(const FrameShape& shape) {
  return "rows = " + std::to_string(shape.rows) + "\ncols = " + std::to_string(shape.cols) + "\n";
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else if (c == '\t') {
      result += "\\t";
    } else if (c == '\r') {
      result += "\\r";
    } else if (byte < 0x20 || byte == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", unsigned{byte});
      result += escape;
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string toml_of(const Draft& draft) {
  std::string text = "[layout]\n";
  const bool is_alone = draft.arrays.size() == 1;
  if (is_alone) text += shape_keys(draft.arrays.front().shape);
  const std::string line = quoted(draft.line);
  const std::string lines = draft.head.empty() ? line : "[" + quoted(draft.head) + ", " + line + "]";
  if (!draft.line.empty()) text += "line = " + lines + "\n";
  if (!draft.packet.empty()) {
    text += "packet = [";
    for (const std::string& field : draft.packet) {
      if (text.back() != '[') text += ", ";
      text += quoted(field);
    }
    text += "]\n";
  }
  for (const auto& [key, value] : draft.keys) text.append(key).append(" = ").append(value).append("\n");
  if (is_alone) return text;
  for (const DraftArray& array : draft.arrays) {
    text += "\n[[layout.array]]\nname = " + quoted(array.name) + "\n";
    if (array.id) text += "id = " + std::to_string(*array.id) + "\n";
    text += shape_keys(array.shape);
  }
  return text;
}

}  // namespace dermis::bytes::proposals
