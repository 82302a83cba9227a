// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

struct FrameStreamOptions {
  const std::atomic<bool>* stop =
      nullptr;  ///< Set: next() returns false within 100 ms, or 2 s where no server answers.
  std::function<void(const std::string&)> notice{};  ///< Told in one line where the server goes and comes back.
};

/// The frames of one array of a robot, as it published them, from the stream of a server. Every RawFrame has the bits
/// that it had there. While the server does not answer it waits, and goes on where it was. Not thread-safe.
class FrameStream final : public FrameSource {
 public:
  /// Fails where no server answers, and where it has nothing of the array.
  [[nodiscard]] static Result<std::unique_ptr<FrameStream>> open(const StreamAddress& address,
                                                                 FrameStreamOptions options = {});
  ~FrameStream() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override;
  [[nodiscard]] SourceStatistics statistics() const override;
  /// An address with `to` ends; it is read as a file is.
  [[nodiscard]] bool is_live() const override;
  [[nodiscard]] std::string place() const override;
  /// The robot's notes on the array.
  [[nodiscard]] const bytes::recordings::FrameNotes& notes() const noexcept;

 private:
  class Implementation;
  explicit FrameStream(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::fleet
