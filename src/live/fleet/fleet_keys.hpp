// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "dermis/touch/frames/result.hpp"

/// Keys and certificates of a fleet. The plugin of NATS makes them, as it has the library of keys. All are Ed25519.
namespace dermis::live::fleet {

/// Who holds a certificate: one that signs others, a server, or the server of a robot.
enum class Holder : std::uint8_t { authority, server, robot };

struct CertificatePlan {
  Holder holder = Holder::authority;
  std::string name{};           ///< For people.
  std::string other_names{};    ///< "DNS:hub.local,IP:10.0.0.1", "email:anna@robots"; empty: none.
  std::string key{};            ///< That of the holder, in PEM.
  std::string authority{};      ///< The certificate that signs it, in PEM; empty: it signs itself.
  std::string authority_key{};  ///< In PEM; empty: it signs itself.
};

class FleetKeys {
 public:
  FleetKeys() = default;
  FleetKeys(const FleetKeys&) = delete;
  FleetKeys& operator=(const FleetKeys&) = delete;
  virtual ~FleetKeys() = default;

  /// A new private key, in PEM.
  [[nodiscard]] virtual Result<std::string> make_key() = 0;
  /// In PEM. It never ends: a fleet is not to stop at a date.
  [[nodiscard]] virtual Result<std::string> make_certificate(const CertificatePlan& plan) = 0;
  /// The seed of a new user of NATS: "SU" and 56 characters more.
  [[nodiscard]] virtual Result<std::string> make_seed() = 0;
  /// The user of a seed: "U" and 55 characters more. No error shows the seed.
  [[nodiscard]] virtual Result<std::string> user_of(const std::string& seed) = 0;
};

/// The function of the plugin, and its name.
using MakeFleetKeys = void (*)(std::unique_ptr<FleetKeys>& made);
inline constexpr const char* kMakeFleetKeys = "dermis_make_fleet_keys";

/// Loads the plugin. Fails where the plugin or its library is not there.
[[nodiscard]] Result<std::unique_ptr<FleetKeys>> load_fleet_keys();

}  // namespace dermis::live::fleet
