// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>
#include <string>
#include <utility>

#include "dermis/fleet/frame_publisher.hpp"
#include "serve/parts/part_makers.hpp"
#include "serve/recording/recorded_arrays.hpp"

namespace dermis::serve {
namespace {

/// Publishes the frames of the arrays for a fleet.
class Publishing final : public Part {
 public:
  explicit Publishing(std::unique_ptr<fleet::FramePublisher> publisher) : publisher_(std::move(publisher)) {}

  void keep(std::size_t array, const RawFrame& frame) override { publisher_->publish(array, frame); }
  void diagnose(std::vector<messages::Diagnosis>& diagnoses) const override;

 private:
  const std::unique_ptr<fleet::FramePublisher> publisher_;
};

void Publishing::diagnose(std::vector<messages::Diagnosis>& diagnoses) const {
  using Level = messages::Diagnosis::Level;
  const fleet::PublisherCounts counts = publisher_->counts();
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
  fleet::PublisherOptions options = *host.options.publish;
  options.notice = [&host](const std::string& line) { host.notify(line); };
  Result<std::unique_ptr<fleet::FramePublisher>> publisher =
      fleet::FramePublisher::create(recorded_arrays(host.suit, host.models), std::move(options));
  if (!publisher) return publisher.error();
  return std::unique_ptr<Part>(std::make_unique<Publishing>(*std::move(publisher)));
}

}  // namespace dermis::serve
