// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/suit/saved_files.hpp"

#include "dermis/bytes/files/frames_csv.hpp"

namespace dermis::out::serve {

Status write_frames(const std::string& path, FrameShape shape, std::size_t count,
                    const std::function<void(std::size_t number, RawFrame& frame)>& fill) {
  auto writer = bytes::files::FramesCsvWriter::create(path, shape);
  if (!writer) return writer.error();
  RawFrame frame;
  for (std::size_t number = 0; number < count; ++number) {
    fill(number, frame);
    if (Status written = (*writer)->write(frame); !written) return written;
  }
  return (*writer)->commit();
}

}  // namespace dermis::out::serve
