// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "dermis/live/dds/publisher.hpp"
#include "dermis/live/dds/subscriber.hpp"
#include "dermis/touch/frames/result.hpp"

/// The work of the plugin of Fast DDS. It is loaded when asked for: linked, it would cost every command its start and 9
/// MB.
namespace dermis::live::dds {

/// Writes one topic.
class Writer {
 public:
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  virtual ~Writer() = default;

  /// Thread-safe.
  [[nodiscard]] virtual bool has_readers() const noexcept = 0;
  /// May wait for the network.
  virtual void write(std::span<const std::uint8_t> message) = 0;
};

/// Reads one topic until it is destroyed.
class Reader {
 public:
  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  virtual ~Reader() = default;
};

/// A program in a domain. It must outlive its writers and readers.
class Participant {
 public:
  Participant() = default;
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  virtual ~Participant() = default;

  [[nodiscard]] virtual Result<std::unique_ptr<Writer>> add_writer(const Topic& topic) = 0;
  [[nodiscard]] virtual Result<std::unique_ptr<Reader>> add_reader(const Subscription& subscription) = 0;
};

/// The function of the plugin, and its name.
using OpenParticipant = void (*)(const PublisherOptions& options, Result<std::unique_ptr<Participant>>& opened);
inline constexpr const char* kOpenParticipant = "dermis_open_participant";

[[nodiscard]] Result<std::unique_ptr<Participant>> open_participant(const PublisherOptions& options);

}  // namespace dermis::live::dds
