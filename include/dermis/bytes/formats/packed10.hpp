// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// Frames as they come over I2C from controllers that pack their readings. A reading has 10 bits, row by row, the
/// highest bit first, without a gap, so 4 readings have 5 bytes. A frame begins with a byte of its own. Nothing else is
/// between the frames. The file has neither shape nor times: options.shape and options.rate_hz give them. A last frame
/// that is cut is left out, with a notice. The memory is that of a frame. `name` stands for the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_packed10(std::unique_ptr<std::istream> in,
                                                                 const std::string& name, const ImportOptions& options);

}  // namespace dermis::bytes::formats
