// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/topics/suit_transforms.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kMostJointsBytes = std::size_t{64} << 10U;

/// Where the arrays are, and the body that carries them where there is one.
class BodyPart final : public Part {
 public:
  BodyPart(const ServedSuit& suit, Host& host, const Topic& transforms)
      : suit_(suit), host_(host), transforms_(transforms) {}

  [[nodiscard]] std::vector<websocket::Service> services() override {
    if (!suit_.body) return {};
    return {service("/body/joints", *this, &BodyPart::set_joints, kMostJointsBytes)};
  }

  /// Offers the meshes of the body, which /suit.json names, and publishes the present places for later nodes.
  [[nodiscard]] Status prepare() override {
    publish(Ends::dds);
    if (!suit_.body) return Done{};
    for (const BodyFile& file : suit_.body->files()) {
      host_.server.set_document(file.path, file.path.ends_with(".stl") ? "model/stl" : "model/gltf-binary", file.bytes);
    }
    return Done{};
  }

  void tick(std::int64_t tick) override {
    const std::uint64_t moved = suit_.body ? suit_.body->version() : 0;
    const bool has_moved = std::exchange(version_, moved) != moved;
    if (has_moved) publish(Ends::dds);
    if (has_moved) publish(Ends::stream);
    if (!has_moved && tick % kTicksPerSecond == kTickOfSecond && transforms_.is_wanted(Ends::stream)) {
      publish(Ends::stream);
    }
  }

 private:
  static constexpr std::int64_t kTickOfSecond = 20;

  /// {"name": ["elbow"], "position": [1.2]}, as sensor_msgs/JointState.
  [[nodiscard]] Result<std::string> set_joints(const JsonRequest& request) {
    const Result<std::vector<std::string>> names = request.texts("name");
    if (!names) return names.error();
    const Result<std::vector<double>> positions = request.numbers("position");
    if (!positions) return positions.error();
    if (Status set = suit_.body->set_joints(*names, *positions); !set) return set.error();
    return std::string("{}");
  }

  void publish(Ends ends) {
    const Nanos time = ends == Ends::dds ? std::chrono::system_clock::now().time_since_epoch() : host_.now();
    bytes::ros_messages::encode_transforms(suit_transforms(suit_), time, message_);
    transforms_.publish(time, message_, ends);
  }

  const ServedSuit& suit_;
  Host& host_;
  Topic transforms_;
  std::uint64_t version_ = 0;  // of the body, of which the transforms were published
  std::vector<std::uint8_t> message_;
};

}  // namespace

Result<std::unique_ptr<Part>> make_body(Host& host) {
  const Result<Topic> transforms =
      host.topics.add({.stream = "/tf", .dds = "/tf_static"}, bytes::ros_messages::transforms_type(),
                      Topics::kMessageBytes, Topics::Keep::last);
  if (!transforms) return transforms.error();
  return std::unique_ptr<Part>(std::make_unique<BodyPart>(host.suit, host, *transforms));
}

}  // namespace dermis::out::serve
