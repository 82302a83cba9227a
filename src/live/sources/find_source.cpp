// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <chrono>
#include <memory>
#include <utility>

#include "dermis/live/sources/array_folder.hpp"
#include "dermis/live/sources/patience.hpp"
#include "live/sources/likely_sources.hpp"

namespace dermis::live::sources {
namespace {

constexpr std::chrono::milliseconds kPatienceAtAPort{2500};  // a board begins anew when its port is opened

bool sends_frames(const SourceName& name, FrameShape sent, SourceOptions options) {
  const Patience patience(options.stop, kPatienceAtAPort);
  options.stop = patience.over();
  const Result<std::unique_ptr<FrameSource>> source = open_source(name, options);
  RawFrame frame;
  const Result<bool> came = source ? (*source)->next(frame) : Result<bool>(false);
  return came && *came && (*source)->shape() == sent;
}

}  // namespace

Result<SourceName> find_source(const ArrayFolder& folder, FrameShape sent, const SourceOptions& options) {
  for (SourceName& name : likely_sources(folder)) {
    if (sends_frames(name, sent, options)) return std::move(name);
  }
  return bad_input(
      fmt::format("'{}': no frame of {}x{} readings came from {}, nor from another serial port: plug it in",
                  folder.path, sent.rows, sent.cols, folder.from));
}

}  // namespace dermis::live::sources
