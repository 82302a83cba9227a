// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "out/serve/parts/host.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/recording/recordings_folder.hpp"
#include "out/serve/recording/suit_recorder.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::int64_t kShortestPause = std::int64_t{1} * Part::kTicksPerSecond;
constexpr std::int64_t kLongestPause = std::int64_t{64} * Part::kTicksPerSecond;

/// A recording whose disk was full goes on in another file when there is room.
class Resumption final : public Part {
 public:
  explicit Resumption(Host& host) : host_(host) {}

  /// A disk that fails again and again is tried less and less often.
  void tick(std::int64_t tick) override {
    if (tick < next_) return;
    const bool is_resumed = host_.recorder.resume();
    pause_ = is_resumed ? std::min(2 * pause_, kLongestPause) : kShortestPause;
    next_ = tick + pause_;
    if (!is_resumed) return;
    host_.notify(fmt::format("the recording goes on in {}; {} frames are in none", absolute_path(host_.recorder.path()),
                             host_.recorder.missed()));
    host_.server.parameters_changed();
  }

 private:
  Host& host_;
  std::int64_t next_ = 0;
  std::int64_t pause_ = kShortestPause;
};

}  // namespace

Result<std::unique_ptr<Part>> make_resumption(Host& host) {
  return std::unique_ptr<Part>(std::make_unique<Resumption>(host));
}

}  // namespace dermis::out::serve
