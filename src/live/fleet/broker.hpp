// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// The work of the plugin of NATS. It is loaded when asked for, as that of DDS is.
namespace dermis::live::fleet {

/// A message that a server keeps.
struct StoredMessage {
  std::uint64_t sequence = 0;  ///< In its stream, from 1 on.
  Nanos time{};                ///< It arrived then at the first server, by UTC.
  std::string id;              ///< As it was published.
  std::vector<std::uint8_t> bytes;
};

/// In the message of a failure to store.
inline constexpr const char* kDiskIsFull = "its disk is full";

/// A connection to a server. It connects again by itself; meanwhile all fail. Thread-safe.
class Broker {
 public:
  Broker() = default;
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;
  virtual ~Broker() = default;

  /// The answer to a request, such as those of the API of JetStream in JSON.
  [[nodiscard]] virtual Result<std::string> ask(const std::string& subject, const std::string& request) = 0;
  /// All that waits for an answer, or asks from now on, fails at once.
  virtual void stop() = 0;
  /// Does not wait for an answer.
  [[nodiscard]] virtual Status send(const std::string& subject, const std::string& text) = 0;
  /// Waits until the server has stored the message; returns its sequence. A message of an id that came within the last
  /// two minutes is stored once; an empty id is none.
  [[nodiscard]] virtual Result<std::uint64_t> store(const std::string& subject, const std::string& id,
                                                    std::span<const std::uint8_t> bytes) = 0;
  /// Stores the message where the last one of its subject has this sequence, 0: where there is none. Returns its
  /// sequence; empty where the last one is another.
  [[nodiscard]] virtual Result<std::optional<std::uint64_t>> store_after(std::uint64_t last, const std::string& subject,
                                                                         std::string_view text) = 0;
  /// The last message of a subject; empty where there is none. `domain`: of a server behind this one; empty: this one.
  [[nodiscard]] virtual Result<std::optional<StoredMessage>> last(const std::string& stream, const std::string& subject,
                                                                  const std::string& domain = "") = 0;
  /// The first message of a subject with this sequence or a later one; empty where there is none yet.
  [[nodiscard]] virtual Result<std::optional<StoredMessage>> next(const std::string& stream, const std::string& subject,
                                                                  std::uint64_t sequence) = 0;
};

/// The function of the plugin, and its name. `password`: of the user of the address, a token without one, or empty.
using ConnectBroker = void (*)(const BrokerAddress& address, const std::string& password,
                               Result<std::unique_ptr<Broker>>& connected);
inline constexpr const char* kConnectBroker = "dermis_connect_broker";

/// The same of SHA-256: as 64 small hexadecimal digits.
using FindSha256 = void (*)(std::string_view bytes, std::string& digits);
inline constexpr const char* kFindSha256 = "dermis_sha256";

/// Finds the password, loads the plugin and connects. Fails where the plugin or its library is not there, and where no
/// server answers.
[[nodiscard]] Result<std::unique_ptr<Broker>> connect_broker(const BrokerAddress& address);

}  // namespace dermis::live::fleet
