// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/marks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/live/dds/subscriber.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/topics/mark_book.hpp"

namespace dermis::out::serve {
namespace {

using bytes::ros_messages::Mark;
using nlohmann::ordered_json;

constexpr const char* kTopic = "/mark";
constexpr const char* kTextType = "std_msgs::msg::dds_::String_";
constexpr const char* kMilliseconds = "a whole number of milliseconds since 1970";
constexpr std::uint64_t kMostMilliseconds = 9'000'000'000'000;  // the year 2255; Nanos end soon after
constexpr Nanos kLastMinute = std::chrono::minutes(1);
constexpr std::size_t kMostRequest = std::size_t{256} << 10U;

/// The services /marks/... of docs/stream.md: marks are set live, and edited in a recording that is played.
class Marks final : public Part {
 public:
  explicit Marks(Host& host) : host_(host) {}

  [[nodiscard]] std::vector<websocket::Service> services() override {
    std::vector<websocket::Service> services = {{"/marks/list", [this](std::string_view) { return list(); }}};
    if (host_.suit.playback) {
      services.push_back(service("/marks/set", *this, &Marks::set, kMostRequest));
    } else {
      services.push_back(service("/marks/add", *this, &Marks::add));
    }
    return services;
  }

  [[nodiscard]] Status prepare() override {
    if (!host_.suit.playback) return hear_topic();
    Result<std::vector<Mark>> marks =
        bytes::recordings::read_marks(host_.suit.playback->path(), host_.suit.playback->start());
    if (!marks) return marks.error();
    host_.marks.replace(*std::move(marks));
    return Done{};
  }

  void tick(std::int64_t /*tick*/) override {
    const std::string recording = host_.recorder.recording() ? host_.recorder.path() : "";
    if (std::exchange(recording_, recording) != recording && !recording.empty()) {
      host_.marks.begin_recording(host_.now());
    }
  }

 private:
  /// Labels of ROS 2, where it hears the server, too.
  [[nodiscard]] Status hear_topic() {
    if (!host_.options.dds) return Done{};
    const auto heard = [this](const live::dds::Sample& sample) {
      const Result<std::string_view> label = bytes::ros_messages::decode_text(sample.message);
      if (!label || label->size() > bytes::recordings::kMostLabelBytes) return;
      host_.marks.add({.time = host_.now(), .label = std::string(*label), .by = kTopic}, host_.now());
    };
    Result<std::unique_ptr<live::dds::Subscriber>> subscriber =
        live::dds::Subscriber::create(*host_.options.dds, {std::string("rt") + kTopic, kTextType, heard});
    if (!subscriber) return subscriber.error();
    subscriber_ = *std::move(subscriber);
    return Done{};
  }

  /// {"label": "grasp", "by": "anna", "at_ms": 1764480000500}; without a time it is now.
  [[nodiscard]] Result<std::string> add(const JsonRequest& request) {
    const Result<std::string> label = request.text("label", bytes::recordings::kMostLabelBytes);
    if (!label) return label.error();
    const Result<std::string> by = request.text("by");
    if (!by) return by.error();
    const auto at = request.number("at_ms", kMilliseconds);
    if (!at) return at.error();
    const Nanos now = host_.now();
    const Nanos time = *at ? Nanos(std::chrono::milliseconds(std::min(**at, kMostMilliseconds))) : now;
    if (time < now - kLastMinute || time > now + kLastMinute) return bad_field("at_ms", "must be of the last minute");
    host_.marks.add({.time = time, .label = *label, .by = *by}, now);
    return std::string("{}");
  }

  [[nodiscard]] Result<std::string> list() const {
    ordered_json answer{{"marks", ordered_json::array()}};
    for (const Mark& mark : host_.marks.marks()) {
      answer["marks"].push_back({{"time_s", std::chrono::duration<double>(mark.time).count()},
                                 {"label", mark.label},
                                 {"by", mark.by},
                                 {"event", mark.event}});
    }
    return json_text(answer);
  }

  /// {"times_s": [1764480000.5], "labels": ["grasp"]}: all marks of people from now on, in the file beside the
  /// recording.
  [[nodiscard]] Result<std::string> set(const JsonRequest& request) {
    const Result<std::vector<double>> times = request.numbers("times_s");
    if (!times) return times.error();
    const Result<std::vector<std::string>> labels = request.texts("labels");
    if (!labels) return labels.error();
    if (labels->size() != times->size()) return bad_field("labels", "must be as many as times_s");
    const live::suits::Playback& playback = *host_.suit.playback;
    std::vector<Mark> marks;
    for (std::size_t k = 0; k < times->size(); ++k) {
      const bool is_within = (*times)[k] >= std::chrono::duration<double>(playback.start()).count() - 1.0 &&
                             (*times)[k] <= std::chrono::duration<double>(playback.end()).count() + 1.0;
      if (!is_within) return bad_field("times_s", "must be within the recording");
      marks.push_back({.time = Nanos(std::llround(1e9 * (*times)[k])), .label = (*labels)[k]});
    }
    if (Status written = bytes::recordings::write_marks(playback.path(), playback.start(), marks); !written) {
      return written.error();
    }
    if (Status read = prepare(); !read) return read.error();
    return list();
  }

  Host& host_;
  std::string recording_;                              // that goes on
  std::unique_ptr<live::dds::Subscriber> subscriber_;  // null: without DDS
};

}  // namespace

Result<std::unique_ptr<Part>> make_marks(Host& host) {
  return std::unique_ptr<Part>(std::make_unique<Marks>(host));
}

}  // namespace dermis::out::serve
