// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/threat_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>

#include "dermis/bytes/devices/protocol.hpp"
#include "support/force_mat.hpp"

namespace dermis::live::forces {
namespace {

using support::error_of;
using support::kShape;
using support::MatFiles;
using support::pressed;

/// A watch on the frames of a source, for contacts beyond a limit [N], and what it logs: "hard begins at 10 ms".
class Watched {
 public:
  Watched(const MatFiles& mat, const std::string& from, Status logged = Done{}, double limit = 5.0)
      : logged_(std::move(logged)) {
    auto operation = open_operation(mat.model(), from, {.stop = &stop});
    EXPECT_TRUE(operation) << error_of(operation);
    operation_ = *std::move(operation);
    limits_.limits = {{.name = "hard", .quantity = threats::ThreatQuantity::contact_force, .limit = limit}};
    const ArrayDescription& array = operation_->model.array;
    auto monitor = threats::ThreatMonitor::create(limits_, array.name, array);
    EXPECT_TRUE(monitor) << error_of(monitor);
    watch_.emplace(*operation_, *std::move(monitor), limits_, stop,
                   [this](const std::vector<ThreatEvent>& events) { return log(events); });
  }

  ThreatWatch::News wait_until_over() {
    ThreatWatch::News news;
    while (!news.is_over) news = watch_->wait(std::chrono::seconds(1));
    return news;
  }
  ThreatWatch::News wait_a_moment() { return watch_->wait(std::chrono::milliseconds(1)); }
  /// All that was logged, once the watch has ended.
  std::vector<std::string> log_at_end() {
    watch_.reset();
    return lines_;
  }

  std::atomic<bool> stop = false;

 private:
  Status log(const std::vector<ThreatEvent>& events) {
    for (const ThreatEvent& event : events) {
      const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(event.time - event.first_time);
      lines_.push_back(event.limit.name + (event.begins() ? " begins at " : " ends at ") +
                       std::to_string(milliseconds.count()) + " ms");
    }
    return logged_;
  }

  Status logged_;
  std::unique_ptr<Operation> operation_;
  threats::ThreatLimits limits_;
  std::vector<std::string> lines_;
  std::optional<ThreatWatch> watch_;
};

/// The bytes of a device that sends those frames.
std::string device_of(const MatFiles& mat, const std::vector<RawFrame>& frames) {
  const auto encoder = *bytes::devices::make_encoder({.name = "dermis", .shape = kShape});
  std::vector<std::uint8_t> bytes;
  for (const RawFrame& frame : frames) encoder->encode(frame, bytes);
  support::write_bytes(mat.file("device.bin"), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return "file:" + mat.file("device.bin") + "?protocol=dermis";
}

TEST(ThreatWatch, logs_when_threats_begin_and_end_and_reads_a_file_to_its_end) {
  const MatFiles mat;
  Watched watched(mat, mat.write("frames.csv", pressed({0.0F, 8.0F, 8.0F, 1.0F, 9.0F})));
  const ThreatWatch::News news = watched.wait_until_over();
  EXPECT_TRUE(news.any_threat);
  EXPECT_TRUE(news.has_begun);
  EXPECT_TRUE(news.source);
  EXPECT_EQ(watched.log_at_end(),
            (std::vector<std::string>{"hard begins at 10 ms", "hard ends at 30 ms", "hard begins at 40 ms"}));
}

TEST(ThreatWatch, has_no_threat_below_the_limit) {
  const MatFiles mat;
  Watched watched(mat, mat.write("frames.csv", pressed({0.0F, 4.0F, 4.0F})));
  const ThreatWatch::News news = watched.wait_until_over();
  EXPECT_FALSE(news.any_threat);
  EXPECT_TRUE(news.has_begun);
  EXPECT_TRUE(watched.log_at_end().empty());
}

TEST(ThreatWatch, of_a_live_source_is_over_with_the_first_threat) {
  const MatFiles mat;
  Watched watched(mat, device_of(mat, pressed({0.0F, 8.0F, 0.0F, 8.0F})));
  EXPECT_TRUE(watched.wait_until_over().any_threat);
  EXPECT_EQ(watched.log_at_end().size(), 1U);
}

TEST(ThreatWatch, tells_why_its_source_or_its_log_has_failed) {
  const MatFiles mat;
  Watched no_log(mat, mat.write("frames.csv", pressed({8.0F, 0.0F, 8.0F})), failed("no paper"));
  const ThreatWatch::News news = no_log.wait_until_over();
  ASSERT_FALSE(news.source);
  EXPECT_EQ(news.source.error().message, "no paper");
  EXPECT_TRUE(news.any_threat);
  EXPECT_EQ(no_log.log_at_end().size(), 1U);

  support::write_bytes(mat.file("cut.csv"), mat.text_of("frames.csv") + "1.5,7\n");
  Watched no_source(mat, mat.file("cut.csv"));
  const ThreatWatch::News end = no_source.wait_until_over();
  ASSERT_FALSE(end.source);
  EXPECT_NE(end.source.error().message.find("cut.csv:5"), std::string::npos) << end.source.error().message;
}

TEST(ThreatWatch, ends_with_its_object_while_the_source_goes_on) {
  const MatFiles mat;
  Watched watched(mat, "sim:idle?rate=100&rows=3&cols=4", Done{}, 1e9);
  EXPECT_FALSE(watched.wait_a_moment().is_over);
  EXPECT_TRUE(watched.log_at_end().empty());
  EXPECT_TRUE(watched.stop);
}

}  // namespace
}  // namespace dermis::live::forces
