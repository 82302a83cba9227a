// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "out/serve/health/ageing_watch.hpp"
#include "out/serve/health/status_messages.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::int64_t kTicksToReport = std::int64_t{5} * Part::kTicksPerSecond;

/// The state of the arrays and of the work: the topics of health and statistics, and lines for the log where something
/// is left out.
class HealthPart final : public Part {
 public:
  HealthPart(Host& host, const Topic& health, const Topic& statistics)
      : host_(host), health_(health), statistics_(statistics), ageing_(host.suit) {}

  void hear(const live::suits::ArrayResult& result) override { ageing_.add(result); }
  void model_changed(std::size_t array) override { ageing_.begin_anew(array, *host_.models.of(array)); }

  void tick(std::int64_t tick) override {
    if (tick % 15 == 2) publish_statistics();
    if (tick % 30 == 5) publish_health();
    if (tick % kTicksToReport == 0) report_left_out();
  }
  void finish() override { report_left_out(); }

  void diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const override {
    for (std::size_t k = 0; k < host_.suit.arrays.size(); ++k) {
      diagnoses.push_back(diagnosis_message(host_.suit.arrays[k].name, *host_.models.of(k), host_.live.statistics(k),
                                            ageing_.evidence(k)));
    }
  }

  void report(live::fleet::RobotHealth& health) const override {
    for (std::size_t k = 0; k < host_.suit.arrays.size(); ++k) {
      fill_in(health.arrays[k], *host_.models.of(k), host_.live.statistics(k), ageing_.evidence(k));
    }
  }

 private:
  void publish_statistics() {
    if (!statistics_.is_wanted()) return;
    bytes::ros_messages::Statistics statistics;
    statistics.time = host_.now();
    for (std::size_t k = 0; k < host_.suit.arrays.size(); ++k) {
      statistics.arrays.push_back(statistics_message(host_.suit.arrays[k].name, host_.live.statistics(k)));
    }
    statistics.recording = host_.recorder.recording();
    statistics.recording_file = host_.recorder.path();
    statistics.recording_frames = host_.recorder.frames();
    statistics.recording_left_out = host_.recorder.left_out() + host_.recorder.missed();
    const websocket::ServerStatistics server = host_.server.statistics();
    statistics.clients = static_cast<std::uint32_t>(server.clients);
    statistics.client_drops = server.dropped;
    statistics.frames_not_streamed = host_.topics.frames_not_streamed();
    bytes::ros_messages::encode_statistics(statistics, kSuitFrame, message_);
    statistics_.publish(statistics.time, message_);
  }

  void publish_health() {
    if (!health_.is_wanted()) return;
    const Nanos now = host_.now();
    bytes::ros_messages::encode_diagnostics(host_.parts.diagnoses(), now, kSuitFrame, message_);
    health_.publish(now, message_);
  }

  /// Here, where no array waits: a log may stall as a disk does.
  void report_left_out() {
    const std::uint64_t of_recording = host_.recorder.left_out();
    if (of_recording != std::exchange(left_out_, of_recording) && of_recording > 0) {
      host_.tell_error(fmt::format("the disk of the recording does not follow: {} frames are left out of {}",
                                   of_recording, host_.recorder.path()));
    }
    report_want_of_time();
    const std::uint64_t of_dds = host_.topics.left_out();
    if (of_dds != std::exchange(left_out_of_dds_, of_dds)) {
      host_.tell_error(fmt::format("the network of DDS does not follow: {} messages are left out", of_dds));
    }
  }

  void report_want_of_time() {
    std::uint64_t skipped = 0;
    std::uint64_t most = 0;
    std::string_view array;
    for (std::size_t k = 0; k < host_.suit.arrays.size(); ++k) {
      const std::uint64_t of_array = host_.live.statistics(k).skipped;
      skipped += of_array;
      if (of_array > most) array = host_.suit.arrays[k].name;
      most = std::max(most, of_array);
    }
    const std::uint64_t not_streamed = host_.topics.frames_not_streamed();
    const bool is_more =
        skipped != std::exchange(skipped_, skipped) || not_streamed != std::exchange(not_streamed_, not_streamed);
    if (!is_more) return;
    host_.tell_error(
        fmt::format("the machine does not follow: {} frames have no contacts{}, {} that were due are not "
                    "streamed; all are acquired",
                    skipped, most > 0 ? fmt::format(" ({} of array '{}')", most, array) : "", not_streamed));
  }

  Host& host_;
  Topic health_;
  Topic statistics_;
  AgeingWatch ageing_;
  std::uint64_t left_out_ = 0;  // when it was reported last
  std::uint64_t left_out_of_dds_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t not_streamed_ = 0;
  std::vector<std::uint8_t> message_;
};

}  // namespace

Result<std::unique_ptr<Part>> make_health(Host& host) {
  const Result<Topic> health =
      host.topics.add({.stream = "/health", .dds = "/diagnostics"}, bytes::ros_messages::diagnostics_type());
  if (!health) return health.error();
  const Result<Topic> statistics = host.topics.add({.stream = "/statistics"}, bytes::ros_messages::statistics_type());
  if (!statistics) return statistics.error();
  return std::unique_ptr<Part>(std::make_unique<HealthPart>(host, *health, *statistics));
}

}  // namespace dermis::out::serve
