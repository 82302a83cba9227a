// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::app {
namespace {

struct RecoverOptions {
  std::string in;
  std::string out;
};

std::string lost_text(const bytes::recordings::Recovery& recovery) {
  std::string text;
  if (recovery.damaged_chunks > 0) {
    text += fmt::format("; {} damaged chunk{} with {} messages", recovery.damaged_chunks,
                        recovery.damaged_chunks == 1 ? "" : "s", recovery.lost_messages);
    text += recovery.damaged_chunks == 1 ? " is lost" : " are lost";
  }
  if (recovery.lost_bytes > 0) text += fmt::format("; {} bytes are in no whole record", recovery.lost_bytes);
  if (text.empty()) text = recovery.was_complete ? "; nothing was wrong" : "; nothing but the index was missing";
  return text;
}

Status recover(const RecoverOptions& options) {
  for (const std::string& path : {options.in, options.out}) {
    const Result<bytes::recordings::FrameFormat> format = bytes::recordings::frame_format(path);
    if (format && *format == bytes::recordings::FrameFormat::mcap) continue;
    return bad_input(
        fmt::format("'{}': is no .mcap recording; files of other formats are complete or not there", path));
  }
  const Result<bytes::recordings::Recovery> recovery = bytes::recordings::recover_recording(options.in, options.out);
  if (!recovery) return recovery.error();
  fmt::print("{}: {} frames, {} messages{}\n", options.out, recovery->frames, recovery->messages, lost_text(*recovery));
  return Done{};
}

}  // namespace

void add_recover(Command& command) {
  auto options = std::make_shared<RecoverOptions>();
  command.input_file("in", options->in, "Recording (.mcap); it is not changed").required();
  command.output("--out", options->out, "Recording to write (.mcap)").required();
  command.action([options] { return recover(*options); });
}

}  // namespace dermis::app
