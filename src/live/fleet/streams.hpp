// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "live/fleet/broker.hpp"

/// Streams of JetStream (https://docs.nats.io/reference/reference-protocols/nats_api_reference).
namespace dermis::live::fleet {

/// The stream of a robot, on the disk of its own server. One that is there keeps its settings.
[[nodiscard]] Status make_stream(Broker& broker, const std::string& robot);

/// A copy of a robot's stream, with the same numbers, which follows that of the robot's server. One that is there
/// stays.
[[nodiscard]] Status mirror_stream(Broker& broker, const std::string& robot);

/// Whether the server has a stream of this name.
[[nodiscard]] Result<bool> has_stream(Broker& broker, const std::string& name);

/// Messages of one subject in a stream.
struct StreamSubject {
  std::string stream;
  std::string subject;
};

/// The number of the first message since a time, among those before `newest`; else `newest`.
[[nodiscard]] Result<std::uint64_t> first_since(Broker& broker, const StreamSubject& of, Nanos time,
                                                std::uint64_t newest);

/// The domain of the server; empty: it has none.
[[nodiscard]] Result<std::string> domain_of(Broker& broker);

/// The domain of a hub.
inline constexpr const char* kHubDomain = "hub";

/// A store of keys, each of which ends when it was not stored for so long. One that is there stays.
[[nodiscard]] Status make_key_store(Broker& broker, const std::string& name, Nanos lasts);

/// A stream that keeps the last message of each subject.
[[nodiscard]] Status make_log(Broker& broker, const std::string& name, const std::string& subjects);

}  // namespace dermis::live::fleet
