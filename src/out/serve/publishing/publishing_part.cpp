// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "dermis/live/fleet/frame_publisher.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recording/recorded_arrays.hpp"
#include "out/serve/topics/contacts_in_suit.hpp"

namespace dermis::out::serve {
namespace {

/// The address of the page, as others reach it; a server of this machine alone has that of the machine for itself.
std::string live_address(const Host& host) {
  std::string name = host.options.server.host;
  if (name == "0.0.0.0" || name == "::") {
    std::array<char, 256> own{};
    if (gethostname(own.data(), own.size() - 1) == 0) name = own.data();
  }
  if (name.find(':') != std::string::npos) name = "[" + name + "]";
  return "http://" + name + ":" + std::to_string(host.server.port()) + "/";
}

/// "chest.safetensors"; a new one has no file that the suit knows of.
std::string model_name(const Host& host, std::size_t array) {
  if (learn::calibration::is_uncalibrated(*host.models.of(array))) return "";
  if (host.models.is_new(array)) return "new";
  return std::filesystem::path(host.suit.arrays[array].model_path).filename().string();
}

/// Contacts that last are published so often; every frame is there, too.
constexpr Nanos kContactsEvery = std::chrono::milliseconds(40);

/// Frames that have waited leave holes between what has not, and the C library would keep them. It takes some 5 ms.
constexpr std::int64_t kTicksToGiveBackMemory = std::int64_t{60} * Part::kTicksPerSecond;

/// The contacts of an array, on its thread.
struct TouchedArray {
  TouchedArray(const ServedSuit& suit, std::size_t array) : contacts(suit, array) {}

  ContactsInSuit contacts;
  Nanos published{};
  std::vector<std::uint8_t> message{};
};

/// Publishes the frames of the arrays for a fleet, and how the arrays are.
class Publishing final : public Part {
 public:
  Publishing(Host& host, std::unique_ptr<live::fleet::FramePublisher> publisher)
      : host_(host), live_(live_address(host)), publisher_(std::move(publisher)) {
    for (std::size_t k = 0; k < host.suit.arrays.size(); ++k) contacts_.emplace_back(host.suit, k);
  }

  void keep(std::size_t array, const RawFrame& frame) override { publisher_->publish(array, frame); }
  void hear(const live::suits::ArrayResult& result) override;
  void tick(std::int64_t tick) override;
  void diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const override;
  void report(live::fleet::RobotHealth& health) const override;

 private:
  Host& host_;
  const std::string live_;
  std::deque<TouchedArray> contacts_;
  const std::unique_ptr<live::fleet::FramePublisher> publisher_;
};

void Publishing::hear(const live::suits::ArrayResult& result) {
  const std::vector<Contact>& contacts = result.report.contacts;
  if (contacts.empty()) return;
  TouchedArray& array = contacts_[result.array];
  const bool is_news = std::any_of(contacts.begin(), contacts.end(),
                                   [](const Contact& contact) { return contact.phase != ContactPhase::held; });
  const Nanos since = result.report.time - array.published;
  if (!is_news && since >= Nanos{} && since < kContactsEvery) return;
  array.published = result.report.time;
  array.contacts.take(result);
  array.contacts.encode(result, array.message);
  publisher_->publish_contacts(result.array, result.report.time, array.message);
}

void Publishing::tick(std::int64_t tick) {
  if (tick % kTicksToGiveBackMemory == 0) ::malloc_trim(0);
  if (tick % kTicksPerSecond != 7) return;
  live::fleet::RobotHealth health{.time = std::chrono::system_clock::now().time_since_epoch(), .live = live_};
  for (std::size_t k = 0; k < host_.suit.arrays.size(); ++k) {
    const ArrayDescription& description = host_.models.of(k)->array;
    health.arrays.push_back({.name = host_.suit.arrays[k].name,
                             .shape = {description.rows, description.cols},
                             .model = model_name(host_, k)});
  }
  const std::string recordings = host_.options.recordings.empty() ? host_.options.record : host_.options.recordings;
  std::error_code error;
  const auto folder = std::filesystem::absolute(recordings.empty() ? "." : recordings, error).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (!error) health.free_bytes = space.available;
  host_.parts.report(health);
  publisher_->publish(health);
}

void Publishing::report(live::fleet::RobotHealth& health) const {
  for (std::size_t k = 0; k < health.arrays.size(); ++k) health.arrays[k].left_out = publisher_->left_out(k);
}

void Publishing::diagnose(std::vector<bytes::ros_messages::Diagnosis>& diagnoses) const {
  using Level = bytes::ros_messages::Diagnosis::Level;
  const live::fleet::PublisherCounts counts = publisher_->counts();
  const bool is_whole = counts.left_out == 0;
  diagnoses.push_back({is_whole ? Level::ok : Level::warning,
                       "publishing",
                       is_whole ? "frames are published" : "frames were left out, as the server did not follow",
                       "",
                       {{"batches", std::to_string(counts.batches)},
                        {"frames", std::to_string(counts.frames)},
                        {"bytes", std::to_string(counts.bytes)},
                        {"left out", std::to_string(counts.left_out)}}});
}

}  // namespace

Result<std::unique_ptr<Part>> make_publishing(Host& host) {
  if (!host.options.publish) return std::unique_ptr<Part>();
  live::fleet::PublisherOptions options = *host.options.publish;
  options.notice = [&host](const std::string& line) { host.notify(line); };
  Result<std::unique_ptr<live::fleet::FramePublisher>> publisher =
      live::fleet::FramePublisher::create(recorded_arrays(host.suit, host.models), std::move(options));
  if (!publisher) return publisher.error();
  return std::unique_ptr<Part>(std::make_unique<Publishing>(host, *std::move(publisher)));
}

}  // namespace dermis::out::serve
