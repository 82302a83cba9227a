// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/draft.hpp"

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::proposals {
namespace {

std::string shape_keys(const FrameShape& shape) {
  return "rows = " + std::to_string(shape.rows) + "\ncols = " + std::to_string(shape.cols) + "\n";
}

}  // namespace

std::string toml_of(const Draft& draft) {
  std::string text = "[layout]\n";
  const bool is_alone = draft.arrays.size() == 1;
  if (is_alone) text += shape_keys(draft.arrays.front().shape);
  const std::string line = files::quoted_toml(draft.line);
  const std::string lines = draft.head.empty() ? line : "[" + files::quoted_toml(draft.head) + ", " + line + "]";
  if (!draft.line.empty()) text += "line = " + lines + "\n";
  if (!draft.packet.empty()) {
    text += "packet = [";
    for (const std::string& field : draft.packet) {
      if (text.back() != '[') text += ", ";
      text += files::quoted_toml(field);
    }
    text += "]\n";
  }
  for (const auto& [key, value] : draft.keys) text.append(key).append(" = ").append(value).append("\n");
  if (is_alone) return text;
  for (const DraftArray& array : draft.arrays) {
    text += "\n[[layout.array]]\nname = " + files::quoted_toml(array.name) + "\n";
    if (array.id) text += "id = " + std::to_string(*array.id) + "\n";
    text += shape_keys(array.shape);
  }
  return text;
}

}  // namespace dermis::bytes::proposals
