// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report_origin.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <sys/stat.h>

#include <chrono>
#include <ctime>

#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/touch/frames/version.hpp"

namespace dermis::app {
namespace {

/// Times before it are no host's: they count from the beginning of a recording.
constexpr Nanos kEarliestClock = std::chrono::sys_days(std::chrono::year(2000) / 1 / 1).time_since_epoch();

std::string utc(std::time_t seconds) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(seconds));
}

/// "multitouch/frames.csv, written 2026-11-25 22:13 UTC, fnv1a64:0123456789abcdef", as far as the system knows.
std::string describe(const std::string& path) {
  std::string words = path;
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return words;
  words += ", written " + utc(status.st_mtime);
  const Result<std::string> hash = bytes::files::content_hash(path);
  return hash ? words + ", " + *hash : words;
}

std::string simulated_source(const live::sources::SourceName& frames) {
  if (frames.kind == live::sources::SourceKind::simulation) return frames.text;
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(frames.file);
  return notes ? notes->simulation : std::string();
}

/// "2026-11-25 22:13 UTC to 2026-11-25 22:15 UTC", where the clock of the frames is that of a host.
std::string time_of(const std::vector<RawFrame>& frames) {
  if (frames.empty() || frames.front().acquisition.arrival_utc < kEarliestClock) return {};
  const auto seconds = [](const RawFrame& frame) {
    return std::chrono::duration_cast<std::chrono::seconds>(frame.acquisition.arrival_utc).count();
  };
  return utc(seconds(frames.front())) + " to " + utc(seconds(frames.back()));
}

}  // namespace

out::report::Origin report_origin(const JudgedFiles& files, const std::vector<RawFrame>& frames) {
  const Result<live::sources::SourceName> from = live::sources::SourceName::parse(files.frames);
  const std::string simulated = from ? simulated_source(*from) : std::string();
  const std::string time = time_of(frames);
  out::report::Origin origin;
  if (!simulated.empty()) {
    origin.summary = fmt::format("Simulated frames ({}).", simulated);
  } else {
    origin.summary = time.empty() ? "Measured frames, as far as their file tells."
                                  : fmt::format("Measured frames of {}, as far as their file tells.", time);
  }
  const std::string& file = from ? from->file : files.frames;
  origin.facts = {{"frames", file.empty() ? files.frames : describe(file)},
                  {"loads", describe(files.loads)},
                  {"model", describe(files.model)},
                  {"dermis version", DERMIS_VERSION}};
  return origin;
}

}  // namespace dermis::app
