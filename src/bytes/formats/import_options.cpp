// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/import_options.hpp"

#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::formats {

Status check_shape(const std::string& name, FrameShape found, const std::optional<FrameShape>& wanted) {
  if (found.rows == 0 || found.cols == 0 || found.rows > kMaxLines || found.cols > kMaxLines) {
    return bad_input(name + ": has frames of " + files::size_text(found) + " taxels; 1x1 to 1024x1024 can be read");
  }
  if (!wanted || *wanted == found) return Done{};
  return bad_input(name + ": has " + files::size_text(found) + " taxels, the array is " + files::size_text(*wanted));
}

}  // namespace dermis::bytes::formats
